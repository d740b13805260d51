"""Whole aircraft by handbook formulas: invariances, signs, lattices of other codes, bad input."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.aircraft.geometry import Airfoil, ControlSurface, Geometry
from alula.base.messages import BadInput
from alula.predict.derivatives import Derivatives
from alula.predict.fin import FinArms, fin_derivatives
from alula.predict.flow import Flow
from alula.predict.handbook import Found
from alula.predict.semi_empirical import from_geometry, semi_empirical
from data import data
from predict.predicted_shapes import FOIL, B, C, S, light_airplane
from verification.prediction.armhawk_surfaces import armhawk_surfaces
from verification.prediction.sportstar_prediction import sportstar_prediction

POINT = np.zeros(3)
AIRCRAFT = Path(__file__).parents[2] / "aircraft"
SPORTSTAR = AIRCRAFT / "sportstar.toml"
SHAPED = [p for p in sorted(AIRCRAFT.glob("*.toml")) if "[[geometry.surfaces]]" in p.read_text()]
SMALL = Flow(alpha=0.05)


def predicted(geometry: Geometry, flow: Flow = SMALL, point: np.ndarray = POINT) -> Derivatives:
    return from_geometry(geometry, S, B, C, point, flow)


def test_rows() -> None:
    for check in (armhawk_surfaces, sportstar_prediction):
        said, holds = check(True)
        assert holds, said


def test_size_does_not_matter() -> None:
    """Derivatives but the drag's, which feels the Reynolds number, belong to the shape alone."""
    small = predicted(light_airplane())
    large = from_geometry(light_airplane(3.0), 9.0 * S, 3.0 * B, 3.0 * C, POINT, SMALL)
    for name, e in small.values.items():
        if not name.startswith("CD"):
            assert large.values[name].value == pytest.approx(e.value, rel=1e-9, abs=1e-12), name
            assert large.values[name].se == pytest.approx(e.se, rel=1e-9, abs=1e-12), name
    assert large.values["CD_0"].value < small.values["CD_0"].value


def test_datum_does_not_matter() -> None:
    here = predicted(light_airplane())
    there = predicted(light_airplane(x=7.0), point=np.array([7.0, 0.0, 0.0]))
    for name, e in here.values.items():
        assert there.values[name].value == pytest.approx(e.value, rel=1e-9, abs=1e-9), name


def test_moments_move_with_the_reference_point() -> None:
    """A point 0.2 m further aft takes 0.2/c of the force with it, whatever the formulas are."""
    front = predicted(light_airplane())
    aft = predicted(light_airplane(), point=np.array([-0.2, 0.0, 0.0]))
    for name in ("alpha", "de", "0"):
        moved = front.values[f"Cm_{name}"].value + 0.2 / C * front.values[f"CL_{name}"].value
        assert aft.values[f"Cm_{name}"].value == pytest.approx(moved, rel=1e-9, abs=1e-12)
    # Sideways the arm lies along stability axes.
    moved = front.values["Cn_dr"].value + 0.2 * np.cos(0.05) / B * front.values["CY_dr"].value
    assert aft.values["Cn_dr"].value == pytest.approx(moved, rel=1e-9)


def test_signs_of_an_ordinary_airplane() -> None:
    """Notation: a positive deflection gives a negative moment; damping is negative."""
    v = {n: e.value for n, e in predicted(light_airplane()).values.items()}
    for name in ("Cm_alpha", "Cm_q", "Cm_alphadot", "Cm_de", "CY_beta", "Cl_p", "Cn_r", "Cn_p",
                 "Cl_da", "Cn_dr"):  # fmt: skip
        assert v[name] < 0.0, name
    for name in ("CL_alpha", "CL_q", "CL_de", "CL_df", "Cn_beta", "Cl_r", "CY_r", "CY_dr", "Cn_da"):
        assert v[name] > 0.0, name


def test_dihedral_and_sweep_roll_into_the_wind() -> None:
    base = light_airplane(body=False)
    wing = base.surfaces[0]
    tip = wing.sections[1]
    for move in ([0.0, 0.0, -0.4], [-2.0, 0.0, 0.0]):
        turned = replace(
            wing, sections=(wing.sections[0], replace(tip, position=tip.position + np.array(move)))
        )
        changed = replace(base, surfaces=(turned, *base.surfaces[1:]))
        assert predicted(changed).values["Cl_beta"].value < predicted(base).values["Cl_beta"].value


