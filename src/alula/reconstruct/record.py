"""One maneuver as the filters take it: inputs on the inertial sensor's stamps, readings on theirs.

Nothing is resampled but the inputs, and those only where a sensor has samples between the inertial
ones: there they are interpolated linearly, which is what the integration step assumes anyhow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.flight import Flight, Maneuver
from alula.reconstruct.sensors import Sensor
from alula.reconstruct.unknowns import INERTIAL
from alula.reconstruct.vibration import aliasing, filtered, lowpass

LEAST = 20  # samples; fewer do not carry a dozen unknowns
_EARTH_A, _EARTH_F = 6378137.0, 1.0 / 298.257223563  # WGS-84
MERGE = 1e-3  # of the inertial sample interval: stamps closer than this are the same instant


@dataclass(frozen=True)
class Record:
    """t (n,) s; base (n,): True at inertial samples; inputs (n, 6); readings (n, sensors), NaN
    where a sensor has no sample.
    """

    maneuver: Maneuver
    t: Array
    base: np.ndarray
    inputs: Array
    readings: Array


def make_record(
    flight: Flight,
    maneuver: Maneuver,
    sensors: Sequence[Sensor],
    vibration_filter_hz: float = 0.0,
) -> tuple[Record, list[Message]]:
    """Cut one maneuver out of its flight; inertial channels are low-passed where that is asked for.

    Raises BadInput where an inertial channel is missing.
    """
    messages: list[Message] = []
    where = f"maneuver {maneuver.id}"
    t = flight["ax"].t
    t = t[(t >= maneuver.start) & (t <= maneuver.end)]
    if len(t) < LEAST:
        raise refuse(
            "too_few_samples",
            where=where,
            expected=f"at least {LEAST} samples of ax",
            found=str(len(t)),
            do="Make the window longer.",
        )
    own = {s.channel: _samples(flight, s, maneuver) for s in sensors}
    tolerance = MERGE * float(np.median(np.diff(t)))
    grid = _union(t, [times for times, _ in own.values()], tolerance)
    base = np.isin(grid, t)
    if not base.all():
        messages.append(
            note(
                "inputs_interpolated",
                where=where,
                expected="sensors on the inertial sensor's stamps",
                found=f"{int(np.sum(~base))} stamps between them",
                do="Nothing: specific force and rates are interpolated linearly at these.",
            )
        )
    inputs = np.column_stack([_input(flight, name, grid, t, where, messages) for name in INERTIAL])
    messages += aliasing(grid[base], inputs[base], INERTIAL, maneuver)
    if vibration_filter_hz > 0.0:
        smooth = lowpass(t, inputs[base], vibration_filter_hz)
        inputs = np.column_stack([np.interp(grid, t, column) for column in smooth.T])
        messages.append(filtered(vibration_filter_hz, maneuver))
    readings = np.full((len(grid), len(sensors)), np.nan)
    for column, sensor in enumerate(sensors):
        times, values = own[sensor.channel]
        readings[_nearest(grid, times), column] = values
    return Record(maneuver, grid, base, inputs, readings), messages


def channel_on(flight: Flight, name: str, t: Array) -> Array:
    """A channel's valid samples, linear between them, at the stamps t (n,)."""
    channel = flight[name]
    if len(channel.t) == 1:
        return np.full(len(t), channel.values[0])
    valid = np.isfinite(channel.values)
    if valid.all() and len(channel.t) >= len(t):
        first = int(np.searchsorted(channel.t, t[0]))
        if np.array_equal(channel.t[first : first + len(t)], t):
            return np.array(channel.values[first : first + len(t)])
    if not valid.any():
        return np.full(len(t), np.nan)
    return np.interp(t, channel.t[valid], channel.values[valid])


