"""Units of derivatives, states, biases and noises, worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest

from alula.identify.linear.filter_error import identify_filter_error
from alula.identify.linear.model import linear_model
from alula.identify.linear.output_error import identify_linear_output_error
from alula.identify.linear.record import linear_record
from alula.identify.parameter_unit import parameter_unit


@pytest.mark.parametrize(
    ("belongs", "name", "unit"),
    [
        ("Cm", "Cm_alpha", "1/rad"),
        ("Cm", "Cm_0[elevator]", "1"),
        # a white-noise drive of x' has (unit of x)/s per root of a hertz: unit of x per root second
        ("alpha", "F_alpha", "rad/s^0.5"),
        ("q", "F_q", "rad/s^1.5"),
        ("V", "F_V", "m/s^1.5"),
        ("az", "sigma_az", "m/s2"),
        ("q", "sigma_q", "rad/s"),
        ("q", "q(0)[elevator]", "rad/s"),
        ("alpha", "alpha(0)[elevator]", "rad"),
        ("az", "b_az[elevator]", "m/s2"),
        ("own", "F_own", ""),
        ("de", "delay_de", "s"),
        ("p", "p_0", ""),
        ("own", "sigma_own", ""),
    ],
)
def test_unit(belongs: str, name: str, unit: str) -> None:
    assert parameter_unit(belongs, name) == unit


def test_a_linear_model_has_them_but_of_what_its_rows_call_their_own() -> None:
    """Lp has no name that tells its unit, `p_0` is no derivative of a coefficient."""
    rng = np.random.default_rng(0)
    t = 0.04 * np.arange(200)
    da = 0.06 * np.sign(np.sin(3.0 * t))
    p = np.zeros(200)
    for i in range(199):
        p[i + 1] = 0.9 * p[i] + 0.4 * da[i] + 0.01 * rng.standard_normal()
    model = linear_model({"p": "Lp*p + Lda*da + p_0"}, ["p"], ["da"])
    z = p + 0.01 * rng.standard_normal(200)
    records = [linear_record("roll", t, {"p": z, "da": da}, model)]
    by_filter = identify_filter_error(model, records)
    units = {q.name: q.unit for q in by_filter.parameters}
    assert units == {
        "Lp": "", "Lda": "", "p_0": "", "p(0)[roll]": "rad/s", "F_p": "rad/s^1.5",
        "sigma_p": "rad/s",
    }  # fmt: skip
    row = next(line for line in by_filter.summary().splitlines() if line.startswith("F_p"))
    assert " rad/s^1.5 " in row
    by_output = identify_linear_output_error(model, records)
    assert by_output["p(0)[roll]"].unit == "rad/s"
