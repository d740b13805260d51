"""Output error of an aircraft that is unstable without its feedback.

The SportStar with its center of gravity at 44 % of the chord: moments transferred by the lift, so
that Cm_alpha is positive. A linear feedback of alpha and q to the elevator holds it; an input on
top of the feedback moves it. The states of the model are pulled to their measurements.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.aircraft import Actuator
from alula.base.arrays import Array
from alula.identify.flown.output_error import identify_output_error
from alula.identify.result import Identification
from alula.simulate import Condition, SimulatedFlight, linearize, trim
from alula.simulate.airframe import core_model
from alula.simulate.inputs import Steps
from verification.estimation.noisy_flights import LONGITUDINAL, Aircraft, flown, measured, sportstar

FORMULAS = {"CD": "1 + alpha", "CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}
DERIVATIVES = ("CL_alpha", "CL_q", "CL_de", "Cm_alpha", "Cm_q", "Cm_de")
AFT = 0.14  # of the chord, behind the 30 % of the aircraft file
GAINS = {("de", "alpha"): -0.5, ("de", "q"): -0.2}  # rad per rad, rad per rad/s
PULL = {"alpha": 0.3, "q": 0.3}  # 1/s, little more than the growth without feedback
DEG = np.pi / 180.0


def aft_sportstar() -> Aircraft:
    """The SportStar whose moments are about a point behind the neutral point.

    A servo moves the elevator, so that what is recorded is as smooth as what was flown.
    """
    front = sportstar().model.params
    moved = {
        f"Cm_{x}": front[f"Cm_{x}"] + AFT * front[f"CL_{x}"] for x in ("0", "alpha", "q", "de")
    }
    aircraft = sportstar(moved)
    servo = Actuator(tau=0.05, rate_limit=np.inf, low=-0.5, high=0.5, dead_band=0.0)
    return replace(aircraft, airframe=replace(aircraft.airframe, actuators={"de": servo}))


def flight_in_loop(aircraft: Aircraft, amplitude: float = 3.0 * DEG) -> SimulatedFlight:
    """12 s with feedback; amplitude: of the input on top, rad."""
    signal = Steps(amplitude, 1.0, (1.2, 0.8, 0.4, 0.4), (-1.0, 1.0, -1.0, 1.0), 0.1)
    return flown(
        aircraft, "loop", {"de": signal}, seconds=12.0, rate=100.0, aspect="longitudinal",
        gains=GAINS,
    )  # fmt: skip


def identified(aircraft: Aircraft, flight: SimulatedFlight, seed: int) -> Identification:
    """Output error with the seed's noise."""
    return identify_output_error(
        [measured(aircraft, flight, LONGITUDINAL, seed)],
        FORMULAS,
        outputs=LONGITUDINAL,
        stabilize=PULL,
        truth=aircraft.model.params,
    )


def loop_alone(seed: int = 0) -> Identification:
    """Nobody but the feedback moves the elevator, after a disturbance of 6 deg/s; no servo."""
    aircraft = aft_sportstar()
    bare = replace(aircraft, airframe=replace(aircraft.airframe, actuators={}))
    flight = flown(
        bare, "loop", {}, seconds=12.0, rate=100.0, aspect="longitudinal", gains=GAINS,
        disturbed=6.0 * DEG,
    )  # fmt: skip
    return identified(bare, flight, seed)


def growth(aircraft: Aircraft) -> float:
    """Fastest growth of the aircraft without feedback, 1/s."""
    start = trim(aircraft.airframe, aircraft.model, Condition(38.0, 915.0))
    plant = core_model(aircraft.airframe, aircraft.model)
    A = linearize(plant, start.state, start.inputs).longitudinal().A
    return float(np.max(np.linalg.eigvals(A).real))


def errors(found: Identification) -> Array:
    """(6,) deviations of the derivatives in their standard errors; NaN where there is no value."""
    parts = [found[n] for n in DERIVATIVES]
    return np.array([(p.value - float(p.truth or 0.0)) / p.se for p in parts])


def unstable(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds.

    Of honest estimates 95 % lie within two standard errors: the share over all flights is judged,
    and each derivative's mean error, within three standard deviations of a mean of so many and a
    third of a standard error, which the noise that enters by the pull may make of bias.
    """
    aircraft = aft_sportstar()
    flight = flight_in_loop(aircraft)
    runs = 8 if quick else 30
    results = [identified(aircraft, flight, seed) for seed in range(runs)]
    z = np.array([errors(r) for r in results])
    share, bias = float(np.mean(np.abs(z) < 2.0)), np.abs(z.mean(axis=0))
    weak = loop_alone()
    said = [m for m in weak.messages if m.code == "control_follows_states"]
    law = said[0].found if said else "no message"
    wrong = [n for n, e in zip(DERIVATIVES, errors(weak), strict=True)
             if weak[n].verdict == "ok" and abs(e) > 4.0]  # fmt: skip
    rates = growth(aircraft)
    got = (
        f"Cm_alpha {aircraft.model.params['Cm_alpha']:+.2f}, open loop grows with {rates:.2f}/s; "
        f"{runs} flights: {share:.1%} of {z.size} derivatives within two standard errors, none "
        f"further than {np.max(np.abs(z)):.1f}, largest mean error "
        f"{np.max(bias):.2f} ({DERIVATIVES[int(np.argmax(bias))]}); feedback alone: {law}"
    )
    holds = share >= (0.85 if quick else 0.92) and bool(np.all(bias < 3.0 / np.sqrt(runs) + 0.35))
    return got, holds and rates > 0.0 and bool(said) and not wrong
