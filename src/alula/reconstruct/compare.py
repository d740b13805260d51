"""Sensors that measure the same thing, set beside each other."""

from __future__ import annotations

import re

import numpy as np

from alula.base.messages import Message, note, warn
from alula.flight import Flight, Maneuver


def compare_duplicates(flight: Flight, maneuver: Maneuver) -> list[Message]:
    """A message for every pair such as 'alpha' and 'alpha_2': offset, scatter and ratio."""
    out = []
    for name in flight.channels:
        first = re.sub(r"_\d+$", "", name)
        if first == name or first not in flight:
            continue
        a, b = flight[first], flight[name]
        t = b.t[(b.t >= maneuver.start) & (b.t <= maneuver.end)]
        if len(t) < 10 or len(a.t) < 10:
            continue
        second = b.values[(b.t >= maneuver.start) & (b.t <= maneuver.end)]
        reference = np.interp(t, a.t[np.isfinite(a.values)], a.values[np.isfinite(a.values)])
        good = np.isfinite(second)
        difference = (second - reference)[good]
        offset, scatter = float(np.mean(difference)), float(np.std(difference))
        spread = float(np.std(reference[good]))
        ratio = float("nan")
        if spread > 0.0:
            ratio = float(np.cov(second[good], reference[good])[0, 1] / np.var(reference[good]))
        apart = scatter > 0.2 * spread > 0.0
        out.append(
            (warn if apart else note)(
                "duplicate_sensors_disagree" if apart else "duplicate_sensors",
                where=f"maneuver {maneuver.id}, {first} and {name}",
                expected="the same history",
                found=f"offset {offset:.3g} {a.unit}, scatter {scatter:.3g}, ratio {ratio:.4g}",
                do="Both are used; switch one off with use = false if it is not to be trusted.",
            )
        )
    return out
