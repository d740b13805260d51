"""How far the lattice's derivatives are from those of ever finer panels.

Each is computed on the mesh and on finer ones, and extrapolated as f = f0 + a h with h the inverse
root of the number of panels: trailing legs beside a tip converge with the first order (Richardson
extrapolation, Roache 1997, Annual Review of Fluid Mechanics 29). The error bar of the mesh is its
distance from f0 plus the largest departure from that line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.aircraft.geometry import Geometry
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.model import Reference
from alula.predict.lattice_result import LatticeResult
from alula.predict.vortex_lattice import vortex_lattice

FACTORS = (1.0, 1.5, 2.0)


@dataclass(frozen=True)
class MeshStudy:
    """The lattice on several meshes. counts: (k,) panels; derivatives in the axes of models.

    values: (k,) by derivative; limit: extrapolated to no panel size; error: of the first mesh, in
    the derivative's unit. result: on the first mesh.
    """

    result: LatticeResult
    counts: Array
    values: Mapping[str, Array]
    limit: Mapping[str, float]
    error: Mapping[str, float]


def mesh_study(
    geometry: Geometry,
    reference: Reference,
    point: Array,
    *,
    factors: tuple[float, ...] = FACTORS,
    panels: Mapping[str, tuple[int, int]] | None = None,
    **options: Any,
) -> MeshStudy:
    """The lattice on its mesh and on finer ones; options: as of `vortex_lattice`.

    factors: of the panels along chord and span, the first 1, growing, at least three. With the
    default the finest mesh has four times the panels. Raises BadInput as `vortex_lattice` does.
    """
    steps = np.diff(factors)
    if len(factors) < 3 or factors[0] != 1.0 or not np.all(steps >= 0.1):
        raise refuse(
            "mesh_factors",
            where="mesh_study, factors",
            expected="at least three, from 1 on, each at least 0.1 more than the one before",
            found=str(factors),
            do=f"Use the default, {FACTORS}.",
        )
    mesh = {s.name: s.panels for s in geometry.surfaces}
    mesh.update(panels or {})
    results = [
        vortex_lattice(
            geometry,
            reference,
            point,
            panels={name: (_times(m, k), _times(s, k)) for name, (m, s) in mesh.items()},
            **options,
        )
        for k in factors
    ]
    counts = np.array([float(r.panels.count) for r in results])
    size = 1.0 / np.sqrt(counts)
    found = [r.derivatives() for r in results]
    values, limit, error = {}, {}, {}
    for name in found[0]:
        values[name] = frozen([f[name] for f in found])
        slope, limit[name] = map(float, np.polyfit(size, values[name], 1))
        misfit = np.abs(values[name] - limit[name] - slope * size).max()
        error[name] = float(abs(values[name][0] - limit[name]) + misfit)
    return MeshStudy(results[0], frozen(counts), values, limit, error)


def _times(count: int, factor: float) -> int:
    return max(1, round(count * factor))
