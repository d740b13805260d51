"""The Earth's magnetic field at a flight: as the project states it, or by the world's model."""

from __future__ import annotations

import numpy as np

from alula.base.messages import Message, note, refuse
from alula.base.project import NavigateSpec
from alula.flight import Flight
from alula.navigate.field import world_magnetic_model


def field_of(
    spec: NavigateSpec, flight: Flight
) -> tuple[tuple[float, float, float] | None, list[Message]]:
    """The Earth's field, T, as stated or by the World Magnetic Model, which is said.

    Raises BadInput where the model is asked for without day or place.
    """
    if spec.field != "world_magnetic_model":
        return spec.field_si, []
    place = [_first(flight, name) for name in ("lat", "lon")]
    if spec.day is None or None in place:
        raise refuse(
            "missing_place_or_day",
            where=f"log {flight.id}: navigate.field",
            expected="channels lat and lon, and 'day' in [navigate], which the model needs",
            found="no day" if spec.day is None else "no position",
            do="Add them, for example day = 2026-05-01, or state the field itself.",
        )
    latitude, longitude = (float(x) for x in place if x is not None)
    height = next((h for n in ("h_gps", "h") if (h := _first(flight, n)) is not None), 0.0)
    found = world_magnetic_model(latitude, longitude, height, spec.day)
    words = ", ".join(f"{1e6 * b:.2f}" for b in found)
    return found, [
        note(
            "field_by_model",
            where=f"log {flight.id}",
            expected="the Earth's magnetic field",
            found=f"{words} uT north, east, down by the World Magnetic Model at "
            f"{np.degrees(latitude):.3f}, {np.degrees(longitude):.3f} deg on {spec.day}",
            do="Nothing, if the day is right.",
        )
    ]


def _first(flight: Flight, name: str) -> float | None:
    """The first valid sample of a channel."""
    if name not in flight:
        return None
    valid = flight[name].values[np.isfinite(flight[name].values)]
    return float(valid[0]) if len(valid) else None
