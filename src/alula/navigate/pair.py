"""Pusztai's pair over a recording: an attitude filter, and a position filter that trusts it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import frozen
from alula.base.messages import Message
from alula.core import core
from alula.navigate.result import (
    PAIR_STATES,
    Navigation,
    euler_angles,
    inertial_counts,
    takings_of,
)
from alula.navigate.samples import (
    MICRO,
    Inertial,
    Readings,
    just_before,
    longest_step,
    merged,
    row,
)
from alula.navigate.start import Start, first_state


@dataclass(frozen=True)
class PairSettings:
    """Noise and constants, SI; densities per root Hz, walks per root second.

    measured: standard deviations of a measured attitude, phi theta psi, rad, as if white at 50 Hz:
    3 deg that last 10 s weigh as much as 1 rad.
    accelerometer: what the attitude's error adds to it counts in. field: (3,) T, NED. steps:
    inertial samples for one step of the position filter.
    """

    gyro: float = 2e-4
    gyro_walk: float = 1e-5
    measured: tuple[float, float, float] = (1.0, 1.0, 1.0)
    accelerometer: float = 0.2
    accelerometer_walk: float = 3e-3
    gravity: float = 9.80665
    field: tuple[float, float, float] = (2.1e-5, 0.0, 4.4e-5)
    steps: int = 2


def navigate_pair(
    inertial: Inertial,
    readings: Sequence[Readings],
    settings: PairSettings | None = None,
    start: Start | None = None,
    every: int = 1,
) -> Navigation:
    """Run the pair. It takes position, velocity, height, field; an airspeed, where there is one,
    only for the centripetal part of the specific force. start: None finds one.
    """
    readings = [r for r in readings if r.kind not in ("alpha", "beta")]
    rows, whose = merged(readings)
    settings = settings or PairSettings()
    messages: tuple[Message, ...] = ()
    if start is None:
        start, messages = first_state(
            inertial, readings, np.array(settings.field), settings.gravity
        )
    attitude, position = core.AttitudeNoise(), core.PositionNoise()
    for name in ("gyro", "gyro_walk", "measured"):
        setattr(attitude, name, getattr(settings, name))
    for name in ("accelerometer", "accelerometer_walk", "gravity"):
        setattr(position, name, getattr(settings, name))
    attitude.longest_step = position.longest_step = longest_step(inertial)
    sigma = np.array(
        [start.sigma_tilt, start.sigma_heading, start.sigma_velocity, start.sigma_position,
         start.sigma_gyro_bias,
         start.sigma_force_bias]
    )  # fmt: skip
    found = core.navigate_pair(
        attitude, position, MICRO * np.array(settings.field), settings.steps, start.state()[:10],
        sigma, just_before(start.t, inertial), row(inertial.t), row(inertial.rate),
        row(inertial.force), rows, every,
    )  # fmt: skip
    x = found["x"]
    unknown = frozen(np.full((len(x), 3), np.nan))
    return Navigation(
        filter="pair",
        t=frozen(found["t"]),
        q=frozen(x[:, :4]),
        euler=frozen(euler_angles(x[:, :4])),
        velocity=frozen(x[:, 4:7]),
        position=frozen(x[:, 7:10]),
        gyro_bias=frozen(x[:, 10:13]),
        force_bias=frozen(x[:, 13:16]),
        wind=unknown,
        steady=unknown,
        height_bias=frozen(np.full(len(x), np.nan)),
        covariance=found["covariance"],
        states=PAIR_STATES,
        takings=takings_of(found, rows, whose, readings),
        inertial=inertial_counts(found),
        messages=tuple(messages),
    )
