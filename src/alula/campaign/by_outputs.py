"""Methods that compare outputs: which maneuvers, states, outputs and options each part gets."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from alula.base.messages import refuse
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.options import bad_option, factors, one_of, priors_of
from alula.identify import Identification
from alula.identify.equation_error.task import LONGITUDINAL
from alula.identify.flown.carried import carried
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_error import identify_output_error
from alula.identify.flown.problem import STATE_SETS, Setting
from alula.identify.flown.usual_outputs import USUAL_OUTPUTS
from alula.identify.merge import merged
from alula.identify.parameter_unit import with_units

LATERAL_OUTPUTS = frozenset({"beta", "p", "r", "phi", "ay", "pdot", "rdot"})


def by_outputs(
    task: IdentifyTask,
    identify: Callable[..., Identification],
    sets: Mapping[str, Sequence[str]],
) -> Identification:
    """Longitudinal and lateral models each on the maneuvers of their aspect, or all together.

    sets: the states of a motion, by its name.
    """
    options = dict(task.options)
    states = options.pop("states", "auto")
    asked = options.pop("outputs", None)
    if isinstance(states, str):
        one_of("states", states, ("auto", *sets))
    if "algorithm" in options:
        one_of("algorithm", options["algorithm"], ("gauss_newton", "levenberg_marquardt"))
    options |= {k: f(options[k]) for k, f in (("tied", factors), ("priors", priors_of))
                if k in options}  # fmt: skip
    if options.get("covariance", "diagonal") != "diagonal":
        one_of("covariance", options["covariance"], ("diagonal", "full"))
        if "noise" in options:
            raise bad_option("covariance", "diagonal, as noise is given", "'full'")
    if "bounds" in options:
        options["bounds"] = {k: tuple(v) for k, v in options["bounds"].items()}
    one_of("initial", options.get("initial", "estimate"), ("estimate", "measured"))
    if "substeps" in options:
        if options["substeps"] not in range(1, 101):
            raise bad_option("substeps", "a whole number from 1 to 100", repr(options["substeps"]))
        options["substeps"] = int(options["substeps"])
    maneuvers, messages, shifts = task.measure()
    results = []
    parts = _parts(task.models) if states == "auto" else [(_set_of(states), dict(task.models))]
    for name, models in parts:
        serving = _serving(maneuvers, models)
        flown = tuple(sets[name] if isinstance(states, str) else states)
        outputs = _outputs(name, flown, asked, serving, split=states == "auto")
        own = _of_part(options, models, outputs, alone=len(parts) == 1)
        found = identify(
            serving,
            models,
            states=flown,
            outputs=outputs,
            **own,
            truth=task.truth,
        )
        if identify is identify_output_error:
            setting = Setting(flown, tuple(outputs), **{k: own[k] for k in _SETTING & own.keys()})
            rest = {k: own[k] for k in ("noise", "priors", "scales", "covariance") if k in own}
            found = carried(found, serving, models, shifts, setting, **rest)
        results.append(with_units(replace(found, formulas=found.formulas or models)))
    result = merged(results)
    return replace(result, messages=(*messages, *result.messages))


_SETTING = {"fixed", "tied", "initial", "biases", "common_constant", "stabilize", "substeps"}


def _parts(models: Mapping[str, str]) -> list[tuple[str, dict[str, str]]]:
    """Models by the motion that they belong to."""
    long = {c: f for c, f in models.items() if c in LONGITUDINAL}
    lateral = {c: f for c, f in models.items() if c not in LONGITUDINAL}
    return [(name, part) for name, part in (("longitudinal", long), ("lateral", lateral)) if part]


def _set_of(states: str | Sequence[str]) -> str:
    if isinstance(states, str):
        return states
    chosen = set(states)
    fits = [name for name, every in STATE_SETS.items() if chosen <= set(every)]
    return fits[0] if fits else "six"


def _serving(
    maneuvers: Sequence[MeasuredManeuver], models: Mapping[str, str]
) -> list[MeasuredManeuver]:
    """The maneuvers of the models' aspect; all where models of both are flown together."""
    aspects = {"longitudinal" if c in LONGITUDINAL else "lateral" for c in models}
    if len(aspects) > 1:
        return list(maneuvers)
    found = [m for m in maneuvers if m.maneuver.aspect in (*aspects, "both")]
    if not any(not m.maneuver.held_out for m in found):
        (aspect,) = aspects
        raise refuse(
            "no_maneuver",
            where="model of " + ", ".join(models),
            expected=f"a {aspect} maneuver (or 'both') that is not held out",
            found=", ".join(f"{m.maneuver.id} ({m.maneuver.aspect})" for m in maneuvers) or "none",
            do="Set a maneuver's aspect or held_out, or take the model out.",
        )
    return found


def _outputs(
    name: str,
    states: Sequence[str],
    asked: Sequence[str] | None,
    maneuvers: Sequence[MeasuredManeuver],
    split: bool,
) -> list[str]:
    """Those asked for, of this part; else the usual ones that every maneuver has readings of.

    What is taken as measured and is no state cannot be compared: the model does not make it.
    """
    if asked is not None:
        if not split:
            return list(asked)
        return [n for n in asked if (n in LATERAL_OUTPUTS) == (name == "lateral")]
    made = [n for n in USUAL_OUTPUTS[name] if n in states or n not in STATE_SETS["six"]]
    found = [n for n in made if all(n in m.outputs for m in maneuvers)]
    if not found:
        raise refuse(
            "no_output",
            where=f"output error, {name}",
            expected="readings of " + ", ".join(USUAL_OUTPUTS[name]),
            found="none that every maneuver has",
            do="Map their channels.",
        )
    return found


def _of_part(
    options: Mapping[str, Any], models: Mapping[str, str], outputs: Collection[str], alone: bool
) -> dict[str, Any]:
    """The options that belong to one part of the models, where there are two."""
    if alone:
        return dict(options)

    def mine(name: str) -> bool:
        head = name.split("[")[0].split("(")[0]
        for kind in ("b_", "F_", "sigma_"):
            head = head.removeprefix(kind)
        return head in outputs or head.split("_")[0] in models

    out = dict(options)
    for key in ("start", "fixed", "tied", "bounds", "priors", "stabilize", "noise"):
        if key in out:
            out[key] = {n: v for n, v in out[key].items() if mine(n)}
    if not out.get("noise", True):
        del out["noise"]
    for key in ("biases", "noisy"):
        if key in out:
            out[key] = [n for n in out[key] if n in outputs]
    return out
