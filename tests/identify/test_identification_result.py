"""What can be asked of a result, and which requests are refused."""

from dataclasses import replace

import numpy as np
import pytest
from identify_flights import maneuver

from alula.base.messages import BadInput
from alula.identify import identify_equation_error
from alula.identify.typical import flown_sum, unit

FORMULA = "1 + alpha + qhat + de + da"


@pytest.fixture(scope="module")
def result():
    held = maneuver("unseen", seed=9)
    held = replace(held, maneuver=replace(held.maneuver, held_out=True))
    return identify_equation_error([maneuver(), held], {"Cm": FORMULA}, truth={"Cm_q": -20.0})


def test_it_speaks_statsmodels(result):
    names = ["Cm_0", "Cm_alpha", "Cm_q", "Cm_de", "Cm_da"]
    assert list(result.params.index) == names
    assert list(result.bse.index) == names
    covariance = result.cov_params()
    assert covariance.loc["Cm_q", "Cm_q"] == pytest.approx(result.bse["Cm_q"] ** 2)
    interval = result.conf_int()
    assert interval.loc["Cm_q", "lower"] < result.params["Cm_q"] < interval.loc["Cm_q", "upper"]
    assert len(result.resid["Cm"]) == result.fits["Cm"].n == 600
    assert result.rsquared["Cm"] == result.fits["Cm"].r2 > 0.99
    assert result["Cm_q"].truth == -20.0
    correlations = result.correlations
    assert np.nanmax(np.abs(correlations)) <= 1.0 + 1e-12
    assert np.isnan(correlations[4]).all()  # nothing is known of Cm_da


def test_summary_is_complete(result):
    text = result.summary()
    for word in ("Cm_alpha", "-20", "not identifiable", "not excited", FORMULA, "D-W", "truth"):
        assert word in text
    assert max(len(line) for line in text.splitlines()) <= 130


def test_a_rate_s_derivative_is_called_the_sum_that_flight_tells(result):
    assert "Cm_q is Cm_q + Cm_alphadot" in " ".join(result.summary().split())
    assert flown_sum("Cn_r") == "Cn_r - Cn_betadot"
    assert flown_sum("CL_q") == "CL_q + CL_alphadot"
    for other in ("Cm_alpha", "Cn_p", "Cm_r", "q(0)[m1]", "F_q"):
        assert flown_sum(other) is None


def test_plot_shows_every_maneuver(result):
    figure = result.plot()
    assert [ax.get_title() for ax in figure.axes] == ["m1", "unseen (held out)"]
    measured = figure.axes[0].lines[0].get_ydata()
    assert measured.tolist() == result.series[0].measured.tolist()


def test_held_out_maneuver_has_its_own_constant(result):
    """A shift of the whole coefficient is trim, not misfit."""
    held = maneuver("unseen", seed=9)
    shifted = replace(
        held,
        maneuver=replace(held.maneuver, held_out=True),
        coefficients={"Cm": held.coefficients["Cm"] + 0.3},
    )
    other = identify_equation_error([maneuver(), shifted], {"Cm": FORMULA})
    assert other.fits["Cm"].r2_held_out == pytest.approx(result.fits["Cm"].r2_held_out)
    assert other.fits["Cm"].r2_held_out > 0.99


def test_result_cannot_be_changed(result):
    with pytest.raises(ValueError, match="read-only"):
        result.covariance[0, 0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        result.series[0].model[0] = 0.0


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("Cm_0", "1"), ("Cm_0[run]", "1"), ("Cm_alpha", "1/rad"), ("Cm_q", "1/rad"),
        ("Cm_alpha2", "1/rad^2"), ("Cm_alpha_de", "1/rad^2"), ("Cm_absbeta", "1/rad"),
        ("Cm_(alpha-0.2)+2", "1/rad^2"), ("Cm_dt", "1"), ("Cm_mach2", "1"), ("Cm_V", "s/m"),
    ],
)  # fmt: skip
def test_units_follow_from_names(name, expected):
    assert unit("Cm", name) == expected


def refused(code, data, models):
    with pytest.raises(BadInput) as caught:
        identify_equation_error(data, models)
    assert [m.code for m in caught.value.messages] == [code]
    return str(caught.value)


def test_unknown_term():
    assert "alfa" in refused("unknown_term", [maneuver()], {"Cm": "1 + alfa"})


def test_channel_of_a_term_is_not_there():
    assert "dr" in refused("missing_variable", [maneuver()], {"Cm": "1 + alpha + dr"})


def test_fewer_samples_than_parameters():
    m = maneuver()
    few = replace(
        m,
        t=m.t[:4],
        coefficients={"Cm": m.coefficients["Cm"][:4]},
        variables={k: v[:4] for k, v in m.variables.items()},
    )
    assert "4 samples" in refused("too_few_samples", [few], {"Cm": "1 + alpha + qhat + de"})


def test_coefficient_that_nobody_measured():
    assert "Cl" in refused("missing_coefficient", [maneuver()], {"Cl": "1 + beta"})


def test_no_maneuver_to_learn_from():
    m = maneuver()
    held = replace(m, maneuver=replace(m.maneuver, held_out=True))
    refused("no_maneuver", [held], {"Cm": "1 + alpha"})
    lateral = replace(m, maneuver=replace(m.maneuver, aspect="lateral"))
    refused("no_maneuver", [lateral], {"Cm": "1 + alpha"})


def test_no_model_at_all():
    refused("no_model", [maneuver()], {})


def test_gap_within_a_maneuver_is_said():
    m = maneuver()
    t = np.where(np.arange(len(m.t)) > 300, m.t + 2.0, m.t)
    result = identify_equation_error([replace(m, t=t)], {"Cm": "1 + alpha + qhat + de"})
    assert [x.code for x in result.messages] == ["uneven_time"]
    assert "2.02 s" in result.messages[0].found


def test_unknown_weighting_is_refused():
    with pytest.raises(BadInput, match="unknown_option"):
        identify_equation_error([maneuver()], {"Cm": "1 + alpha"}, weighting="loudest")