def test_camber_lifts_and_pitches_down() -> None:
    """A circular arc of 4 %: alpha_0 = -0.08 rad, c_m = -pi 0.04 by thin-airfoil theory."""
    x = np.linspace(0.0, 1.0, 201)
    arc = np.column_stack([x, 0.16 * x * (1.0 - x)])
    base = light_airplane(body=False)
    wing = replace(base.surfaces[0], controls=())
    flat = replace(base, surfaces=(wing,))
    cambered = replace(flat, airfoils={FOIL: Airfoil(FOIL, 0.12, camber=arc)})
    v = predicted(cambered).values
    assert v["CL_0"].value == pytest.approx(0.08 * v["CL_alpha"].value, rel=2e-3)
    aft = (
        0.25 * C
    )  # put the reference at a quarter chord of the mean chord: only the couple is left
    quarter = predicted(cambered, point=np.array([0.375 - aft, 0.0, 0.0])).values["Cm_0"].value
    assert quarter == pytest.approx(-np.pi * 0.04, rel=0.02)


def test_washout_trims_a_flying_wing() -> None:
    """Swept back with its tips nose down, it lifts inboard, ahead: nose up at zero lift."""
    base = light_airplane(body=False)
    wing = base.surfaces[0]
    for twist, sweep in ((-0.08, 2.0), (-0.08, 0.0), (0.0, 2.0)):
        tip = replace(
            wing.sections[1], twist=twist, position=wing.sections[1].position - [sweep, 0.0, 0.0]
        )
        alone = replace(wing, sections=(wing.sections[0], tip), controls=())
        v = predicted(replace(base, surfaces=(alone,))).values
        at_zero_lift = v["Cm_0"].value - v["Cm_alpha"].value / v["CL_alpha"].value * v["CL_0"].value
        if twist and sweep:
            assert at_zero_lift > 0.02
        else:  # the straight wing's quarter chord line is swept by a third of a degree only
            assert abs(at_zero_lift) < 0.002


def test_beside_the_lattices_of_other_codes() -> None:
    """The SportStar-sized case of vortex_lattice.json: within twice the stated standard error.

    The lattice knows no body, so none is given. Its values are inviscid, the sections here 5 %
    weaker; the stated errors cover that.
    """
    cases = json.loads(data("references", "vortex_lattice.json").read_text())["cases"]
    case = next(c for c in cases if c["name"].startswith("light airplane"))
    expected = case["expected"][0]
    aircraft = load_aircraft(SPORTSTAR)
    assert aircraft.geometry is not None
    shape = replace(aircraft.geometry, bodies=())
    # The file's datum lies 0.375 m behind the leading edge of the mean chord, the case's at 0.3125.
    point = np.array([0.375 - case["x_ref"], 0.0, 0.0])
    found = from_geometry(shape, case["S"], case["b"], case["c"], point, Flow(alpha=0.0)).values
    names = [
        "CL_alpha",
        "Cm_alpha",
        "CL_q",
        "Cm_q",
        "CY_beta",
        "Cl_beta",
        "Cn_beta",
        "Cl_p",
        "Cn_r",
    ]
    pairs = {n: expected[n] for n in names}
    for lattice, ours in (("CL_elevator_per_deg", "CL_de"), ("Cm_elevator_per_deg", "Cm_de")):
        pairs[ours] = np.degrees(expected[lattice])
    for name, value in pairs.items():
        e = found[name]
        assert abs(e.value - value) < 2.0 * e.se, (name, e.value, e.se, value)
        assert e.se < 0.25 * abs(value), name  # and the errors are not an excuse


