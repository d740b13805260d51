"""Sensors that measure the same thing, set beside each other."""

from __future__ import annotations

import re

import numpy as np

from alula.base.messages import Message, note, warn
from alula.flight import Flight, Maneuver

# Channels of another name that measure the same quantity.
_ALSO = {"h_gps": "h"}
LEVEL = 10.0  # m, by which heights of satellites scatter about a barometer's in level flight


def compare_duplicates(flight: Flight, maneuver: Maneuver) -> list[Message]:
    """A message for every pair such as 'alpha' and 'alpha_2', 'h' and 'h_gps': offset, scatter and
    ratio over the maneuver. Angles that differ by whole turns are the same.
    """
    out = []
    for name in flight.channels:
        first = _ALSO.get(name, re.sub(r"_\d+$", "", name))
        if first == name or first not in flight:
            continue
        a, b = flight[first], flight[name]
        within = (b.t >= maneuver.start) & (b.t <= maneuver.end) & np.isfinite(b.values)
        known = np.isfinite(a.values)
        if within.sum() < 10 or known.sum() < 10:
            continue
        t, second = b.t[within], b.values[within]
        values = a.values[known]
        if first in ("phi", "psi"):
            values = np.unwrap(values)
        reference = np.interp(t, a.t[known], values)
        if first in ("phi", "psi"):  # a turn away is the same attitude
            second = second - 2.0 * np.pi * np.round((second - reference) / (2.0 * np.pi))
        difference = second - reference
        offset, scatter = float(np.mean(difference)), float(np.std(difference))
        spread = float(np.std(reference))
        ratio = float("nan")
        if spread > 0.0:
            ratio = float(np.cov(second, reference)[0, 1] / np.var(reference))
        apart = scatter > max(0.2 * spread, LEVEL if name in _ALSO else 0.0) and spread > 0.0
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
