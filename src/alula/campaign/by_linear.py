"""Methods that fly the linear equations of flight: output error, filter error, with delays.

`equations = "linear"` in [identify.options]. The equations are those of the mean flight of all
maneuvers to learn from, in total states, so that parameters carry the names of the formulas.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, warn
from alula.campaign.by_outputs import (
    LATERAL_OUTPUTS,
    TABLES,
    left_aside,
    of_formulas,
    of_part,
    parts_of,
    searching,
    serving,
)
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.options import bad_option
from alula.identify import Identification
from alula.identify.flown.measured_maneuver import CONTROLS, MeasuredManeuver
from alula.identify.flown.saturation import without_saturated
from alula.identify.flown.start import regressor_variables
from alula.identify.linear.flight import LATERAL, LONGITUDINAL, SteadyFlight, linear_flight_model
from alula.identify.linear.record import linear_record
from alula.identify.merge import merged
from alula.identify.parameter_unit import with_units
from alula.identify.trust.control_sign import contradicted, signs_checked
from alula.identify.trust.feedback import feedback, warn_of_feedback
from alula.identify.typical import constant_name
from alula.model import parse, reference_scales

# How far a maneuver may go from the mean flight. A tenth of the airspeed is a fifth of the dynamic
# pressure; at 20 deg of bank the sine has lost 2 %, and the turn adds a pitch rate.
AIRSPEED, ANGLE, BANK = 0.1, np.deg2rad(6.0), np.deg2rad(20.0)


def by_linear(
    task: IdentifyTask, identify: Callable[..., Identification], *, in_time: bool = True
) -> Identification:
    """Longitudinal and lateral linear models, each on the maneuvers of its aspect.

    in_time: constants count, and are each maneuver's own where the options do not say otherwise.
    """
    options = searching(task.options)
    options.pop("equations")
    states, asked = options.pop("states", "auto"), options.pop("outputs", None)
    late = options.get("delayed", [])
    driven = _controls(task.models)
    if strange := [u for u in late if u not in driven]:
        raise bad_option("delayed", "some of " + ", ".join(driven), ", ".join(strange))
    if states != "auto" and isinstance(states, str):
        raise bad_option("states", '"auto" or a list such as ["alpha", "q"]', repr(states))
    maneuvers, messages, _ = task.measure()
    results, owns = [], []
    for name, models in parts_of(task.models):
        axis = LATERAL if name == "lateral" else LONGITUDINAL
        wanted = [o for o in asked or () if (o in LATERAL_OUTPUTS) == (name == "lateral")]
        chosen = [] if states == "auto" else [s for s in axis if s in states]
        own = of_part(options, name)
        owns.append(dict(own))
        if late:
            own["delayed"] = [u for u in late if u in _controls(models)]
            others = {f"delay_{u}" for u in {*late} - {*own["delayed"]}}
            own |= {k: _without(own[k], others) for k in TABLES & own.keys()}
        if in_time and not own.pop("common_constant", False):
            own["own"] = [constant_name(c) for c in models]
        part = serving(maneuvers, models)
        chosen = chosen or _states(models, axis)
        results.append(_part(part, models, chosen, wanted, identify, own, task.truth))
    result = merged(results)
    said = (*messages, *left_aside(options, owns))
    return replace(result, messages=(*said, *result.messages))


def _part(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    states: Sequence[str],
    asked: Sequence[str],
    identify: Callable[..., Identification],
    options: dict[str, Any],
    truth: Mapping[str, float] | None,
) -> Identification:
    whole = [without_saturated(m) for m in maneuvers]
    maneuvers = [m for m, _ in whole]
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    controls = _controls(models)
    outputs = asked or [
        s for s in states
        if all(s in m.outputs and np.isfinite(m.outputs[s]).any() for m in maneuvers)
    ]  # fmt: skip
    tied = options.pop("tied", {})
    model = linear_flight_model(
        _steady(learn), models, controls=controls, states=states, outputs=outputs, total=True,
        tied=tied,
    )  # fmt: skip
    records = [
        linear_record(
            m.maneuver.id,
            m.t,
            {**m.controls, **m.outputs, **_as_measured(m, model.inputs)},
            model,
            m.maneuver.held_out,
        )
        for m in maneuvers
    ]
    if "own" in options:
        options["own"] = [n for n in options["own"] if n in model.parameters]
    enough = {n: v for c, f in models.items() for n, v in reference_scales(c, f).items()}
    options["scales"] = {**enough, **options.get("scales", {})}
    found = identify(model, records, **options, truth=truth)
    parameters = tuple(
        replace(p, coefficient=_belongs(p.name, p.coefficient, models)) for p in found.parameters
    )
    parameters = with_units(replace(found, parameters=parameters)).parameters
    parameters, turned = signs_checked(parameters)
    if far := _far(learn):
        parameters = tuple(
            replace(p, verdict="weak") if p.verdict == "ok" else p for p in parameters
        )
    said = [*(m for _, saturated in whole for m in saturated), *far]
    for c, formula in models.items():
        names = sorted({v for term in parse(formula) for f in term.factors for v in f.variables})
        said += warn_of_feedback(c, feedback([regressor_variables(m) for m in learn], names))
    return replace(
        found,
        parameters=parameters,
        fits={k: replace(fit, formula="") for k, fit in found.fits.items()},
        formulas=dict(models),
        fixed=of_formulas(options.get("fixed", {}), models),
        tied=tied,
        messages=(*said, *found.messages, *turned),
        status=found.status
        + contradicted(turned)
        + "".join(f"; beyond linear equations: {m.where}" for m in far),
    )


def _without(given: Mapping[str, Any], names: Collection[str]) -> dict[str, Any]:
    return {k: v for k, v in given.items() if k not in names}


def _as_measured(m: MeasuredManeuver, inputs: Sequence[str]) -> dict[str, Array]:
    """States that drive the model: the motion's, which has no holes."""
    return {s: m.motion[s] for s in inputs if s in m.motion}


