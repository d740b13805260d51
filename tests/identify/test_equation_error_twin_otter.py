"""NASA's Twin Otter, run 018: equation error as published (Klein and Morelli's examples)."""

import numpy as np
import pytest
from identify_flights import twin_otter

from alula.identify import identify_equation_error
from verification.main_job.published import TWIN_OTTER

MODELS = {"CZ": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}

PLAIN = {"Cm_alpha": 0.0122, "Cm_q": 0.430, "Cm_de": 0.0121}


@pytest.fixture(scope="module")
def result():
    return identify_equation_error([twin_otter()], MODELS)


@pytest.mark.parametrize("name", TWIN_OTTER)
def test_published_value_and_coloured_standard_error(result, name):
    value, se, tolerance = TWIN_OTTER[name]
    assert result[name].value == pytest.approx(value, rel=tolerance)
    assert result[name].se == pytest.approx(se, rel=0.05)  # the sources round to three figures
    assert result[name].verdict == "ok"


@pytest.mark.parametrize("name", PLAIN)
def test_plain_standard_error_beside(result, name):
    assert result[name].se_white == pytest.approx(PLAIN[name], rel=0.01)  # printed to 3 figures


def test_interval_is_wider_than_two_coloured_standard_errors(result):
    """Eight seconds hold few periods of the motion; an interval of 2 se would be too narrow."""
    for p in result.parameters:
        assert p.ci95[1] - p.ci95[0] > 4.0 * p.se
        assert np.mean(p.ci95) == pytest.approx(p.value)


def test_fit_is_as_good_as_published_residuals_say(result):
    assert result.rsquared["Cm"] > 0.99
    assert result.rsquared["CZ"] > 0.999


def test_without_pitch_rate_the_fit_is_worse():
    """A control that the model matters: the published fit needs the pitch rate."""
    poorer = identify_equation_error([twin_otter()], {"Cm": "1 + alpha + de"})
    assert poorer.rsquared["Cm"] < 0.97
