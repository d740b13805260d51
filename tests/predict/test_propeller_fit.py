"""Parameters from tests: recovered with honest errors, or said to be open."""

from __future__ import annotations

import numpy as np
import pytest

from alula.aircraft.blades import MomentumParameters
from alula.base.messages import BadInput
from alula.predict.propeller_fit import PropellerFit, fit_propeller
from alula.predict.propeller_momentum import momentum_propeller
from alula.predict.propeller_test import propeller_test, static_test
from predict.propellers import PARAMETERS, blades

J = np.linspace(0.0, 0.5, 21)


def noisy(seed: int, sigma: float = 1e-3) -> PropellerFit:
    """A fit to the model's own curves with white noise of known size."""
    curve = momentum_propeller(blades(), J, PARAMETERS)
    noise = np.random.default_rng(seed).normal(0.0, sigma, (2, len(J)))
    test = propeller_test(J, curve.CT + noise[0], curve.CP + noise[1], se_CT=sigma, se_CP=sigma)
    return fit_propeller(blades(), test)


def by_name(fit: PropellerFit) -> dict[str, object]:
    return {e.name: e for e in fit.estimates}


def test_exact_curves_give_the_parameters_back() -> None:
    curve = momentum_propeller(blades(), J, PARAMETERS)
    fit = fit_propeller(blades(), propeller_test(J, curve.CT, curve.CP))
    assert fit.identified
    assert fit.parameters is not None
    for name in ("c_l_alpha", "alpha_max", "c_d_alpha", "pitch"):
        # the fit's splines over J1 are good to 1e-6 of the largest value
        assert getattr(fit.parameters, name) == pytest.approx(getattr(PARAMETERS, name), rel=1e-3)
    assert fit.rms_CT < 1e-5


def test_errors_stand_within_their_error_bars() -> None:
    """Three seeds, four parameters: none beyond 4 standard errors (chance 1 in 1000)."""
    for seed in range(3):
        fit = noisy(seed)
        for e in fit.estimates:
            assert e.verdict in ("ok", "weak")
            assert abs(e.value - getattr(PARAMETERS, e.name)) < 4.0 * e.se
            assert e.se < 0.5 * e.value


def test_stall_that_no_section_reaches_is_a_lower_bound() -> None:
    high = MomentumParameters(5.2, 1.2, 1.1, 0.3)
    low = J[J > 0.15]  # at rest the root would reach it
    curve = momentum_propeller(blades(), low, high)
    fit = fit_propeller(blades(), propeller_test(low, curve.CT, curve.CP))
    e = by_name(fit)["alpha_max"]
    assert e.verdict == "not_identifiable"
    assert "lower bound" in e.note
    assert not fit.identified
    # the curves do not depend on it, so the others are known and usable
    assert fit.parameters is not None
    assert fit.parameters.pitch == pytest.approx(high.pitch, rel=1e-3)
    again = momentum_propeller(blades(), low, fit.parameters)
    assert np.max(np.abs(again.CT - curve.CT)) < 1e-5


def static(efficiency_se: float = 0.0):
    """A bench test with the model's own thrust, and power through a motor of 0.8."""
    curve = momentum_propeller(blades(), 0.0, PARAMETERS)
    omega = np.array([200.0, 300.0, 400.0, 500.0])
    n, D = omega / (2.0 * np.pi), blades().diameter
    thrust = curve.CT[0] * 1.2 * n**2 * D**4 * np.array([1.001, 0.999, 1.001, 0.999])
    power = curve.CP[0] * 1.2 * n**3 * D**5 * np.array([0.999, 0.999, 1.001, 1.001])
    return static_test(
        thrust, omega, np.full(4, 20.0), power / 0.8 / 20.0, 0.8, D, 1.2, efficiency_se
    )


def test_static_test_gives_two_numbers_and_no_more() -> None:
    fit = fit_propeller(blades(), static())
    assert not fit.identified
    assert fit.parameters is None
    assert "does not determine" in fit.status
    lost = [e for e in fit.estimates if e.verdict == "not_identifiable"]
    assert len(lost) >= 3
    assert any(e.tied_to for e in lost)
    given = {"alpha_max": PARAMETERS.alpha_max, "pitch": PARAMETERS.pitch}
    known = fit_propeller(blades(), static(), given)
    assert known.identified
    e = by_name(known)
    assert e["alpha_max"].verdict == "given"
    # scatter of 1e-3 in CT and CP; c_l_alpha and c_d_alpha follow with a gain of some 3
    assert e["c_l_alpha"].value == pytest.approx(PARAMETERS.c_l_alpha, rel=5e-3)
    assert e["c_d_alpha"].value == pytest.approx(PARAMETERS.c_d_alpha, rel=5e-3)


def test_doubt_of_the_motors_efficiency_is_in_the_error_bar() -> None:
    given = {"alpha_max": PARAMETERS.alpha_max, "pitch": PARAMETERS.pitch}
    sure = by_name(fit_propeller(blades(), static(), given))
    doubtful = by_name(fit_propeller(blades(), static(0.04), given))
    assert doubtful["c_d_alpha"].value == pytest.approx(sure["c_d_alpha"].value)
    assert doubtful["c_d_alpha"].se > 3.0 * sure["c_d_alpha"].se
    # 5 % of power is what c_d_alpha would take up: its shift, by hand from two fits
    bench = static()
    shifted = propeller_test(bench.J, bench.CT, 1.05 * bench.CP)
    moved = by_name(fit_propeller(blades(), shifted, given))
    step = abs(moved["c_d_alpha"].value - sure["c_d_alpha"].value)
    assert doubtful["c_d_alpha"].se == pytest.approx(step, rel=0.1)  # 0.04/0.8 = 5 %


@pytest.mark.parametrize(
    ("columns", "found"),
    [
        (([0.0, 0.1], [0.1], [0.05, 0.04]), "1"),
        (([0.0, np.nan], [0.1, 0.1], [0.05, 0.04]), "not finite"),
        (([-0.1, 0.1], [0.1, 0.1], [0.05, 0.04]), "reverse"),
        (([], [], []), "0"),
    ],
)
def test_tables_that_are_none_are_refused(columns, found) -> None:
    with pytest.raises(BadInput, match=found):
        propeller_test(*columns)


def test_bench_tests_that_are_none_are_refused() -> None:
    for omega, efficiency in (([0.0, 100.0], 0.8), ([100.0], 0.8), ([90.0, 100.0], 1.2)):
        with pytest.raises(BadInput):
            static_test([1.0, 2.0], omega, [9.0, 9.0], [1.0, 1.0], efficiency, 0.3)


def test_options_of_the_fit_are_checked() -> None:
    test = propeller_test([0.0], [0.1], [0.05])
    for given in ({"alpha": 0.2}, {"pitch": np.nan}, dict.fromkeys(
        ("c_l_alpha", "alpha_max", "c_d_alpha", "pitch"), 0.3)):  # fmt: skip
        with pytest.raises(BadInput, match="bad_fit_options"):
            fit_propeller(blades(), test, given)
