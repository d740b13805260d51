"""Period and damping of the free response, measured and model, against their tolerances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.validate.oscillation import Oscillation, fit_oscillation
from alula.validate.requirement import Requirement, evidence_row, follows
from alula.validate.result import Criterion, Evidence, Flown, Verdict
from alula.validate.windows import free_response

LEAST_CYCLES = 1.0  # visible, two overshoots; how well they tell is then told by the fit's error
LEAST_EXPLAINED = 0.8  # of a trace's variance, for its oscillation to have a period at all


def oscillation_rows(
    flown: Flown, requirement: Requirement, names: Sequence[str], period_floor: float | None
) -> list[Evidence]:
    """Period, damping and for the Dutch roll the peaks, of the free response of both flights."""
    period_words = "±10 % of period" if period_floor is None else "±0.5 s or ±10 % of period"
    damping_words = "±0.02 of damping ratio or ±10 % of time to half or double amplitude"
    peak_words = "±20 % or ±1 s of time between the peaks of bank and sideslip"
    words = [period_words, damping_words, *([] if period_floor is None else [peak_words])]
    stretch = free_response(flown.t, flown.controls, flown.maneuver.aspect)
    t = flown.t[stretch]
    window = (float(t[0]), float(t[-1])) if len(t) else None

    def none(why: str, verdict: Verdict = "not_judged") -> list[Evidence]:
        return [
            evidence_row(flown, requirement, tolerance, (), verdict, window, why)
            for tolerance in words
        ]

    names = [n for n in names if flown.channels[n].recorded]
    filled = [n for n in names if flown.channels[n].as_recorded]
    if filled:
        return none(follows(filled))
    if not names:
        return none("channels not recorded")
    measured = fit_oscillation(t, {n: flown.channels[n].measured[stretch] for n in names})
    why = _unfit(measured, LEAST_CYCLES, "measured response", names)
    if why and flown.diverged_at is not None:
        return none(f"the model's flight diverged at {flown.diverged_at:.5g} s", "fail")
    if why or measured is None:
        return none(why)
    model = fit_oscillation(t, {n: flown.channels[n].model[stretch] for n in names})
    if model is None:
        return none("the model's response does not oscillate", "fail")
    why = _unfit(model, 0.0, "model's response", names)
    if why:
        return none(why)
    allowed = max(0.1 * measured.period, period_floor or 0.0)
    spread = float(np.hypot(measured.period_se, model.period_se))
    rows = [
        _decided(flown, requirement, words[0], window, measured.cycles, [
            _against("period", "s", measured.period, model.period, allowed, spread)
        ]),
        _decided(flown, requirement, words[1], window, measured.cycles, _damping(measured, model)),
    ]  # fmt: skip
    if period_floor is not None and {"phi", "beta"} <= set(names):
        first, second = (found.lag("phi", "beta") for found in (measured, model))
        allowed = max(1.0, 0.2 * abs(first))
        rows.append(
            _decided(flown, requirement, words[2], window, measured.cycles, [
                _against("bank to sideslip", "s", first, second, allowed, spread)
            ])
        )  # fmt: skip
    return rows


def _damping(measured: Oscillation, model: Oscillation) -> list[Criterion]:
    spread = float(np.hypot(measured.damping_se, model.damping_se))
    out = [_against("damping ratio", "1", measured.damping, model.damping, 0.02, spread)]
    halves = measured.time_to_half, model.time_to_half
    if all(np.isfinite(halves)):
        allowed = 0.1 * abs(halves[0])
        relative = np.hypot(
            measured.damping_se / measured.damping, model.damping_se / model.damping
        )
        out.append(
            _against(
                "time to half" if halves[0] > 0 else "time to double", "s",
                abs(halves[0]), abs(halves[1]), allowed, float(relative * abs(halves[0])),
            )
        )  # fmt: skip
        if halves[0] * halves[1] < 0.0:  # one grows, one dies out: no likeness by size
            out.pop()
    return out


def _against(
    quantity: str, unit: str, measured: float, model: float, tolerance: float, se: float
) -> Criterion:
    """None for `met` where twice the standard error could turn the answer round."""
    deviation = model - measured
    far = abs(deviation) - 2.0 * se > tolerance
    sure = 2.0 * se <= tolerance
    met = None if not (far or sure) else abs(deviation) <= tolerance
    return Criterion(quantity, unit, measured, model, deviation, tolerance, met, se)


def _decided(
    flown: Flown,
    requirement: Requirement,
    tolerance: str,
    window: tuple[float, float] | None,
    cycles: float,
    criteria: Sequence[Criterion],
) -> Evidence:
    said = f"{cycles:.1f} visible cycles of free response"
    if any(c.met for c in criteria):
        return evidence_row(flown, requirement, tolerance, criteria, "pass", window, said)
    if any(c.met is None for c in criteria):
        worst = next(c for c in criteria if c.met is None)
        error = f"{worst.deviation_se:.2g}" + ("" if worst.unit == "1" else f" {worst.unit}")
        why = (
            f"{said} leave a standard error of {error} in the difference: too large for this "
            "tolerance"
        )
        return evidence_row(flown, requirement, tolerance, criteria, "not_judged", window, why)
    return evidence_row(flown, requirement, tolerance, criteria, "fail", window, said)


def _unfit(found: Oscillation | None, cycles: float, whose: str, names: Sequence[str]) -> str:
    """Why an oscillation cannot be judged; empty where it can."""
    if found is None:
        return f"no oscillation is found in the free part of the {whose}"
    if found.cycles < cycles:
        return f"{found.cycles:.1f} visible cycles of free response; at least {cycles:g} needed"
    best = max(found.explained[n] for n in names)
    if best < LEAST_EXPLAINED:
        return f"a damped sine explains {100 * best:.0f} % of the {whose}; at least 80 % needed"
    return ""
