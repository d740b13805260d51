"""JSBSim: aircraft exported, loaded by JSBSim, flown there beside Alula."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from alula.aircraft import Actuator, Aircraft, load_aircraft
from alula.base.messages import BadInput
from alula.export import jsbsim, jsbsim_check
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import read_daveml
from alula.export.jsbsim import export_jsbsim
from alula.export.jsbsim_check import ANGLES, compare_jsbsim
from alula.export.jsbsim_property import norm_command
from alula.export.jsbsim_write import jsbsim_text
from alula.model import AeroModel, Reference, aero_model, load_model, lookup_table
from alula.simulate import Airframe, Condition, airframe_of
from data import data
from export.consumer import need_jsbsim

AIRCRAFT = Path(__file__).parents[2] / "aircraft"


@pytest.fixture(autouse=True)
def _jsbsim() -> None:
    need_jsbsim()


def sportstar(**options) -> tuple[Aircraft, Airframe, AeroModel]:
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    assert aircraft.aero is not None
    return aircraft, airframe_of(aircraft, **options), load_model(aircraft.aero)


# What remains is of JSBSim's integrators at 1 ms and of controls held over a step: 20 deg/s for
# 2 ms. The export's own limits, V 0.2 m/s and 0.1 deg, are for any aircraft.
@pytest.mark.parametrize(
    ("name", "engines", "moved"),
    [
        ("sportstar", "modeled", {"elevator doublet": "theta", "rudder doublet": "beta"}),
        ("x8", "modeled", {"elevator doublet": "theta", "aileron doublet": "phi"}),
        ("citation2", "modeled", {"elevator doublet": "theta", "rudder doublet": "beta"}),
    ],
)
def test_ready_aircraft_fly_as_they_do_here(
    name: str, engines: str, moved: dict[str, str], tmp_path: Path
) -> None:
    aircraft = load_aircraft(AIRCRAFT / f"{name}.toml")
    assert aircraft.aero is not None
    airframe = airframe_of(aircraft, engines=engines)  # type: ignore[arg-type]
    done = export_jsbsim(aircraft, airframe, load_model(aircraft.aero), tmp_path)
    assert done.path.parent.parent == tmp_path
    assert [c.maneuver for c in done.comparisons] == list(moved)
    for c in done.comparisons:
        assert c.passed
        assert c.difference["V"] < 0.02
        assert all(np.degrees(c.difference[n]) < 0.06 for n in ANGLES)
        assert np.degrees(np.ptp(c.ours[moved[c.maneuver]])) > 4.0  # it did fly


def test_coefficients_read_back_are_the_models(tmp_path: Path) -> None:
    aircraft, airframe, model = sportstar()
    done = export_jsbsim(aircraft, airframe, replace(model, stall=None), tmp_path)
    for c in done.comparisons:
        for name in model.coefficients:
            # along the flown path, whose angles differ by 5e-4 rad; CL_alpha is 5, Cm_q 25
            assert c.difference[name] < 0.02
        at_trim = {n: abs(c.theirs[n][0] - c.ours[n][0]) for n in model.coefficients}
        assert max(at_trim.values()) < 1e-9  # the same state: rounding of printed units


def test_stalled_flight_agrees(tmp_path: Path) -> None:
    # slow: alpha near alpha_star, where separation takes part of the lift
    aircraft, airframe, model = sportstar()
    assert model.stall is not None
    early = replace(model, stall=replace(model.stall, alpha_star=0.16, a1=15.0))
    jsb = tmp_path / "evektor_sportstar_rtc"
    jsb.mkdir()
    text = jsbsim_text(aircraft, airframe, early, author="a", date="2026-01-02")
    (jsb / f"{jsb.name}.xml").write_text(text)
    here = Condition(32.0, 1000.0)
    stalled = compare_jsbsim(aircraft, airframe, early, tmp_path, condition=here, duration=6.0)
    attached = compare_jsbsim(
        aircraft, airframe, replace(model, stall=None), tmp_path, condition=here, duration=6.0
    )
    assert all(c.passed for c in stalled)
    assert not all(c.passed for c in attached)  # the stall did matter


def test_actuators_lag_alike(tmp_path: Path) -> None:
    # rate limit and dead band both act: 0.05 rad over 0.1 s is above 0.3 rad/s
    aircraft, airframe, model = sportstar()
    slow = {
        "de": Actuator(0.1, 0.3, -0.4, 0.35, 0.0),
        "dr": Actuator(0.2, np.inf, -0.5, 0.5, 0.01),
    }
    done = export_jsbsim(aircraft, replace(airframe, actuators=slow), model, tmp_path)
    assert all(c.passed for c in done.comparisons)
    direct = export_jsbsim(aircraft, airframe, model, tmp_path)
    for with_lag, without in zip(done.comparisons, direct.comparisons, strict=True):
        moved = max(np.max(np.abs(with_lag.ours[n] - without.ours[n])) for n in ANGLES)
        assert np.degrees(moved) > 0.5  # the actuators did matter


def test_f16_with_its_tables_flies_as_it_does_here(tmp_path: Path) -> None:
    point = np.array([-0.345, 0.0, 0.0])  # moments about 35 %, center of gravity at 25 %
    dave = read_daveml(data("nesc_6dof", "models", "F16_aero.dml"))
    model = import_daveml(dave, reference_point=point).model
    J = 1.35582 * np.array([[9496.0, 0, -982.0], [0, 55814.0, 0], [-982.0, 0, 63100.0]])
    aircraft, _, _ = sportstar()
    limits = {"de": (-0.43, 0.43), "da": (-0.37, 0.37), "dr": (-0.52, 0.52)}
    aircraft = replace(aircraft, name="F-16", control_limits=limits, engines=())
    airframe = Airframe(9298.6, J)
    done = export_jsbsim(aircraft, airframe, model, tmp_path, condition=Condition(172.0, 3000.0))
    assert all(c.passed for c in done.comparisons)


def test_every_kind_of_factor_and_both_axes(tmp_path: Path) -> None:
    # pages, lines outside, signs, sizes, splines: the coefficients at trim and along the flight
    aircraft, airframe, _ = sportstar()
    rich = aero_model(
        "rich",
        {
            "CX": "1 + alpha + ct(alpha, de, mach)", "CZ": "1 + alpha + qhat + de",
            "CY": "beta + rhat + dr + beta*abs(beta)", "Cl": "beta + phat + rhat + da",
            "Cm": "1 + alpha + qhat + de + (alpha - 0.01)+^2 + sign(beta) + cm(de) + V*alpha",
            "Cn": "beta + rhat + dr + dt",
        },
        {
            "CX_0": -0.05, "CX_alpha": 0.2, "CX_ct": 1.0, "CZ_0": -0.49, "CZ_alpha": -5.0,
            "CZ_q": -7.0, "CZ_de": -0.4, "CY_beta": -0.55, "CY_r": 0.3, "CY_dr": 0.18,
            "CY_beta_absbeta": -1.0, "Cl_beta": -0.08, "Cl_p": -0.47, "Cl_r": 0.1, "Cl_da": -0.2,
            "Cm_0": -0.1, "Cm_alpha": -0.5, "Cm_q": -25.0, "Cm_de": -2.0, "Cm_(alpha-0.01)+2": -1.0,
            "Cm_signbeta": 1e-6, "Cm_cm": 1.0, "Cm_V_alpha": -0.001, "Cn_beta": 0.08, "Cn_r": -0.11,
            "Cn_dr": -0.08, "Cn_dt": 1e-3,
        },
        Reference(10.6, 8.65, 1.25),
        tables={
            "ct": lookup_table(
                {"alpha": [-0.1, 0.0, 0.2], "de": [-0.3, 0.3], "mach": [0.05, 0.1, 0.3]},
                0.01 * np.random.default_rng(2).normal(size=(3, 2, 3)),
            ),
            "cm": lookup_table({"de": [-0.01, 0.01]}, [0.001, -0.001], outside="line"),
        },
    )  # fmt: skip
    done = export_jsbsim(aircraft, airframe, rich, tmp_path)
    for c in done.comparisons:
        assert c.passed
        # the speed of sound, and so the Mach number of one table, differs in the sixth digit
        assert max(abs(c.theirs[n][0] - c.ours[n][0]) for n in rich.coefficients) < 1e-7


def test_what_flies_otherwise_is_not_exported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def wrong(*args, **more) -> str:
        return jsbsim_text(*args, **more).replace(">-2.077<", ">-2.2<")

    monkeypatch.setattr(jsbsim, "jsbsim_text", wrong)
    with pytest.raises(BadInput, match="export_differs") as caught:
        export_jsbsim(*sportstar(), tmp_path)
    assert "elevator doublet" in str(caught.value)
    assert list(tmp_path.iterdir()) == []
    monkeypatch.setattr(jsbsim, "jsbsim_text", lambda *args, **more: "<fdm_config>")
    with pytest.raises(BadInput, match="jsbsim_refused"):
        export_jsbsim(*sportstar(), tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_without_jsbsim_nothing_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(jsbsim_check, "find_spec", lambda name: None)
    with pytest.raises(BadInput, match="pip install"):
        export_jsbsim(*sportstar(), tmp_path)
    assert list(tmp_path.iterdir()) == []
    done = export_jsbsim(*sportstar(), tmp_path, unchecked=True)
    assert done.path.name == "evektor_sportstar_rtc_unchecked.xml"
    assert [m.code for m in done.messages] == ["export_unchecked"]


def test_units_and_structural_axes_of_the_file() -> None:
    aircraft, airframe, model = sportstar()
    moved = replace(airframe, cg=np.array([0.1, 0.2, 0.3]))
    root = ElementTree.fromstring(
        jsbsim_text(aircraft, moved, model, author="a", date="2026-01-02").split("?>", 1)[1]
    )
    at = {e.tag: float(e.text or "") for e in root.find("mass_balance/location")}
    # x aft, y right, z up; inches
    assert at == pytest.approx({"x": -0.1 / 0.0254, "y": 0.2 / 0.0254, "z": -0.3 / 0.0254})
    weight = float(root.findtext("mass_balance/emptywt") or "")
    assert weight == pytest.approx(airframe.mass / 0.45359237, rel=1e-6)  # JSBSim's own slug
    area = float(root.findtext("metrics/wingarea") or "")
    assert area == pytest.approx(10.6 / 0.3048**2, rel=1e-15)
    functions = [e.get("name") for e in root.findall("aerodynamics/function")]
    assert {f"aero/coefficient/{c}" for c in model.coefficients} <= set(functions)


@pytest.mark.parametrize(
    ("control", "position", "expected"),
    [("de", -0.2, -0.5), ("de", 0.15, 0.5), ("da", 0.15, -0.5), ("dt", 0.3, 1.0), ("de", 0.0, 0.0)],
)
def test_commands_have_a_scale_for_each_side(
    control: str, position: float, expected: float
) -> None:
    assert norm_command(control, position, (-0.4, 0.3)) == pytest.approx(expected)


def test_cubic_tables_are_refused(tmp_path: Path) -> None:
    aircraft, airframe, _ = sportstar()
    model = aero_model(
        "m", {"CX": "t(alpha)"}, {"CX_t": 1.0}, Reference(1, 1, 1),
        tables={"t": lookup_table({"alpha": [0.0, 0.1, 0.3]}, [0.0, 1.0, 2.0], "cubic")},
    )  # fmt: skip
    with pytest.raises(BadInput, match="jsbsim_interpolation"):
        export_jsbsim(aircraft, airframe, model, tmp_path)
