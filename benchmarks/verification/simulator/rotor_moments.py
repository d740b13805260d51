"""Signs of what a turning propeller does to the airframe, about all three axes, both senses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.model import load_model
from alula.simulate import airframe_of, fly, initial_state
from alula.simulate.airframe import Airframe
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
OMEGA, RATE, SHIFT = 230.0, 0.5, 0.4  # rad/s of the propeller, rad/s of the aircraft, m


def moment(sense: float, rates: tuple[float, float, float], throttle: float, arm: Array) -> Array:
    """Moment (3,) N m of SportStar's engine at 45 m/s; arm: (3,) m added to its position."""
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    model = load_model(AIRCRAFT / "sportstar_aero.toml")
    frame = airframe_of(aircraft, engines="modeled")
    turned = replace(frame, engines=(_turned(frame, sense, arm),))
    state = initial_state(45.0, 0.03, 0.03, 500.0, rates=rates)
    t = np.array([0.0, 1e-4])
    controls = {"dt": throttle}
    settled = fly(turned, model, state, t, controls, stall=False).plant_states[0].copy()
    settled[13] = OMEGA  # the further state of a piston engine
    return np.asarray(fly(turned, model, settled, t, controls, stall=False).engine_moment[0])


def _turned(frame: Airframe, sense: float, arm: Array):
    engine = frame.engines[0]
    propeller = replace(engine.machine.propeller, sense=sense)
    return replace(
        engine,
        position=engine.position + arm,
        machine=replace(engine.machine, propeller=propeller),
    )


def check(quick: bool = False) -> tuple[str, bool]:
    """Which signs are wrong, and whether none is."""
    wrong = []
    none, zero = np.zeros(3), (0.0, 0.0, 0.0)

    def expect(what: str, value: float, sign: float) -> None:
        if not value * sign > 0.0:
            wrong.append(f"{what}: {value:.3g} N m")

    for sense in (1.0, -1.0):
        turning = "clockwise" if sense > 0 else "counterclockwise"
        still = moment(sense, zero, 0.7, none)
        # Clockwise from behind: the airframe is rolled to the left, more so while it speeds up.
        expect(f"{turning}, torque", still[0], -sense)
        faster = moment(sense, zero, 1.0, none) - still
        expect(f"{turning}, opened throttle", faster[0], -sense)
        # -w x h: nose up (q) yaws a clockwise one right, nose right (r) pitches it down.
        expect(f"{turning}, pitch rate", moment(sense, (0.0, RATE, 0.0), 0.7, none)[2], sense)
        pitched = moment(sense, (0.0, 0.0, RATE), 0.7, none) - still
        expect(f"{turning}, yaw rate", pitched[1], -sense)
        # Rolling about the propeller's own axis leaves its momentum where it is.
        rolled = moment(sense, (RATE, 0.0, 0.0), 0.7, none) - still
        if max(abs(rolled[1]), abs(rolled[2])) > 1e-9 + 0.02 * abs(pitched[1]):
            wrong.append(f"{turning}, roll rate: {rolled[1]:.3g}, {rolled[2]:.3g} N m")
        # Thrust above pitches down, to the right yaws left, whatever the sense.
        above = moment(sense, zero, 0.7, np.array([0.0, 0.0, -SHIFT])) - still
        beside = moment(sense, zero, 0.7, np.array([0.0, SHIFT, 0.0])) - still
        expect(f"{turning}, thrust above", above[1], -1.0)
        expect(f"{turning}, thrust to the right", beside[2], -1.0)
    count = 2 * 7
    text = f"{count - len(wrong)} of {count} signs as mechanics has them"
    return text + (f"; wrong: {'; '.join(wrong)}" if wrong else ""), not wrong
