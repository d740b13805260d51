"""DAVE-ML out: the model to the bit, elements in the standard's order."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np
import pytest
from hypothesis import assume, given, settings

from alula.base.messages import BadInput
from alula.export.daveml import compare_daveml, export_daveml
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import read_daveml
from alula.export.daveml_write import daveml_text
from alula.export.safe_xml import parse_xml
from alula.model import AeroModel, Reference, aero_model, load_model, lookup_table
from data import data
from model.formulas import models

# Order of children in the document type of DAVE-ML 2.0 (AIAA S-119-2011, annex).
ORDER = {
    "DAVEfunc": "fileHeader variableDef breakpointDef griddedTableDef function checkData",
    "fileHeader": "author creationDate fileVersion description reference modificationRecord",
    "variableDef": "description calculation isInput isOutput isStdAIAA uncertainty",
    "griddedTableDef": "description breakpointRefs uncertainty dataTable",
    "function": "description independentVarRef dependentVarRef functionDefn",
    "normalPDF": "bounds correlatesWith correlation",
    "staticShot": "description checkInputs internalValues checkOutputs",
    "signal": "signalName signalUnits signalValue tol",
}


def ordered(element: Element) -> bool:
    wanted = ORDER.get(element.tag, "").split()
    tags = [child.tag for child in element]
    known = not wanted or (
        set(tags) <= set(wanted)
        and [wanted.index(t) for t in tags] == sorted(map(wanted.index, tags))
    )
    return known and all(ordered(child) for child in element)


def rich_model() -> AeroModel:
    names = ("CX_cxt", "CX_q_cxt", "Cm_0", "Cm_q", "Cm_absbeta", "Cm_(alpha+0.2)+2",
             "Cm_V2", "Cm_signbeta")  # fmt: skip
    spread = np.random.default_rng(5).normal(size=(8, 8))
    covariance = spread @ spread.T * 1e-6
    covariance[2], covariance[:, 2] = 0.0, 0.0  # one value is exact
    return aero_model(
        "rich <&> \u03b1",
        {"CX": "cxt(de, alpha) + qhat*cxt(de, alpha)",
         "Cm": "1 + qhat + abs(beta) + (alpha + 0.2)+^2 + V^2 + sign(beta)"},
        dict(zip(names, (1.0, 0.1, 1 / 3, -25.4, 0.3, np.pi, 1e-7, -0.02), strict=True)),
        Reference(10.6, 8.65, 1.25),
        covariance=covariance,
        reference_point=np.array([0.1, 0.0, -1 / 3]),
        validity={"alpha": (-0.1, 0.3)},
        assumed=("Cm_q",),
        provenance={"log": "0123", "note": "a < b"},
        tables={"cxt": lookup_table({"de": [-0.4, 1 / 3], "alpha": [-0.1, 0.0, 0.2]},
                                    [[0.1, 0.2, 0.3], [1 / 7, 0.5, 0.6]], outside="line")},
    )  # fmt: skip


def test_every_part_comes_back(tmp_path: Path) -> None:
    model = rich_model()
    done = export_daveml(model, tmp_path / "m.dml", date="2026-01-02")
    assert done.files == (tmp_path / "m.dml",)
    dave = read_daveml(tmp_path / "m.dml")
    back = import_daveml(dave).model
    assert back.params == model.params  # to the bit
    assert back.terms == model.terms
    assert back.tables == model.tables
    assert back.reference == model.reference
    np.testing.assert_array_equal(back.reference_point, model.reference_point)
    assert back.name == model.name
    assert back.covariance is not None
    # sigma times sigma times correlation: three roundings
    np.testing.assert_allclose(back.covariance, model.covariance, rtol=1e-14, atol=1e-22)
    assert "note: a < b" in dave.header["description"]
    assert "assumed" in dave.variables["Cm_q"].description
    assert dave.variables["Cm_absbeta"].units == "_rad"
    assert dave.variables["Cm_V2"].units == "s2_m2"
    assert len(dave.cases) == 20


def test_elements_are_in_the_standards_order() -> None:
    root = parse_xml(daveml_text(rich_model(), author="a", date="2026-01-02").encode(), "m")
    assert ordered(root)
    ids = [e.get(k) for e in root.iter() for k in ("varID", "bpID", "gtID")
           if e.get(k) and e.tag.endswith("Def")]  # fmt: skip
    assert len(ids) == len(set(ids))
    backwards = Element("normalPDF")
    backwards.extend([Element("correlation"), Element("bounds")])
    assert not ordered(backwards)


@given(models())
@settings(max_examples=25, deadline=None)
def test_any_model_comes_back_to_the_bit(model: AeroModel) -> None:
    assume("wash" not in " ".join(model.formulas.values()))  # refused: the next test
    # compare_daveml raises where a value differs by a bit or a coefficient by 1e-12
    difference = compare_daveml(model, daveml_text(model, author="a", date="2026-01-02"))
    assert set(difference) == set(model.coefficients)


def test_propwash_is_refused() -> None:
    model = aero_model(
        "washed", {"Cl": "1 + beta*wash"}, {"Cl_0": 0.1, "Cl_beta_wash": 0.2}, Reference(1, 1, 1)
    )
    with pytest.raises(BadInput) as caught:
        daveml_text(model, author="a", date="2026-01-02")
    assert caught.value.messages[0].code == "wash_in_model"


def test_f16_out_and_in_again(tmp_path: Path) -> None:
    first = import_daveml(read_daveml(data("nesc_6dof", "models", "F16_aero.dml"))).model
    export_daveml(first, tmp_path / "f16.dml")
    second = import_daveml(read_daveml(tmp_path / "f16.dml")).model
    assert (second.params, second.tables) == (first.params, first.tables)


def test_a_text_that_differs_is_not_called_exported() -> None:
    model = load_model(Path(__file__).parents[2] / "aircraft" / "sportstar_aero.toml")
    text = daveml_text(model, author="a", date="2026-01-02")
    compare_daveml(model, text)
    for wrong in (
        text.replace('initialValue="-25.379"', 'initialValue="-25.378999999999998"'),
        text.replace('sign="+TED"', 'sign="+TEU"'),
        text.replace("<cn>2.0</cn>", "<cn>1.0</cn>"),
    ):
        assert wrong != text
        with pytest.raises(BadInput, match="export_differs"):
            compare_daveml(model, wrong)


def test_cubic_tables_are_refused() -> None:
    model = aero_model(
        "m", {"CX": "t(alpha)"}, {"CX_t": 1.0}, Reference(1, 1, 1),
        tables={"t": lookup_table({"alpha": [0.0, 0.1, 0.3]}, [0.0, 1.0, 2.0], "cubic")},
    )  # fmt: skip
    with pytest.raises(BadInput, match="daveml_interpolation"):
        daveml_text(model, author="a", date="2026-01-02")


def test_a_table_must_not_take_a_signals_name() -> None:
    model = aero_model(
        "m", {"CX": "b_ref(alpha)"}, {"CX_b_ref": 1.0}, Reference(1, 1, 1),
        tables={"b_ref": lookup_table({"alpha": [0.0, 0.1]}, [0.0, 1.0])},
    )  # fmt: skip
    with pytest.raises(BadInput, match="b_ref"):
        daveml_text(model, author="a", date="2026-01-02")


def test_nothing_is_written_to_a_folder_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="output_not_writable"):
        export_daveml(rich_model(), tmp_path / "none" / "m.dml")
