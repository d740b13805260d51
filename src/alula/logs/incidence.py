"""Flow angles in radians that are declared in degrees, by what turning and forces make of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.base.messages import Message
from alula.base.project import ChannelSpec, LogSpec
from alula.base.units import G0
from alula.flight import Channel
from alula.logs.changes import at, integral, together
from alula.logs.unit_message import other_unit_message

WINDOW = 0.5  # s over which changes are compared
ALIKE = 0.7  # correlation of the two accounts
FAR = 25.0  # times as much; radians for degrees are 57


def flow_angles(
    log: LogSpec, specs: Mapping[str, ChannelSpec], channels: Mapping[str, Channel]
) -> list[Message]:
    """An error for each of alpha and beta that changes 57 times too much or too little.

    For small angles V dalpha/dt = az + g cos(theta) cos(phi) + V q and V dbeta/dt = ay
    + g cos(theta) sin(phi) - V r + V alpha p (Etkin 1972, Eq. 5.6,2); the last is left out.
    """
    needed = ("V", "theta", "phi")
    out = []
    for name, force, rate in (("alpha", "az", "q"), ("beta", "ay", "r")):
        names = (*needed, force, rate, name)
        if any(n not in channels for n in names) or specs[name].constant is not None:
            continue
        if specs[name].confirmed:
            continue
        begin = max(float(channels[n].t[0]) for n in names)
        end = min(float(channels[n].t[-1]) for n in names)
        base = channels[force].t
        t = base[(base >= begin) & (base <= end)]
        if len(t) < 50 or end - begin < 10.0 * WINDOW:
            continue
        got = [at(channels, n, t, angle=n == "phi") for n in names]
        if any(x is None for x in got):
            continue
        V, theta, phi, f, turn, angle = (np.asarray(x) for x in got)
        V = np.where(
            0.3 * np.quantile(V, 0.95) < V, V, np.nan
        )  # on the ground vanes point anywhere
        if name == "alpha":
            slope = (f + G0 * np.cos(theta) * np.cos(phi)) / V + turn
        else:
            slope = (f + G0 * np.cos(theta) * np.sin(phi)) / V - turn
        slope = np.where(np.isfinite(slope), slope, 0.0)
        grid = np.arange(float(t[0]), float(t[-1]), WINDOW)
        flying = np.isfinite(np.interp(grid, t, V))
        flying = flying[1:] & flying[:-1]
        made = np.diff(np.interp(grid, t, integral(t, slope)))[flying]
        alike, ratio = together(np.diff(np.interp(grid, t, angle))[flying], made)
        if alike < ALIKE or not (ratio > FAR or ratio < 1.0 / FAR):
            continue
        looks = "deg" if ratio > 1.0 else "rad"
        expected = f"changes as {force}, {rate} and V make them"
        out.append(other_unit_message(log, name, expected, f"{ratio:.3g} times as much", looks))
    return out
