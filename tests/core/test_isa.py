"""Both builds of the core compute the same flight."""

from __future__ import annotations

import importlib

import numpy as np
import pytest

from alula.core import ISA


def flown(module_name: str) -> np.ndarray:
    core = importlib.import_module(f"alula.{module_name}")
    steps = np.array([[0.0, 2, 2, 0], [2.0, 2, 0, 0.03], [1.0, 3, 0, 0]])
    terms = [(0, 0, 0.05), (0, 13, 1.0), (2, 0, 0.5), (2, 2, 5.0), (2, 14, -0.5), (4, 2, -0.4)]
    terms += [(4, 5, -25.0), (4, 0, -0.03), (3, 4, -0.5), (3, 3, -0.1), (5, 3, 0.1), (5, 6, -0.1)]
    terms += [(1, 15, 0.01), (1, 3, -0.5)]
    table = core.TermTable(steps, np.array([t[:2] for t in terms], dtype=float))
    inertia = np.array([[655.0, 0, -30], [0, 723, 0], [-30, 0, 1139]])
    model = core.AircraftModel(
        560.0, inertia, np.array([10.6, 8.65, 1.25]), np.zeros(3), np.zeros(3),
        np.array([1.0, 0, 0]), np.array([3.0, -2.0, 0]), 9.80665, True, table,
        np.array([t[2] for t in terms]),
    )  # fmt: skip
    x0 = np.array([0, 0, -900.0, 0.998, 0.05, 0.02, 0.01, 45.0, 2.0, 1.0, 0.2, -0.1, 0.1])
    states, outputs = np.empty((1000, 13)), np.empty((1000, 17))
    assert model.fly(x0, np.tile([0, 0, 0, 0, 0, 700.0], (1000, 1)), 0.01, 1, states, outputs)
    return np.hstack([states, outputs])


def test_baseline_and_v3_agree() -> None:
    if ISA == "baseline":
        pytest.skip("this processor has no AVX2, or the baseline was asked for")
    a, b = flown("_core"), flown("_core_v3")
    assert np.isfinite(a).all()
    # The design's promise: 1e-10 between instruction sets (relative to each column's size).
    scale = np.abs(a).max(axis=0).clip(1.0)
    np.testing.assert_allclose(a / scale, b / scale, rtol=0, atol=1e-10)


def test_same_flight_is_the_same_bytes() -> None:
    module = "_core" if ISA == "baseline" else "_core_v3"
    assert flown(module).tobytes() == flown(module).tobytes()
