"""Flights whose model is known: a light aircraft flown by a truth, recorded without error."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.flight import Maneuver, Motion
from alula.identify import Reference as DataReference
from alula.identify.coefficients import regressor_variables
from alula.model import AeroModel, load_model
from alula.simulate import Airframe, Signal, airframe_of, doublet, fly, input_3211, trim_level
from alula.validate import Case

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
DEG = np.pi / 180.0
RATE = 50.0


def truth() -> AeroModel:
    """The SportStar's attached flow, with no limits to where it holds."""
    return replace(load_model(AIRCRAFT / "sportstar_aero.toml"), stall=None, validity={})


def airframe() -> Airframe:
    return airframe_of(load_aircraft(AIRCRAFT / "sportstar.toml"))


def changed(model: AeroModel, **factors: float) -> AeroModel:
    """The model with parameters multiplied: changed(m, Cm_alpha=-1.0)."""
    values = np.array(model.values)
    for name, factor in factors.items():
        values[model.names.index(name)] *= factor
    return replace(model, values=values)


def case(
    maneuver: Maneuver, inputs: dict[str, Signal], *, height: float = 900.0, **options: object
) -> Case:
    """A maneuver of the truth from trimmed level flight at 45 m/s."""
    model, frame = truth(), airframe()
    trim = trim_level(frame, model, 45.0, height)
    t = maneuver.start + np.arange(round((maneuver.end - maneuver.start) * RATE) + 1) / RATE
    controls: dict[str, Array | float] = {**trim.controls, "thrust": trim.thrust}
    for name, signal in inputs.items():
        controls[name] = trim.controls[name] + signal.value(t - t[0])
    flown = fly(frame, model, trim.state, t, controls, substeps=2, maneuver=maneuver).motion
    return as_case(flown, **options)


def as_case(motion: Motion, **options: object) -> Case:
    model = truth()
    r = model.reference
    reference = DataReference(r.S, r.b, r.c, model.reference_point)
    settings = {
        "motion": motion,
        "airframe": airframe(),
        "seen": "no",
        "area": r.S,
        "thrust": motion.thrust,
        "coefficients": motion.recorded,
        "variables": regressor_variables(replace(motion, recorded={}), reference),
        **options,
    }
    return Case(**settings)  # type: ignore[arg-type]


def elevator(**options: object) -> Case:
    """A 3-2-1-1 that begins at 1 s of 12 s."""
    maneuver = Maneuver("elevator", "log", "3211", 100.0, 112.0, "longitudinal")
    return case(maneuver, {"de": input_3211(-2.0 * DEG, 1.0, 0.45, ramp=0.2)}, **options)


def aileron(**options: object) -> Case:
    maneuver = Maneuver("aileron", "log", "doublet", 0.0, 12.0, "lateral")
    return case(maneuver, {"da": doublet(6.0 * DEG, 1.0, 0.8, ramp=0.2)}, **options)


def rudder(**options: object) -> Case:
    maneuver = Maneuver("rudder", "log", "doublet", 0.0, 20.0, "lateral")
    return case(maneuver, {"dr": doublet(6.0 * DEG, 1.0, 0.8, ramp=0.2)}, **options)
