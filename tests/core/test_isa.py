"""Both builds of the core compute the same flight."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from alula.core import MODULES, core


def flown(core: Any, wgs84: bool = False) -> np.ndarray:
    steps = np.array([[0.0, 2, 2, 0], [2.0, 2, 0, 0.03], [1.0, 3, 0, 0]])
    terms = [(0, 0, 0.05), (0, 13, 1.0), (2, 0, 0.5), (2, 2, 5.0), (2, 14, -0.5), (4, 2, -0.4)]
    terms += [(4, 5, -25.0), (4, 0, -0.03), (3, 4, -0.5), (3, 3, -0.1), (5, 3, 0.1), (5, 6, -0.1)]
    terms += [(1, 15, 0.01), (1, 3, -0.5)]
    table = core.TermTable(steps, np.array([t[:2] for t in terms], dtype=float))
    inertia = np.array([[655.0, 0, -30], [0, 723, 0], [-30, 0, 1139]])
    model = core.AircraftModel(
        560.0, inertia, np.array([10.6, 8.65, 1.25]), np.zeros(3), 9.80665, True, table,
        np.array([t[2] for t in terms]), wgs84,
    )  # fmt: skip
    J, CT, CP = np.linspace(0.0, 1.0, 5), np.linspace(0.12, 0.0, 5), np.linspace(0.06, 0.01, 5)
    model.add_piston(
        np.array([1.6, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), 1.7, 0.3, 1.0, J, CT, CP,
        np.array([0.0, 300.0, 600.0]), np.array([60.0, 120.0, 115.0]), 2.43, -1.0, 0.05, 12.0, 0.1,
        8e-8,
    )  # fmt: skip
    model.set_stall(22.0, 0.27, 0.2, 0.1, 5.0, -0.1, 0.1, -0.1, 2.0, 0.01)
    model.set_wind(np.array([3.0, -2.0, 0]), np.zeros(3), 0.0, False, 0.05, 0.0)
    position, quaternion = np.array([0.0, 0.0, -900.0]), np.array([0.998, 0.05, 0.02, 0.01])
    if wgs84:
        core.ecef_state(0.8, 0.3, 900.0, 0.1, 0.04, 0.02, position, quaternion)
    body = np.concatenate([position, quaternion, [45.0, 2.0, 1.0, 0.2, -0.1, 0.1]])
    controls = np.tile([0, 0, 0, 0, 0.7, 0.0], (1000, 1))
    x0 = np.zeros(model.state_count)
    model.settle(body, controls[0], x0)
    states, outputs = np.empty((1000, len(x0))), np.empty((1000, model.output_count))
    inputs = np.empty((1000, model.input_count))
    normals = np.random.default_rng(1).standard_normal((1000, 8))
    turbulence = np.array([8.65, 4.0, 1.0])
    assert model.fly(
        x0, controls, 0.01, 1, states, outputs, inputs, turbulence=turbulence, normals=normals
    )
    return np.hstack([states, outputs, inputs])


@pytest.mark.parametrize("wgs84", [False, True])
def test_baseline_and_v3_agree(wgs84: bool) -> None:
    if len(MODULES) < 2:
        pytest.skip("built for one instruction set alone, or the baseline was asked for")
    a, b = (flown(module, wgs84) for module in MODULES.values())
    assert np.isfinite(a).all()
    # The design's promise: 1e-10 between instruction sets (relative to each column's size).
    scale = np.abs(a).max(axis=0).clip(1.0)
    np.testing.assert_allclose(a / scale, b / scale, rtol=0, atol=1e-10)


def test_same_flight_is_the_same_bytes() -> None:
    assert flown(core).tobytes() == flown(core).tobytes()
