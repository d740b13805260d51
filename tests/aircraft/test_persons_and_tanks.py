"""Persons against measured ones, fuel against particles that fill the tank's shape."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from particles import sums

from alula.aircraft import Aircraft, Tank, load_aircraft, person_inertia
from alula.aircraft.tanks import CylinderTank, TaperedTank
from alula.base.arrays import Array

HEAD = """schema = "alula.aircraft/1"
name = "tanks"
[reference]
S = 10.0
b = 8.0
c = 1.25
[[mass.components]]
name = "empty"
mass = 300.0
position = [0.1, 0.0, 0.05]
inertia = {Ixx = 400.0, Iyy = 500.0, Izz = 800.0, Ixz = 10.0}
"""
DENSITY = 700.0
CELLS = 60


def load(tmp_path: Path, text: str) -> Aircraft:
    path = tmp_path / "aircraft.toml"
    path.write_text(text)
    return load_aircraft(path)


@pytest.mark.parametrize(
    ("mass", "height", "moments"),
    [
        # Three men measured singly, standing: height in, weight lb, lb in s2 forward, sideways, up.
        (173.5, 72.2, (132.0, 119.0, 13.1)),
        (147.3, 67.4, (95.6, 81.9, 10.3)),
        (203.0, 73.3, (144.0, 129.0, 14.2)),
    ],
)
def test_standing_persons_are_met_within_what_is_stated(
    mass: float, height: float, moments: tuple[float, float, float]
) -> None:
    """Single men of the kind whose means the formula scales; it states 9 %."""
    got = np.diag(person_inertia(0.45359 * mass, 0.0254 * height, "standing"))
    np.testing.assert_allclose(got, 0.1129848 * np.array(moments), rtol=0.10)


def test_a_seated_person_is_of_the_size_of_simple_bodies() -> None:
    """Trunk with head, arms bent, thighs and shanks as bars, by the parallel-axis theorem."""
    # Shares of the mass as in Winter 2009, anthropometric table. Center x forward, +-y, z down from
    # the hips (m), length along x and z, half widths along y and x.
    parts = [
        (0.578, 0.00, 0.00, -0.34, 0.00, 0.80, 0.16, 0.11),
        (0.056, 0.02, 0.21, -0.32, 0.00, 0.28, 0.05, 0.05),
        (0.044, 0.20, 0.21, -0.18, 0.30, 0.00, 0.04, 0.04),
        (0.200, 0.21, 0.10, 0.00, 0.43, 0.00, 0.07, 0.07),
        (0.122, 0.45, 0.10, 0.24, 0.00, 0.45, 0.05, 0.05),
    ]
    mass, height = 75.5, 1.763
    share, x, y, z, lx, lz, wy, wx = np.array(parts).T
    m = mass * share
    x, z = x - m @ x / mass, z - m @ z / mass
    bar = [
        lz**2 / 12 + wy**2 / 4,
        (lx**2 + lz**2) / 12 + wx**2 / 4,
        lx**2 / 12 + (wx**2 + wy**2) / 4,
    ]
    J = np.array(
        [m @ (bar[0] + y**2 + z**2), m @ (bar[1] + x**2 + z**2), m @ (bar[2] + x**2 + y**2)]
    )
    # A figure of five bars: a quarter off is what it can be.
    np.testing.assert_allclose(np.diag(person_inertia(mass, height)), J, rtol=0.25)


def test_persons_are_parts_of_the_mass(tmp_path: Path) -> None:
    person = '[[mass.{}]]\nname = "pilot"\nmass = 80.0\n{}position = [0.2, -0.3, -0.1]\n{}'
    J = person_inertia(80.0, 1.8)
    inertia = f"inertia = {{Ixx = {J[0, 0]}, Iyy = {J[1, 1]}, Izz = {J[2, 2]}}}\n"
    one = load(tmp_path, HEAD + person.format("persons", "height = 1.8\n", "")).mass
    other = load(tmp_path, HEAD + person.format("components", "", inertia)).mass
    assert one is not None
    assert other is not None
    np.testing.assert_allclose(one.inertia, other.inertia, rtol=1e-14)
    np.testing.assert_allclose(one.cg, other.cg, rtol=1e-14)
    assert one.mass == 380.0


def particles_of(shape: TaperedTank | CylinderTank, filled: float) -> tuple[Array, Array]:
    """Cells of the tank's shape below the surface: mass (n,) and position (n, 3)."""
    u = (np.arange(CELLS) + 0.5) / CELLS
    a, b, c = (x.ravel() for x in np.meshgrid(u, u, u, indexing="ij"))
    if isinstance(shape, TaperedTank):
        center = shape.centers[0] + b[:, None] * (shape.centers[1] - shape.centers[0])
        length = shape.lengths[0] + b * np.diff(shape.lengths)
        depth = shape.depths[0] + b * np.diff(shape.depths)
        span = abs(shape.centers[1, 1] - shape.centers[0, 1])
        offset = np.column_stack([(a - 0.5) * length, 0 * b, (0.5 - filled * c) * depth])
        return DENSITY * span * length * depth * filled / CELLS**3, center + offset
    R, L = 0.5 * shape.diameter, shape.length
    local = np.column_stack([(a - 0.5) * L, (2 * b - 1) * R, (2 * c - 1) * R])
    inside = local[:, 1] ** 2 + local[:, 2] ** 2 < R**2
    mass = np.full(inside.sum(), DENSITY * shape.volume / inside.sum())
    local = local[inside]
    if shape.axis == 2:
        local = local[:, [1, 2, 0]]
    elif shape.axis == 1:
        local = local[:, [1, 0, 2]]
    # The lowest cells (z down: the largest z) up to the share, the last ones in part.
    order = np.argsort(-local[:, 2], kind="stable")
    level = np.cumsum(mass[order]) <= filled * mass.sum()
    return mass[order][level], shape.center + local[order][level]


