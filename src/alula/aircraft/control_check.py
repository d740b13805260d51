"""Whether a recorded control contradicts what the aircraft did.

A positive deflection in Alula's notation gives a negative moment. The angular acceleration is
regressed on the control beside the motion that the aircraft answers to by itself; the sign of the
control's coefficient and its t-value say whether the recording has it the other way round.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, warn

T_SURE = 5.0  # t-value from which a sign is believed
SHARE = 0.2  # of the variance left by the motion alone that the control must explain
EXCITED = np.radians(0.2)  # rms of a control that was moved, not only held or quantized
MEMORY_S = 1.0  # s, over which residuals are taken to be correlated


@dataclass(frozen=True)
class _Axis:
    control: str
    acceleration: str
    rate: str
    others: tuple[str, ...]
    opposite: str


# The other lateral control is beside each: pilots move aileron and rudder together.
_AXES = (
    _Axis("de", "qdot", "q", ("alpha", "q"), "'+TEU' instead of '+TED'"),
    _Axis("da", "pdot", "p", ("beta", "p", "r", "dr"), "'+LTED' instead of '+RTED'"),
    _Axis("dr", "rdot", "r", ("beta", "p", "r", "da"), "'+TER' instead of '+TEL'"),
)


def control_sign_check(motion_like: Mapping[str, Array], dt: float) -> list[Message]:
    """One warning for each control whose sign contradicts the motion; none where it cannot tell.

    motion_like: arrays (n,) by name, SI and radians: 'de', 'da', 'dr' with 'qdot', 'pdot', 'rdot'
    (or 'q', 'p', 'r' to differentiate) and what there is of alpha, beta, p, q, r. dt: s. Samples
    with NaN are left out. Standard errors allow for residuals correlated over a second (Newey and
    West 1987).
    """
    messages = []
    for axis in _AXES:
        if axis.control not in motion_like:
            continue
        found = _slope(axis, motion_like, dt)
        if found is not None and found[0] > 0.0 and found[1] > T_SURE:
            slope, t_value, share = found
            messages.append(_contradiction(axis, slope, t_value, share))
    return messages


def _contradiction(axis: _Axis, slope: float, t_value: float, share: float) -> Message:
    return warn(
        "control_sign",
        where=f"channel '{axis.control}'",
        expected=f"a positive deflection that gives a negative {axis.acceleration}",
        found=f"{axis.acceleration} of {slope:+.3g} 1/s2 per radian, t = {t_value:.0f}, "
        f"which explains {100 * share:.0f} % of what the motion leaves",
        do=f"Check controls.{axis.control}.sign in the aircraft file: it may have to be "
        f"{axis.opposite}; or the channel's sign in the project file.",
    )


def _slope(
    axis: _Axis, arrays: Mapping[str, Array], dt: float
) -> tuple[float, float, float] | None:
    """The control's coefficient, its t-value and the share it explains; None if it cannot tell."""
    if axis.acceleration in arrays:
        response = np.asarray(arrays[axis.acceleration], dtype=np.float64)
    elif axis.rate in arrays:
        response = np.gradient(np.asarray(arrays[axis.rate], dtype=np.float64), dt)
    else:
        return None
    names = [axis.control, *(name for name in axis.others if name in arrays)]
    columns = np.column_stack([np.asarray(arrays[name], dtype=np.float64) for name in names])
    good = np.isfinite(response) & np.isfinite(columns).all(axis=1)
    y, X = response[good], columns[good]
    if len(y) <= 4 * (X.shape[1] + 1):
        return None
    y, X = y - y.mean(), X - X.mean(axis=0)
    # What the motion and the other control say alone, and what the control adds to it.
    base, control = X[:, 1:], X[:, 0]
    rest_y = y - base @ np.linalg.lstsq(base, y, rcond=None)[0]
    rest_u = control - base @ np.linalg.lstsq(base, control, rcond=None)[0]
    power = float(rest_u @ rest_u)
    moved = control.std() >= EXCITED and power > 1e-6 * float(control @ control)
    if not moved or not rest_y.any():
        return None
    slope = float(rest_u @ rest_y) / power
    residual = rest_y - slope * rest_u
    share = 1.0 - float(residual @ residual) / float(rest_y @ rest_y)
    if share < SHARE:
        return None
    se = np.sqrt(_newey_west(rest_u * residual, round(MEMORY_S / dt))) / power
    return slope, abs(slope) / max(float(se), 1e-300), share


def _newey_west(score: Array, lags: int) -> float:
    """Variance of the sum of a series correlated over `lags` samples; positive by its weights."""
    lags = min(lags, len(score) - 1)
    total = float(score @ score)
    for lag in range(1, lags + 1):
        total += 2.0 * (1.0 - lag / (lags + 1)) * float(score[lag:] @ score[:-lag])
    return max(total, 0.0)
