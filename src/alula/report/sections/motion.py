"""The plots of one maneuver's reconstruction."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from alula.flight import Maneuver, Motion
from alula.reconstruct.result import Segment, SensorFit
from alula.report.figures import Band, Figure, Line, Panel
from alula.report.names import titled, unit_of
from alula.report.numbers import shown

_MOTION = {
    "Air data": ("V", "alpha", "beta"),
    "Attitude": ("phi", "theta", "psi"),
    "Rates": ("p", "q", "r"),
    "Angular accelerations": ("pdot", "qdot", "rdot"),
    "Specific force": ("ax", "ay", "az"),
}
_STATES = {
    "u": "Velocity",
    "V": "Air data",
    "phi": "Attitude",
    "b_ax": "Accelerometer biases",
    "b_p": "Rate gyro biases",
}
_PANELS = 3  # states above one another in a figure


def state_figures(segment: Segment) -> Iterator[Figure]:
    """The filter's states, neighbors of one unit in one figure, with bands of ±2 se."""
    names = segment.state_names
    for _, group in groupby(range(len(names)), key=lambda k: unit_of(names[k])):
        members = list(group)
        for first in range(0, len(members), _PANELS):
            chosen = members[first : first + _PANELS]
            first_name = names[chosen[0]]
            alone = titled(first_name) if len(chosen) == 1 else ", ".join(names[k] for k in chosen)
            title = alone if len(chosen) == 1 else _STATES.get(first_name, alone)
            yield Figure(
                title,
                segment.maneuver.id,
                segment.motion.t,
                tuple(_state(segment, k) for k in chosen),
            )


def _state(segment: Segment, k: int) -> Panel:
    name = segment.state_names[k]
    factor, unit = shown(unit_of(name))
    values = factor * segment.states[:, k]
    return Panel(
        f"{titled(name)} ({unit})",
        (Line("estimate", values, "estimate"),),
        (Band("±2 se", 2.0 * factor * segment.states_se[:, k], values),),
        small=True,
    )


def motion_figures(motion: Motion) -> Iterator[Figure]:
    """Air data, attitude, rates, accelerations, controls and thrust."""
    for title, names in _MOTION.items():
        yield _figure(title, motion, {n: getattr(motion, n) for n in names})
    if motion.controls:
        yield _figure("Controls", motion, dict(motion.controls))
    if motion.thrust is not None:
        yield _figure("Thrust", motion, {"thrust": motion.thrust})


def _figure(
    title: str,
    motion: Motion,
    columns: dict[str, np.ndarray[tuple[int, ...], np.dtype[np.float64]]],
) -> Figure:
    panels = []
    for name, values in columns.items():
        factor, unit = shown("1" if name == "dt" else unit_of(name))
        line = Line(name, factor * values, "estimate")
        panels.append(Panel(f"{titled(name)} ({unit})", (line,), small=True))
    return Figure(title, motion.maneuver.id, motion.t, tuple(panels))


def sensor_figure(sensor: SensorFit, maneuver: Maneuver, title: str) -> Figure:
    """Measured and fitted above; innovations in their 2 sigma band below, else the residual."""
    factor, unit = shown(sensor.unit)
    if np.isfinite(sensor.innovation).any():
        below = Line("innovation", factor * sensor.innovation, "residual")
        half, name = 2.0 * factor * sensor.innovation_se, "±2 σ"
    else:
        below = Line("measured − fitted", factor * (sensor.measured - sensor.fitted), "residual")
        half, name = np.full(len(sensor.t), 2.0 * factor * sensor.sigma), "±2 σ stated"
    return Figure(
        title,
        maneuver.id,
        sensor.t,
        (
            Panel(
                f"{sensor.name} ({unit})",
                (
                    Line("measured", factor * sensor.measured, "measured"),
                    Line("fitted", factor * sensor.fitted, "model"),
                ),
            ),
            Panel(f"{below.name} ({unit})", (below,), (Band(name, half),), small=True),
        ),
    )
