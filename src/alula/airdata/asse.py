"""Angles of attack and sideslip without vanes or model, from inertial sensors and airspeed.

The exact affine form of the scheme of Lerro, Brandl and Gili (J. Guidance 2020) over a window of
airspeeds, and the same information in a filter that carries the angles through trim. The printed
scheme is in `asse_zero_order`. Both run in the core as they would on board, sample by sample.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, field

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.core import core

GRAVITY = 9.80665  # m/s2
COLUMNS = 13
Arrays = tuple[Array, Array, Array, Array, Array, Array]
REASONS = (
    ("not_finite", "finite numbers", "Mend or mark the channel."),
    ("backward_time", "time that goes forward, airspeeds not ahead or too old", "Sort by time."),
    ("slow", "airspeeds above the least one", "Give the airspeed once the aircraft flies."),
    ("outlier", "airspeeds near the expected ones", "Check the pitot tube and its noise."),
    ("gap", "samples without interruption", "The estimate started over there."),
)


@dataclass(frozen=True)
class AsseSettings:
    """What is known of the sensors beforehand, SI and rad; defaults: an IMU of Xsens MTi-G class.

    sigma_V: noise of the airspeed per sample, m/s; delay: s by which it is old at its time stamp.
    sigma_tilt: attitude error about each axis, rad, with correlation time tilt_time, s. sigma_a
    (m/s2), sigma_w (rad/s): constant errors; density_a, density_w: noise per root hertz,
    two-sided; density_wind: the same of a wind's acceleration that is not given. first_alpha,
    first_beta, first_sigma: angles before anything is known, rad. limit: standard deviation above
    which an angle reads not observable, rad. least_V: m/s. longest_gap: s without inertial samples
    after which all starts over. gate: standard deviations that make an airspeed an outlier. block:
    s of airspeeds that the window averages to one sample; 0: each is one.
    """

    sigma_V: float = 0.3
    delay: float = 0.0
    sigma_tilt: float = np.pi / 180.0
    tilt_time: float = 20.0
    sigma_a: float = 0.02
    sigma_w: float = 0.1 * np.pi / 180.0
    density_a: float = 0.002 / np.sqrt(2.0)
    density_w: float = 0.05 * np.pi / 180.0 / np.sqrt(2.0)
    density_wind: float = 0.0
    first_alpha: float = 3.0 * np.pi / 180.0
    first_beta: float = 0.0
    first_sigma: float = 5.0 * np.pi / 180.0
    limit: float = 2.5 * np.pi / 180.0
    least_V: float = 3.0
    longest_gap: float = 0.25
    gate: float = 5.0
    block: float = 0.2

    def numbers(self) -> Array:
        """As the core takes them; raises BadInput where one is not possible."""
        out = np.array(astuple(self), dtype=np.float64)
        free = ("first_alpha", "first_beta")  # of either sign
        positive = ("sigma_V", "first_sigma", "limit", "least_V", "longest_gap", "gate")
        for name, value in zip(self.__dataclass_fields__, out, strict=True):
            bad = not np.isfinite(value) or (name not in free and value < 0.0)
            if bad or (name in positive and value == 0.0):
                raise refuse(
                    "asse_settings",
                    where=f"angle estimation, {name}",
                    expected="a finite number, above zero" if name in positive else "not below 0",
                    found=f"{value:g}",
                    do="Correct the setting.",
                )
        return out


@dataclass(frozen=True)
class AsseRecord:
    """What is on board at times t (n,), s, body axes.

    f: specific force (n, 3) m/s2; w: rates (n, 3) rad/s; gravity: (n, 3) m/s2 from the attitude;
    wind_rate: (n, 3) m/s2, the wind's acceleration where it is known. V: airspeed (n,), NaN where
    none was measured. Numbers that are not finite are rejected sample by sample and counted.
    """

    t: Array
    f: Array
    w: Array
    gravity: Array
    V: Array
    wind_rate: Array = field(default_factory=lambda: frozen(np.zeros((0, 3))))

    def arrays(self) -> Arrays:
        """t, f, w, gravity, wind_rate, V as the core takes them; BadInput where shapes differ."""
        n = len(np.atleast_1d(self.t))
        wind = self.wind_rate if np.size(self.wind_rate) else np.zeros((n, 3))
        given = {"t": self.t, "f": self.f, "w": self.w, "gravity": self.gravity,
                 "wind_rate": wind, "V": self.V}  # fmt: skip
        out: list[Array] = []
        for name, values in given.items():
            array = np.ascontiguousarray(values, dtype=np.float64)
            shape = (n,) if name in ("t", "V") else (n, 3)
            if array.shape != shape or n < 2:
                raise refuse(
                    "shape",
                    where=f"angle estimation, {name}",
                    expected=f"shape {shape}, at least two samples",
                    found=f"shape {array.shape}",
                    do="Give one row per time.",
                )
            out.append(array)
        return out[0], out[1], out[2], out[3], out[4], out[5]


def gravity_in_body(phi: Array, theta: Array, g: float = GRAVITY) -> Array:
    """Gravity (n, 3), m/s2, in body axes from bank and pitch angles (n,), rad."""
    phi, theta = np.asarray(phi, dtype=np.float64), np.asarray(theta, dtype=np.float64)
    down = np.stack(
        [-np.sin(theta), np.sin(phi) * np.cos(theta), np.cos(phi) * np.cos(theta)], axis=-1
    )
    return np.asarray(g * down, dtype=np.float64)


@dataclass(frozen=True)
class AsseResult:
    """Airspeed and angles over time, (n,) each, m/s and rad; NaN where nothing was estimated.

    covariance: (n, 3, 3) of V, alpha, beta. observable_alpha, observable_beta: (n,) of bool; where
    it is False the angle reads not observable and age_alpha, age_beta (n,), s, tell how long ago
    it last was not so (NaN: never). rejected: samples by reason.
    """

    t: Array
    V: Array
    alpha: Array
    beta: Array
    covariance: Array
    observable_alpha: NDArray[np.bool_]
    observable_beta: NDArray[np.bool_]
    age_alpha: Array
    age_beta: Array
    rejected: dict[str, int]
    messages: tuple[Message, ...] = ()

    @property
    def sigma_alpha(self) -> Array:
        """Standard deviation of alpha (n,), rad."""
        return np.asarray(np.sqrt(self.covariance[:, 1, 1]), dtype=np.float64)

    @property
    def sigma_beta(self) -> Array:
        """Standard deviation of beta (n,), rad."""
        return np.asarray(np.sqrt(self.covariance[:, 2, 2]), dtype=np.float64)


def estimate_window(
    record: AsseRecord, settings: AsseSettings | None = None, *, samples: int = 20, every: int = 1
) -> AsseResult:
    """Angles at every `every`th time from the last `samples` (3 to 32) blocks of airspeeds.

    Each estimate stands for itself: constrained weighted least squares of the exact affine form
    (see docs/methods/asse.md), with the sensors' errors as further unknowns. Raises BadInput for
    settings and shapes that are not possible.
    """
    arrays = record.arrays()
    numbers = (settings or AsseSettings()).numbers()
    if not 3 <= samples <= core.MAX_ASSE_SAMPLES or every < 1:
        raise refuse(
            "asse_window",
            where="angle estimation, window",
            expected=f"3 to {core.MAX_ASSE_SAMPLES} samples, every 1 or more",
            found=f"{samples} samples, every {every}",
            do="Choose others, or longer blocks.",
        )
    out = np.empty((len(arrays[0]), COLUMNS))
    counts = core.asse_window(*arrays, numbers, samples, every, out)
    return _result(arrays[0], out, counts)


def estimate_filter(
    record: AsseRecord,
    settings: AsseSettings | None = None,
    *,
    alpha: Array | None = None,
    alpha_sigma: float = 0.0,
) -> AsseResult:
    """Angles over the record by the filter, which carries them through trim.

    alpha: (n,) angles of attack from elsewhere, as `asse_lift.lift_angle` gives them, rad, NaN
    where there are none, of standard deviation alpha_sigma. Raises BadInput as `estimate_window`.
    """
    arrays = record.arrays()
    numbers = (settings or AsseSettings()).numbers()
    given = np.zeros(0) if alpha is None else np.ascontiguousarray(alpha, dtype=np.float64)
    if alpha is not None and (given.shape != arrays[0].shape or not alpha_sigma > 0.0):
        raise refuse(
            "asse_alpha",
            where="angle estimation, given alpha",
            expected=f"{len(arrays[0])} values and a standard deviation above zero",
            found=f"shape {given.shape}, {alpha_sigma:g} rad",
            do="Give one angle per time, NaN where there is none.",
        )
    out = np.empty((len(arrays[0]), COLUMNS))
    counts = core.asse_filter(*arrays, numbers, given, alpha_sigma, out)
    return _result(arrays[0], out, counts)


def rejections(counts: tuple[int, ...]) -> tuple[dict[str, int], tuple[Message, ...]]:
    """The core's counts by reason, and what is said of them."""
    found = {code: int(n) for (code, _, _), n in zip(REASONS, counts, strict=True)}
    messages = tuple(
        warn(code, where="angle estimation", expected=expected, found=f"{found[code]} others",
             do=do)
        for code, expected, do in REASONS
        if found[code]
    )  # fmt: skip
    return found, messages


def _result(t: Array, out: Array, counts: tuple[int, ...]) -> AsseResult:
    covariance = np.empty((len(t), 3, 3))
    for column, (i, j) in enumerate(((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))):
        covariance[:, i, j] = covariance[:, j, i] = out[:, 3 + column]
    rejected, messages = rejections(counts)
    return AsseResult(
        t=frozen(t),
        V=frozen(out[:, 0]),
        alpha=frozen(out[:, 1]),
        beta=frozen(out[:, 2]),
        covariance=frozen(covariance),
        observable_alpha=out[:, 9] == 1.0,
        observable_beta=out[:, 10] == 1.0,
        age_alpha=frozen(out[:, 11]),
        age_beta=frozen(out[:, 12]),
        rejected=rejected,
        messages=messages,
    )
