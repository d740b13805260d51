"""Strip theory as lookup tables: an AeroModel of sums of tables over up to three axes.

As Pusztai 2018, Eq. (2.47), but his tables of six and seven axes are taken apart: a base over angle
of attack, sideslip and wash; beside it what each control and each rate adds, over the angle that
its surface feels, itself and the wash. Increments of controls and rates that act through the angle
of attack shrink with sideslip as cos(beta)^2, those of fin and rudder with cos(alpha)^2. What the
sum leaves out is measured together with the interpolation (`alula.predict.table_error`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.model import AeroModel, LookupTable, Reference, aero_model, lookup_table, parse
from alula.predict.strip_model import COEFFICIENTS, StripModel

# Which coefficients each control and rate changes enough to be tabulated, and over which angle.
INCREMENTS: dict[str, tuple[str, tuple[str, ...]]] = {
    "de": ("alpha", ("CD", "CL", "Cm")),
    "df": ("alpha", ("CD", "CL", "Cl", "Cm")),
    "da": ("alpha", ("CD", "Cl", "Cm", "Cn")),
    "phat": ("alpha", ("CY", "Cl", "Cn")),
    "qhat": ("alpha", ("CD", "CL", "Cm")),
    "dr": ("beta", ("CD", "CY", "Cl", "Cm", "Cn")),
    "rhat": ("beta", ("CY", "Cl", "Cn")),
}
SHRINKS = {"alpha": "cos2_beta", "beta": "cos2_alpha"}
ROLL_BY_YAW = "Cl_by_rhat"  # the wing's, slope over alpha and wash


@dataclass(frozen=True)
class Grid:
    """Breakpoints of each variable, rad, hats, wash; all increasing and with a node at zero."""

    axes: Mapping[str, Array]

    def __getitem__(self, name: str) -> Array:
        return self.axes[name]


def table_grid(resolution: float = 1.0) -> Grid:
    """A grid over Pusztai's ranges (2.2.3), alpha and beta to 90 deg, wash from -0.5 to 4.

    resolution: deg, of the angle of attack within 26 deg; other axes scale with it. Raises BadInput
    outside 0.5 to 4 deg.
    """
    if not 0.5 <= resolution <= 4.0:
        raise refuse(
            "table_resolution",
            where="lookup tables",
            expected="a resolution of 0.5 to 4 deg",
            found=f"{resolution:g} deg",
            do="Finer tables do not fit a flight computer, coarser ones miss the stall.",
        )
    r = resolution
    alpha = _two_sided(np.concatenate([_steps(26.0, r), 26.0 + _steps(64.0, 5.0 * r)[1:]]))
    beta = _two_sided(np.concatenate([_steps(20.0, 2.5 * r), 20.0 + _steps(70.0, 10.0 * r)[1:]]))
    n = max(3, round(8 / r))

    def even(limit: float) -> Array:
        return np.linspace(-limit, limit, 2 * n + 1)

    wash = np.array([-0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0])
    return Grid(
        {
            "alpha": np.radians(alpha),
            "beta": np.radians(beta),
            "wash": wash,
            "de": np.radians(even(25.0)),
            "da": np.radians(even(25.0)),
            "dr": np.radians(even(40.0)),
            "df": np.radians(np.linspace(0.0, 30.0, n + 1)),
            "phat": even(0.32),
            "qhat": even(0.065),
            "rhat": even(0.32),
        }
    )


def strip_tables(strips: StripModel, grid: Grid, reference_point: Array) -> AeroModel:
    """The tables as an AeroModel in stability axes; its variables are alpha, beta, the hats, the
    controls and `wash`. reference_point: (3,) m, of the aircraft.
    """
    tables: dict[str, LookupTable] = {}
    formulas: dict[str, list[str]] = {}

    def add(c: str, name: str, axes: tuple[str, ...], values: Array, times: str = "") -> None:
        tables[name] = lookup_table({a: grid[a] for a in axes}, values, where=name)
        formulas.setdefault(c, []).append(f"{name}({', '.join(axes)}){times}")

    base = _sweep(strips, grid, ("alpha", "beta", "wash"))
    for c in COEFFICIENTS:
        add(c, f"{c}_base", ("alpha", "beta", "wash"), base[c])
    for variable, (angle, coefficients) in INCREMENTS.items():
        axes = (angle, variable, "wash")
        rest = _sweep(strips, grid, (angle, "wash"))
        whole = _sweep(strips, grid, axes)
        other = "beta" if angle == "alpha" else "alpha"
        for c in coefficients:
            values = whole[c] - rest[c][:, None, :]
            add(c, f"{c}_of_{variable}", axes, values, f"*{SHRINKS[angle]}({other})")
    step = 0.02
    slope = _at(strips, grid, ("alpha", "wash"), {"rhat": step})["Cl"]
    slope = (slope - _at(strips, grid, ("alpha", "wash"), {"rhat": -step})["Cl"]) / (2.0 * step)
    level = int(np.argmin(np.abs(grid["alpha"])))
    # What it is at alpha = 0 is in the fin's table.
    values = slope - slope[level]
    add("Cl", ROLL_BY_YAW, ("alpha", "wash"), values, f"*rhat*{SHRINKS['alpha']}(beta)")
    for angle, name in (("beta", "cos2_beta"), ("alpha", "cos2_alpha")):
        tables[name] = lookup_table({angle: grid[angle]}, np.cos(grid[angle]) ** 2, where=name)
    text = {c: " + ".join(parts) for c, parts in formulas.items()}
    return aero_model(
        f"{strips.name}, strip theory",
        text,
        _ones(text, tables),
        Reference(strips.S, strips.b, strips.c),
        axes="stability",
        reference_point=frozen(reference_point),
        validity={a: (float(grid[a][0]), float(grid[a][-1])) for a in grid.axes},
        provenance={"method": "strip theory with propwash (Pusztai 2018, 2.2), tabulated"},
        tables=tables,
    )


def _ones(text: Mapping[str, str], tables: Mapping[str, LookupTable]) -> dict[str, float]:
    return {term.name(c): 1.0 for c, formula in text.items() for term in parse(formula, tables)}


def _sweep(strips: StripModel, grid: Grid, axes: tuple[str, ...]) -> dict[str, Array]:
    return _at(strips, grid, axes, {})


def _at(
    strips: StripModel, grid: Grid, axes: tuple[str, ...], fixed: Mapping[str, float]
) -> dict[str, Array]:
    """Coefficients over the product of the axes, everything else zero or as fixed."""
    mesh = np.meshgrid(*(grid[a] for a in axes), indexing="ij")
    shape = mesh[0].shape
    flat = {a: m.ravel() for a, m in zip(axes, mesh, strict=True)}
    flat |= {name: np.full(mesh[0].size, value) for name, value in fixed.items()}
    return {c: values.reshape(shape) for c, values in strips.evaluate(flat).items()}


def _steps(to: float, step: float) -> Array:
    return np.linspace(0.0, to, max(2, round(to / step) + 1))


def _two_sided(positive: Array) -> Array:
    return np.concatenate([-positive[:0:-1], positive])
