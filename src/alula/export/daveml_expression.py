"""Calculations of a DAVE-ML file: MathML content markup as a small tree, and its value."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse

_CONSTANTS = {"pi": math.pi, "exponentiale": math.e, "true": 1.0, "false": 0.0}
_UNARY: dict[str, Callable[[Array], Array]] = {
    "abs": np.abs,
    "exp": np.exp,
    "ln": np.log,
    "floor": np.floor,
    "ceiling": np.ceil,
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "sec": lambda x: 1.0 / np.cos(x),
    "csc": lambda x: 1.0 / np.sin(x),
    "cot": lambda x: 1.0 / np.tan(x),
    "arcsin": np.arcsin,
    "arccos": np.arccos,
    "arctan": np.arctan,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "not": lambda x: np.where(x != 0.0, 0.0, 1.0),
}
_BINARY: dict[str, Callable[[Array, Array], Array]] = {
    "divide": np.divide,
    "power": np.power,
    "atan2": np.arctan2,
    "lt": np.less,
    "leq": np.less_equal,
    "gt": np.greater,
    "geq": np.greater_equal,
    "eq": np.equal,
    "neq": np.not_equal,
}
_MANY: dict[str, Callable[[Array, Array], Array]] = {
    "plus": np.add,
    "times": np.multiply,
    "min": np.minimum,
    "max": np.maximum,
    "and": lambda a, b: (a != 0.0) & (b != 0.0),
    "or": lambda a, b: (a != 0.0) | (b != 0.0),
}
RELATIONS = ("lt", "leq", "gt", "geq", "eq", "neq")


@dataclass(frozen=True)
class Expression:
    """A number ('cn', in `value`), a variable ('ci', in `name`) or an operation on `args`.

    'piecewise' has value, condition, value, condition, ..., and the 'otherwise' last, if any.
    Angles of the trigonometric functions are in rad; relations are 1 or 0.
    """

    op: str
    args: tuple[Expression, ...] = ()
    value: float = 0.0
    name: str = ""

    def names(self) -> set[str]:
        """The variables it needs."""
        if self.op == "ci":
            return {self.name}
        return set().union(*(a.names() for a in self.args))

    def evaluate(self, variables: Mapping[str, Array]) -> Array:
        """Its value (n,) for variables (n,) by varID."""
        if self.op == "cn":
            return np.asarray(self.value)
        if self.op == "ci":
            return variables[self.name]
        values = [a.evaluate(variables) for a in self.args]
        if self.op == "minus":
            return -values[0] if len(values) == 1 else values[0] - values[1]
        if self.op == "root":  # degree, radicand
            return np.power(values[1], 1.0 / values[0])
        if self.op == "log":  # base, argument
            return np.log(values[1]) / np.log(values[0])
        if self.op == "piecewise":
            return _piecewise(values)
        if self.op in _UNARY:
            return _UNARY[self.op](values[0])
        if self.op in _BINARY:
            return np.asarray(_BINARY[self.op](values[0], values[1]), dtype=np.float64)
        out = values[0]
        for other in values[1:]:
            out = np.asarray(_MANY[self.op](out, other), dtype=np.float64)
        return out


def number(value: float) -> Expression:
    """A constant."""
    return Expression("cn", value=value)


def variable(name: str) -> Expression:
    """A variable by its varID."""
    return Expression("ci", name=name)


def from_mathml(element: Element, where: str) -> Expression:
    """The expression of a `math` element or of one inside it; raises BadInput at `where`."""
    tag, children = element.tag, list(element)
    if tag == "math":
        return from_mathml(_only(children, where, "one expression"), where)
    if tag == "cn":
        return number(_number(element, where))
    if tag == "ci":
        return variable((element.text or "").strip())
    if tag in _CONSTANTS:
        return number(_CONSTANTS[tag])
    if tag == "piecewise":
        return _read_piecewise(children, where)
    if tag != "apply" or not children:
        raise _wrong(where, f"<{tag}>")
    first, *rest = children
    if first.tag in ("piecewise", "apply") and not rest:  # met in files: an apply around one
        return from_mathml(first, where)
    op = first.tag
    if op == "csymbol":
        url = first.get("definitionURL", "")
        op = "atan2" if url.endswith("#atan2") or (first.text or "").strip() == "atan2" else url
    if op in ("root", "log"):
        return _read_root(op, rest, where)
    args = tuple(from_mathml(e, where) for e in rest)
    right = (
        (op in _UNARY and len(args) == 1)
        or (op in _BINARY and len(args) == 2)
        or (op in _MANY and len(args) >= 1)
        or (op == "minus" and len(args) in (1, 2))
    )
    if not right:
        raise _wrong(where, f"'{op}' of {len(args)} arguments")
    return Expression(op, args)


def to_mathml(expression: Expression, parent: Element) -> None:
    """Append the expression's markup to `parent`."""
    e = expression
    if e.op == "cn":
        _append(parent, "cn", repr(e.value))
    elif e.op == "ci":
        _append(parent, "ci", e.name)
    elif e.op == "piecewise":
        whole = _append(parent, "piecewise")
        pairs = len(e.args) // 2
        for i in range(pairs):
            piece = _append(whole, "piece")
            to_mathml(e.args[2 * i], piece)
            to_mathml(e.args[2 * i + 1], piece)
        if len(e.args) % 2:
            to_mathml(e.args[-1], _append(whole, "otherwise"))
    else:
        apply = _append(parent, "apply")
        _append(apply, e.op)
        for argument in e.args:
            to_mathml(argument, apply)


