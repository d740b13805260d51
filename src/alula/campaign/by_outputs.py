"""Methods that compare outputs: which maneuvers, states, outputs and options each part gets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from alula.base.messages import Message, note, refuse
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.options import bad_option, factors, one_of, priors_of
from alula.identify import Identification
from alula.identify.equation_error.task import LONGITUDINAL
from alula.identify.flown.carried import carried
from alula.identify.flown.carried_filter_error import carried_by_filter
from alula.identify.flown.filter_error import identify_flight_filter_error
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_error import identify_output_error
from alula.identify.flown.problem import STATE_SETS, Setting
from alula.identify.flown.usual_outputs import USUAL_OUTPUTS
from alula.identify.merge import merged
from alula.model import parse

LATERAL_OUTPUTS = frozenset({"beta", "p", "r", "phi", "ay", "pdot", "rdot"})
_NAMES: Mapping[str, frozenset[str]] = {  # coefficients, states and outputs by motion
    "longitudinal": frozenset({*LONGITUDINAL, "V", "alpha", "theta", "q", "ax", "az", "qdot"}),
    "lateral": frozenset({"CY", "Cl", "Cn", *LATERAL_OUTPUTS}),
}
TABLES = frozenset({"start", "fixed", "tied", "bounds", "priors", "stabilize", "noise", "scales"})
LISTS = frozenset({"biases", "noisy"})  # options that hold names, besides `outputs`


def by_outputs(
    task: IdentifyTask,
    identify: Callable[..., Identification],
    sets: Mapping[str, Sequence[str]],
) -> Identification:
    """Longitudinal and lateral models each on the maneuvers of their aspect, or all together.

    sets: the states of a motion, by its name.
    """
    options = searching(task.options)
    options.pop("equations", None)
    states = options.pop("states", "auto")
    asked = options.pop("outputs", None)
    if isinstance(states, str):
        one_of("states", states, ("auto", *sets))
    if options.get("covariance", "diagonal") != "diagonal":
        one_of("covariance", options["covariance"], ("diagonal", "full"))
        if "noise" in options:
            raise bad_option("covariance", "diagonal, as noise is given", "'full'")
    one_of("initial", options.get("initial", "estimate"), ("estimate", "measured"))
    if "substeps" in options:
        if options["substeps"] not in range(1, 101):
            raise bad_option("substeps", "a whole number from 1 to 100", repr(options["substeps"]))
        options["substeps"] = int(options["substeps"])
    maneuvers, messages, shifts = task.measure()
    results, owns = [], []
    parts = parts_of(task.models) if states == "auto" else [(_set_of(states), dict(task.models))]
    for name, models in parts:
        chosen = serving(maneuvers, models)
        flown = tuple(sets[name] if isinstance(states, str) else states)
        outputs = _outputs(name, flown, asked, chosen, split=states == "auto")
        own = of_part(options, name if states == "auto" else "")
        owns.append(own)
        found = identify(
            chosen,
            models,
            states=flown,
            outputs=outputs,
            **own,
            truth=task.truth,
        )
        if identify is identify_output_error:
            setting = Setting(flown, tuple(outputs), **{k: own[k] for k in _SETTING & own.keys()})
            rest = {k: own[k] for k in ("noise", "priors", "scales", "covariance") if k in own}
            found = carried(found, chosen, models, shifts, setting, **rest)
        elif identify is identify_flight_filter_error:
            same = {k: v for k, v in own.items() if k != "algorithm"}
            found = carried_by_filter(
                found, chosen, models, shifts, states=flown, outputs=outputs, **same
            )
        results.append(found)
    result = merged(results)
    said = (*messages, *left_aside(options, owns))
    return replace(result, messages=(*said, *result.messages))


def searching(given: Mapping[str, Any]) -> dict[str, Any]:
    """The options, those of a search as its functions take them. Raises BadInput."""
    options = dict(given)
    if "algorithm" in options:
        one_of("algorithm", options["algorithm"], ("gauss_newton", "levenberg_marquardt"))
    kinds: dict[str, Callable[[Any], Any]] = {
        "tied": factors,
        "priors": priors_of,
        "bounds": lambda x: {k: tuple(v) for k, v in x.items()},
    }
    return {k: kinds[k](v) if k in kinds else v for k, v in options.items()}


_SETTING = {"fixed", "tied", "initial", "biases", "common_constant", "stabilize", "substeps"}


def parts_of(models: Mapping[str, str]) -> list[tuple[str, dict[str, str]]]:
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


def serving(
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


def of_part(options: Mapping[str, Any], part: str) -> dict[str, Any]:
    """The options without names that belong to the other motion, which is 'lateral' for the
    'longitudinal' and the other way round; a name of neither stays and is refused further on.
    """
    other = _NAMES.get({"longitudinal": "lateral", "lateral": "longitudinal"}.get(part, ""), ())

    def mine(name: str) -> bool:
        head = name.split("[")[0].split("(")[0]
        for kind in ("b_", "F_", "sigma_"):
            head = head.removeprefix(kind)
        return head not in other and head.split("_")[0] not in other

    out = dict(options)
    for key in TABLES & out.keys():
        out[key] = {n: v for n, v in out[key].items() if mine(n)}
    for key in LISTS & out.keys():
        out[key] = [n for n in out[key] if mine(n)]
    if not out.get("noise", True):
        del out["noise"]
    return out


def of_formulas(fixed: Mapping[str, float], models: Mapping[str, str]) -> dict[str, float]:
    """Those of the fixed values that terms of the formulas have; not noises, say."""
    terms = {t.name(c) for c, formula in models.items() for t in parse(formula)}
    return {n: v for n, v in fixed.items() if n in terms}


def left_aside(options: Mapping[str, Any], own: Sequence[Mapping[str, Any]]) -> list[Message]:
    """A note on names that went to none of the parts, whose options are `own`."""
    every = [f"{k}.{n}" for k in sorted((TABLES | LISTS) & options.keys()) for n in options[k]]
    gone = [e for e in every if not any(e.split(".", 1)[1] in o.get(e.split(".", 1)[0], ())
                                        for o in own)]  # fmt: skip
    if not gone:
        return []
    return [
        note(
            "option_left_aside",
            where="[identify.options]",
            expected="names of the models that are identified now",
            found=", ".join(gone),
            do="Nothing: they belong to the motion whose models were left out.",
        )
    ]