def _samples(flight: Flight, sensor: Sensor, maneuver: Maneuver) -> tuple[Array, Array]:
    """Valid samples of a sensor within the window; latitude and longitude as local meters.

    Dittrich 2016, Eq. (2.3) to (2.5): ellipsoid's radii at the first sample, height neglected
    against them only where no height is recorded.
    """
    channel = flight[sensor.channel]
    if len(channel.t) == 1:  # a constant is not a measurement
        return np.empty(0), np.empty(0)
    use = (channel.t >= maneuver.start) & (channel.t <= maneuver.end) & np.isfinite(channel.values)
    values = channel.values[use]
    if sensor.channel.startswith(("lat", "lon")) and len(values):
        e2 = 2.0 * _EARTH_F - _EARTH_F**2
        at = _valid_at(flight, sensor.channel.replace("lon", "lat"), channel.t[use][0])
        if at is None:
            raise refuse(
                "missing_channel",
                where=f"maneuver {maneuver.id}, channel {sensor.channel}",
                expected="a latitude, which the length of a degree of longitude follows from",
                found="no valid sample of one",
                do="Map lat, or switch the longitude off with use = false.",
            )
        heights = (_valid_at(flight, name, channel.t[use][0]) for name in ("h", "h_gps"))
        h = next((x for x in heights if x is not None), 0.0)
        w = np.sqrt(1.0 - e2 * np.sin(at) ** 2)
        meridian, prime = _EARTH_A * (1.0 - e2) / w**3, _EARTH_A / w
        radius = meridian + h if sensor.kind == "north" else (prime + h) * np.cos(at)
        turn = values - values[0]  # beyond the date line a longitude is a whole turn away
        values = (turn - 2.0 * np.pi * np.round(turn / (2.0 * np.pi))) * radius
    return channel.t[use], values


def _valid_at(flight: Flight, name: str, t: float) -> float | None:
    """The channel at t by its valid samples; None where there are none."""
    if name not in flight:
        return None
    channel = flight[name]
    valid = np.isfinite(channel.values)
    return float(np.interp(t, channel.t[valid], channel.values[valid])) if valid.any() else None


def _union(t: Array, others: Sequence[Array], tolerance: float) -> Array:
    """Stamps t and those of the others that are not within the tolerance of one already there."""
    grid = t
    for times in others:
        times = times[(times >= t[0] - tolerance) & (times <= t[-1] + tolerance)]
        if len(times):
            far = np.abs(grid[_nearest(grid, times)] - times) > tolerance
            grid = np.union1d(grid, times[far])
    return grid


def _nearest(grid: Array, times: Array) -> np.ndarray:
    """Index of the grid's stamp nearest to each of the times."""
    right = np.clip(np.searchsorted(grid, times), 1, len(grid) - 1)
    return right - (times - grid[right - 1] < grid[right] - times)


def _input(
    flight: Flight, name: str, grid: Array, t: Array, where: str, messages: list[Message]
) -> Array:
    channel = flight[name]
    inside = (channel.t >= grid[0]) & (channel.t <= grid[-1])
    bad = int(np.sum(~np.isfinite(channel.values[inside])))
    if bad == np.sum(inside) and len(channel.t) > 1:
        raise refuse(
            "no_valid_sample",
            where=f"{where}, channel {name}",
            expected="specific force and rates throughout the window",
            found="no valid sample",
            do="Choose another window or map another channel.",
        )
    if bad:
        messages.append(
            note(
                "inputs_interpolated",
                where=f"{where}, channel {name}",
                expected="a valid sample at every stamp",
                found=f"{bad} that are not numbers",
                do="They are interpolated linearly; choose another window if that is too much.",
            )
        )
    if not np.array_equal(channel.t, flight["ax"].t):
        messages.append(
            note(
                "inputs_interpolated",
                where=f"{where}, channel {name}",
                expected="the stamps of ax",
                found="stamps of its own",
                do="Nothing: it is interpolated linearly at those of ax.",
            )
        )
    return channel_on(flight, name, grid)
