"""What the in-flight calibration is made from: air data, attitude and GPS velocity on one grid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, note, refuse, warn
from alula.flight import Flight

NEEDED = ("V", "phi", "theta", "psi", "v_north", "v_east", "v_down")
FURTHER = ("alpha", "beta", "beta_flank", "h", "h_gps", "p", "q", "r", "ax", "ay", "az",
           "de", "da", "dr")  # fmt: skip
SHORTEST = 60.0  # s of flight below which nothing is begun
Point = tuple[float, float, float]
_MAP = "Map them in [channels]; GPS velocity and attitude are what tells wind from error."


@dataclass(frozen=True)
class AirDataRecord:
    """Readings (n,) by channel name at even times t (n,), NaN where there is none; SI.

    `V phi theta psi v_north v_east v_down` and any of `alpha`, `beta` or `beta_flank` (a vane
    reads the flank angle), `h` with `h_gps`, `p q r`, `ax ay az`,
    `de da dr` in any unit. arms: (3,) m from the center of
    gravity to 'V', 'alpha', 'beta', 'gps', 'imu', body axes; they need the rates.
    """

    t: Array
    readings: Mapping[str, Array]
    arms: Mapping[str, Point] = field(default_factory=dict)
    messages: tuple[Message, ...] = ()

    def __post_init__(self) -> None:
        steps = np.diff(self.t)
        if len(self.t) < 2 or not np.all(steps > 0.0) or np.ptp(steps) > 1e-3 * np.mean(steps):
            raise refuse(
                "air_data_time",
                where="in-flight calibration",
                expected="two or more times of even spacing, increasing",
                found=f"{len(self.t)} times",
                do="Resample with record_of, or cut the record where it has a hole.",
            )
        missing = [name for name in NEEDED if name not in self.readings]
        if missing:
            raise refuse(
                "missing_channel",
                where="in-flight calibration",
                expected=", ".join(NEEDED),
                found="no " + ", ".join(missing),
                do=_MAP,
            )
        usable = np.all([np.isfinite(self.readings[name]) for name in NEEDED], axis=0)
        usable &= self.readings["V"] > 0.0
        if np.sum(usable) * float(np.mean(steps)) < SHORTEST:
            raise refuse(
                "air_data_too_short",
                where="in-flight calibration",
                expected=f"{SHORTEST:g} s or more in which all of {', '.join(NEEDED)} are there",
                found=f"{np.sum(usable) * float(np.mean(steps)):.3g} s",
                do="Give a longer part of the flight.",
            )

    @property
    def rates(self) -> Array:
        """(n, 3) rad/s; zero where the record has none."""
        none = np.zeros(len(self.t))
        return np.column_stack([self.readings.get(name, none) for name in ("p", "q", "r")])


def record_of(
    flight: Flight,
    start: float | None = None,
    end: float | None = None,
    *,
    rate: float = 50.0,
    arms: Mapping[str, Point] | None = None,
    slowest: float = 5.0,
) -> AirDataRecord:
    """A Flight's channels between two times on one grid of `rate` Hz, straight between samples.

    Samples below `slowest` m/s of airspeed (on the ground) are left out. Where a channel has no
    sample for half a second it is NaN. What was done is in the messages.
    """
    names = [n for n in (*NEEDED, *FURTHER) if n in flight]
    missing = [n for n in NEEDED if n not in flight]
    if missing:
        raise refuse(
            "missing_channel",
            where=f"log {flight.id}",
            expected=", ".join(NEEDED),
            found=f"no {', '.join(missing)} among {', '.join(sorted(flight.channels))}",
            do=_MAP,
        )
    begin = max([float(flight[n].t[0]) for n in NEEDED] + ([] if start is None else [start]))
    last = min([float(flight[n].t[-1]) for n in NEEDED] + ([] if end is None else [end]))
    if not last - begin >= SHORTEST:
        raise refuse(
            "air_data_too_short",
            where=f"log {flight.id}",
            expected=f"{SHORTEST:g} s or more that all of {', '.join(NEEDED)} have in common",
            found=f"{begin:.6g} to {last:.6g} s",
            do="Give a longer part of the flight.",
        )
    t = begin + np.arange(int((last - begin) * rate) + 1) / rate
    readings, lost = {}, []
    for name in names:
        channel = flight[name]
        good = np.isfinite(channel.values)
        if np.sum(good) < 2:
            readings[name] = np.full(len(t), np.nan)
            continue
        at, values = channel.t[good], channel.values[good]
        if name == "psi":
            values = np.unwrap(values)
        found = np.interp(t, at, values, left=np.nan, right=np.nan)
        after = np.clip(np.searchsorted(at, t), 1, len(at) - 1)
        hole = at[after] - at[after - 1] > max(0.5, 1.5 * float(np.median(np.diff(at))))
        found[hole] = np.nan
        if np.any(hole):
            lost.append(f"{name} {int(np.sum(hole))}")
        readings[name] = frozen(found)
    ground = ~(readings["V"] > slowest)
    readings["V"] = frozen(np.where(ground, np.nan, readings["V"]))
    messages = [
        note(
            "resampled",
            where=f"log {flight.id}",
            expected="channels on one grid",
            found=f"{', '.join(names)} at their own rates",
            do=f"Put on {rate:g} Hz by straight lines; {int(np.sum(ground))} of {len(t)} samples "
            f"below {slowest:g} m/s are not used.",
        )
    ]
    if lost:
        messages.append(
            warn(
                "holes",
                where=f"log {flight.id}",
                expected="no hole over half a second",
                found="samples in holes: " + ", ".join(lost),
                do="They are not used.",
            )
        )
    return AirDataRecord(t, readings, dict(arms or {}), tuple(messages))
