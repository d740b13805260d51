"""The zero-order scheme of Lerro, Brandl and Gili as printed (J. Guidance 2020), over a record.

Its equations need the airspeed's derivative and hold without noise; `asse` goes beyond it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.airdata.asse import AsseRecord, rejections
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse
from alula.core import core

THRESHOLD = 200.0  # existence number, 1/rad: an expected error of 0.29 deg


@dataclass(frozen=True)
class ZeroOrderResult:
    """Angles (n,), rad, as the equations give them; NaN where they were not solved.

    existence_alpha, existence_beta: (n,) 1/rad, inverse of the error to expect of the zero order,
    zero in trim. observable_*: (n,) of bool, above the threshold; age_*: (n,) s since it last was
    (NaN: never). rejected: samples by reason.
    """

    t: Array
    alpha: Array
    beta: Array
    existence_alpha: Array
    existence_beta: Array
    observable_alpha: NDArray[np.bool_]
    observable_beta: NDArray[np.bool_]
    age_alpha: Array
    age_beta: Array
    rejected: dict[str, int]
    messages: tuple[Message, ...] = ()


def differentiated(t: Array, x: Array) -> Array:
    """Derivative (n,) of x (n,) by central differences of fourth order; NaN at two ends each.

    t: (n,) s, evenly spaced.
    """
    out = np.full(len(x), np.nan)
    h = float(t[-1] - t[0]) / (len(t) - 1)
    out[2:-2] = (x[:-4] - 8.0 * x[1:-3] + 8.0 * x[3:-1] - x[4:]) / (12.0 * h)
    return out


def zero_order(
    record: AsseRecord,
    first_alpha: float,
    first_beta: float,
    *,
    offsets: Sequence[int] = (1,),
    every: int = 1,
    threshold: float = THRESHOLD,
    equation_error: float = 0.05,
    V_dot: Array | None = None,
) -> ZeroOrderResult:
    """Angles at every `every`th sample from n + 1 equations, Eq. (20), from first angles, rad.

    offsets: samples back to the times of the further equations (1 to 3 of them, uneven if wished;
    negative: ahead, after the fact). V_dot: (n,) m/s2, else by differences of V. equation_error:
    m/s2, what the measured side of an equation over V is uncertain by; 1e-9 without noise. Raises
    BadInput for shapes, offsets and thresholds that are not possible.
    """
    t, f, w, gravity, wind_rate, V = record.arrays()
    steps = np.array(offsets, dtype=np.float64)
    unique = len(set(steps.tolist())) == len(steps) and not np.any(steps == 0.0)
    if not 1 <= len(steps) < core.MAX_ZERO_ORDER or not unique or every < 1:
        raise refuse(
            "asse_offsets",
            where="zero-order scheme, offsets",
            expected=f"1 to {core.MAX_ZERO_ORDER - 1} different ones, none zero; every 1 or more",
            found=f"{list(offsets)}, every {every}",
            do="Give the samples back to the further equations.",
        )
    if not (threshold > 0.0 and equation_error >= 0.0):
        raise refuse(
            "asse_threshold",
            where="zero-order scheme",
            expected="a threshold above zero, an equation error not below",
            found=f"{threshold:g}, {equation_error:g}",
            do="Correct them.",
        )
    a = f + gravity - wind_rate
    known = np.where(np.isfinite(a), a, 0.0)  # a gap: its equations are rejected by their own a
    gained = np.zeros_like(a)
    gained[1:] = np.cumsum(0.5 * (known[1:] + known[:-1]) * np.diff(t)[:, None], axis=0)
    slope = differentiated(t, V) if V_dot is None else np.ascontiguousarray(V_dot, np.float64)
    out = np.empty((len(t), 8))
    counts = core.asse_zero_order(
        t, V, slope, a, w, gained, steps, every, threshold, equation_error,
        first_alpha, first_beta, out,
    )  # fmt: skip
    rejected, messages = rejections(counts)
    alpha, beta, existence_alpha, existence_beta, _, _, age_alpha, age_beta = (
        frozen(c) for c in out.T
    )
    return ZeroOrderResult(
        t=frozen(t), alpha=alpha, beta=beta,
        existence_alpha=existence_alpha, existence_beta=existence_beta,
        observable_alpha=out[:, 4] == 1.0, observable_beta=out[:, 5] == 1.0,
        age_alpha=age_alpha, age_beta=age_beta,
        rejected=rejected, messages=messages,
    )  # fmt: skip


def zero_order_error(t: Array, v: Array, w: Array, a: Array, back: int) -> tuple[Array, Array]:
    """Relative error of the zero order (n,), Eq. (25) from tau on, and its denominator, m2/s3.

    v, w, a: (n, 3) true velocity, rates and acceleration against the air, body axes; back: samples
    from t to tau. Near zeros of the denominator the ratio says nothing. NaN before sample `back`.
    """
    turning = np.cross(w, v)
    steps = 0.5 * (turning[1:] + turning[:-1]) * np.diff(t)[:, None]
    total = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    ratio, denominator = np.full(len(t), np.nan), np.full(len(t), np.nan)
    integral = total[back:] - total[:-back]
    held = turning[back:] * (t[back:] - t[:-back])[:, None]
    exact = np.einsum("ni,ni->n", integral, a[:-back])
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio[back:] = -(np.einsum("ni,ni->n", held, a[:-back]) - exact) / exact
    denominator[back:] = exact
    return ratio, denominator
