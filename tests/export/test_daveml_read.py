"""DAVE-ML files: their own check data, tables between and beyond breakpoints, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given as given_text
from hypothesis import settings
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import parse_daveml, read_daveml
from data import data
from export.daveml_texts import REFERENCE, file, given, math, output, table

ALPHA = given("angleOfAttack", "a", "deg")
T = '<variableDef name="t" varID="t" units="nd"><isOutput/></variableDef>'


@pytest.mark.parametrize(
    ("name", "cases"),
    [
        ("F16_aero", 16), ("F16_prop", 9), ("F16_inertia", 0), ("F16_control", 0), ("F16_gnc", 0),
        ("brick_aero", 0), ("brick_inertia", 0), ("cannonball_aero", 0), ("cannonball_inertia", 0),
    ],
)  # fmt: skip
def test_files_of_the_check_cases_pass_their_own(name: str, cases: int) -> None:
    model = read_daveml(data("nesc_6dof", "models", f"{name}.dml"))
    assert len(model.cases) == cases
    assert model.messages == ()
    assert [c for c in model.check() if not c.passed] == []
    assert len(model.check()) >= 6 * cases
    assert model.outputs


def test_a_wrong_check_case_is_seen() -> None:
    model = read_daveml(data("nesc_6dof", "models", "F16_aero.dml"))
    case = model.cases[0]
    moved = replace(case.outputs[3], value=case.outputs[3].value + 1.5 * case.outputs[3].tolerance)
    wrong = replace(case, outputs=(*case.outputs[:3], moved, *case.outputs[4:]))
    failed = [c for c in replace(model, cases=(wrong,)).check() if not c.passed]
    assert [c.id for c in failed] == [moved.id]


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ("", [1.0, 1.0, 2.0, 3.0, 2.5, 2.0]),
        ('extrapolate="both"', [0.0, 1.0, 2.0, 3.0, 2.5, 1.0]),
        ('extrapolate="min"', [0.0, 1.0, 2.0, 3.0, 2.5, 2.0]),
        ('extrapolate="max"', [1.0, 1.0, 2.0, 3.0, 2.5, 1.0]),
        ('min="5" max="12" extrapolate="both"', [2.0, 2.0, 2.0, 3.0, 2.8, 2.8]),
        ('interpolate="discrete"', [1.0, 1.0, 3.0, 3.0, 2.0, 2.0]),
        ('interpolate="floor"', [1.0, 1.0, 1.0, 3.0, 3.0, 2.0]),
        ('interpolate="ceiling"', [1.0, 1.0, 3.0, 3.0, 2.0, 2.0]),
    ],
)
def test_between_and_beyond_breakpoints(attributes: str, expected: list[float]) -> None:
    model = parse_daveml(file(ALPHA, T, table("a", attributes)))
    found = model.evaluate({"a": np.array([-5.0, 0.0, 5.0, 10.0, 15.0, 30.0])})["t"]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-15)


def test_points_written_into_the_function() -> None:
    text = """<function name="f">
      <independentVarPts varID="a">0, 10</independentVarPts>
      <independentVarPts varID="m">0 1 2</independentVarPts>
      <dependentVarPts varID="t">0 1 2 10 11 12</dependentVarPts></function>"""
    model = parse_daveml(file(ALPHA, given("mach", "m", "nd"), T, text))
    # the last axis varies fastest
    assert model.evaluate({"a": 5.0, "m": 1.5})["t"] == 6.5


def test_limits_of_variables_hold() -> None:
    more = 'minValue="2" maxValue="4"'
    out = output("o", "<apply><times/><ci>a</ci><cn>10</cn></apply>", 'maxValue="35"')
    model = parse_daveml(file(given("angleOfAttack", "a", "deg", more), out))
    np.testing.assert_array_equal(model.evaluate({"angleOfAttack": [0.0, 3.0, 9.0]})["out"],
                                  [20.0, 30.0, 35.0])  # fmt: skip


def test_check_signals_in_other_units_are_converted() -> None:
    shot = """<checkData><staticShot name="s">
      <checkInputs><signal><signalName>angleOfAttack</signalName><signalUnits>rad</signalUnits>
        <signalValue>0.17453292519943295</signalValue></signal></checkInputs>
      <checkOutputs><signal><signalName>t</signalName><signalUnits>nd</signalUnits>
        <signalValue>3</signalValue><tol>1e-9</tol></signal></checkOutputs>
    </staticShot></checkData>"""
    model = parse_daveml(file(ALPHA, T, table("a"), shot))
    assert [c.passed for c in model.check()] == [True]


def test_uncertainty_references_and_modifications_are_kept() -> None:
    head = (
        '<variableDef name="k" varID="k" units="nd" initialValue="3"><uncertainty '
        'effect="additive"><normalPDF numSigmas="2"><bounds>0.5</bounds>'
        '<correlation varID="a" corrCoef="-0.25"/></normalPDF></uncertainty></variableDef>'
    )
    text = file(ALPHA, head).replace(
        "</fileHeader>",
        '<reference refID="R" author="me" title="it" date="2001"/>'
        '<modificationRecord modID="A" date="2002"><author name="a" org="b"/>'
        "<description>mended</description></modificationRecord></fileHeader>",
    )
    model = parse_daveml(text)
    found = model.variables["k"].uncertainty
    assert found is not None
    assert (found.sigma, found.correlations) == (0.25, {"a": -0.25})
    assert model.references == {"R": "me, it, 2001"}
    assert model.modifications == {"A": "2002: mended"}
    assert model.header["name"] == "small"


UNGRIDDED = (
    '<function name="f"><independentVarRef varID="a"/><dependentVarRef varID="t"/><functionDefn>'
    '<ungriddedTableDef utID="U"><dataPoint>1 2</dataPoint></ungriddedTableDef></functionDefn>'
    "</function>"
)


@pytest.mark.parametrize(
    ("text", "code", "word"),
    [
        ("<other/>", "daveml", "<other>"),
        (file(ALPHA, T, UNGRIDDED), "daveml_ungridded", "ungridded"),
        (file(ALPHA, T, table("a", 'interpolate="cubicSpline"')), "daveml_interpolation", "cubic"),
        (file(ALPHA, T, table("z")), "daveml", "'z'"),
        (file(ALPHA, T, table("a", values="1, 2")), "daveml", "found 2"),
        (file(ALPHA, T, table("a", values="1, nan, 2")), "daveml", "finite"),
        (file(ALPHA, T, table("a", values="1, x, 2")), "daveml", "'x'"),
        (file(ALPHA, T, table("a").replace("0 10 20", "0 20 10")), "daveml", "increasing"),
        (file(ALPHA, T, table("a").replace('bpRef bpID="B"', 'bpRef bpID="C"')), "daveml", "'C'"),
        (file(ALPHA, ALPHA), "daveml", "twice"),
        (file(ALPHA, output("o", "<ci>none</ci>")), "daveml", "'none'"),
        (file(ALPHA, output("o", "<cn>x</cn>")), "daveml_math", "'x'"),
        (file(given("n", "a", "deg", 'minValue="low"')), "daveml", "'low'"),
    ],
)
def test_what_is_refused(text: str, code: str, word: str) -> None:
    with pytest.raises(BadInput) as caught:
        parse_daveml(text, "small.dml")
    message = caught.value.messages[0]
    assert message.code == code
    assert word in str(message)
    assert message.where.startswith("small.dml")


def test_circles_and_missing_inputs_are_named() -> None:
    one = f'<variableDef name="x" varID="x" units="nd">{math("<ci>out</ci>")}</variableDef>'
    with pytest.raises(BadInput, match="daveml_circle"):
        parse_daveml(file(one, output("o", "<ci>x</ci>"))).evaluate({})
    model = parse_daveml(file(REFERENCE, ALPHA, output("o", "<ci>a</ci>")))
    with pytest.raises(BadInput, match="'a'"):
        model.evaluate({})
    with pytest.raises(BadInput, match="'b2'"):
        model.evaluate({"a": 1.0, "b2": 2.0})


WHOLE = file(
    REFERENCE, ALPHA, T, output("o", "<apply><times/><ci>a</ci><ci>t</ci></apply>"), table("a")
)


@given_text(st.integers(0, len(WHOLE) - 1), st.integers(1, 12), st.text(max_size=6))
@settings(max_examples=300, deadline=None)
def test_a_damaged_file_is_read_or_refused(at: int, cut: int, put: str) -> None:
    damaged = WHOLE[:at] + put + WHOLE[at + cut :]
    try:
        model = parse_daveml(damaged)
        model.check()
        import_daveml(model)
    except BadInput:
        pass
