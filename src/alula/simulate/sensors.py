"""What sensors make of a motion: place, scale error, bias, white noise, quantization, own rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.core import core


@dataclass(frozen=True)
class SensorError:
    """reading = (1 + scale) delayed truth + bias + sigma N(0, 1), rounded to multiples of step.

    All in the SI unit of the quantity; scale is relative (the upwash of a vane is one); step 0
    means no quantization. lag: time constant of a first-order lag, s. loss: share of the samples
    that never arrive, each by chance. stuck: (start, end), s, in which the reading stays as it was
    at the start.
    """

    scale: float = 0.0
    bias: float = 0.0
    sigma: float = 0.0
    step: float = 0.0
    lag: float = 0.0
    loss: float = 0.0
    stuck: tuple[float, float] | None = None


def readings(
    truth: Array, error: SensorError, random: np.random.Generator, t: Array | None = None
) -> Array:
    """Readings (n,) of a true quantity (n,), with numbers drawn from `random`.

    t: (n,) s, evenly spaced; needed for a lag and for a time of being stuck. A sample that is
    lost is NaN.
    """
    truth = np.ascontiguousarray(truth, dtype=np.float64)
    if t is None and (error.lag > 0.0 or error.stuck is not None):
        raise refuse(
            "sensor_without_time",
            where="simulated sensor",
            expected="time stamps for a lag or a stuck reading",
            found="none",
            do="Give t.",
        )
    if t is not None and error.lag > 0.0:
        truth = lagged(t, truth, error.lag)
    out = np.empty_like(truth)
    normal = random.standard_normal(len(truth))
    core.readings(truth, normal, error.scale, error.bias, error.sigma, error.step, out)
    if t is not None and error.stuck is not None:
        first, last = np.searchsorted(t, error.stuck)
        if first < len(t):
            out[first:last] = out[first]
    if error.loss > 0.0:
        out[random.random(len(out)) < error.loss] = np.nan
    return out


def lagged(t: Array, x: Array, tau: float) -> Array:
    """x (n,) behind a first-order lag of tau s, steady at the start; t (n,) s evenly spaced.

    Exact for an x that is linear between samples.
    """
    from scipy.signal import lfilter  # only where a sensor lags: it takes long to load

    h = float(t[1] - t[0])
    decay = np.exp(-h / tau)
    slope = tau / h * (1.0 - decay)
    behind = lfilter([1.0 - slope, slope - decay], [1.0, -decay], x - x[0])
    return np.ascontiguousarray(x[0] + behind, dtype=np.float64)


def every(t: Array, rate: float) -> Array:
    """Indices of the samples of a sensor of its own `rate` (Hz) in times t (n,) of even spacing.

    Raises BadInput where the sensor is faster than the times, or the ratio is not whole.
    """
    ratio = (len(t) - 1) / (t[-1] - t[0]) / rate
    step = round(ratio)
    if step < 1 or abs(ratio - step) > 1e-6 * ratio:
        raise refuse(
            "sensor_rate",
            where="simulated sensor",
            expected="a rate that divides the simulation's rate",
            found=f"{rate:g} Hz at {ratio * rate:g} Hz",
            do="Simulate at a multiple of the sensor's rate.",
        )
    return np.arange(0, len(t), step)


def specific_force_at(f: Array, w: Array, w_dot: Array, r: Sequence[float] | Array) -> Array:
    """Specific force (n, 3) at r (3,) m from the center of gravity; f, w, w_dot: (n, 3)."""
    out = np.empty((len(f), 3))
    core.specific_force_at(_rows(f), _rows(w), _rows(w_dot), np.array(r, dtype=np.float64), out)
    return out


def velocity_at(v: Array, w: Array, r: Sequence[float] | Array) -> Array:
    """Velocity (n, 3) at r (3,) m from the center of gravity; v, w: (n, 3) body axes."""
    out = np.empty((len(v), 3))
    core.velocity_at(_rows(v), _rows(w), np.array(r, dtype=np.float64), out)
    return out


def flow_angles(v: Array) -> tuple[Array, Array, Array]:
    """Speed, angle of attack atan2(w, u), sideslip asin(v/V) of velocities (n, 3), each (n,)."""
    plane = np.hypot(v[:, 0], v[:, 2])
    return np.hypot(plane, v[:, 1]), np.arctan2(v[:, 2], v[:, 0]), np.arctan2(v[:, 1], plane)


def _rows(values: Array) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)
