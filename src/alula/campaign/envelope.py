"""The maneuvers' airspeeds against the envelope: a unit that no other channel shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from alula.aircraft import Aircraft
from alula.base.messages import Message, warn
from alula.base.project import ChannelSpec
from alula.base.units import to_si
from alula.flight import Flight, Maneuver
from alula.logs.airspeed import UNITS

SLACK = 0.1  # of the limits: a position error, a stall with flaps, a dive


def outside_envelope(
    flight: Flight,
    maneuvers: Sequence[Maneuver],
    aircraft: Aircraft,
    specs: Mapping[str, ChannelSpec],
) -> list[Message]:
    """A warning where a log's maneuvers are for the most part outside the limits of airspeed."""
    limits = aircraft.envelope.V
    if limits is None or "V" not in flight or "V" not in specs or specs["V"].confirmed:
        return []
    V = flight["V"]
    inside = np.zeros(len(V.t), dtype=bool)
    for m in maneuvers:
        inside |= (V.t >= m.start) & (V.t <= m.end)
    values = V.values[inside & np.isfinite(V.values)]
    if not len(values):
        return []
    low, high = (1.0 - SLACK) * limits[0], (1.0 + SLACK) * limits[1]
    middle = float(np.median(values))
    if low <= middle <= high:
        return []
    stated = to_si(specs["V"].unit or "m/s").scale
    fits = [u for u in UNITS if limits[0] <= middle * to_si(u).scale / stated <= limits[1]]
    hint = f"Should its unit be {' or '.join(repr(u) for u in fits)}? " if fits else ""
    return [
        warn(
            "outside_envelope",
            where=f"log {flight.id}, channel V",
            expected=f"{limits[0]:.4g} to {limits[1]:.4g} m/s in its maneuvers, the envelope of "
            f"{aircraft.path}",
            found=f"a median of {middle:.4g} m/s",
            do=f"{hint}If it is right as it is, correct the envelope or write confirmed = true.",
        )
    ]
