"""Wind from ground velocity, air data and attitude, one sample at a time; and the reverse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.core import core

Three = tuple[float, float, float]


@dataclass(frozen=True)
class WindEstimate:
    """wind (n, 3) m/s NED, the way it blows to, covariance (n, 3, 3); NaN where nothing is known.

    mean (3,), mean_covariance (3, 3): weighted by each sample's covariance, as if the errors of
    different samples had nothing in common; white noise averages out, a bias of a vane does not.
    """

    wind: Array
    covariance: Array
    mean: Array
    mean_covariance: Array


@dataclass(frozen=True)
class AirEstimate:
    """V m/s, alpha, beta rad (n,) and their standard deviations; NaN where there is no airspeed."""

    V: Array
    alpha: Array
    beta: Array
    se_V: Array
    se_alpha: Array
    se_beta: Array


def wind_from(
    velocity: Array,
    q: Array,
    air: Array,
    *,
    sigma_velocity: Three = (0.2, 0.2, 0.3),
    sigma_turn: Three = (0.01, 0.01, 0.03),
    sigma_air: Three = (0.5, 0.01, 0.01),
) -> WindEstimate:
    """Wind from velocity (n, 3) NED, attitude q (n, 4), air (n, 3): V (m/s), alpha, beta (rad).

    Standard deviations of velocity, of the attitude about body axes (rad), of the air data. An
    angle that is not measured: zero, with the deviation that it may have.
    """
    n = len(velocity)
    wind, covariance = np.empty((n, 3)), np.empty((n, 3, 3))
    core.wind_from(
        _rows(velocity), np.array(sigma_velocity), _rows(q), np.array(sigma_turn), _rows(air),
        np.array(sigma_air), wind, covariance,
    )  # fmt: skip
    good = np.isfinite(wind).all(axis=1)
    mean, mean_covariance = np.full(3, np.nan), np.full((3, 3), np.nan)
    if good.any():
        information = np.linalg.inv(covariance[good])
        mean_covariance = np.linalg.inv(information.sum(axis=0))
        mean = mean_covariance @ np.einsum("nij,nj->i", information, wind[good])
    return WindEstimate(frozen(wind), frozen(covariance), frozen(mean), frozen(mean_covariance))


def air_from_wind(
    velocity: Array,
    q: Array,
    wind: Array,
    wind_covariance: Array,
    *,
    sigma_velocity: Three = (0.2, 0.2, 0.3),
    sigma_turn: Three = (0.01, 0.01, 0.03),
) -> AirEstimate:
    """Airspeed and flow angles without air-data sensors: velocity (n, 3) NED, attitude q (n, 4),
    wind (n, 3) or (3,) with covariance (3, 3).
    """
    out = np.empty((len(velocity), 6))
    core.air_from_wind(
        _rows(velocity), np.array(sigma_velocity), _rows(q), np.array(sigma_turn),
        _rows(np.broadcast_to(wind, (len(velocity), 3))), _rows(wind_covariance), out,
    )  # fmt: skip
    return AirEstimate(*(frozen(column) for column in out.T))


def _rows(values: Array) -> Array:
    return np.ascontiguousarray(values, dtype=np.float64)
