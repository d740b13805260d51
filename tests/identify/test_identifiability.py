"""Parameters that the data cannot tell are not given a value, and what is known is named."""

from dataclasses import replace

import numpy as np
import pytest
from identify_flights import DT, N, maneuver

from alula.base.local_cubic import LocalCubic
from alula.identify import identify_equation_error
from alula.identify.result import Parameter
from alula.identify.trust.verdict import verdict, weak_words


def identify(formula, *data, **options):
    return identify_equation_error(list(data) or [maneuver()], {"Cm": formula}, **options)


def test_control_everything_is_resolved():
    result = identify("1 + alpha + qhat + de")
    assert [p.verdict for p in result.parameters[1:]] == ["ok"] * 3
    assert result.identifiable
    assert result["Cm_q"].value == pytest.approx(-20.0, abs=4.0 * result["Cm_q"].se)


def test_two_collinear_regressors_name_their_combination():
    """beta recorded as 2.5 alpha: only Cm_alpha + 2.5 Cm_beta can be known, and it is -1.2."""
    alpha = maneuver().variables["alpha"]
    result = identify("1 + alpha + beta + qhat + de", maneuver(beta=2.5 * alpha))
    bad = [p.name for p in result.parameters if p.verdict == "not_identifiable"]
    assert bad == ["Cm_alpha", "Cm_beta"]
    (tie,) = result["Cm_alpha"].tied_to
    assert (tie.name, tie.weight) == ("Cm_beta", pytest.approx(2.5))
    (back,) = result["Cm_beta"].tied_to
    assert (back.name, back.weight) == ("Cm_alpha", pytest.approx(0.4))
    assert np.isnan(result["Cm_alpha"].value)
    assert not result.identifiable
    message = next(m for m in result.messages if m.where == "Cm, Cm_alpha")
    assert message.code == "not_identifiable"
    assert "Cm_alpha + 2.5 Cm_beta = -1.2" in message.found
    assert result["Cm_de"].verdict == "ok"  # the others are as good as without
    assert result["Cm_de"].value == pytest.approx(identify("1+alpha+qhat+de")["Cm_de"].value)


def test_collinear_but_for_sensor_noise():
    """The copy has noise of 1 % of its own: what sets it apart is noise, not motion."""
    alpha = maneuver().variables["alpha"]
    noise = 1e-4 * np.random.default_rng(5).standard_normal(N)
    result = identify("1 + alpha + beta + qhat + de", maneuver(beta=2.0 * alpha + noise))
    assert result["Cm_alpha"].verdict == "not_identifiable"
    assert result["Cm_beta"].verdict == "not_identifiable"
    (tie,) = result["Cm_alpha"].tied_to
    assert (tie.name, tie.weight) == ("Cm_beta", pytest.approx(2.0, rel=0.05))


def test_dependent_triple_is_named_whole():
    v = maneuver().variables
    result = identify("1 + alpha + beta + qhat + de", maneuver(beta=v["alpha"] + v["de"]))
    for name in ("Cm_alpha", "Cm_beta", "Cm_de"):
        assert result[name].verdict == "not_identifiable"
        assert len(result[name].tied_to) == 2
    assert result["Cm_q"].verdict == "ok"


def test_control_that_stands_still_at_zero():
    result = identify("1 + alpha + qhat + de + da")
    assert result["Cm_da"].verdict == "not_identifiable"
    assert result["Cm_da"].tied_to == ()
    assert "Cm_0" in result.params
    assert result["Cm_0"].verdict != "not_identifiable"


def test_control_that_stands_still_elsewhere_is_tied_to_the_constant():
    result = identify("1 + alpha + qhat + de + df", maneuver(df=np.full(N, 0.35)))
    (tie,) = result["Cm_0"].tied_to
    assert (tie.name, tie.weight) == ("Cm_df", pytest.approx(0.35))
    assert result["Cm_df"].verdict == "not_identifiable"


def test_control_that_only_shows_sensor_noise():
    noise = 1e-3 * np.random.default_rng(6).standard_normal(N)
    result = identify("1 + alpha + qhat + de + da", maneuver(da=noise))
    assert result["Cm_da"].verdict == "not_identifiable"
    assert [result[n].verdict for n in ("Cm_alpha", "Cm_q", "Cm_de")] == ["ok"] * 3


def test_white_excitation_that_acts_is_resolved():
    """A control that jumps every sample looks like noise, but the coefficient follows it."""
    jumps = 0.05 * np.sign(np.random.default_rng(7).standard_normal(N))
    result = identify("1 + alpha + qhat + de", maneuver(de=jumps))
    assert result["Cm_de"].verdict == "ok"


def test_excited_far_too_little():
    """One step of 1e-6 rad: the standard error is hundreds, where a Cm_de is about one."""
    step = np.where(np.arange(N) > 300, 1e-6, 0.0)
    result = identify("1 + alpha + qhat + de", maneuver(de=step))
    assert result["Cm_de"].verdict == "not_identifiable"
    assert result["Cm_alpha"].verdict == "ok"


def test_two_maneuvers_lift_what_one_cannot():
    """Flaps stand still in each: no help with own constants, resolved with a common one."""
    up, down = maneuver("up", df=np.zeros(N)), maneuver("down", seed=1, df=np.full(N, 0.3))
    own = identify("1 + alpha + qhat + de + df", up, down)
    assert own["Cm_df"].verdict == "not_identifiable"
    assert own["Cm_0[down]"].verdict == "not_identifiable"
    assert own["Cm_0[up]"].verdict != "not_identifiable"
    common = identify("1 + alpha + qhat + de + df", up, down, common_constant=True)
    assert common["Cm_df"].verdict != "not_identifiable"


