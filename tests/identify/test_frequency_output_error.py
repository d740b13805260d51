"""Output error in the frequency domain: truth by an integrator in time, a delay included."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from alula.base.messages import BadInput
from alula.identify.frequency.output_error import FrequencyError, identify_frequency_output_error
from alula.identify.linear.model import linear_model
from alula.identify.linear.record import Unknowns, linear_record

TRUE = {"Za": -1.2, "Zde": -0.15, "Ma": -6.0, "Mq": -1.8, "Mde": -9.0}
DELAY, DT = 0.07, 0.02
BAND = (0.05, 2.0)


def short_period():
    return linear_model(
        {"alpha": "Za*alpha + q + Zde*de + Z0", "q": "Ma*alpha + Mq*q + Mde*de"},
        ["alpha", "q"],
        ["de"],
    )


def elevator(t):
    """A smooth sweep from 0.1 to 1.5 Hz that starts and ends at rest."""
    s = np.clip(t / 18.0, 0.0, 1.0)
    phase = 2.0 * np.pi * 18.0 * (0.1 * s + 0.7 * s**2)
    return 0.03 * np.sin(phase) * np.sin(np.pi * s) ** 0.5


@cache
def motion(delay, trim):
    """Angle of attack and pitch rate (2, n), without noise."""
    t = DT * np.arange(1001)

    def rate(s, x):
        de = elevator(max(s - delay, 0.0))
        a, q = x - np.array([trim, 0.0])
        return [
            TRUE["Za"] * a + q + TRUE["Zde"] * de,
            TRUE["Ma"] * a + TRUE["Mq"] * q + TRUE["Mde"] * de,
        ]

    start = [trim, 0.01]
    return solve_ivp(rate, (0, t[-1]), start, t_eval=t, rtol=1e-9, atol=1e-11, max_step=0.02).y


def flown(seed, delay=DELAY, noise=1.0, trim=0.04):
    t = DT * np.arange(1001)
    x = motion(delay, trim)
    rng = np.random.default_rng(seed)
    channels = {
        "alpha": x[0] + noise * 0.003 * rng.standard_normal(len(t)),
        "q": x[1] + noise * 0.006 * rng.standard_normal(len(t)) + 0.02,  # a bias too
        "de": elevator(t) - 0.01,
    }
    return linear_record("sweep", t, channels, short_period())


def identify(records, **options):
    options = {"band_hz": BAND, "delayed": ["de"], **options}
    return identify_frequency_output_error(short_period(), records, **options)


def test_recovers_truth_and_delay_whatever_trim_and_bias():
    found = identify([flown(0, noise=1e-6)])
    for name, value in TRUE.items():
        assert found[name].value == pytest.approx(value, rel=2e-4), (
            name
        )  # the cubics between samples
    assert found["delay_de"].value == pytest.approx(DELAY, abs=1e-5)
    assert found["alpha(0)-(T)[sweep]"].verdict != "not_identifiable"
    assert "no_constants" in [m.code for m in found.messages]


def test_intervals_hold():
    """40 draws, 240 intervals: 3 binomial deviations are 91 to 99 %."""
    results = [identify([flown(s)]) for s in range(40)]
    assert all(r.status.startswith("converged") for r in results)
    true = {**TRUE, "delay_de": DELAY}
    inside = [r[n].ci95[0] < v < r[n].ci95[1] for r in results for n, v in true.items()]
    assert 0.91 <= np.mean(inside) <= 0.99
    ratio = [
        np.std([r[n].value for r in results], ddof=1) / np.mean([r[n].se_white for r in results])
        for n in true
    ]
    assert 0.85 < np.mean(ratio) < 1.15  # 40 draws know a deviation to 11 %, six of them to 5 %


def test_without_its_delay_the_model_is_biased():
    """What the parameter is for: 0.07 s left out moves the damping by many standard errors."""
    found = identify([flown(1)], delayed=[])
    assert abs(found["Mq"].value - TRUE["Mq"]) > 4.0 * found["Mq"].se


def test_two_maneuvers_share_derivatives():
    one = flown(2)
    both = identify([one, replace(flown(3, trim=-0.02), id="again")])
    assert both["Ma"].se < identify([one])["Ma"].se
    assert abs(both["Ma"].value - TRUE["Ma"]) < 4.0 * both["Ma"].se


def test_gradient_is_that_of_the_cost():
    model, record = short_period(), flown(4)
    unknowns = Unknowns(model, [record], (), {"Z0": 0.0}, True)
    problem = FrequencyError(model, [record], unknowns, ("de",), BAND)
    p = np.array([-1.0, -0.1, -5.0, -1.5, -8.0, 0.01, -0.01, 0.03])
    point = problem.likelihood(p, True)
    for j in range(len(p)):
        step = np.eye(len(p))[j] * 1e-5
        up, down = problem.likelihood(p + step, False), problem.likelihood(p - step, False)
        assert point.gradient[j] == pytest.approx((up.cost - down.cost) / 2e-5, rel=1e-5, abs=1e-4)


def test_still_control_is_named():
    record = flown(5)
    found = identify([replace(record, inputs=np.full_like(record.inputs, 0.01))], delayed=[])
    assert found["Mde"].verdict == "not_identifiable"


def test_refusals():
    with pytest.raises(BadInput, match="bad_option"):
        identify([flown(6)], delayed=["dr"])
    with pytest.raises(BadInput, match="narrow_band"):
        identify([flown(6)], band_hz=(0.01, 0.06))
