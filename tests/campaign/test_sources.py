"""Derivatives of other programs and tables: read, brought to one convention, refused."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, isnan, radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.campaign.results import read_sources
from alula.campaign.sources.avl_output import read_avl
from alula.campaign.sources.conventions import to_body_axes, to_point, to_reference
from alula.campaign.sources.datcom_output import read_datcom
from alula.campaign.sources.derivative_table import read_table
from alula.identify.compare import Entry
from alula.model import Reference
from alula.predict.lattice_result import LatticeResult
from alula.predict.vortex_lattice import vortex_lattice
from campaign.derivative_files import DATCOM, avl_file

AIRCRAFT = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"
DIGITS = 1e-6  # eight decimals, times 57.3 for controls


def solved(point: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> LatticeResult:
    plane = load_aircraft(AIRCRAFT)
    assert plane.geometry is not None
    reference = Reference(plane.S, plane.b, plane.c)
    # The wake held, as AVL differentiates; an angle at which the axes differ.
    return vortex_lattice(plane.geometry, reference, np.array(point), alpha=0.09, wake="held")


@pytest.fixture(scope="module")
def lattice() -> LatticeResult:
    return solved()


@pytest.mark.parametrize("kind", ["ST", "SB"])
def test_avl_file_gives_the_derivatives_it_was_made_of(lattice: LatticeResult, kind: str) -> None:
    """Axes, units and senses of either file, against the lattice's own derivatives."""
    stated = read_avl(avl_file(lattice, kind), "case", "case.st")
    assert stated.alpha == pytest.approx(0.09, abs=1e-6)
    entries = dict(stated.entries)
    if kind == "ST":
        assert stated.axes == "stability"
        entries, lost = to_body_axes(entries, 0.09)
        assert not lost
    else:
        assert stated.axes == "model"
    truth = lattice.derivatives("model")
    shared = {n for n in truth if n in entries}
    want = {n for n in truth if not n.startswith("CD")} if kind == "ST" else set(truth)
    assert shared >= want - {"CY_da"}
    for name in shared:
        assert entries[name].value == pytest.approx(truth[name], abs=10 * DIGITS), name
    assert stated.reference == Reference(10.6, 8.65, 1.25)
    zero = lattice.as_derivatives().values
    for name in ("CL_0", "Cm_0"):
        assert entries[name].value == pytest.approx(zero[name].value, abs=10 * DIGITS)
    assert {m.code for m in stated.messages} == {"avl_controls", "control_sense"}


def test_avl_without_derivatives_is_refused() -> None:
    with pytest.raises(BadInput) as error:
        read_avl(" Vortex Lattice Output -- Total Forces\n Alpha = 2.0\n", "x", "x.st")
    assert error.value.messages[0].code == "unreadable_derivatives"
    assert "ST or SB" in error.value.messages[0].do


def test_avl_in_other_axes_is_refused(lattice: LatticeResult) -> None:
    text = avl_file(lattice, "ST").replace("Standard axis orientation,  X fwd, Z down",
                                           "Geometric axis orientation,  X aft, Z up")  # fmt: skip
    with pytest.raises(BadInput, match="X aft"):
        read_avl(text, "x", "x.st")


def test_datcom_is_per_radian_at_the_angle() -> None:
    stated = read_datcom(DATCOM, "case", "case.out", radians(2.0))
    e = {n: x.value for n, x in stated.entries.items()}
    assert e["CL_alpha"] == pytest.approx(degrees(0.08695))  # between two rows
    assert e["Cm_alpha"] == pytest.approx(degrees(-0.01365))
    assert e["CY_beta"] == pytest.approx(degrees(-5.6e-3))  # stands in the first row only
    assert e["Cn_beta"] == pytest.approx(degrees(1.05e-3))
    assert e["Cl_beta"] == pytest.approx(degrees(-2.1e-4))
    assert e["Cm_q"] == pytest.approx(degrees(-0.184))
    assert e["CL_alphadot"] == pytest.approx(degrees(0.025))
    assert e["Cm_alphadot"] == pytest.approx(degrees(-0.07))
    assert e["Cl_r"] == pytest.approx(degrees(1e-3))
    assert e["CL_de"] == pytest.approx(degrees(0.0083), rel=0.01)  # a slope through four points
    assert e["Cm_de"] == pytest.approx(degrees(-0.0245), rel=0.01)
    assert e["CL_0"] == pytest.approx(0.214 - degrees(0.08695) * radians(2.0))
    assert stated.reference == Reference(10.6, 8.65, 1.25)
    assert stated.aft == (2.1, 0.0, 0.0)
    assert stated.axes == "stability"
    assert "datcom_flap" in {m.code for m in stated.messages}


