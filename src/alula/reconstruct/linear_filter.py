"""Linear Kalman filter and smoother for any constant linear system.

Dittrich 2016, Eq. (3.15) to (3.21), with the covariance in Joseph's form; Rauch, Tung, Striebel
1965. Flight path reconstruction is not linear: it has the filters of alula.reconstruct.kalman. This
one is for signals: a bias that wanders, a height from pressure and acceleration, a rate.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, refuse
from alula.core import core


@dataclass(frozen=True)
class LinearSystem:
    """x(k+1) = transition x(k) + input u(k) + gain w(k),  z(k) = output x(k) + v(k).

    transition (n, n); output (m, n); process (q, q): covariance of w over one step; noise (m, m):
    covariance of v; gain (n, q), default the unit matrix; input (n, i), default none. The units are
    the caller's own. Raises BadInput where shapes disagree or a covariance is none.
    """

    transition: Array
    output: Array
    process: Array
    noise: Array
    gain: Array | None = None
    input: Array | None = None

    def __post_init__(self) -> None:
        """Matrices as float arrays, looked at once."""
        for name in ("transition", "output", "process", "noise", "gain", "input"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, np.atleast_2d(np.asarray(value, dtype=float)))
        n, m = len(self.transition), len(self.output)
        q = n if self.gain is None else self.gain.shape[1]
        expected = {"transition": (n, n), "output": (m, n), "process": (q, q), "noise": (m, m)}
        if self.gain is not None:
            expected["gain"] = (n, q)
        if self.input is not None:
            expected["input"] = (n, self.input.shape[1])
        if not 1 <= n <= core.MAX_STATES or not 1 <= m <= core.MAX_OUTPUTS:
            raise _wrong(
                "transition, output",
                f"up to {core.MAX_STATES} states and {core.MAX_OUTPUTS} outputs",
                f"{n} and {m}",
            )
        for name, shape in expected.items():
            value = getattr(self, name)
            if value.shape != shape or not np.all(np.isfinite(value)):
                raise _wrong(name, f"finite numbers of shape {shape}", f"shape {value.shape}")
        for name, strict in (("process", False), ("noise", True)):
            _covariance(name, getattr(self, name), strict)


@dataclass(frozen=True)
class LinearEstimate:
    """x (samples, n) with covariance (samples, n, n): given all readings where smoothed, else those
    so far. innovation (samples, m) and its standard deviation, NaN where there was no reading; nis
    (samples,) its normalized square, on average the number of readings where the noise is as
    stated.
    """

    x: Array
    covariance: Array
    innovation: Array
    deviation: Array
    nis: Array

    @property
    def se(self) -> Array:
        """Standard deviations (samples, n) of x."""
        return np.asarray(np.sqrt(np.diagonal(self.covariance, axis1=1, axis2=2)))


def linear_filter(
    system: LinearSystem,
    readings: Array,
    x0: Array,
    P0: Array,
    inputs: Array | None = None,
    smooth: bool = True,
) -> LinearEstimate:
    """The estimate over a record with one row a step.

    readings (samples, m), NaN for none; x0 (n,), P0 (n, n) before the first reading; inputs
    (samples, i), row k leads from sample k to the next. Raises BadInput for wrong shapes and where
    the covariance is lost.
    """
    n, m = len(system.transition), len(system.output)
    z = np.asarray(readings, dtype=float)
    z = z[:, None] if z.ndim == 1 else z
    gamma = np.zeros((n, 0)) if system.input is None else system.input
    u = np.zeros((len(z), 0)) if inputs is None else np.asarray(inputs, dtype=float)
    u = u[:, None] if u.ndim == 1 else u
    x, P = np.atleast_1d(np.asarray(x0, dtype=float)), np.atleast_2d(np.asarray(P0, dtype=float))
    shapes = {
        "readings": (z, (max(len(z), 1), m)),
        "inputs": (u, (len(z), gamma.shape[1])),
        "x0": (x, (n,)),
        "P0": (P, (n, n)),
    }
    for name, (value, shape) in shapes.items():
        missing = name == "readings"
        if value.shape != shape or not np.all(np.isfinite(value) | (missing & np.isnan(value))):
            raise _wrong(name, f"finite numbers of shape {shape}", f"shape {value.shape}")
    _covariance("P0", P, strict=False)
    L = np.eye(n) if system.gain is None else system.gain
    whole = np.ascontiguousarray
    out = core.linear_filter(
        whole(system.transition), whole(gamma), whole(L @ system.process @ L.T),
        whole(system.output), whole(system.noise), whole(u), whole(z), whole(x), whole(P), smooth,
    )  # fmt: skip
    if out["done"] < len(z) or out["reached"] > 0:
        raise refuse(
            "filter_diverged",
            where=f"sample {out['done'] if out['done'] < len(z) else out['reached']}",
            expected="a covariance that stays positive and finite",
            found="one that is not",
            do="Give every state some process noise or a smaller P0, and look at the units.",
        )
    return LinearEstimate(
        out["x"], out["covariance"], out["innovation"], out["deviation"], out["nis"]
    )


def _covariance(name: str, value: Array, strict: bool) -> None:
    """Raise BadInput where a matrix is not symmetric and positive (semi)definite."""
    scale = np.sqrt(np.maximum(np.diagonal(value), 0.0))
    unit = value / np.outer(np.where(scale > 0.0, scale, 1.0), np.where(scale > 0.0, scale, 1.0))
    least = float(np.linalg.eigvalsh(unit).min())
    if not np.allclose(unit, unit.T, rtol=0.0, atol=1e-9) or least < (1e-12 if strict else -1e-9):
        raise _wrong(
            name,
            f"a symmetric matrix, positive {'' if strict else 'semi'}definite",
            f"least eigenvalue of the correlations {least:.3g}",
        )


def _wrong(what: str, expected: str, found: str) -> BadInput:
    return refuse(
        "bad_system",
        where=f"linear filter, {what}",
        expected=expected,
        found=found,
        do="Correct the matrix; its rows are states or outputs as LinearSystem says.",
    )
