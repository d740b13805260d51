"""The maneuvers that a project holds out without naming them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.base.messages import note
from alula.campaign.check import Checked
from alula.flight import Flight, Maneuver
from alula.identify.split import LEAST, hold_out


def with_held_out(checked: Checked, seed: int = 0) -> Checked:
    """The project with a share of its maneuvers held out, where it marks none and has enough.

    The share is `identify.hold_out` of the project; nothing changes without models to identify.
    """
    spec = checked.project.identify
    if not spec.models or spec.hold_out == 0.0:
        return checked
    if any(m.held_out for m in checked.project.maneuvers):
        return checked
    conditions = {m.id: _condition(m, checked.flights[m.log]) for m in checked.maneuvers}
    chosen = hold_out(checked.maneuvers, conditions, share=spec.hold_out, seed=seed)
    if not chosen:
        return checked
    said = note(
        "held_out",
        where="[[maneuvers]]",
        expected="some maneuvers held out to judge the model by",
        found=f"none marked among {len(checked.maneuvers)}: {', '.join(chosen)} "
        f"{'is' if len(chosen) == 1 else 'are'} held out (a share of {spec.hold_out:g} of each "
        f"aspect with {LEAST} or more, spread over the conditions, seed {seed})",
        do="Nothing; mark maneuvers with held_out = true to choose them yourself, or set "
        "identify.hold_out = 0 to learn from all.",
    )
    return replace(
        checked,
        maneuvers=tuple(
            replace(m, held_out=True) if m.id in chosen else m for m in checked.maneuvers
        ),
        messages=(*checked.messages, said),
    )


def _condition(maneuver: Maneuver, flight: Flight) -> tuple[float, float]:
    """Airspeed and height, medians over the window; 0 where they were not recorded."""

    def median(name: str) -> float:
        if name not in flight:
            return 0.0
        channel = flight[name]
        if len(channel.t) == 1:
            return float(channel.values[0])
        use = (channel.t >= maneuver.start) & (channel.t <= maneuver.end)
        values = channel.values[use & np.isfinite(channel.values)]
        return float(np.median(values)) if len(values) else 0.0

    return median("V"), median("h")
