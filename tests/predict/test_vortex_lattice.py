"""The vortex lattice against reference values, closed forms and itself."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from lattice_shapes import (
    FLAT,
    geometry,
    light_airplane,
    rectangle,
    reference_case,
    section,
    surface,
    unit,
)

from alula.aircraft.geometry import Airfoil, ControlSurface, Geometry
from alula.base.arrays import Array
from alula.base.messages import BadInput
from alula.model import Reference
from alula.predict.lattice_axes import LatticeAxes, coefficient_names
from alula.predict.mesh_study import mesh_study
from alula.predict.vortex_lattice import vortex_lattice
from data import data

CASES = ["rectangle AR 8", "Bertin and Smith swept wing", "light airplane of SportStar size"]


@pytest.mark.parametrize("name", CASES)
def test_reference_values_to_the_last_digit(name: str) -> None:
    file = json.loads(data("references", "vortex_lattice.json").read_text())
    case = next(c for c in file["cases"] if c["name"] == name)
    shape, reference, point = reference_case(case)
    for expected in case["expected"]:
        mesh = {k: tuple(v) for k, v in expected["panels"].items()}
        result = vortex_lattice(shape, reference, point, panels=mesh)
        found = result.derivatives("stability")
        found |= result.derivatives("stability", per_degree=True)
        for key, value in expected.items():
            if key != "panels":
                # One unit in the sixth decimal, and what rounding to it hides.
                assert found[key.replace("elevator", "de")] == pytest.approx(value, abs=1.5e-6), key


def test_elliptic_wing_of_lifting_line_theory() -> None:
    aspect = 40.0
    b = aspect * np.pi / 4
    eta = np.sin(np.linspace(0.0, 0.5 * np.pi, 21))
    sections = tuple(
        section(-0.25 * c, 0.5 * b * y, 0, c)
        for y, c in zip(eta, np.sqrt(1.0 - eta**2) + 1e-6, strict=True)
    )
    shape = geometry(surface("wing", sections, panels=(1, 20)))
    reference = Reference(b**2 / aspect, b, 1.0)
    result = vortex_lattice(shape, reference, np.zeros(3), alpha=0.05, spacing="cosine")
    flat = vortex_lattice(shape, reference, np.zeros(3), spacing="cosine").derivatives()
    # Prandtl 1918: CL_alpha = 2 pi/(1 + 2/A), e = 1, constant downwash CL/(pi A); Van Dyke 1964,
    # lifting-line theory: the next term. Trapezoids have 0.1 % less area than the ellipse.
    next_term = 16 / np.pi**2 * (np.log(np.pi * aspect) - 9 / 8) / aspect**2
    slope = 2 * np.pi / (1 + 2 / aspect + next_term)
    assert flat["CL_alpha"] == pytest.approx(slope, rel=2.5e-3)
    assert result.oswald == pytest.approx(1.0, abs=4e-3)
    load = result.span_loads[0]
    inside = np.abs(load.position[:, 1]) < 0.4 * b
    downwash = result.coefficients()["CL"] / (np.pi * aspect)
    assert load.induced_angle[inside] == pytest.approx(downwash, rel=0.01)


@pytest.mark.parametrize("strips", [10, 60])
def test_near_field_drag_is_that_of_the_trefftz_plane(strips: int) -> None:
    reference, point = unit(6.0)
    result = vortex_lattice(
        rectangle(6.0), reference, point, alpha=0.1, panels={"wing": (6, strips)}, spacing="cosine"
    )
    # The wake starts where it is not quite along the flow: of the order of alpha^2.
    assert result.coefficients()["CD"] == pytest.approx(result.induced_drag, rel=0.01)
    # Glauert 1926, Fig. 11.1: delta of about 0.02 for a rectangle of A = 6 by lifting-line theory.
    assert result.oswald == pytest.approx(0.98, abs=0.01)
    assert result.oswald_of == "the condition's load"


@pytest.mark.parametrize("mach", [0.0, 0.5])
def test_half_a_lattice_gives_what_the_whole_gives(mach: float) -> None:
    shape, reference, point = light_airplane()
    half = vortex_lattice(shape, reference, point, alpha=0.1, mach=mach)
    whole = vortex_lattice(shape, reference, point, alpha=0.1, mach=mach, symmetry=False)
    assert half.symmetric
    assert not whole.symmetric
    expected = whole.derivatives()
    size = max(map(abs, expected.values()))
    for name, value in half.derivatives().items():
        assert value == pytest.approx(expected.pop(name), abs=1e-11 * size), name
    # What half a lattice leaves out is zero by symmetry.
    assert max(map(abs, expected.values())) < 1e-10 * size
    assert half.coefficients() == pytest.approx(whole.coefficients(), abs=1e-13)
    for a, b in zip(half.span_loads, whole.span_loads, strict=True):
        assert a.c_l == pytest.approx(b.c_l, abs=1e-12)


def test_a_far_origin_changes_nothing() -> None:
    shape, reference, point = light_airplane()
    away = np.array([-250.0, 0.0, 80.0])
    moved = Geometry(
        tuple(
            replace(s, sections=tuple(replace(x, position=x.position + away) for x in s.sections))
            for s in shape.surfaces
        ),
        airfoils=FLAT,
    )
    here = vortex_lattice(shape, reference, point, alpha=0.05)
    there = vortex_lattice(moved, reference, point + away, alpha=0.05)
    # 250 m of coordinates in 1 m panels cost three digits of sixteen.
    assert there.derivatives() == pytest.approx(here.derivatives(), rel=1e-9, abs=1e-11)
    assert there.neutral_point == pytest.approx(here.neutral_point + away, abs=1e-9)


def test_moments_and_rotations_are_about_the_reference_point() -> None:
    reference, point = unit()
    shape = rectangle()
    ahead = 7.0
    one = vortex_lattice(shape, reference, point).derivatives()
    two = vortex_lattice(shape, reference, point + np.array([ahead, 0, 0])).derivatives()
    # Turning about a point ahead is turning about the first, and sinking by q times the distance.
    assert two["CL_q"] == pytest.approx(one["CL_q"] + 2 * ahead * one["CL_alpha"])
    assert two["Cm_alpha"] == pytest.approx(one["Cm_alpha"] - ahead * one["CL_alpha"])
    assert two["Cm_q"] == pytest.approx(
        one["Cm_q"] - ahead * one["CL_q"] + 2 * ahead * (one["Cm_alpha"] - ahead * one["CL_alpha"])
    )


@pytest.mark.parametrize("axes", ["body", "model", "stability"])
@pytest.mark.parametrize(("beta", "mach"), [(0.0, 0.0), (0.07, 0.4)])
def test_derivatives_are_those_of_whole_solutions(
    axes: LatticeAxes, beta: float, mach: float
) -> None:
    shape, reference, _ = light_airplane()
    point = np.array([-30.0, 0.0, 12.0])  # far from the aircraft
    at: dict[str, Any] = {"alpha": 0.09, "beta": beta, "mach": mach}
    deflected = {"de": -0.05, "df": 0.1}
    got = vortex_lattice(shape, reference, point, deflections=deflected, **at).derivatives(axes)
    h = 4e-5

    def solved(name: str, by: float) -> Array:
        there, moved = dict(at), dict(deflected)
        if name in there:
            there[name] += by
        else:
            moved[name] = moved.get(name, 0.0) + by
        loads = vortex_lattice(shape, reference, point, deflections=moved, **there)
        return np.array(list(loads.coefficients(axes).values()))

    for name in ("alpha", "beta", "de", "da", "dr", "df"):
        wide, narrow = ((solved(name, x) - solved(name, -x)) / (2 * x) for x in (2 * h, h))
        # Extrapolated: h^4 times fifth derivatives remain, which the fin beside the tailplane's
        # wake makes large, and rounding over h.
        for coefficient, want in zip(coefficient_names(axes), (4 * narrow - wide) / 3, strict=True):
            key = f"{coefficient}_{name}"
            if key in got:
                assert got[key] == pytest.approx(want, rel=1e-8, abs=1e-8), key


def test_prandtl_glauert_stretches_the_wing() -> None:
    reference, point = unit()
    mach = 0.6
    B = np.sqrt(1 - mach**2)
    stretched = geometry(
        surface("wing", (section(0, 0, 0, 1 / B), section(0.7 / B, 4, 0, 0.6 / B)), panels=(4, 16))
    )
    shape = geometry(
        surface("wing", (section(0, 0, 0, 1), section(0.7, 4, 0, 0.6)), panels=(4, 16))
    )
    fast = vortex_lattice(shape, reference, point, mach=mach).derivatives()
    slow = vortex_lattice(stretched, reference, point / B).derivatives()
    # Goethert 1940: the same circulation on the wing that is longer by 1/B; equal in all digits.
    assert fast["CL_alpha"] == pytest.approx(slow["CL_alpha"], rel=1e-12)
    assert fast["Cl_p"] == pytest.approx(slow["Cl_p"], rel=1e-12)
    assert fast["Cm_alpha"] == pytest.approx(B * slow["Cm_alpha"], rel=1e-11)
    assert (
        fast["CL_alpha"] > 1.1 * vortex_lattice(shape, reference, point).derivatives()["CL_alpha"]
    )


def test_a_control_of_the_whole_chord_is_a_twist() -> None:
    reference, point = unit()
    angle = 0.06
    whole = ControlSurface("all", 0.0, 1.0, (0.0, 0.0), {"de": 1.0})
    ends = section(0, 0, 0, 1.0, angle), section(0, 4.0, 0, 1.0, angle)
    by_twist = vortex_lattice(geometry(surface("wing", ends, panels=(4, 16))), reference, point)
    by_control = vortex_lattice(
        rectangle(controls=(whole,)), reference, point, deflections={"de": angle}
    )
    assert by_control.coefficients() == pytest.approx(by_twist.coefficients(), abs=1e-14)
    flat = vortex_lattice(rectangle(controls=(whole,)), reference, point).derivatives()
    assert flat["CL_de"] == pytest.approx(flat["CL_alpha"], rel=1e-12)


def test_parabolic_camber_of_thin_airfoil_theory() -> None:
    height, aspect = 0.03, 2000.0
    x = np.linspace(0.0, 1.0, 41)
    camber = np.column_stack([x, 4 * height * x * (1 - x)])
    ends = section(0, 0, 0, 1), section(0, 0.5 * aspect, 0, 1)
    reference, point = unit(aspect)
    bent = geometry(
        surface("wing", ends, panels=(8, 40)), airfoils={"flat": Airfoil("flat", 0.0, camber)}
    )
    result = vortex_lattice(bent, reference, point)
    # Glauert 1926: alpha_0 = -2 h, c_m = -pi h; the lattice is exact for the parabola but for the
    # tips (Katz and Plotkin, Sec. 11.1.2) and for angle against tangent of h^2.
    slope = result.derivatives()["CL_alpha"]
    assert result.coefficients()["CL"] / slope == pytest.approx(2 * height, rel=5e-3)
    assert result.coefficients()["Cm"] == pytest.approx(-np.pi * height, rel=0.02)
    shifted = geometry(
        surface("wing", ends, panels=(8, 40)),
        airfoils={"flat": Airfoil("flat", 0.0, alpha_0=-2 * height)},
    )
    only = vortex_lattice(shifted, reference, point)
    assert only.coefficients()["CL"] == pytest.approx(result.coefficients()["CL"], rel=5e-3)
    assert "camber_by_zero_lift" in {m.code for m in only.messages}


def test_positive_deflections_give_negative_moments() -> None:
    shape, reference, point = light_airplane()
    found = vortex_lattice(shape, reference, point).derivatives()
    assert found["Cm_de"] < 0 < found["CL_de"]
    assert found["Cl_da"] < 0
    assert found["Cn_dr"] < 0 < found["CY_dr"]
    assert found["CL_df"] > 0
    assert found["Cl_beta"] < 0 < found["Cn_beta"]
    assert found["Cl_r"] > 0 > found["Cl_p"]


def test_the_neutral_point_has_no_moment() -> None:
    shape, reference, point = light_airplane()
    neutral = vortex_lattice(shape, reference, point, alpha=0.03).neutral_point
    there = vortex_lattice(shape, reference, neutral, alpha=0.03)
    # To the rounding of sums of some tens.
    assert there.derivatives("body")["Cm_alpha"] == pytest.approx(0.0, abs=1e-12)


def test_stability_axes_turn_moments_and_rates() -> None:
    shape, reference, point = light_airplane()
    result = vortex_lattice(shape, reference, point, alpha=0.2)
    body, stability = result.derivatives("body"), result.derivatives("stability")
    c, s = np.cos(0.2), np.sin(0.2)
    along = c * body["Cl_p"] + s * body["Cn_p"], c * body["Cl_r"] + s * body["Cn_r"]
    assert stability["Cl_p"] == pytest.approx(c * along[0] + s * along[1])
    assert result.derivatives("model")["Cl_p"] == body["Cl_p"]
    per_degree = result.derivatives("stability", per_degree=True)
    assert per_degree["Cn_beta_per_deg"] == pytest.approx(stability["Cn_beta"] * np.pi / 180)
    assert per_degree["Cn_r"] == stability["Cn_r"]


def test_a_vortex_core_acts_between_surfaces_only() -> None:
    shape, reference, point = light_airplane()
    apart = vortex_lattice(shape, reference, point).derivatives()
    smoothed = vortex_lattice(shape, reference, point, core=0.3).derivatives()
    assert abs(smoothed["CY_beta"] / apart["CY_beta"] - 1) > 0.01
    alone, unit_point = unit()
    one = vortex_lattice(rectangle(), alone, unit_point).derivatives()
    assert vortex_lattice(rectangle(), alone, unit_point, core=0.3).derivatives() == one


def test_a_mesh_study_covers_what_finer_panels_change() -> None:
    reference, point = unit()
    study = mesh_study(rectangle(panels=(4, 12)), reference, point)
    fine = vortex_lattice(rectangle(panels=(24, 72)), reference, point).derivatives()
    for name in ("CL_alpha", "Cm_alpha", "CL_q", "Cm_q", "Cl_p"):
        # What six times as fine a mesh changes is within the bar, which is not idle.
        change = abs(fine[name] - study.values[name][0])
        assert 0.3 * study.error[name] < change < study.error[name], name
    for name in ("CL_alpha", "CL_q", "Cl_p"):
        assert abs(study.limit[name] - fine[name]) < 0.3 * abs(fine[name] - study.values[name][0])
    assert list(study.counts) == [96, 216, 384]
    predicted = study.result.as_derivatives(study.error)
    estimate = predicted.values["CL_alpha"]
    assert estimate.se == pytest.approx(np.hypot(0.1 * estimate.value, study.error["CL_alpha"]))
    assert "mesh study" in estimate.source


def test_the_predicted_derivatives_hold_the_load_at_zero() -> None:
    shape, reference, point = light_airplane()
    result = vortex_lattice(shape, reference, point, alpha=0.05, deflections={"de": 0.1})
    values = result.as_derivatives().values
    tangent = values["CL_0"].value + 0.05 * values["CL_alpha"].value + 0.1 * values["CL_de"].value
    assert tangent == pytest.approx(result.coefficients()["CL"])
    assert "CY_0" not in values
    assert result.as_derivatives().conditions["alpha_deg"].startswith("2.86")


@pytest.mark.parametrize("spacing", ["uniform", "cosine"])
def test_panels_tile_the_surface(spacing: Any) -> None:
    shape, reference, point = light_airplane()
    result = vortex_lattice(shape, reference, point, spacing=spacing)
    corners = result.panels.corners
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1
    )
    wing = [s.position for s in shape.surfaces[0].sections]
    arc = [np.hypot(*(b - a)[1:]) for a, b in pairwise(wing)]
    ends = (1.5, 1.3, 0.9)
    whole = 2 * sum(0.5 * (ends[k] + ends[k + 1]) * arc[k] for k in range(2))
    whole += 2 * 1.25 * 0.75 + 1.2 * 0.875
    assert area.sum() == pytest.approx(whole, rel=0.01)  # a swept edge tilts dihedral panels
    # Sections and ends of controls are edges of strips.
    edges = result.panels.lines[0][0, :, 1]
    for y in (2.0, 4.3):
        assert np.min(np.abs(edges - y)) < 1e-9


def test_more_strips_where_pieces_ask_for_them() -> None:
    shape, reference, point = light_airplane(wing=(2, 2))
    result = vortex_lattice(shape, reference, point)
    assert result.panels.mesh["wing"] == (2, 6)
    assert "more_strips" in {m.code for m in result.messages}


def _refused(shape: Geometry, **options: Any) -> str:
    reference, point = unit()
    with pytest.raises(BadInput) as refused:
        vortex_lattice(shape, options.pop("reference", reference), point, **options)
    return str(refused.value)


def test_bad_shapes_are_refused_by_name() -> None:
    root, tip = section(0, 0, 0, 1), section(0, 4, 0, 1)
    wing = surface("wing", (root, tip))
    assert "[no_surfaces]" in _refused(geometry())
    assert "[zero_area]" in _refused(geometry(surface("wing", (root, section(1, 0, 0, 1)))))
    assert "[zero_area]" in _refused(
        geometry(surface("wing", (section(0, 0, 0, 0), section(0, 4, 0, 0))))
    )
    folded = surface("wing", (root, tip, section(0, 2, 0, 1)))
    assert "[crossing_sections]" in _refused(geometry(folded))
    double = geometry(wing, surface("canard", (section(0.5, 1, 0, 1), section(0.5, 3, 0, 1))))
    assert "'wing' and 'canard'" in _refused(double)
    for hinge in (1.2, -0.1):
        control = ControlSurface("flap", 0.0, 1.0, (hinge, hinge), {"df": 1.0})
        assert "[hinge_outside]" in _refused(rectangle(controls=(control,)))
    assert "[non_finite]" in _refused(geometry(surface("wing", (root, section(0, np.nan, 0, 1)))))
    assert "[surface_names]" in _refused(geometry(wing, wing))
    bent = {"flat": Airfoil("flat", 0.0, np.array([[0, 0.0], [0, 1.0]]))}
    assert "[camber]" in _refused(geometry(wing, airfoils=bent))
    assert "[unknown_airfoil]" in _refused(geometry(wing, airfoils={}))


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ({"mach": 0.8}, "mach_range"),
        ({"mach": -0.1}, "mach_range"),
        ({"alpha": np.nan}, "non_finite"),
        ({"alpha": 5.0}, "angle_range"),
        ({"panels": {"tail": (2, 2)}}, "unknown_surface"),
        ({"panels": {"wing": (0, 2)}}, "panels"),
        ({"panels": {"wing": (200, 200)}}, "too_many_panels"),
        ({"spacing": "sine"}, "lattice_option"),
        ({"core": -1.0}, "lattice_option"),
        ({"wake": "free"}, "lattice_option"),
        ({"deflections": {"throttle": 0.1}}, "unknown_control"),
        ({"deflections": {"de": np.inf}}, "deflection"),
        ({"reference": Reference(0.0, 1.0, 1.0)}, "reference"),
    ],
)
def test_bad_conditions_are_refused(options: dict[str, Any], code: str) -> None:
    assert f"[{code}]" in _refused(rectangle(), **options)


def test_borders_are_warned_of() -> None:
    reference, point = unit()
    result = vortex_lattice(rectangle(), reference, point, mach=0.7, alpha=0.3)
    codes = {m.code for m in result.messages}
    assert {"mach_border", "angle_border", "lattice_conventions"} <= codes


def test_a_wake_through_panels_is_said() -> None:
    reference, point = unit()
    wing = surface("wing", (section(0, 0, 0, 1), section(0, 4, 0, 1)), panels=(2, 8))

    def with_tail(strips: int, half_span: float) -> Geometry:
        ends = section(4, 0, 0, 1), section(4, half_span, 0, 1)
        return geometry(wing, surface("tail", ends, role="tailplane", panels=(2, strips)))

    assert not _warned(vortex_lattice(with_tail(4, 2.0), reference, point).messages)
    near = vortex_lattice(with_tail(4, 1.99 * 8 / 7), reference, point)
    assert "'wing' and 'tail'" in _warned(near.messages)
    with pytest.raises(BadInput, match="wake_in_panel"):
        vortex_lattice(with_tail(1, 1.0), reference, point)
    vortex_lattice(with_tail(1, 1.0), reference, point, core=0.1)


def test_a_held_wake_differs_only_with_load() -> None:
    shape, reference, point = light_airplane()
    flat = rectangle(), *unit()
    turning, held = (vortex_lattice(*flat, wake=w).derivatives() for w in ("turning", "held"))
    assert turning == held
    # The wake of the wing sweeps over tail and fin; on the wing alone it is far from the panels.
    turning, held = (
        vortex_lattice(shape, reference, point, alpha=0.1, wake=w).derivatives()
        for w in ("turning", "held")
    )
    assert abs(turning["Cm_alpha"] - held["Cm_alpha"]) > 0.01
    for name in ("CL_q", "Cm_de", "Cl_p", "Cn_dr"):
        assert turning[name] == held[name], name


def _warned(messages: tuple[Any, ...]) -> str:
    return " ".join(str(m) for m in messages if m.code == "wake_near_panel")