def test_fin_in_yaw_and_roll_by_its_own_velocity() -> None:
    """The fin's sideslip from v + w x r at its place; rolling is that less the wing's sidewash."""
    a, span, arms = 0.3, 8.0, FinArms(aft=3.5, up=0.9, flat=0.7)
    found = fin_derivatives(Found(-a, 0.0, ""), arms, span)
    r_S = np.array([-arms.aft, 0.0, -arms.up])
    for axis, label in ((2, "r"), (0, "p")):
        w = np.zeros(3)
        w[axis] = 2.0 / span  # rad/s at 1 m/s: a hat of one
        v = np.cross(w, r_S)[1]
        force = np.array([0.0, -a * v, 0.0])
        moment = np.cross(r_S, force) / span
        share = 1.0 if label == "r" else (arms.up - arms.flat) / arms.up
        assert found[f"CY_{label}"].value == pytest.approx(share * force[1])
        assert found[f"Cl_{label}"].value == pytest.approx(share * moment[0])
        assert found[f"Cn_{label}"].value == pytest.approx(share * moment[2])


def test_full_span_flap_is_incidence_times_its_turning() -> None:
    """A hinge almost at the leading edge: the elevator is the tailplane itself."""
    base = light_airplane(body=False)
    tail = replace(
        base.surfaces[1], controls=(ControlSurface("e", 0.0, 1.0, (1e-6, 1e-6), {"de": 1.0}),)
    )
    v = predicted(replace(base, surfaces=(base.surfaces[0], tail))).values
    q = v["CL_q"].value - predicted(replace(base, surfaces=base.surfaces[:1])).values["CL_q"].value
    tail_lift = q * C / (2.0 * (3.325 + 0.2))
    # 0.98: friction takes 1.4 times from the flap what it takes from the section, 0.93/0.95.
    assert v["CL_de"].value == pytest.approx(tail_lift * 0.93 / 0.95, rel=2e-3)


def test_sportstar_says_what_it_stands_on() -> None:
    found = semi_empirical(load_aircraft(SPORTSTAR))
    assert found.axes == "stability"
    assert "level flight" in found.conditions["alpha"]
    assert all(e.se >= 0.0 and np.isfinite(e.value) for e in found.values.values())
    assert all(e.source for e in found.values.values())
    assert "Datcom 4.4.1" in found.conditions["downwash gradient"]


@pytest.mark.parametrize("path", SHAPED, ids=lambda path: path.stem)
def test_every_ready_aircraft_with_a_shape(path: Path) -> None:
    """Finite values with errors and sources, stable and damped, by all that the shape offers."""
    aircraft = load_aircraft(path)
    found = semi_empirical(aircraft, Flow(V=1.5 * (aircraft.envelope.V or (30.0, 0.0))[0]))
    for name, e in found.values.items():
        assert np.isfinite(e.value), name
        assert e.se >= 0.0, name
        assert e.source, name
    for name in ("Cm_alpha", "Cm_q", "Cl_p", "Cn_r", "CY_beta"):
        assert found.values[name].value < 0.0, name
    assert found.values["Cn_beta"].value > 0.0


def test_low_aspect_ratio_is_noted_with_larger_error() -> None:
    base = light_airplane(body=False)
    wing = base.surfaces[0]
    tip = replace(wing.sections[1], position=wing.sections[1].position * [1.0, 0.3, 1.0])
    stub = replace(base, surfaces=(replace(wing, sections=(wing.sections[0], tip)),))
    found = predicted(stub)
    assert any("aspect ratio" in note and "Cl_p" in note for note in found.notes)
    wide = predicted(replace(base, surfaces=base.surfaces[:1]))
    relative = [e.se / abs(e.value) for e in (found.values["Cl_p"], wide.values["Cl_p"])]
    assert relative[0] == pytest.approx(2.0 * relative[1], rel=0.02)


@pytest.mark.parametrize(
    ("change", "flow", "words"),
    [
        (lambda g: replace(g, surfaces=g.surfaces[1:]), SMALL, "wing"),
        (lambda g: g, Flow(lift=3.0), "attached flow"),
    ],
)
def test_refused(change, flow: Flow, words: str) -> None:
    with pytest.raises(BadInput, match=words):
        predicted(change(light_airplane()), flow)


@pytest.mark.parametrize("bad", [{"V": 0.0}, {"mach": 1.2}, {"alpha": 1.0}, {"density": np.nan}])
def test_impossible_conditions_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(BadInput, match="condition of the prediction"):
        Flow(**bad)


def test_aircraft_without_geometry_is_refused() -> None:
    aircraft = replace(load_aircraft(SPORTSTAR), geometry=None)
    with pytest.raises(BadInput, match="geometry"):
        semi_empirical(aircraft)
