"""The methods of identification by name: what each needs of a task, and which options it takes.

One method: one file in identify/ and one entry in `IDENTIFIERS`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from alula.base.messages import note, refuse
from alula.campaign.by_linear import by_linear
from alula.campaign.by_outputs import by_outputs
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.options import Kind, bad_option, checked_options, one_of
from alula.identify import Identification, identify_equation_error
from alula.identify.equation_error.bootstrap import BLOCK_OPTIONS, bootstrapped
from alula.identify.equation_error.choice import OPTIONS as REGRESSION
from alula.identify.equation_error.choice import regression_choice
from alula.identify.equation_error.recursive import identify_recursive
from alula.identify.equation_error.recursive_least_squares import forgetting_of
from alula.identify.flown.filter_error import STATES_OF, identify_flight_filter_error
from alula.identify.flown.output_error import identify_output_error
from alula.identify.flown.problem import STATE_SETS
from alula.identify.flown.stall import ALONE, identify_stall
from alula.identify.frequency.output_error import identify_frequency_output_error
from alula.identify.frequency.regression import identify_frequency_regression
from alula.identify.linear.filter_error import identify_filter_error
from alula.identify.linear.output_error import identify_linear_output_error


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
    equations = task.options.get("equations", "flight")
    one_of("equations", equations, ("flight", "linear"))
    method = IDENTIFIERS[method_name(name)]
    if equations == "linear":
        method = LINEAR.get(name, method)
    both = (*IDENTIFIERS.values(), *LINEAR.values())
    every = {option for other in both for option in other.options}
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


def takes_readings(name: str, options: Mapping[str, object]) -> bool:
    """Whether the method compares with what sensors read, not with coefficients."""
    return name in ("oe", "fe") or (name in LINEAR and options.get("equations") == "linear")


def _equation_error(task: IdentifyTask) -> Identification:
    own = {k: v for k, v in task.options.items() if k in ("weighting", "common_constant", "scales")}
    choice = regression_choice({k: v for k, v in task.options.items() if k in REGRESSION})
    kind = task.options.get("uncertainty", "coloured")
    one_of("uncertainty", kind, ("coloured", "bootstrap"))
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
    options.pop("equations", None)
    if "delayed" in options:
        raise bad_option(
            "delayed",
            'equations = "linear" beside it: a regression knows no delays, output error does',
            repr(options["delayed"]),
        )
    if "band_hz" in options:
        options["band_hz"] = tuple(options["band_hz"])
    one_of("detrend", options.get("detrend", "line"), ("ends", "mean", "line", "none"))
    return identify_frequency_regression(task.data, task.models, **options, truth=task.truth)


def _output_error(task: IdentifyTask) -> Identification:
    return by_outputs(task, identify_output_error, STATE_SETS)


def _filter_error(task: IdentifyTask) -> Identification:
    return by_outputs(task, identify_flight_filter_error, STATES_OF)


def _stall(task: IdentifyTask) -> Identification:
    models = {c: f for c, f in task.models.items() if c in ALONE}
    data = [d for d in task.data if d.maneuver.aspect != "lateral"]
    found = identify_stall(data, models, fixed=task.options.get("fixed", {}), truth=task.truth)
    others = ", ".join(c for c in task.models if c not in ALONE)
    if not others:
        return found
    said = note(
        "model_not_served",
        where="[identify.models]",
        expected=f"formulas of {', '.join(ALONE)}",
        found=others,
        do="Nothing: these are left out. Identify them by another method.",
    )
    return replace(found, messages=(*found.messages, said))


def _delays(task: IdentifyTask) -> Identification:
    band = task.options.get("band_hz")
    if band is None:
        raise bad_option("band_hz", "[low, high], the band in Hz that is compared", "none")
    options = {**task.options, "band_hz": tuple(band)}
    task = replace(task, options=options)
    return by_linear(task, identify_frequency_output_error, in_time=False)


# What every search over outputs takes.
_OF_A_SEARCH: Mapping[str, Kind] = {
    "equations": "text",
    "states": "names",
    "outputs": "list",
    "start": "numbers",
    "fixed": "numbers",
    "tied": "texts",
    "bounds": "pairs",
    "priors": "pairs",
    "algorithm": "text",
    "scales": "numbers",
}

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
            **_OF_A_SEARCH,
            "initial": "text",
            "biases": "list",
            "common_constant": "flag",
            "stabilize": "numbers",
            "noise": "numbers",
            "covariance": "text",
            "substeps": "number",
        },
        _output_error,
    ),
    "fe": Method(
        "filter error",
        {
            **_OF_A_SEARCH,
            "noisy": "list",
            "common_constant": "flag",
        },
        _filter_error,
    ),
    "fd": Method(
        "frequency-domain regression",
        {
            "equations": "text",
            "band_hz": "pair",
            "delayed": "list",
            "detrend": "text",
            "weighting": "text",
            "scales": "numbers",
        },
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
    "stall": Method("output error of a stall", {"fixed": "numbers"}, _stall),
}

# The same methods on the linear equations of flight, equations = "linear".
LINEAR: Mapping[str, Method] = {
    "oe": Method(
        "output error of the linear equations",
        {**_OF_A_SEARCH, "common_constant": "flag"},
        lambda task: by_linear(task, identify_linear_output_error),
    ),
    "fe": Method(
        "filter error of the linear equations",
        {**_OF_A_SEARCH, "common_constant": "flag", "noisy": "list", "gain": "text"},
        lambda task: by_linear(task, identify_filter_error),
    ),
    "fd": Method(
        "output error of the linear equations in the frequency domain",
        {**_OF_A_SEARCH, "band_hz": "pair", "delayed": "list"},
        _delays,
    ),
}
