"""When the controls moved and when they were left alone."""

from __future__ import annotations

import numpy as np
import pytest

from alula.simulate import Sum, doublet, input_3211
from alula.validate.windows import find_input, free_response

T = np.arange(0.0, 20.0, 0.02)
DEG = np.pi / 180.0


def test_input_of_a_doublet() -> None:
    controls = {"de": 0.03 + doublet(3.0 * DEG, 2.0, 1.0).value(T), "da": np.zeros(len(T))}
    found = find_input(T, controls, "longitudinal")
    assert found is not None
    assert found.control == "de"
    assert (found.start, found.end) == pytest.approx((2.0, 4.0), abs=0.021)  # one sample


def test_main_control_is_the_one_that_travels_most() -> None:
    controls = {
        "da": doublet(2.0 * DEG, 2.0, 1.0).value(T),
        "dr": doublet(5.0 * DEG, 6.0, 1.0).value(T),
    }
    found = find_input(T, controls, "lateral")
    assert found is not None
    assert found.control == "dr"
    assert (found.start, found.end) == pytest.approx((2.0, 8.0), abs=0.021)


@pytest.mark.parametrize("aspect", ["longitudinal", "lateral", "both"])
def test_tremor_is_no_input(aspect: str) -> None:
    tremor = 0.1 * DEG * np.sin(9.0 * T)
    assert find_input(T, {"de": tremor, "da": tremor, "dr": tremor}, aspect) is None
    assert free_response(T, {"de": tremor}, aspect) == slice(0, len(T))


def test_free_response_is_the_longest_quiet_stretch_after_the_input() -> None:
    """Two inputs: between them 5 s, after the second 6 s; before the first 3 s do not count."""
    u = Sum((input_3211(3.0 * DEG, 3.0, 0.4), doublet(3.0 * DEG, 10.8, 1.6)))
    controls = {"de": u.value(T), "da": 0.05 * DEG * np.sin(5.0 * T)}
    free = free_response(T, controls, "both")
    assert T[free][0] == pytest.approx(14.0, abs=0.021)
    assert free.stop == len(T)


def test_a_small_second_surface_does_not_end_the_quiet() -> None:
    """Half a degree of aileron beside 8 degrees of rudder: within a tenth of the input."""
    controls = {
        "dr": doublet(4.0 * DEG, 2.0, 1.0).value(T),
        "da": 0.3 * DEG * np.sin(2.0 * T),
    }
    free = free_response(T, controls, "lateral")
    assert T[free][0] == pytest.approx(4.0, abs=0.021)
