"""A log's channels as the navigation filters take them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.base.project import NoiseSpec, SensorSpec
from alula.flight import Channel, Flight
from alula.navigate.samples import Inertial, Readings

Sigma = Callable[[str], float]
There = Callable[..., bool]
INERTIAL = ("p", "q", "r", "ax", "ay", "az")
# Standard deviations taken where the project states none, SI.
SIGMA: Mapping[str, float] = {
    "north": 3.0, "east": 3.0, "down": 5.0, "h_gps": 5.0, "lat": 3.0, "lon": 3.0,
    "v_north": 0.2, "v_east": 0.2, "v_down": 0.3, "h": 1.0, "V": 0.5, "alpha": 0.01, "beta": 0.01,
    "mag_x": 5e-7, "mag_y": 5e-7, "mag_z": 5e-7,
}  # fmt: skip
UNMEASURED = 1e4  # standard deviation of a component that is not there: it says nothing
_EARTH_A, _EARTH_F = 6378137.0, 1.0 / 298.257223563  # WGS-84


@dataclass(frozen=True)
class FlightSamples:
    """inertial, readings; gyro, accelerometer: noise densities where the project states the noise,
    else None; heading: rad, the first one recorded, or None; messages.
    """

    inertial: Inertial
    readings: tuple[Readings, ...]
    gyro: float | None
    accelerometer: float | None
    heading: float | None
    messages: tuple[Message, ...]


def samples_of(
    flight: Flight, sensors: Mapping[str, SensorSpec], imu: Mapping[Any, NoiseSpec]
) -> FlightSamples:
    """Inertial samples and readings of a flight.

    sensors, imu: the project's noise. Raises BadInput where an inertial channel is missing.
    """
    t = flight["ax"].t
    if len(t) < 2:
        raise refuse(
            "too_few_samples", where=f"log {flight.id}", expected="two or more samples of ax",
            found=str(len(t)), do="Map inertial channels of a rate.",
        )  # fmt: skip
    columns = [_on(flight[name], t) for name in INERTIAL]
    inertial = Inertial(t, np.column_stack(columns[:3]), np.column_stack(columns[3:]))
    said: list[Message] = []

    def sigma(name: str) -> float:
        spec = sensors.get(name, SensorSpec())
        if spec.sigma_si is not None:
            return spec.sigma_si
        said.append(
            note(
                "assumed_sigma",
                where=f"log {flight.id}, sensor {name}",
                expected="a standard deviation in [navigate.sensors] or [reconstruct.sensors]",
                found=f"none; {SIGMA[name]:g} SI is assumed",
                do="State it if you know the instrument; filters weigh sensors by it.",
            )
        )
        return SIGMA[name]

    def there(*names: str) -> bool:
        return all(n in flight and sensors.get(n, SensorSpec()).use for n in names)

    readings = []
    if there("north", "east") or there("lat", "lon"):
        readings.append(_position(flight, sigma, there))
    if there("v_north", "v_east"):
        names = ("v_north", "v_east", "v_down") if there("v_down") else ("v_north", "v_east")
        readings.append(_vector("velocity", flight, names, sigma))
    if there("mag_x", "mag_y", "mag_z"):
        names = ("mag_x", "mag_y", "mag_z")
        stamps, values = _together([flight[n] for n in names])
        readings.append(Readings("field", stamps, values, max(sigma(n) for n in names)))
    for kind, name in (("height", "h"), ("V", "V"), ("alpha", "alpha"), ("beta", "beta")):
        if there(name):
            stamps, values = _together([flight[name]])
            readings.append(Readings(kind, stamps, values[:, 0], sigma(name)))
    step = float(np.median(np.diff(t)))
    heading = float(flight["psi"].values[0]) if "psi" in flight else None
    return FlightSamples(
        inertial, tuple(readings), _density(imu, "pqr", step),
        _density(imu, ("ax", "ay", "az"), step), heading, tuple(said),
    )  # fmt: skip


def _on(channel: Channel, t: Array) -> Array:
    """A channel at times t: its own samples where these are its times, else between them."""
    if channel.t is t or np.array_equal(channel.t, t):
        return channel.values
    good = np.isfinite(channel.values)
    return np.interp(t, channel.t[good], channel.values[good], left=np.nan, right=np.nan)


def _together(channels: Sequence[Channel]) -> tuple[Array, Array]:
    """Times of the first and values (m, k) of all, where every one has a sample."""
    t = channels[0].t
    values = np.column_stack([_on(c, t) for c in channels])
    good = np.isfinite(values).all(axis=1)
    return t[good], values[good]


def _vector(kind: str, flight: Flight, names: Sequence[str], sigma: Sigma) -> Readings:
    stamps, values = _together([flight[n] for n in names])
    deviations = [sigma(n) for n in names]
    if len(names) == 2:  # down is not measured
        values = np.column_stack([values, np.zeros(len(values))])
        deviations.append(UNMEASURED)
    return Readings(kind, stamps, values, deviations)


def _position(flight: Flight, sigma: Sigma, there: There) -> Readings:
    """Position NED; latitude and longitude about the first sample."""
    vertical = next((n for n in ("down", "h_gps") if there(n)), None)
    plane = ("north", "east") if there("north", "east") else ("lat", "lon")
    channels = [flight[n] for n in (*plane, *((vertical,) if vertical else ()))]
    stamps, values = _together(channels)
    if plane[0] == "lat" and len(values):
        lat0, lon0 = values[0, :2]
        e2 = _EARTH_F * (2.0 - _EARTH_F)
        bent = 1.0 - e2 * np.sin(lat0) ** 2
        north = (values[:, 0] - lat0) * _EARTH_A * (1.0 - e2) / bent**1.5
        turn = np.angle(np.exp(1j * (values[:, 1] - lon0)))
        east = turn * _EARTH_A / np.sqrt(bent) * np.cos(lat0)
        values = np.column_stack([north, east, values[:, 2:]])
    deviations = [sigma(n) for n in plane]
    if vertical is None:
        values = np.column_stack([values, np.zeros(len(values))])
        deviations.append(UNMEASURED)
    else:
        deviations.append(sigma(vertical))
        if vertical == "h_gps":
            values[:, 2] *= -1.0
    return Readings("position", stamps, values, deviations)


def _density(imu: Mapping[Any, NoiseSpec], names: Sequence[str], step: float) -> float | None:
    """Noise per root Hz of the worst axis whose noise per sample is stated."""
    stated = [imu[n].sigma_si for n in names if n in imu]
    return max(stated) * float(np.sqrt(step)) if stated and max(stated) > 0.0 else None
