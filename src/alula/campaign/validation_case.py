"""What validation by flying needs of one maneuver, from the stages before it."""

from __future__ import annotations

import numpy as np

from alula.base.messages import Message, warn
from alula.campaign.check import Checked
from alula.campaign.learned import seen_by
from alula.identify import CoefficientData
from alula.identify.coefficients import Reference, regressor_variables
from alula.model import AeroModel
from alula.reconstruct import Segment
from alula.reconstruct.transfer import engines_on
from alula.simulate import airframe_of
from alula.validate import Case

UNEQUAL = 0.02  # of the sum of thrusts, mean difference of an engine from the others


def unequal_thrust(checked: Checked, segment: Segment) -> list[Message]:
    """A warning where engines pull unequally: the simulator is given their sum, shared evenly."""
    aircraft = checked.aircraft_of(segment.maneuver.log)
    flight = checked.flights[segment.maneuver.log]
    forces = engines_on(flight, aircraft, segment.motion.t)
    if len(forces) < 2:
        return []
    each = np.array(list(forces.values()))
    total = np.abs(each.sum(axis=0)).mean()
    off = float(np.abs(each - each.mean(axis=0)).mean())
    if total == 0.0 or off <= UNEQUAL * total:
        return []
    return [
        warn(
            "unequal_thrust",
            where=f"maneuver {segment.maneuver.id}",
            expected="engines that pull alike",
            found=f"thrusts that differ from their mean by {100.0 * off / total:.2g} % of the sum",
            do="The sum was flown, shared evenly: the moment of the difference is missing.",
        )
    ]


def case_of(checked: Checked, segment: Segment, item: CoefficientData, model: AeroModel) -> Case:
    """What validation needs of one maneuver, from the stages before it."""
    motion, flight = segment.motion, checked.flights[segment.maneuver.log]
    aircraft = checked.aircraft_of(segment.maneuver.log)
    forces = engines_on(flight, aircraft, motion.t)
    reference = Reference(
        model.reference.S, model.reference.b, model.reference.c, model.reference_point
    )
    fuel = 0.0 if motion.fuel_used is None else float(motion.fuel_used[0])
    given = ("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "psi", "h", "ax", "ay", "az")
    filtered = {*segment.state_names, "V", "alpha", "beta"} if segment.state_names else set()
    return Case(
        motion=motion,
        airframe=airframe_of(aircraft, fuel),
        seen=seen_by(model, segment.maneuver, flight),
        area=aircraft.S,
        thrust=sum(forces.values(), np.zeros(len(motion.t))) if forces else None,
        coefficients=item.coefficients,
        variables=regressor_variables(motion, reference),
        missing=tuple(n for n in given if n not in flight and n not in filtered),
        force=np.asarray(
            sum(
                (
                    np.outer(forces[e.name], e.direction)
                    for e in aircraft.engines
                    if e.name in forces
                ),
                np.zeros((len(motion.t), 3)),
            )
        ),
    )
