"""ATTAS, three real maneuvers: published biases, kinematic mismatch, methods beside each other."""

import numpy as np
import pytest

from real import reconstructed
from verification.main_job.published import ATTAS_BIASES


@pytest.fixture(scope="module")
def solved():
    return reconstructed("attas", "ml", "ekf", "ukf")


def constants(result):
    return {c.name: c for c in result.constants}


@pytest.mark.parametrize("name", ATTAS_BIASES)
def test_output_error_finds_the_published_biases(solved, name):
    value, tolerance = ATTAS_BIASES[name]
    assert constants(solved["ml"])[name].value == pytest.approx(value, abs=tolerance)


@pytest.mark.parametrize("method", ["ml", "ekf", "ukf"])
def test_kinematics_with_the_estimates_fit_the_measurements(solved, method):
    assert solved[method].converged
    for segment in solved[method].segments:
        # The publication's own mismatch is 0.1 to 0.4 m/s, 0.12 to 0.15 deg, 0.1 to 0.2 deg.
        assert segment.mismatch["V"] < 0.3
        assert np.rad2deg(segment.mismatch["alpha"]) < 0.2
        assert np.rad2deg(segment.mismatch["theta"]) < 0.2


@pytest.mark.parametrize("method", ["ekf", "ukf"])
@pytest.mark.parametrize("name", ATTAS_BIASES)
def test_filters_agree_with_the_publication_within_their_own_errors(solved, method, name):
    constant = constants(solved[method])[name]
    assert abs(constant.value - ATTAS_BIASES[name][0]) < 3.0 * constant.se


@pytest.mark.parametrize("name", ATTAS_BIASES)
def test_filters_agree_with_each_other(solved, name):
    ekf, ukf = constants(solved["ekf"])[name], constants(solved["ukf"])[name]
    # One model, one weighting: what differs is the treatment of curvature, far below the errors.
    assert abs(ekf.value - ukf.value) < 0.1 * ekf.se


def test_errors_of_filter_and_output_error_are_of_one_size(solved):
    """The innovations are coloured; the filter's own covariance would be six times too small."""
    for name, constant in constants(solved["ekf"]).items():
        ratio = constant.se / constants(solved["ml"])[name].se
        # Different weightings, and a coloured error known to some 30 % from three maneuvers.
        assert 0.3 < ratio < 6.0
