"""A predicted model as what output error knows before the flight."""

from __future__ import annotations

import numpy as np
import pytest

from alula.identify.flown.output_error import identify_output_error
from alula.identify.likelihood.parameters import Prior
from alula.model import Reference
from alula.predict.combine import combine
from alula.predict.flow import Flow
from alula.predict.semi_empirical import from_geometry
from alula.predict.to_model import priors, to_model
from identify.flown_maneuvers import CHORD, LATERAL, SPAN, S, every_axis, flown
from predict.predicted_shapes import light_airplane

OUTPUTS = ("beta", "p", "r", "phi", "ay")


def without_rudder(t: np.ndarray) -> dict[str, np.ndarray]:
    return {**every_axis(t), "dr": np.zeros_like(t)}


def test_what_the_flight_does_not_show_stays_as_predicted() -> None:
    """The rudder never moves: its derivatives keep the prediction and its error, others do not."""
    prediction = combine(
        [from_geometry(light_airplane(), S, SPAN, CHORD, np.zeros(3), Flow(V=45.0, alpha=0.05))]
    )
    model = to_model(prediction, Reference(S, SPAN, CHORD), np.zeros(3), name="before")
    terms = [n for n in priors(model) if n.split("_")[0] in LATERAL]
    known = {n: Prior(*priors(model)[n]) for n in terms if n not in ("CY_p", "CY_r")}
    found = identify_output_error(
        [flown(without_rudder, seed=2)], LATERAL, states="lateral", outputs=OUTPUTS, priors=known,
        start={n: p.mean for n, p in known.items()},
    )  # fmt: skip
    assert found.status.startswith("converged")
    for name in ("CY_dr", "Cl_dr", "Cn_dr"):
        assert found[name].value == pytest.approx(known[name].mean, rel=1e-6)
        assert found[name].se == pytest.approx(known[name].se, rel=1e-6)
    # What the ailerons do show is known far better than before.
    assert found["Cl_p"].se < 0.3 * known["Cl_p"].se
