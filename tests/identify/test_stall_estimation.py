"""Kirchhoff parameters from simulated stalls: right where they can be told, else not told."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from alula.base.messages import BadInput
from alula.identify.flown.stall import identify_stall, separation

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))

from verification.stall_identification import FORMULAS, identified, stall_data, wing


def test_dynamic_stall_tells_all_four():
    found = identified(("dynamic",), 50)
    for name, share in (("a1", 0.1), ("alpha_star", 0.1), ("tau1", 0.2), ("tau2", 0.2)):
        p = found[name]
        assert p.verdict == "ok"
        assert p.value == pytest.approx(p.truth, rel=share), name  # as the verification asks
        assert abs(p.value - p.truth) < 4.0 * p.se  # by chance one in 16 000


def test_quasi_steady_stall_tells_the_angle_and_not_the_delay():
    found = identified(("quasi-steady",), 50, gentle=True)
    assert found["alpha_star"].value == pytest.approx(0.374, rel=0.1)
    assert found["tau2"].verdict == "not_identifiable"
    assert "tau2" in found.status
    assert np.isnan(found["tau2"].value)


def test_attached_flow_tells_no_stall_parameter():
    """The first second of the maneuver, before the pull: no flow separates."""
    d = stall_data(wing(), "dynamic", 3)
    early = replace(
        d,
        t=d.t[:60],
        coefficients={k: v[:60] for k, v in d.coefficients.items()},
        variables={k: v[:60] for k, v in d.variables.items()},
    )
    found = identify_stall([early], FORMULAS)
    assert all(found[n].verdict == "not_identifiable" for n in ("a1", "tau1", "tau2"))


def test_separation_solves_its_equation():
    """Against SciPy on a smooth motion; lines between samples of 0.01 s lack its curvature."""
    t = np.arange(401) / 100.0
    alpha, dot = 0.35 + 0.1 * np.sin(2.0 * t), 0.2 * np.cos(2.0 * t)

    def rate(s, x):
        a, d = 0.35 + 0.1 * np.sin(2.0 * s), 0.2 * np.cos(2.0 * s)
        return (0.5 * (1.0 - np.tanh(25.0 * (a - 0.06 * d - 0.374))) - x) / 0.24

    X = separation(t, alpha, dot, 25.0, 0.374, 0.24, 0.06)
    exact = solve_ivp(rate, (0.0, 4.0), [X[0]], t_eval=t, rtol=1e-9, atol=1e-11).y[0]
    np.testing.assert_allclose(X, exact, atol=3e-4)  # h^2/8 times the curvature of X0, about 20


def test_lift_of_the_attached_flow_is_asked_for():
    with pytest.raises(BadInput, match="CL"):
        identify_stall([stall_data(wing(), "dynamic", 0)], {"Cm": "1 + alpha"})
