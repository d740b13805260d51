"""Blades from a table of the aircraft or propeller file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft.blades import BladePolar, Blades, MomentumParameters
from alula.aircraft.schema_blades import BladesTable, PolarParameters
from alula.base.arrays import frozen
from alula.base.project_messages import validated


def load_blades(table: Mapping[str, Any], where: str) -> Blades:
    """The blades of a table, in SI and radians; where: file and key, for messages.

    Raises BadInput with one message per thing that is wrong: stations out of order, a chord of
    zero, a polar that is not finite, columns of different length.
    """
    return blades_of(validated(BladesTable, table, Path(where)), where)


def blades_of(table: BladesTable, where: str) -> Blades:
    """The blades of a table that is already checked."""
    r = frozen(table.r)
    if table.beta_deg is not None:
        pitch = frozen(np.radians(table.beta_deg))
    else:
        pitch = frozen(np.arctan2(table.pitch or 0.0, 2.0 * np.pi * r))
    given = table.polars or ([] if table.polar is None else [table.polar])
    momentum = table.momentum
    return Blades(
        name=table.name or Path(where).stem,
        count=table.count,
        radius=0.5 * table.diameter,
        hub_radius=table.r[0] if table.hub_radius is None else table.hub_radius,
        r=r,
        chord=frozen(table.chord),
        pitch=pitch,
        pitch_of=table.pitch_of,
        source=table.source or where,
        polars=tuple(blade_polar(p) for p in given),
        sense=1.0 if table.sense == "right" else -1.0,
        helix=table.pitch,
        momentum=None
        if momentum is None
        else MomentumParameters(
            momentum.c_l_alpha,
            float(np.radians(momentum.alpha_max_deg)),
            momentum.c_d_alpha,
            momentum.pitch,
        ),
    )


def blade_polar(p: PolarParameters) -> BladePolar:
    """A section's polar in radians."""
    table = None
    if p.alpha_deg is not None:
        table = (frozen(np.radians(p.alpha_deg)), frozen(p.c_l), frozen(p.c_d))
    return BladePolar(
        p.c_l_0, p.c_l_alpha, p.c_l_min, p.c_l_max, p.c_d_0, p.c_d_2_upper, p.c_d_2_lower,
        p.c_l_cd0, p.c_d_stalled, p.reynolds, p.reynolds_power, p.mach_corrected, table, p.source,
    )  # fmt: skip
