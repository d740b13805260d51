"""Sums of products of a model's factors, with what their coefficients owe to uncertain constants.

A polynomial is {monomial: Value}; a monomial is a sorted tuple of (factor, power). Factors are
those of an AeroModel and the rates 'p', 'q', 'r' (rad/s), which become phat, qhat, rhat with V.
Powers may be negative on the way.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.model import Factor

Monomial = tuple[tuple[Factor, int], ...]
ONE: Monomial = ()
MOST_TERMS = 2000
_ROUNDING = 8 * 2.0**-52


@dataclass(frozen=True)
class Value:
    """A number, and its derivative with respect to each uncertain constant (by varID)."""

    value: float
    slopes: Mapping[str, float] = field(default_factory=dict)

    def plus(self, other: Value) -> Value:
        """The sum."""
        keys = {**self.slopes, **other.slopes}
        return Value(
            self.value + other.value,
            {k: self.slopes.get(k, 0.0) + other.slopes.get(k, 0.0) for k in keys},
        )

    def times(self, other: Value) -> Value:
        """The product."""
        keys = {**self.slopes, **other.slopes}
        return Value(
            self.value * other.value,
            {
                k: self.slopes.get(k, 0.0) * other.value + self.value * other.slopes.get(k, 0.0)
                for k in keys
            },
        )

    def inverse(self) -> Value:
        """1 over it."""
        one = 1.0 / self.value
        return Value(one, {k: -s * one * one for k, s in self.slopes.items()})


Polynomial = dict[Monomial, Value]


def constant(value: float, slopes: Mapping[str, float] | None = None) -> Polynomial:
    """A number."""
    return {ONE: Value(value, slopes or {})}


def single(factor: Factor, coefficient: float = 1.0) -> Polynomial:
    """A number times one factor."""
    return {((factor.base, factor.power),): Value(coefficient)}


def add(a: Polynomial, b: Polynomial) -> Polynomial:
    """The sum; terms that cancel are gone."""
    out = dict(a)
    for m, v in b.items():
        out[m] = out[m].plus(v) if m in out else v
    return {m: v for m, v in out.items() if v.value != 0.0 or any(v.slopes.values())}


def scaled(a: Polynomial, factor: float) -> Polynomial:
    """A number times the polynomial."""
    return {m: v.times(Value(factor)) for m, v in a.items()}


def multiply(a: Polynomial, b: Polynomial, lengths: Mapping[str, float]) -> Polynomial:
    """The product. lengths: b for 'p' and 'r', c for 'q', which join with V; see `joined`."""
    out: Polynomial = {}
    for m, v in a.items():
        for n, w in b.items():
            powers = dict(m)
            for f, power in n:
                powers[f] = powers.get(f, 0) + power
            monomial, factor = joined(powers, lengths)
            value = v.times(w)
            if factor != 1.0:
                value = _clean(value.times(Value(factor)))
            out = add(out, {monomial: value})
    if len(out) > MOST_TERMS:
        raise OverflowError
    return out


def joined(powers: Mapping[Factor, int], lengths: Mapping[str, float]) -> tuple[Monomial, float]:
    """The monomial in normal form, and the number that comes out of it.

    p/V is 2/b phat (so with q and c, r and b); sign(x) x is abs(x); an even power of a sign is 1.
    """
    left = {f: k for f, k in powers.items() if k != 0}
    number = 1.0
    V = Factor("V")
    for rate, length in lengths.items():
        raw = Factor(rate)
        pairs = min(left.get(raw, 0), -left.get(V, 0))
        if pairs > 0:
            hat = Factor(rate + "hat")
            left[raw] -= pairs
            left[V] += pairs
            left[hat] = left.get(hat, 0) + pairs
            number *= (2.0 / length) ** pairs
    for f in [f for f in left if f.kind == "sign"]:
        left[f] = left[f] % 2
        plain = Factor(f.variable)
        if left[f] and left.get(plain, 0) > 0:
            left[f] = 0
            left[plain] -= 1
            size = Factor(f.variable, kind="abs")
            left[size] = left.get(size, 0) + 1
    items = sorted(((f, k) for f, k in left.items() if k), key=lambda item: repr(item[0]))
    return tuple(items), number


def as_constant(a: Polynomial) -> Value | None:
    """Its value where it is a number."""
    if not a:
        return Value(0.0)
    return a[ONE] if set(a) == {ONE} else None


def as_line(a: Polynomial) -> tuple[Factor, float, float] | None:
    """Factor x, slope k and knot c where it is k (x - c) of one factor to the first power."""
    rest = [m for m in a if m != ONE]
    if len(rest) != 1 or len(rest[0]) != 1 or rest[0][0][1] != 1:
        return None
    slope = a[rest[0]].value
    at = a[ONE].value if ONE in a else 0.0
    return rest[0][0][0], slope, -at / slope + 0.0  # no negative zero


def tidy(a: Polynomial) -> Polynomial:
    """A variable that is phat, qhat or rhat but for rounding is that."""
    if len(a) == 1:
        ((monomial, value),) = a.items()
        if len(monomial) == 1 and monomial[0][0].variable in ("phat", "qhat", "rhat"):
            return {monomial: _clean(value)}
    return a


def _clean(value: Value) -> Value:
    """A one that rounding has touched is a one: p b/(2V) is phat."""
    return Value(1.0, value.slopes) if abs(value.value - 1.0) <= _ROUNDING else value