def test_reference_scale_makes_a_small_parameter_ok():
    """beta moves but does not act: weak, unless an error below the stated scale is good enough."""
    beta = 0.05 * np.sin(2.0 * np.arange(N) * DT)
    plain = identify("1 + alpha + qhat + de + beta", maneuver(beta=beta))
    assert plain["Cm_beta"].verdict == "weak"
    stated = identify("1 + alpha + qhat + de + beta~0.05", maneuver(beta=beta))
    assert stated["Cm_beta"].verdict == "ok"
    by_option = identify(
        "1 + alpha + qhat + de + beta", maneuver(beta=beta), scales={"Cm_beta": 0.05}
    )
    assert by_option["Cm_beta"].verdict == "ok"


def test_variance_inflation_is_one_or_more_with_a_common_constant():
    """Against the textbook's, over two maneuvers at different angles of attack, as one record."""
    first, second = maneuver("first"), maneuver("second", seed=1)
    shifted = dict(second.variables) | {"alpha": second.variables["alpha"] + 0.1}
    second = replace(second, variables=shifted)
    v = {n: np.concatenate([first.variables[n], shifted[n]]) for n in ("alpha", "qhat", "de")}
    x = np.column_stack([np.ones(2 * N), v["qhat"], v["de"]])
    left = v["alpha"] - x @ np.linalg.lstsq(x, v["alpha"], rcond=None)[0]
    expected = np.sum((v["alpha"] - v["alpha"].mean()) ** 2) / np.sum(left**2)
    found = identify(
        "1 + alpha + qhat + de", first, second, common_constant=True, weighting="equal"
    )
    assert expected > 1.0
    assert found["Cm_alpha"].vif == pytest.approx(expected, rel=1e-8)


def test_variance_inflation_is_one_over_one_minus_r2():
    """Against its textbook definition by an auxiliary regression."""
    v = maneuver().variables
    x = np.column_stack([np.ones(N), v["qhat"], v["de"]])
    left = v["alpha"] - x @ np.linalg.lstsq(x, v["alpha"], rcond=None)[0]
    expected = np.sum((v["alpha"] - v["alpha"].mean()) ** 2) / np.sum(left**2)
    assert identify("1 + alpha + qhat + de")["Cm_alpha"].vif == pytest.approx(expected, rel=1e-8)


@pytest.mark.parametrize(
    ("value", "se", "ci", "scale", "expected"),
    [
        (1.0, 0.1, (0.8, 1.2), None, "ok"),
        (0.15, 0.1, (-0.1, 0.4), None, "weak"),
        (0.21, 0.1, (-0.1, 0.5), None, "weak"),  # over 2 se, but the interval includes zero
        (-1.0, 0.6, (-1.9, -0.1), None, "weak"),  # se over half the value
        (0.0, 0.1, (-0.2, 0.2), 0.2, "ok"),
        (0.0, 0.1, (-0.2, 0.2), 0.05, "weak"),
    ],
)
def test_verdict_rule(value, se, ci, scale, expected):
    assert verdict(value, se, ci, scale) == expected


def test_weak_constants_that_are_zero_are_told_apart():
    def parameter(name, ci95, verdict):
        return Parameter(name, name[:2], sum(ci95) / 2, 0.1, 0.1, ci95, verdict, (), "1", 1.0)

    zero, off = parameter("CY_0[a]", (-0.2, 0.3), "weak"), parameter("Cl_0", (0.1, 0.9), "weak")
    rate, good = parameter("Cn_p", (-0.2, 0.3), "weak"), parameter("Cm_0", (-0.1, 0.1), "ok")
    assert [p.zero_constant for p in (zero, off, rate, good)] == [True, False, False, False]
    words = weak_words([zero, off, rate, good])
    assert words == "weak: Cl_0, Cn_p; zero within their error: CY_0[a]"
    assert weak_words([good]) == ""


def test_noisy_regressor_is_said():
    """Half a degree of noise on alpha, used unsmoothed."""
    v = maneuver().variables
    item = maneuver()
    rough = v["alpha"] + 0.01 * np.random.default_rng(3).standard_normal(N)
    item = replace(item, variables={**v, "alpha": rough})
    result = identify("1 + alpha + qhat + de", item)
    assert "noisy_regressor" in [m.code for m in result.messages]
    assert "noisy_regressor" not in [m.code for m in identify("1+alpha+qhat+de").messages]


def test_smoothing_does_not_make_noise_a_signal():
    """The same standing control where moments and regressors have passed a low-pass."""
    noise = 1e-3 * np.random.default_rng(6).standard_normal(N)
    item = maneuver(da=noise)
    cubic = LocalCubic(item.t, 0.3)
    smooth = replace(item, cubic=cubic, coefficients={"Cm": cubic.matched(item.coefficients["Cm"])})
    result = identify("1 + alpha + qhat + de + da", smooth)
    assert result["Cm_da"].verdict == "not_identifiable"
    assert [result[n].verdict for n in ("Cm_alpha", "Cm_q", "Cm_de")] == ["ok"] * 3
