"""What flights of the a-priori model will tell, by the method that is to identify them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from alula.base.messages import refuse
from alula.identify.coefficients import Reference
from alula.identify.equation_error.task import LONGITUDINAL
from alula.identify.flown.measured_maneuver import CONTROLS, OUTPUTS, STATES, MeasuredManeuver
from alula.identify.flown.problem import STATE_SETS
from alula.identify.flown.usual_outputs import USUAL_OUTPUTS
from alula.model import AeroModel
from alula.plan.information import Flown, Prediction, predict
from alula.plan.output_error_information import predict_output_error
from alula.simulate.airframe import Airframe
from alula.simulate.fly import SimulatedFlight

Method = Literal["ee", "oe"]


def expected(
    method: Method,
    flights: Sequence[SimulatedFlight],
    frame: Airframe,
    model: AeroModel,
    formulas: Mapping[str, str],
    sigma: Mapping[str, float],
) -> tuple[Prediction, ...]:
    """Standard errors of the parameters of `formulas` by all flights together.

    method: equation error or output error, as `alula identify` takes them; the latter longitudinal
    and lateral models each on the maneuvers of their aspect, with the readings that it compares
    where none are chosen, as far as they have a `sigma` above zero. Raises BadInput where no such
    reading is left.
    """
    if method == "ee":
        flown = [Flown(f.motion, frame.mass, frame.inertia) for f in flights]
        return predict(flown, model, formulas, sigma)
    out: list[Prediction] = []
    for aspect in ("longitudinal", "lateral"):
        own = {c: f for c, f in formulas.items() if (c in LONGITUDINAL) == (aspect != "lateral")}
        serving = [f for f in flights if f.motion.maneuver.aspect in (aspect, "both")]
        if not own or not serving:
            continue
        outputs = tuple(n for n in USUAL_OUTPUTS[aspect] if sigma.get(n, 0.0) > 0.0)
        if not outputs:
            raise refuse(
                "missing_sigma",
                where=f"plan, output error, {aspect}",
                expected="a sigma for at least one of " + ", ".join(USUAL_OUTPUTS[aspect]),
                found="none",
                do="State the sensors' noise.",
            )
        out += predict_output_error(
            [without_noise(f, frame, model) for f in serving],
            model,
            own,
            sigma,
            states=STATE_SETS[aspect],
            outputs=outputs,
        )
    return tuple(out)


def without_noise(flight: SimulatedFlight, frame: Airframe, model: AeroModel) -> MeasuredManeuver:
    """A flight as output error takes it: every reading exact and at the center of gravity."""
    m, r = flight.motion, model.reference
    point = np.asarray(model.reference_point)
    recorded = dict(m.recorded)
    if {"CD", "CL"} <= recorded.keys():  # without a formula they are asked for in body axes
        sine, cosine = np.sin(m.alpha), np.cos(m.alpha)
        recorded["CX"] = recorded["CL"] * sine - recorded["CD"] * cosine
        recorded["CZ"] = -recorded["CL"] * cosine - recorded["CD"] * sine
    return MeasuredManeuver(
        maneuver=m.maneuver,
        t=m.t,
        outputs={name: getattr(m, name) for name in OUTPUTS},
        motion={name: getattr(m, name) for name in STATES},
        controls={k: v for k, v in m.controls.items() if k in CONTROLS},
        rho=m.rho,
        reference=Reference(r.S, r.b, r.c, point),
        mass=frame.mass,
        inertia=np.array(frame.inertia),
        speed_of_sound=m.V / np.maximum(flight.mach, 1e-9),
        force=flight.engine_force,
        moment=flight.engine_moment,
        arm=point - np.asarray(frame.cg),
        coefficients=recorded,
    )
