"""The methods of identification by name: what each needs of a task, and which options it takes.

One method: one file in identify/ and one entry in `IDENTIFIERS`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from alula.base.messages import BadInput, Message, note, refuse
from alula.campaign.options import Kind, checked_options, factors, priors_of
from alula.identify import CoefficientData, Identification, Reference, identify_equation_error
from alula.identify.bootstrap import BLOCK_OPTIONS, bootstrapped
from alula.identify.carried import Shifts, carried
from alula.identify.flight_filter_error import STATES_OF, identify_flight_filter_error
from alula.identify.frequency_regression import identify_frequency_regression
from alula.identify.measured_maneuver import MeasuredManeuver
from alula.identify.merge import merged
from alula.identify.output_error import identify_output_error
from alula.identify.output_error_problem import STATE_SETS, Setting
from alula.identify.recursive import forgetting_of
from alula.identify.recursive_equation_error import identify_recursive
from alula.identify.regression_choice import OPTIONS as REGRESSION
from alula.identify.regression_choice import regression_choice
from alula.identify.task import LONGITUDINAL
from alula.identify.usual_outputs import USUAL_OUTPUTS

Measured = tuple[tuple[MeasuredManeuver, ...], tuple[Message, ...], list[Shifts]]


@dataclass(frozen=True)
class IdentifyTask:
    """All that a method may ask for.

    data: coefficients of each maneuver. measure: readings of each maneuver, made when they are
    wanted. models: formula by coefficient. reference: of the aircraft. seed: of what is random.
    """

    data: tuple[CoefficientData, ...]
    measure: Callable[[], Measured]
    models: Mapping[str, str]
    reference: Reference
    options: Mapping[str, Any] = field(default_factory=dict)
    truth: Mapping[str, float] | None = None
    seed: int = 0


@dataclass(frozen=True)
class Method:
    """words: what it is called. options: kind of value by name. run: on a task of such options."""

    words: str
    options: Mapping[str, Kind]
    run: Callable[[IdentifyTask], Identification]


def identify_by(name: str, task: IdentifyTask) -> Identification:
    """Identify by the method of that name.

    An option of another method is left aside, with a note: a project serves several. Raises
    BadInput for a method or an option that nobody knows, or a value that does not fit.
    """
    method = IDENTIFIERS[method_name(name)]
    every = {option for other in IDENTIFIERS.values() for option in other.options}
    strange = sorted(task.options.keys() - every)
    if strange:
        raise refuse(
            "unknown_option",
            where="[identify.options]",
            expected="only " + ", ".join(sorted(method.options)),
            found=", ".join(strange),
            do="Take the entry out.",
        )
    aside = sorted(task.options.keys() - method.options.keys())
    given = {k: v for k, v in task.options.items() if k in method.options}
    result = method.run(replace(task, options=checked_options(given, method.options)))
    if not aside:
        return result
    said = note(
        "option_of_another_method",
        where="[identify.options]",
        expected=f"options of {method.words}",
        found=", ".join(aside),
        do="Nothing: they are for other methods and left aside here.",
    )
    return replace(result, messages=(*result.messages, said))


def method_name(name: str) -> str:
    """The name, if there is such a method; else raises BadInput."""
    if name in IDENTIFIERS:
        return name
    raise refuse(
        "unknown_method",
        where="identify.method",
        expected="one of " + ", ".join(IDENTIFIERS),
        found=f"'{name}'",
        do="Choose one of these.",
    )


def _equation_error(task: IdentifyTask) -> Identification:
    own = {k: v for k, v in task.options.items() if k in ("weighting", "common_constant", "scales")}
    choice = regression_choice({k: v for k, v in task.options.items() if k in REGRESSION})
    kind = task.options.get("uncertainty", "coloured")
    _one_of("uncertainty", kind, ("coloured", "bootstrap"))
    blocks = {k: v for k, v in task.options.items() if k in BLOCK_OPTIONS}
    result = identify_equation_error(
        task.data, task.models, **own, regression=choice, truth=task.truth
    )
    if kind == "coloured":
        return result
    return bootstrapped(result, task.data, **own, **blocks, seed=task.seed)


def _recursive(task: IdentifyTask) -> Identification:
    own = {k: v for k, v in task.options.items() if k in ("common_constant", "scales")}
    return identify_recursive(
        task.data, task.models, forgetting=forgetting_of(task.options), **own, truth=task.truth
    )


def _frequency(task: IdentifyTask) -> Identification:
    options = dict(task.options)
    if "band_hz" in options:
        options["band_hz"] = tuple(options["band_hz"])
    _one_of("detrend", options.get("detrend", "line"), ("ends", "mean", "line", "none"))
    return identify_frequency_regression(task.data, task.models, **options, truth=task.truth)


LATERAL_OUTPUTS = frozenset({"beta", "p", "r", "phi", "ay", "pdot", "rdot"})


def _output_error(task: IdentifyTask) -> Identification:
    return _by_outputs(task, identify_output_error, STATE_SETS)


def _filter_error(task: IdentifyTask) -> Identification:
    return _by_outputs(task, identify_flight_filter_error, STATES_OF)


def _by_outputs(
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
        _one_of("states", states, ("auto", *sets))
    if "algorithm" in options:
        _one_of("algorithm", options["algorithm"], ("gauss_newton", "levenberg_marquardt"))
    options |= {k: f(options[k]) for k, f in (("tied", factors), ("priors", priors_of))
                if k in options}  # fmt: skip
    if options.get("covariance", "diagonal") != "diagonal":
        _one_of("covariance", options["covariance"], ("diagonal", "full"))
        if "noise" in options:
            raise _bad("covariance", "diagonal, as noise is given", "'full'")
    if "bounds" in options:
        options["bounds"] = {k: tuple(v) for k, v in options["bounds"].items()}
    _one_of("initial", options.get("initial", "estimate"), ("estimate", "measured"))
    if "substeps" in options:
        if options["substeps"] not in range(1, 101):
            raise _bad("substeps", "a whole number from 1 to 100", repr(options["substeps"]))
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
        results.append(replace(found, formulas=found.formulas or models))
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


def _one_of(name: str, value: str, known: Sequence[str]) -> None:
    if value not in known:
        raise _bad(name, "one of " + ", ".join(known), repr(value))


def _bad(name: str, expected: str, found: str) -> BadInput:
    return refuse(
        "bad_option",
        where=f"identify.options.{name}",
        expected=expected,
        found=found,
        do="Correct it.",
    )


IDENTIFIERS: Mapping[str, Method] = {
    "ee": Method(
        "equation error",
        {
            "weighting": "text",
            "common_constant": "flag",
            "scales": "numbers",
            "uncertainty": "text",
            **dict.fromkeys(REGRESSION, "any"),  # looked at by regression_choice
            **dict.fromkeys(BLOCK_OPTIONS, "number"),
        },
        _equation_error,
    ),
    "oe": Method(
        "output error",
        {
            "states": "names",
            "outputs": "list",
            "start": "numbers",
            "fixed": "numbers",
            "tied": "texts",
            "bounds": "pairs",
            "priors": "pairs",
            "initial": "text",
            "biases": "list",
            "common_constant": "flag",
            "stabilize": "numbers",
            "noise": "numbers",
            "covariance": "text",
            "algorithm": "text",
            "substeps": "number",
            "scales": "numbers",
        },
        _output_error,
    ),
    "fe": Method(
        "filter error",
        {
            "states": "names",
            "outputs": "list",
            "noisy": "list",
            "start": "numbers",
            "fixed": "numbers",
            "bounds": "pairs",
            "priors": "pairs",
            "common_constant": "flag",
            "algorithm": "text",
            "scales": "numbers",
        },
        _filter_error,
    ),
    "fd": Method(
        "frequency-domain regression",
        {"band_hz": "pair", "detrend": "text", "weighting": "text", "scales": "numbers"},
        _frequency,
    ),
    "rls": Method(
        "recursive least squares",
        {
            "forgetting": "number",
            "forgetting_directional": "flag",
            "adaptive_window": "number",
            "least_forgetting": "number",
            "residual_variance": "number",
            "reset_ratio": "number",
            "common_constant": "flag",
            "scales": "numbers",
        },
        _recursive,
    ),
}