def _controls(models: Mapping[str, str]) -> list[str]:
    named = {
        v for f in models.values() for term in parse(f) for x in term.factors for v in x.variables
    }
    return [c for c in CONTROLS if c in named]


def _states(models: Mapping[str, str], axis: Sequence[str]) -> list[str]:
    """Those whose rates the formulas tell; V is as measured where there is none of the drag."""
    lost = {"V": {"CD"}, "alpha": {"CL"}, "q": {"Cm"}, "beta": {"CY"}, "p": {"Cl"}, "r": {"Cn"}}
    return [s for s in axis if s not in lost or lost[s] & models.keys()]


def _steady(learn: Sequence[MeasuredManeuver]) -> SteadyFlight:
    """The mean flight, wings level."""
    first = learn[0]

    def mean(of: Callable[[MeasuredManeuver], Array]) -> Array:
        out: Array = np.mean(np.concatenate([of(m) for m in learn]), axis=0)
        return out

    force, moment = mean(lambda m: m.force), mean(lambda m: m.moment)
    arm = np.mean([m.arm for m in learn], axis=0)
    return SteadyFlight(
        V=float(mean(lambda m: m.motion["V"])),
        alpha=float(mean(lambda m: m.motion["alpha"])),
        theta=float(mean(lambda m: m.motion["theta"])),
        rho=float(mean(lambda m: m.rho)),
        mass=float(np.mean([m.mass for m in learn])),
        inertia=np.mean([m.inertia for m in learn], axis=0),
        S=first.reference.S,
        b=first.reference.b,
        c=first.reference.c,
        thrust=float(force[0]),
        gravity=first.gravity,
        thrust_z=float(force[2]),
        thrust_moment=(float(moment[0]), float(moment[1]), float(moment[2])),
        arm=(float(arm[0]), float(arm[1]), float(arm[2])),
    )


def _far(learn: Sequence[MeasuredManeuver]) -> tuple[Message, ...]:
    """A warning for each maneuver that goes beyond what linear equations describe."""
    steady = _steady(learn)
    out = []
    for m in learn:
        V, alpha, phi = (
            float(np.max(np.abs(m.motion[n] - at)))
            for n, at in (("V", steady.V), ("alpha", steady.alpha), ("phi", 0.0))
        )
        if V > AIRSPEED * steady.V or alpha > ANGLE or phi > BANK:
            out.append(
                warn(
                    "beyond_linear",
                    where=f"maneuver {m.maneuver.id}",
                    expected=f"within {AIRSPEED:.0%} of {steady.V:.1f} m/s, "
                    f"{np.rad2deg(ANGLE):.0f} deg of alpha {np.rad2deg(steady.alpha):.1f} deg, "
                    f"and {np.rad2deg(BANK):.0f} deg of bank",
                    found=f"up to {V / steady.V:.0%}, {np.rad2deg(alpha):.0f} deg and "
                    f"{np.rad2deg(phi):.0f} deg from it",
                    do="No derivative counts as resolved: take a smaller maneuver, this one alone, "
                    'or equations = "flight".',
                )
            )
    return tuple(out)


def _belongs(name: str, row: str, models: Mapping[str, str]) -> str:
    """The coefficient of a derivative; else the state or output."""
    head = name.split("_")[0]
    return head if head in models else row.removesuffix("dot")
