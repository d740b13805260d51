"""Verdicts by 14 CFR Part 60 Appendix A, Table A2A, in the edition of 1 January 2014.

The table's objective tests of longitudinal and lateral-directional handling, those that a model of
rigid-body motion with recorded surface positions can be put to: 2.c.9 phugoid, 2.c.10 short
period, 2.d.2 roll rate response, 2.d.6 rudder response, 2.d.7 Dutch roll. The regulation speaks of
simulators; here the flight of the model takes the simulator's place, and flight conditions,
control forces and the number of maneuvers remain the reader's business.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array
from alula.validate.oscillation import Oscillation, fit_oscillation
from alula.validate.result import Criterion, Evidence, Flown, Verdict
from alula.validate.windows import find_input, free_response

REGULATION = "14 CFR Part 60, Appendix A, Table A2A (1-1-14 edition)"
AFTER_INPUT = 5.0  # s after the last movement that belong to the response: two short periods
LEAST_CYCLES = 1.0  # visible, two overshoots; how well they tell is then told by the fit's error
LEAST_EXPLAINED = 0.8  # of a trace's variance, for its oscillation to have a period at all
G = 9.80665


@dataclass(frozen=True)
class Test:
    """One entry of the table. judge: its rows for one flown maneuver."""

    entry: str
    title: str
    judge: Callable[[Flown, Test], list[Evidence]]


@dataclass(frozen=True)
class _Band:
    """A time history within +-absolute, or +-share of the measured value where that is more."""

    channel: str
    quantity: str
    unit: str
    factor: float
    absolute: float
    share: float = 0.0


_PITCH = _Band("theta", "pitch angle", "deg", 180.0 / np.pi, 1.5)
_PITCH_RATE = _Band("q", "pitch rate", "deg/s", 180.0 / np.pi, 2.0)
_NORMAL = _Band("az", "normal acceleration", "g", -1.0 / G, 0.10)
_ROLL_RATE = _Band("p", "roll rate", "deg/s", 180.0 / np.pi, 2.0, 0.10)
_YAW_RATE = _Band("r", "yaw rate", "deg/s", 180.0 / np.pi, 2.0, 0.10)


def judge(flown: Flown) -> tuple[Evidence, ...]:
    """Every row of evidence that this maneuver gives.

    The tests follow from the maneuver's kind where it names one ('phugoid', 'short_period',
    'dutch_roll', 'roll', 'bank_to_bank', 'rudder_response'); else from the surface that moved
    most: elevator, short period; aileron, roll response; rudder, Dutch roll and rudder response.
    """
    tests = tests_of(flown)
    return tuple(row for test in tests for row in test.judge(flown, test))


def tests_of(flown: Flown) -> Sequence[Test]:
    """The table's entries that a maneuver serves."""
    kind = flown.maneuver.kind.lower().replace(" ", "_").replace("-", "_")
    for name, tests in _BY_KIND.items():
        if name in kind:
            return tests
    found = find_input(flown.t, flown.controls, flown.maneuver.aspect)
    return () if found is None else _BY_CONTROL[found.control]


def tolerances(flown: Flown) -> dict[str, Array]:
    """Half width (n,) of the tolerance about each judged channel, SI; NaN outside the window."""
    out = {}
    for test in tests_of(flown):
        window = _response(flown)
        for band in _BANDS.get(test.entry, ()) if window else ():
            channel = flown.channels[band.channel]
            if not channel.counts or window is None:
                continue
            half = np.maximum(
                band.absolute, band.share * np.abs(band.factor * channel.measured)
            ) / abs(band.factor)
            inside = (flown.t >= window[0]) & (flown.t <= window[1])
            out[band.channel] = np.where(inside, half, np.nan)
    return out


def _response(flown: Flown) -> tuple[float, float] | None:
    """From the input's beginning to AFTER_INPUT s past its end, within the maneuver."""
    found = find_input(flown.t, flown.controls, flown.maneuver.aspect)
    if found is None:
        return None
    return found.start, min(found.end + AFTER_INPUT, flown.maneuver.end)


def _short_period(flown: Flown, test: Test) -> list[Evidence]:
    return [
        _history(flown, test, (_PITCH, _PITCH_RATE), "±1.5° pitch angle or ±2 °/s pitch rate"),
        _history(flown, test, (_NORMAL,), "±0.10 g normal acceleration"),
    ]


def _roll_response(flown: Flown, test: Test) -> list[Evidence]:
    return [_history(flown, test, (_ROLL_RATE,), "±10 % or ±2 °/s roll rate")]


def _rudder_response(flown: Flown, test: Test) -> list[Evidence]:
    return [_history(flown, test, (_YAW_RATE,), "±2 °/s or ±10 % yaw rate")]