def test_datcom_per_radian_says_so() -> None:
    text = DATCOM.replace("(PER DEGREE)", "(PER RADIAN)")
    assert read_datcom(text, "x", "x").entries["CL_alpha"].value == pytest.approx(0.0869)


def test_datcom_column_without_method_is_left_out() -> None:
    text = DATCOM.replace("-7.000E-02", "      NDM").replace("-6.900E-02", "      NDM")
    assert "Cm_alphadot" not in read_datcom(text, "x", "x").entries


TABLE = """# axes = stability
# per = deg
# alpha_deg = 3
name,value,se
CL_alpha,0.0875,0.001
Cm_q + Cm_alphadot,-17,2
Cl_p,-0.5,
Cn_dr,-0.0015,0.0001
"""


def test_csv_table() -> None:
    stated = read_table(TABLE, "tunnel", "t.csv")
    e = stated.entries
    assert e["CL_alpha"].value == pytest.approx(degrees(0.0875))
    assert e["CL_alpha"].se == pytest.approx(degrees(0.001))
    assert (e["Cm_q"].value, e["Cm_q"].verdict) == (-17.0, "sum")
    assert e["Cl_p"].value == -0.5
    assert isnan(e["Cl_p"].se)
    assert stated.alpha == pytest.approx(radians(3.0))


def test_toml_table() -> None:
    text = """schema = "alula.derivatives/1"
name = "report"
axes = "body"
per = "rad"
rates = "pb/V"
point = [0.1, 0.0, 0.0]
reference = {S = 10.6, b = 8.65, c = 1.25}
[values]
CL_alpha = 5.0
Cm_q = {value = -6.0, se = 0.5}
"""
    stated = read_table(text, "x", "x.toml")
    assert stated.name == "report"
    assert stated.axes == "model"
    assert (stated.entries["Cm_q"].value, stated.entries["Cm_q"].se) == (-12.0, 1.0)
    assert stated.point is not None
    assert stated.point.tolist() == [0.1, 0.0, 0.0]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("# axes = stability\n", "", "axes = "),
        ("# per = deg\n", "", "per = "),
        ("per = deg", "per = gradian", "gradian"),
        ("axes = stability", "axes = wind", "wind"),
        ("0.0875", "many", "number for CL_alpha"),
        ("0.0875", "inf", "finite"),
        ("0.001\n", "-0.001\n", "from zero on"),
        ("CL_alpha", "alpha_CL", "alpha_CL"),
        ("Cl_p,-0.5,", "CL_alpha,1,", "twice"),
        ("Cl_p,-0.5,", "Cm_q,1,", "both"),
        ("name,value,se", "value,name", "heading"),
        ("# alpha_deg", "# aplha_deg", "aplha_deg"),
        ("# alpha_deg = 3", "# S = -1\n# b = 1\n# c = 1", "above zero"),
        ("# alpha_deg = 3", "# point = 1 2", "point"),
    ],
)
def test_table_that_does_not_say_what_it_is(old: str, new: str, said: str) -> None:
    assert old in TABLE
    with pytest.raises(BadInput) as error:
        read_table(TABLE.replace(old, new), "t", "t.csv")
    (message,) = error.value.messages
    assert said in message.expected + message.found
    assert "Tables" in message.do


def test_moments_about_another_point_are_the_lattice_about_it() -> None:
    """Transfer of moments and rates against a lattice solved about the other point."""
    at, to = (0.15, 0.0, -0.08), (-0.1, 0.0, 0.05)
    first, second = solved(at), solved(to)
    entries = {n: Entry(e.value, 0.1) for n, e in _model(first).items()}
    step = np.array(at) - np.array(to)
    moved, lost = to_point(entries, step, first.reference, 0.09)
    assert not lost
    for name, truth in _model(second).items():
        assert moved[name].value == pytest.approx(truth.value, abs=1e-9), name


