"""Period and damping of an oscillation, from the response itself, with their errors.

Damped sines of one frequency and one damping are matched to several traces at once, each with its
own amplitude, phase, offset and drift:

    y_k = a_k + b_k t + exp(-s t) (c_k cos w t + d_k sin w t).

For given s and w the rest is linear least squares, so that two numbers are searched for (variable
projection; Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973). The errors take the residuals as
coloured (base/coloured.py) and different traces as independent.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from alula.base.arrays import Array
from alula.base.coloured import coloured_covariance

FEWEST = 20  # samples
VISIBLE = 20.0  # an oscillation of a twentieth of its first size has died out
GROWTH = 5.0  # exponent over the stretch at most: a hundred and fifty times the first amplitude
GRID = 200  # samples of each trace that the first, coarse search looks at
FREQUENCIES, DAMPINGS = 20, (-0.1, 0.0, 0.05, 0.15, 0.3, 0.5)


@dataclass(frozen=True)
class Oscillation:
    """A damped oscillation.

    period: of the damped motion, s. damping: ratio, negative if it grows. *_se: standard errors.
    cycles: periods within the stretch and before the oscillation has died out. explained: by
    trace, the share of its variance about a straight line that the oscillation explains. phase: by
    trace, rad, of a cosine.
    """

    period: float
    damping: float
    period_se: float
    damping_se: float
    cycles: float
    explained: Mapping[str, float]
    phase: Mapping[str, float]

    @property
    def time_to_half(self) -> float:
        """Time to half amplitude, s; negative: to double; infinite where undamped."""
        rate = 2.0 * np.pi / self.period * self.damping / np.sqrt(1.0 - self.damping**2)
        return float(np.log(2.0) / rate) if rate else np.inf

    def lag(self, first: str, second: str) -> float:
        """Time from a peak of `first` to the next or last one of `second`, s, within half a
        period."""
        turns = (self.phase[second] - self.phase[first]) / (2.0 * np.pi)
        return float((turns + 0.5) % 1.0 - 0.5) * self.period


def fit_oscillation(t: Array, traces: Mapping[str, Array]) -> Oscillation | None:
    """The oscillation common to traces (n,) over times t (n,); None where there is none to find.

    Where it dies out within the stretch it is matched once more until then (at least one period
    and a half), so that what is left of slower modes does not bend it. None: too few samples, a
    trace that does not vary, or a best match whose period exceeds the stretch or is shorter than
    four samples.
    """
    found = _fit(t, traces)
    if found is None or found.damping <= 0.0:
        return found
    lasts = max(np.log(VISIBLE) / np.log(2.0) * found.time_to_half, 1.5 * found.period)
    end = int(np.searchsorted(t, t[0] + lasts))
    if end >= 0.9 * len(t):
        return found
    return _fit(t[:end], {name: y[:end] for name, y in traces.items()}) or found


def _fit(t: Array, traces: Mapping[str, Array]) -> Oscillation | None:
    n = len(t)
    if n < FEWEST or any(np.ptp(y) == 0.0 for y in traces.values()):
        return None
    tau = t - t[0]
    length = float(tau[-1])
    line = np.column_stack([np.ones(n), tau])
    bent = [y - line @ np.linalg.lstsq(line, y, rcond=None)[0] for y in traces.values()]
    sizes = [float(np.std(y)) for y in bent]
    if min(sizes) <= 0.0:
        return None
    scaled = np.column_stack([y / s for y, s in zip(traces.values(), sizes, strict=True)])

    def basis(z: Array, x: Array) -> Array:
        w, s = z
        shrink = np.exp(-s * x)
        return np.column_stack([np.ones(len(x)), x, shrink * np.cos(w * x), shrink * np.sin(w * x)])

    def left(z: Array, x: Array, y: Array) -> Array:
        q, _ = np.linalg.qr(basis(z, x))
        return np.asarray(y - q @ (q.T @ y))

    low, high = 2.0 * np.pi * 0.7 / length, 2.0 * np.pi * (n - 1) / length / 4.0
    coarse = slice(None, None, max(1, n // GRID))
    x, y = tau[coarse], scaled[coarse]
    slowest = -GROWTH / length
    starts = [
        np.array([w, max(d * w / np.sqrt(1.0 - d * d), slowest)])
        for w in _frequencies(tau, np.column_stack(bent) / sizes, low, high)
        for d in DAMPINGS
    ]
    start = starts[int(np.argmin([np.sum(left(z, x, y) ** 2) for z in starts]))]

    def misfit(z: Array) -> Array:
        return left(z, tau, scaled).ravel(order="F")

    found = least_squares(
        misfit,
        start,
        bounds=([0.5 * low, 1.01 * slowest], [2.0 * high, 10.0 * high]),
        x_scale=[start[0], start[0]],
    )
    w, s = (float(v) for v in found.x)
    if not low < w < high:
        return None
    columns = basis(found.x, tau)
    linear = np.asarray(np.linalg.lstsq(columns, scaled, rcond=None)[0], dtype=np.float64)
    residual = scaled - columns @ linear
    covariance = _covariance(tau, (w, s), linear, columns, residual)
    wn = float(np.hypot(w, s))
    to_damping = np.array([-s * w, w * w]) / wn**3
    return Oscillation(
        period=2.0 * np.pi / w,
        damping=s / wn,
        period_se=2.0 * np.pi / w**2 * float(np.sqrt(covariance[0, 0])),
        damping_se=float(np.sqrt(to_damping @ covariance @ to_damping)),
        cycles=min(length, np.log(VISIBLE) / max(s, 1e-9)) * w / (2.0 * np.pi),
        explained={
            name: 1.0 - float(np.mean(residual[:, k] ** 2)) for k, name in enumerate(traces)
        },
        phase={
            name: float(np.arctan2(linear[3, k], linear[2, k])) for k, name in enumerate(traces)
        },
    )


def _frequencies(x: Array, bent: Array, low: float, high: float) -> Array:
    """Where to begin, rad/s: about the peak of the common periodogram, and a few of every size."""
    length = 4 * len(x)
    power = np.sum(np.abs(np.fft.rfft(bent, length, axis=0)) ** 2, axis=1)
    at = 2.0 * np.pi * np.arange(len(power)) * (len(x) - 1) / (length * x[-1])
    inside = (at > low) & (at < high)
    every = np.geomspace(low, min(high, 30.0 * low), FREQUENCIES)
    if not inside.any():
        return np.asarray(every)
    peak = at[inside][int(np.argmax(power[inside]))]
    return np.concatenate([every, peak * np.array([0.9, 0.97, 1.0, 1.03, 1.1])])


def _covariance(
    x: Array, z: tuple[float, float], linear: Array, columns: Array, residual: Array
) -> Array:
    """(2, 2) of frequency and decay.

    The common estimate is the mean of those that each trace would give by itself, weighted by
    their information, so that its covariance follows from theirs.
    """
    w, s = z
    shrink = np.exp(-s * x)
    own, _ = np.linalg.qr(columns)
    total, spread = np.zeros((2, 2)), np.zeros((2, 2))
    for k in range(linear.shape[1]):
        c, d = linear[2, k], linear[3, k]
        wave = shrink * (c * np.cos(w * x) + d * np.sin(w * x))
        turned = shrink * (d * np.cos(w * x) - c * np.sin(w * x))
        jacobian = np.column_stack([x * turned, -x * wave])
        free = jacobian - own @ (own.T @ jacobian)  # of what the trace's own terms could imitate
        regressors = np.column_stack([jacobian, columns])
        scale = np.linalg.norm(regressors, axis=0)
        regressors = regressors / scale
        dispersion = np.linalg.pinv(regressors.T @ regressors)
        alone = coloured_covariance([(regressors, residual[:, k])], dispersion).corrected
        information = free.T @ free
        total += information
        spread += information @ (alone / np.outer(scale, scale))[:2, :2] @ information
    weight = np.linalg.pinv(total)
    return np.asarray(weight @ spread @ weight)