SHAPES = [
    TaperedTank(np.array([[0.2, 0.5, 0.1], [0.0, 2.0, -0.1]]), np.array([0.6, 0.4]),
                np.array([0.15, 0.1])),
    TaperedTank(np.array([[0.2, 0.9, 0.1], [0.2, 0.5, 0.1]]), np.array([0.6, 0.6]),
                np.array([0.3, 0.3])),
    *[CylinderTank(np.array([0.3, -0.2, 0.1]), 0.4, 0.9, axis) for axis in range(3)],
]  # fmt: skip


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("filled", [1.0, 0.5, 0.2])
def test_contents_are_sums_over_particles(shape: TaperedTank | CylinderTank, filled: float) -> None:
    tank = Tank("tank", shape, DENSITY * shape.volume, DENSITY)
    mass, position, inertia = tank.content(np.array([filled * tank.capacity]))
    m, r = particles_of(shape, filled)
    want_mass, want_cg, want_J = sums(m, r)
    # Cells of a 60th of each side: boxes to (1/60)^2, round walls and levels to about 1/60.
    rough = isinstance(shape, CylinderTank)
    assert mass[0] == pytest.approx(want_mass, rel=0.03 if rough else 1e-3)
    np.testing.assert_allclose(position[0], want_cg, atol=0.008 if rough else 1e-4)
    scale = want_J.max()
    np.testing.assert_allclose(inertia[0], want_J, atol=(0.05 if rough else 1e-3) * scale)


def test_liquid_ellipsoid_is_the_formulas_measure() -> None:
    """A cube of liquid is taken as a sphere, which does not turn with its tank at all."""
    cube = TaperedTank(np.array([[0, -0.5, 0], [0, 0.5, 0]], dtype=float), np.ones(2), np.ones(2))
    solid = Tank("a", cube, 100.0, 1000.0)
    liquid = Tank("a", cube, 100.0, 1000.0, reduced=True)
    full = np.array([1000.0])
    np.testing.assert_allclose(solid.content(full)[2][0], 1000.0 / 6.0 * np.eye(3))
    np.testing.assert_allclose(liquid.content(full)[2][0], np.zeros((3, 3)), atol=1e-9)
    # Axes 3, 2, 1 of an ellipsoid-like slab: ((9-4)/(9+4))^2 of the solid about the third.
    slab = TaperedTank(
        np.array([[0, -1.0, 0], [0, 1.0, 0]]), np.array([3.0, 3.0]), np.array([1.0, 1.0])
    )
    ratio = Tank("a", slab, 1.0, 1000.0, reduced=True).content(np.array([6000.0]))[2][
        0
    ] / np.maximum(Tank("a", slab, 1.0, 1000.0).content(np.array([6000.0]))[2][0], 1e-9)
    np.testing.assert_allclose(
        np.diag(ratio), [(3 / 5) ** 2, (8 / 10) ** 2, (5 / 13) ** 2], rtol=1e-12
    )


BOX = """[[mass.tanks]]
name = "{}"
shape = "box"
fuel = {}
density = 700.0
center = [{}, 0.0, 0.2]
size = [0.5, 0.4, 0.3]
burn = {}
"""


def test_tanks_burn_in_order(tmp_path: Path) -> None:
    text = HEAD + BOX.format("aft", 30.0, -1.0, 1) + BOX.format("fore", 20.0, 1.0, 2)
    aircraft = load(tmp_path, text)
    got = aircraft.mass_properties(np.array([0.0, 15.0, 30.0, 50.0, np.nan]))
    moment = 300.0 * 0.1
    want = [(moment - 30.0 + 20.0) / 350.0, (moment - 15.0 + 20.0) / 335.0,
            (moment + 20.0) / 320.0, moment / 300.0]  # fmt: skip
    np.testing.assert_allclose(got.cg[:4, 0], want, rtol=1e-12)
    np.testing.assert_allclose(got.mass[:4], [350.0, 335.0, 320.0, 300.0], rtol=1e-12)
    assert np.isnan(got.mass[4])
    # Empty again: the component alone.
    np.testing.assert_allclose(np.diag(got.inertia[3]), [400.0, 500.0, 800.0], rtol=1e-12)
    # Full: the mass model's own totals.
    assert aircraft.mass is not None
    np.testing.assert_allclose(got.inertia[0], aircraft.mass.inertia, rtol=1e-12)


def test_equal_tanks_burn_together(tmp_path: Path) -> None:
    text = HEAD + BOX.format("aft", 30.0, -1.0, 1) + BOX.format("fore", 15.0, 1.0, 1)
    cg = load(tmp_path, text).mass_properties(np.array([0.0, 30.0])).cg
    np.testing.assert_allclose(cg[:, 0], [15.0 / 345.0, (30.0 - 10.0 + 5.0) / 315.0], rtol=1e-12)


def test_tanks_turn_with_the_design_frame(tmp_path: Path) -> None:
    """Drawings count z up: the same tank, and its floor is still below."""
    body = HEAD + BOX.format("t", 10.0, 0.4, 1)
    design = body.replace("[0.1, 0.0, 0.05]", "[-0.1, 0.0, -0.05]").replace(
        "[0.4, 0.0, 0.2]", "[-0.4, 0.0, -0.2]"
    )
    design = design.replace("[reference]", '[datum]\nname = "x"\nframe = "design"\n[reference]')
    one, other = load(tmp_path, body).mass, load(tmp_path, design).mass
    assert one is not None
    assert other is not None
    np.testing.assert_allclose(one.cg, other.cg, rtol=1e-12)
    np.testing.assert_allclose(one.inertia, other.inertia, rtol=1e-12)