def _model(result: LatticeResult) -> dict[str, Entry]:
    values = {n: Entry(v) for n, v in result.derivatives("model").items()}
    zero = result.coefficients("model")
    for c in ("CL", "CD", "Cm"):
        values[f"{c}_0"] = Entry(zero[c] - values[f"{c}_alpha"].value * result.alpha)
    return values


def test_other_reference_is_the_lattice_on_it(lattice: LatticeResult) -> None:
    plane = load_aircraft(AIRCRAFT)
    assert plane.geometry is not None
    other = Reference(12.0, 8.0, 1.5)
    truth = vortex_lattice(plane.geometry, other, np.zeros(3), alpha=0.09, wake="held")
    entries = {n: Entry(v) for n, v in lattice.derivatives("model").items()}
    moved = to_reference(entries, lattice.reference, other)
    for name, value in truth.derivatives("model").items():
        assert moved[name].value == pytest.approx(value, rel=1e-9, abs=1e-12), name


def test_half_a_pair_is_left_out_of_the_turn() -> None:
    turned, lost = to_body_axes({"Cn_beta": Entry(0.1), "CL_alpha": Entry(5.0)}, 0.1)
    assert lost == ["Cn_beta"]
    assert list(turned) == ["CL_alpha"]
    turned, lost = to_body_axes({"Cn_beta": Entry(0.1)}, 0.0)
    assert (turned["Cn_beta"].value, lost) == (0.1, [])


def test_moment_without_its_force_is_left_out() -> None:
    reference = Reference(10.0, 8.0, 1.0)
    _, lost = to_point({"Cm_de": Entry(-1.0)}, np.array([0.1, 0.0, 0.0]), reference, 0.0)
    assert lost == ["Cm_de"]


def complete(error: BadInput) -> None:
    assert all(m.do and m.expected and m.found for m in error.messages)


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=2000))
def test_any_bytes_are_a_source_or_bad_input(
    tmp_path_factory: pytest.TempPathFactory, raw: bytes
) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzz.csv"
    for start in (b"", b"Stability-axis derivatives...", b"schema = \"alula.derivatives/1\"\n",
                  b"DATCOM ALPHA CD CL CM CLA CMA\n", b"{"):  # fmt: skip
        path.write_bytes(start + raw)
        try:
            found = read_sources(path)
        except BadInput as error:
            complete(error)
        else:
            assert found


@pytest.mark.parametrize("reader", ["avl", "datcom", "csv"])
@settings(max_examples=100, deadline=None)
@given(data=st.data())
def test_damaged_files_give_numbers_or_bad_input(reader: str, data: st.DataObject) -> None:
    """Pieces of a sound file cut out, doubled or overwritten."""
    text = {"avl": AVL, "datcom": DATCOM, "csv": TABLE}[reader]
    a = data.draw(st.integers(0, len(text)))
    b = data.draw(st.integers(0, len(text)))
    put = data.draw(
        st.sampled_from(["", "9" * 400, "nan", "***", "-", "\n", "=", "1e400", "\x00", text[:60]])
    )
    low, high = min(a, b), max(a, b)
    high = min(high, low + data.draw(st.integers(0, 200)))
    broken = text[:low] + put + text[high:]
    read = {"avl": read_avl, "datcom": read_datcom, "csv": read_table}[reader]
    try:
        stated = read(broken, "x", "x")
    except BadInput as error:
        complete(error)
    else:
        assert all(np.isfinite(e.value) for e in stated.entries.values())


AVL = avl_file(solved(), "SB")


def test_geometry_file_with_no_angle_is_refused() -> None:
    with pytest.raises(BadInput, match="Alpha"):
        read_avl(AVL.replace("  Alpha =", "  Aplha ="), "x", "x")


def test_aircraft_file_gives_a_column_for_each_method() -> None:
    found = read_sources(AIRCRAFT, ("lattice", "semi"))
    assert [s.column.name for s in found] == ["lattice", "semi"]
    assert all(s.stated is not None and s.stated.kind == "prediction" for s in found)
    assert replace(found[0].file) == found[1].file
