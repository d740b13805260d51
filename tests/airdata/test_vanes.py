"""Angle vanes and the static port."""

from __future__ import annotations

import numpy as np
import pytest

from alula.airdata.cp_fit import read_points
from alula.airdata.static_port import fit_static_port
from alula.airdata.vanes import Vane, beta_of_flank, flank_of_beta, flow_from_vanes, vane_readings
from alula.base.messages import BadInput
from data import data


def test_vane_in_a_roll() -> None:
    """A vane 4 m out on the right wing of a level roll at 0.5 rad/s meets 2 m/s from below."""
    v, rates = np.array([[40.0, 0.0, 0.0]]), np.array([[0.5, 0.0, 0.0]])
    alpha, beta = vane_readings(Vane(arm=(0.0, 4.0, 0.0)), Vane(0.1, 0.02), v, rates)
    assert alpha == pytest.approx(np.arctan(2.0 / 40.0))
    assert beta == pytest.approx(0.02)


def test_there_and_back() -> None:
    random = np.random.default_rng(1)
    n = 500
    v = np.column_stack([random.uniform(20, 60, n), *random.uniform(-10, 10, (2, n))])
    rates = random.uniform(-0.5, 0.5, (n, 3))
    a, b, pitot = Vane(0.3, 0.02, (2.0, -3.0, 0.1)), Vane(-0.1, 0.01, (2.0, 3.0, 0.0)), (1.0, 5, 0)
    read = vane_readings(a, b, v, rates)
    V = np.linalg.norm(v + np.cross(rates, pitot), axis=1)
    found = flow_from_vanes(a, b, *read, V, rates, pitot)
    assert pytest.approx(np.linalg.norm(v, axis=1), rel=1e-12) == found.V
    assert found.alpha == pytest.approx(np.arctan2(v[:, 2], v[:, 0]), abs=1e-12)
    assert found.beta == pytest.approx(np.arcsin(v[:, 1] / found.V), abs=1e-12)
    flank = flank_of_beta(found.beta, found.alpha)
    assert flank == pytest.approx(np.arctan2(v[:, 1], v[:, 0]), abs=1e-12)
    assert beta_of_flank(flank, found.alpha) == pytest.approx(found.beta, abs=1e-12)


def test_refused_readings_are_counted() -> None:
    found = flow_from_vanes(
        Vane(), Vane(), [0.1, np.nan, 1.5, 0.1], 0.0, [40.0, 40.0, 40.0, 0.0], np.zeros((4, 3))
    )
    assert np.isfinite(found.V).tolist() == [True, False, False, False]
    assert "3 of 4" in found.messages[0].found


def test_static_port_of_the_armhawk() -> None:
    """The author's quadratic (3.11), 0.579 U2 - 0.819 U, through the same points."""
    points = read_points(data("armhawk", "probe_cfd", "static_port_calibration.csv"), (1, 3))
    port = fit_static_port(points[:, 0], points[:, 1], 1.169)
    U = np.linspace(10.0, 40.0, 10)
    printed = 0.579 * U**2 - 0.819 * U
    # His fit and this one differ by no more than the points do from either (0.6 Pa) and the
    # printed digits allow (0.0005 x 1600 + 0.0005 x 40).
    assert port.correction(U, 1.169) == pytest.approx(printed, abs=1.5)
    assert port.rms < 0.5
    assert port.correction(20.0, 2.338) == pytest.approx(2.0 * port.correction(20.0, 1.169))
    assert port.correction([-3.0, 0.0], 1.169) == pytest.approx([0.0, 0.0])


def test_bad_points() -> None:
    for U, dp in (([1, 2, 3], [1, 2, 3]), ([1, 2, 3, -4], [1, 2, 3, 4]), ([1, 2, 3, 4], [1] * 5)):
        with pytest.raises(BadInput, match="static_port_points"):
            fit_static_port(U, dp, 1.2)
