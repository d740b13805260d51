"""Validation by flying: each recorded maneuver through the model, compared and judged."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np

from alula.base.messages import Message, note, refuse, warn
from alula.model import AeroModel
from alula.validate.case import Case
from alula.validate.flown import fly_case
from alula.validate.part60 import REGULATION, judge
from alula.validate.result import Flown, Validation
from alula.validate.windows import find_input

Trim = Literal["none", "entry", "whole"]
DRAWS = 40  # the standard deviation of a band is then known to a ninth
LEAST_ENTRY = 10  # samples before the input that make a mean
CLOSED = 0.2  # m/s2, mean; a fiftieth of g, above the bias of any accelerometer worth identifying
GRAVITY = 9.80665  # m/s2, standard


def validate(
    model: AeroModel,
    cases: Sequence[Case],
    *,
    gravity: float = GRAVITY,
    trim: Trim = "none",
    horizon: float | None = None,
    draws: int = DRAWS,
    seed: int = 0,
    source: str = "",
    progress: Callable[[str], None] = lambda _: None,
) -> Validation:
    """Fly every case's recorded controls through the model from its measured start, and judge.

    gravity: m/s2, as the reconstruction took it. trim: 'none' flies the model as it is; 'entry'
    adds to each of its coefficients the constant by which it misses the measured one before the
    input begins; 'whole' the mean over the maneuver. Such offsets stand in the result. horizon: s
    from each maneuver's start, None for all of it. draws: parameter sets for the uncertainty band;
    0 for none. source: where the model came from, in words.

    Raises BadInput for what cannot be flown; a flight that diverges is compared until then.
    """
    if not cases:
        raise refuse(
            "no_maneuver",
            where="validation",
            expected="at least one maneuver to fly",
            found="none",
            do="Mark maneuvers held_out = true, or name them with --maneuver.",
        )
    if horizon is not None and not horizon > 0.0:
        raise refuse(
            "bad_option",
            where="horizon",
            expected="a time above zero, s",
            found=f"{horizon:g}",
            do="Give the seconds of each maneuver that are to be compared.",
        )
    flown: list[Flown] = []
    messages: list[Message] = []
    for case in cases:
        progress(f"flying {case.motion.maneuver.id} through the model")
        offsets, said = _trim(model, case, trim)
        one, more = fly_case(
            model, case, gravity=gravity, trim=offsets, draws=draws, seed=seed, horizon=horizon
        )
        flown.append(one)
        messages += [*_closure(case), *said, *more, *_label(one)]
    messages += _validity(model, flown)
    return Validation(
        model=model.name,
        source=source,
        regulation=REGULATION,
        flown=tuple(flown),
        evidence=tuple(row for one in flown for row in judge(one)),
        seed=seed,
        messages=tuple(dict.fromkeys(messages)),
    )


def _trim(
    model: AeroModel, case: Case, trim: Trim
) -> tuple[Callable[[AeroModel], dict[str, float]], list[Message]]:
    """The constants that make a model's coefficients equal the measured ones in the mean."""
    if trim == "none":
        return _as_it_is, []
    motion = case.motion
    where = f"maneuver {motion.maneuver.id}"
    count = len(motion.t)
    words = "the whole maneuver"
    if trim == "entry":
        found = find_input(motion.t, motion.controls, motion.maneuver.aspect)
        count = 0 if found is None else int(np.searchsorted(motion.t, found.start))
        words = f"the {motion.t[max(count - 1, 0)] - motion.t[0]:.3g} s before the input"
    names = [n for n in model.coefficients if n in case.coefficients]
    if count < LEAST_ENTRY or not names:
        return _as_it_is, [
            warn(
                "no_trim_offset",
                where=where,
                expected=f"{LEAST_ENTRY} samples before the input, and measured coefficients",
                found=f"{count} samples, {len(names)} coefficients",
                do="The model was flown as it is. Begin the window earlier, or use --trim whole.",
            )
        ]
    before = {n: v[:count] for n, v in case.variables.items()}

    def offsets(some: AeroModel) -> dict[str, float]:
        expected = some.evaluate(before)
        return {n: float(np.mean(case.coefficients[n][:count] - expected[n])) for n in names}

    listed = ", ".join(f"{n} {v:+.3g}" for n, v in offsets(model).items())
    return offsets, [
        note(
            "trim_offset",
            where=where,
            expected="the model's own constants",
            found=f"offsets from {words}, as asked for: {listed}",
            do="They were added to the model's coefficients in this maneuver.",
        )
    ]


def _as_it_is(model: AeroModel) -> dict[str, float]:
    return {}


def _closure(case: Case) -> list[Message]:
    """A warning where recorded coefficients and thrust do not add up to the specific force."""
    motion, body = case.motion, ("CX", "CY", "CZ")
    if not set(body) <= case.coefficients.keys():
        return []
    pressure = 0.5 * motion.rho * motion.V**2 * case.area / case.airframe.mass
    force = np.column_stack([case.coefficients[n] for n in body]) * pressure[:, None]
    if case.force is not None:
        force += case.force / case.airframe.mass
    left = np.mean(np.column_stack([motion.ax, motion.ay, motion.az]) - force, axis=0)
    k = int(np.argmax(np.abs(left)))
    if abs(left[k]) <= CLOSED:
        return []
    return [
        warn(
            "forces_do_not_close",
            where=f"maneuver {motion.maneuver.id}",
            expected="coefficients times dynamic pressure plus thrust equal to mass times the "
            "specific force",
            found=f"{left[k]:+.3g} m/s2 missing in {'xyz'[k]} on the average",
            do="State mass, [[engines]] with their channels and the reference area as the "
            "recorded coefficients were made with; the flight cannot be right without.",
        )
    ]


def _label(one: Flown) -> list[Message]:
    """Promise 4: what the estimate has seen does not validate it, and says so."""
    where = f"maneuver {one.maneuver.id}"
    if one.seen == "yes":
        return [
            warn(
                "seen_by_the_estimate",
                where=where,
                expected="a maneuver that the estimate never saw",
                found="one that the model was identified from",
                do="The match shows the fit, not the prediction. Hold a maneuver out: "
                "held_out = true, or --maneuver.",
            )
        ]
    if one.seen == "unknown":
        return [
            warn(
                "origin_unknown",
                where=where,
                expected="a model file that says what it was estimated from",
                found="one that does not",
                do="Whether this maneuver was used is for you to know; 'alula identify --model' "
                "writes it down.",
            )
        ]
    return []


def _validity(model: AeroModel, flown: Sequence[Flown]) -> list[Message]:
    """One message for all that lies outside the model's range, with the farthest values."""
    worst: dict[str, tuple[str, float, float, float]] = {}
    for one in flown:
        for name, (value, low, high) in one.outside.items():
            far = max(low - value, value - high)
            if name not in worst or far > max(low - worst[name][1], worst[name][1] - high):
                worst[name] = (one.maneuver.id, value, low, high)
    if not worst:
        return []
    listed = "; ".join(
        f"{name} {_shown(name, value)} (range {_shown(name, low)} to {_shown(name, high)}, "
        f"maneuver {id})"
        for name, (id, value, low, high) in worst.items()
    )
    return [
        warn(
            "outside_validity",
            where=f"model '{model.name}'",
            expected="a flight within the range that the model was found in",
            found=listed,
            do="There the model extrapolates; identify it from maneuvers that reach as far.",
        )
    ]


_ANGLES = ("alpha", "beta", "de", "da", "dr", "df")


def _shown(name: str, value: float) -> str:
    return f"{np.degrees(value):.3g} deg" if name in _ANGLES else f"{value:.3g}"
