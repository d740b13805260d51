"""A control recorded with the wrong sign, in every method that regresses coefficients."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from identify_flights import maneuver

from alula.identify import identify_equation_error
from alula.identify.equation_error.bootstrap import bootstrapped
from alula.identify.equation_error.recursive import identify_recursive
from alula.identify.frequency.regression import identify_frequency_regression

MODEL = {"Cm": "1 + alpha + qhat + de"}


def recorded(sign):
    """Cm_de is -1.5; what is recorded is the deflection times `sign`."""
    item = maneuver()
    v = item.variables
    clean = -1.2 * v["alpha"] - 20.0 * v["qhat"] - 1.5 * v["de"]
    noisy = clean + 1e-3 * np.random.default_rng(3).standard_normal(len(clean))
    return replace(item, coefficients={"Cm": noisy}, variables={**v, "de": sign * v["de"]})


@pytest.mark.parametrize(
    "identify", [identify_equation_error, identify_frequency_regression, identify_recursive]
)
def test_turned_control_is_named_and_its_derivative_not_ok(identify):
    right, turned = (identify([recorded(sign)], MODEL) for sign in (1.0, -1.0))
    assert right["Cm_de"].verdict == "ok"
    assert "control_sign" not in {m.code for m in right.messages}
    assert turned["Cm_de"].verdict == "weak"
    assert turned["Cm_alpha"].verdict == "ok"
    assert "sign contradicted: Cm, de" in turned.status
    assert [m.where for m in turned.messages if m.code == "control_sign"] == ["Cm, de"]


def test_bootstrap_keeps_the_warning_once():
    data = [recorded(-1.0)]
    found = bootstrapped(identify_equation_error(data, MODEL), data, replicates=100)
    assert found["Cm_de"].verdict == "weak"
    assert [m.code for m in found.messages].count("control_sign") == 1