def _history(flown: Flown, test: Test, bands: Sequence[_Band], tolerance: str) -> Evidence:
    """Every sample from the input's beginning to AFTER_INPUT s past its end, against a band."""
    window = _response(flown)
    if window is None:
        return _row(flown, test, tolerance, (), "not_judged", None, "no control surface moved")
    bands = [b for b in bands if flown.channels[b.channel].recorded]
    if not bands:
        return _row(flown, test, tolerance, (), "not_judged", window, "channel not recorded")
    filled = [b.channel for b in bands if flown.channels[b.channel].as_recorded]
    bands = [b for b in bands if b.channel not in filled]
    if not bands:
        why = f"{', '.join(filled)} follows a coefficient that was taken as recorded"
        return _row(flown, test, tolerance, (), "not_judged", window, why)
    inside = (flown.t >= window[0]) & (flown.t <= window[1])
    if int(inside.sum()) < 2:
        why = f"the model's flight ended at {flown.t[-1]:.5g} s, before the input"
        verdict: Verdict = "fail" if flown.diverged_at is not None else "not_judged"
        return _row(flown, test, tolerance, (), verdict, window, why)
    criteria = tuple(_within(flown, band, inside) for band in bands)
    met = any(c.met for c in criteria)
    if flown.diverged_at is not None and flown.diverged_at < window[1]:
        why = f"the model's flight diverged at {flown.diverged_at:.5g} s"
        return _row(flown, test, tolerance, criteria, "fail", window, why)
    if flown.t[-1] < window[1] - 1e-6 - (flown.t[1] - flown.t[0]):
        window = (window[0], float(flown.t[-1]))
    return _row(flown, test, tolerance, criteria, "pass" if met else "fail", window, "")


def _within(flown: Flown, band: _Band, inside: NDArray[np.bool_]) -> Criterion:
    channel = flown.channels[band.channel]
    measured = band.factor * channel.measured[inside]
    model = band.factor * channel.model[inside]
    allowed = np.maximum(band.absolute, band.share * np.abs(measured))
    k = int(np.argmax(np.abs(model - measured) / allowed))
    good = np.abs(model - measured) <= allowed
    return Criterion(
        quantity=band.quantity,
        unit=band.unit,
        measured=float(measured[k]),
        model=float(model[k]),
        deviation=float(model[k] - measured[k]),
        tolerance=float(allowed[k]),
        met=bool(good.all()),
        within_share=float(good.mean()),
    )


def _phugoid(flown: Flown, test: Test) -> list[Evidence]:
    return _oscillation_rows(flown, test, ("V", "theta"), None)


def _dutch_roll(flown: Flown, test: Test) -> list[Evidence]:
    return _oscillation_rows(flown, test, ("beta", "p", "r", "phi"), 0.5)


def _oscillation_rows(
    flown: Flown, test: Test, names: Sequence[str], period_floor: float | None
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
        return [_row(flown, test, tolerance, (), verdict, window, why) for tolerance in words]

    names = [n for n in names if flown.channels[n].recorded]
    filled = [n for n in names if flown.channels[n].as_recorded]
    if filled:
        return none(f"{', '.join(filled)} follow coefficients that were taken as recorded")
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
        _decided(flown, test, words[0], window, measured.cycles, [
            _against("period", "s", measured.period, model.period, allowed, spread)
        ]),
        _decided(flown, test, words[1], window, measured.cycles, _damping(measured, model)),
    ]  # fmt: skip
    if period_floor is not None and {"phi", "beta"} <= set(names):
        first, second = (found.lag("phi", "beta") for found in (measured, model))
        allowed = max(1.0, 0.2 * abs(first))
        rows.append(
            _decided(flown, test, words[2], window, measured.cycles, [
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
    test: Test,
    tolerance: str,
    window: tuple[float, float] | None,
    cycles: float,
    criteria: Sequence[Criterion],
) -> Evidence:
    said = f"{cycles:.1f} visible cycles of free response"
    if any(c.met for c in criteria):
        return _row(flown, test, tolerance, criteria, "pass", window, said)
    if any(c.met is None for c in criteria):
        worst = next(c for c in criteria if c.met is None)
        error = f"{worst.deviation_se:.2g}" + ("" if worst.unit == "1" else f" {worst.unit}")
        why = (
            f"{said} leave a standard error of {error} in the difference: too large for this "
            "tolerance"
        )
        return _row(flown, test, tolerance, criteria, "not_judged", window, why)
    return _row(flown, test, tolerance, criteria, "fail", window, said)


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


def _row(
    flown: Flown,
    test: Test,
    tolerance: str,
    criteria: Sequence[Criterion],
    verdict: Verdict,
    window: tuple[float, float] | None,
    reason: str,
) -> Evidence:
    return Evidence(
        entry=test.entry,
        title=test.title,
        maneuver=flown.maneuver.id,
        tolerance=tolerance,
        criteria=tuple(criteria),
        verdict=verdict,
        seen=flown.seen,
        window=window,
        reason=reason,
    )


_BANDS: Mapping[str, Sequence[_Band]] = {
    "2.c.10": (_PITCH, _PITCH_RATE, _NORMAL),
    "2.d.2": (_ROLL_RATE,),
    "2.d.6": (_YAW_RATE,),
}
PHUGOID = Test("2.c.9", "Phugoid dynamics", _phugoid)
SHORT_PERIOD = Test("2.c.10", "Short period dynamics", _short_period)
ROLL_RESPONSE = Test("2.d.2", "Roll response (rate)", _roll_response)
RUDDER_RESPONSE = Test("2.d.6", "Rudder response", _rudder_response)
DUTCH_ROLL = Test("2.d.7", "Dutch roll (yaw damper off)", _dutch_roll)

_BY_KIND: Mapping[str, Sequence[Test]] = {
    "phugoid": (PHUGOID,),
    "short_period": (SHORT_PERIOD,),
    "dutch_roll": (DUTCH_ROLL,),
    "rudder_response": (RUDDER_RESPONSE,),
    "roll": (ROLL_RESPONSE,),
    "bank_to_bank": (ROLL_RESPONSE,),
    "spiral": (),
}
_BY_CONTROL: Mapping[str, Sequence[Test]] = {
    "de": (SHORT_PERIOD,),
    "da": (ROLL_RESPONSE,),
    "dr": (DUTCH_ROLL, RUDDER_RESPONSE),
}
