"""Output error of a real flight against its published estimates, values and bounds of one fit."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.io import loadmat

from data import data
from verification.estimation.twin_otter_output_error import (
    FLOWN,
    PUBLISHED,
    compared,
    identified,
    maneuver,
)


@pytest.fixture(scope="module")
def flown():
    recording = data("twin_otter", "totter_lon_020213f1_018.mat")
    return maneuver(np.asarray(loadmat(recording)["fdata"], dtype=np.float64))


@pytest.fixture(scope="module")
def found(flown):
    return compared(flown, identified(flown))


def test_values(found) -> None:
    for name, (value, se) in PUBLISHED.items():
        # The same model and data: what is left is another integration, a tenth of a standard error.
        assert abs(found[name][0] - value) < 0.1 * se, name


def test_bounds(found) -> None:
    for name, (_, se) in PUBLISHED.items():
        # Two estimators of a coloured bound differ by so much on 400 samples.
        assert 1.0 / 1.5 < found[name][1] / se < 1.5, name


def test_damping_by_the_flown_rate_is_another_model(flown) -> None:
    """It fits q better: its own noise is not fed back through the damping. Values agree weakly."""
    other = identified(flown, FLOWN)
    for name, (value, _) in compared(flown, other).items():
        if name != "Cm_0":  # two of the published standard errors
            assert abs(value - PUBLISHED[name][0]) < 2.0 * PUBLISHED[name][1], name
    assert other.fits["q"].rrmse < identified(flown).fits["q"].rrmse