def _append(parent: Element, tag: str, text: str | None = None) -> Element:
    child = Element(tag)
    child.text = text
    parent.append(child)
    return child


def _piecewise(values: list[Array]) -> Array:
    out = values[-1] if len(values) % 2 else np.asarray(np.nan)
    for i in reversed(range(len(values) // 2)):  # the first that holds counts
        out = np.where(values[2 * i + 1] != 0.0, values[2 * i], out)
    return out


def _read_piecewise(children: list[Element], where: str) -> Expression:
    args: list[Expression] = []
    for i, child in enumerate(children):
        parts = [from_mathml(e, where) for e in child]
        wanted = {"piece": 2, "otherwise": 1}.get(child.tag)
        if len(parts) != wanted or (wanted == 1 and i + 1 != len(children)):
            raise _wrong(where, f"<{child.tag}> of {len(parts)} parts in <piecewise>")
        args += parts
    if not args:
        raise _wrong(where, "an empty <piecewise>")
    return Expression("piecewise", tuple(args))


def _read_root(op: str, rest: list[Element], where: str) -> Expression:
    special = {"root": "degree", "log": "logbase"}[op]
    first = next((e for e in rest if e.tag == special), None)
    argument = _only([e for e in rest if e is not first], where, f"one argument of '{op}'")
    default = number(2.0 if op == "root" else 10.0)
    by = default if first is None else from_mathml(_only(list(first), where, "a number"), where)
    return Expression(op, (by, from_mathml(argument, where)))


def _number(element: Element, where: str) -> float:
    parts = [element.text or "", *((e.tail or "") for e in element if e.tag == "sep")]
    try:
        numbers = [float(p) for p in parts]
        kind = element.get("type", "real")
        if kind == "e-notation" and len(numbers) == 2:
            return float(f"{parts[0].strip()}e{int(numbers[1])}")
        if kind == "rational" and len(numbers) == 2:
            return numbers[0] / numbers[1]
        if len(numbers) == 1 and element.get("base", "10") == "10":
            return numbers[0]
    except (ValueError, ZeroDivisionError, OverflowError):
        pass
    raise _wrong(where, f"<cn> {' '.join(parts).strip()!r}")


def _only(elements: list[Element], where: str, what: str) -> Element:
    if len(elements) != 1:
        raise _wrong(where, f"{len(elements)} elements instead of {what}")
    return elements[0]


def _wrong(where: str, found: str) -> BadInput:
    return refuse(
        "daveml_math",
        where=where,
        expected="MathML content markup with arithmetic, relations, piecewise, trigonometric and "
        "logarithmic functions, min, max, atan2",
        found=found,
        do="Rewrite the calculation with these.",
    )
