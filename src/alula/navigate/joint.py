"""The joint filter over a recording: attitude, velocity, position, biases, wind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import frozen
from alula.base.messages import Message
from alula.core import core
from alula.navigate.result import (
    JOINT_STATES,
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
class JointSettings:
    """Noise and constants, SI; densities per root Hz, walks per root second.

    gust: standard deviation of the turbulence (3,) NED m/s, gust_length (3,) m: Gauss-Markov along
    the way through the air. wind_walk: of the wind that it goes about. field: (3,) T, NED; None: no
    magnetometer is taken. air_sensor, antenna of the satellites: (3,) m from the inertial sensor,
    body axes.
    """

    gyro: float = 2e-4
    gyro_walk: float = 1e-5
    accelerometer: float = 5e-3
    accelerometer_walk: float = 5e-4
    wind_walk: float = 0.02
    gust: tuple[float, float, float] = (1.0, 1.0, 1.0)
    gust_length: tuple[float, float, float] = (300.0, 300.0, 150.0)
    height_walk: float = 0.02
    gravity: float = 9.80665
    field: tuple[float, float, float] | None = None
    air_sensor: tuple[float, float, float] = (0.0, 0.0, 0.0)
    antenna: tuple[float, float, float] = (0.0, 0.0, 0.0)


def navigate_joint(
    inertial: Inertial,
    readings: Sequence[Readings],
    settings: JointSettings | None = None,
    start: Start | None = None,
    every: int = 1,
) -> Navigation:
    """Run the joint filter. start: None finds one in the first second. every: samples per row.

    Readings that are late (`Readings.arrived`), not numbers, out of order or far off are taken as
    late, or refused and counted; see `Navigation.takings`.
    """
    rows, whose = merged(readings)
    settings = settings or JointSettings()
    messages: tuple[Message, ...] = ()
    if start is None:
        field = None if settings.field is None else np.array(settings.field)
        start, messages = first_state(inertial, readings, field, settings.gravity)
    noise = core.JointNoise()
    for name in (
        "gyro", "gyro_walk", "accelerometer", "accelerometer_walk", "wind_walk", "gust",
        "gust_length", "height_walk", "gravity", "air_sensor", "antenna",
    ):  # fmt: skip
        setattr(noise, name, getattr(settings, name))
    noise.longest_step = longest_step(inertial)
    if settings.field is not None:
        x, y, z = settings.field
        noise.field = (MICRO * x, MICRO * y, MICRO * z)
    sigma = np.array(
        [start.sigma_tilt, start.sigma_heading, start.sigma_velocity, start.sigma_position,
         start.sigma_gyro_bias,
         start.sigma_force_bias, start.sigma_wind, start.sigma_height_bias]
    )  # fmt: skip
    found = core.navigate_joint(
        noise, start.state(), sigma, just_before(start.t, inertial), row(inertial.t),
        row(inertial.rate), row(inertial.force), rows, every,
    )  # fmt: skip
    x = found["x"]
    return Navigation(
        filter="joint",
        t=frozen(found["t"]),
        q=frozen(x[:, :4]),
        euler=frozen(euler_angles(x[:, :4])),
        velocity=frozen(x[:, 4:7]),
        position=frozen(x[:, 7:10]),
        gyro_bias=frozen(x[:, 10:13]),
        force_bias=frozen(x[:, 13:16]),
        wind=frozen(x[:, 16:19] + x[:, 19:22]),
        steady=frozen(x[:, 16:19]),
        height_bias=frozen(x[:, 22]),
        covariance=found["covariance"],
        states=JOINT_STATES,
        takings=takings_of(found, rows, whose, readings),
        inertial=inertial_counts(found),
        messages=tuple(messages),
    )
