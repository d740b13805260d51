"""The AeroModel of an identification predicts what the identification fitted."""

import numpy as np
import pytest
from identify_flights import attas, maneuver

from alula.base.messages import BadInput
from alula.identify import identified_model, identify_equation_error
from alula.model import Reference

REFERENCE = Reference(S=64.0, b=21.5, c=3.159)


def test_it_predicts_the_fitted_series():
    data = [attas("Ail1", "lateral"), attas("Rud1", "lateral")]
    result = identify_equation_error(data, {"CY": "1 + beta", "Cn": "1 + beta + phat + rhat + dr"})
    model = identified_model(result, "ATTAS", REFERENCE, data=data, constant_of="Rud1")
    predicted = model.evaluate(data[1].variables)
    for coefficient in ("CY", "Cn"):
        (series,) = [
            s for s in result.series if (s.coefficient, s.maneuver) == (coefficient, "Rud1")
        ]
        assert predicted[coefficient] == pytest.approx(series.model, abs=1e-12)
    beta = np.concatenate([d.variables["beta"] for d in data])
    assert model.validity["beta"] == (beta.min(), beta.max())
    assert model.covariance is not None
    spread = dict(zip(model.names, np.sqrt(np.diag(model.covariance)), strict=True))
    assert spread["Cn_beta"] == pytest.approx(result["Cn_beta"].se)


def test_constants_of_several_maneuvers_are_averaged():
    data = [attas("Ail1", "lateral"), attas("Rud1", "lateral")]
    result = identify_equation_error(data, {"CY": "1 + beta"})
    model = identified_model(result, "ATTAS", REFERENCE)
    mean = (result["CY_0[Ail1]"].value + result["CY_0[Rud1]"].value) / 2.0
    assert model.params["CY_0"] == pytest.approx(mean)


def test_what_nothing_excited_is_left_out_and_said():
    result = identify_equation_error([maneuver()], {"Cm": "1 + alpha + qhat + de + da"})
    model = identified_model(result, "made", REFERENCE)
    assert "Cm_da" not in model.names
    assert "Cm_da" in model.provenance["left out"]
    assert model.params["Cm_q"] == result["Cm_q"].value


def test_tied_parameters_make_no_model():
    alpha = maneuver().variables["alpha"]
    result = identify_equation_error(
        [maneuver(beta=2.0 * alpha)], {"Cm": "1 + alpha + beta + qhat + de"}
    )
    with pytest.raises(BadInput, match="Cm_alpha, Cm_beta are known only in combination"):
        identified_model(result, "made", REFERENCE)


def test_both_sets_of_axes():
    """CX and CZ beside CD and CL: one set goes into the model, the other on request."""
    item = attas("Elv1", "longitudinal")
    result = identify_equation_error([item], dict.fromkeys(("CX", "CZ", "CD", "CL"), "1 + alpha"))
    assert identified_model(result, "a", REFERENCE).coefficients == ("CD", "CL")
    assert identified_model(result, "b", REFERENCE, axes="body").coefficients == ("CX", "CZ")
