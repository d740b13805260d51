"""Dynamic stability by CS-23.181 and CS-25.181.

Editions: EASA CS-23 Amendment 4 (2015), the last with numbered handling requirements, and EASA
CS-25 Amendment 27 (2021). 'Heavily damped' has no number in either; as the flight test guides read
it (FAA AC 23-8C, AC 25-7D), it is a tenth of the amplitude within about two cycles. What asks for
controls free needs hinge moments and friction, which no model here has.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, log, pi, sqrt

from alula.simulate.modes import Mode
from alula.simulate.requirement import Judgment, Verdict, missing, of_family, second_order

CS23 = "CS-23 Amendment 4 (2015)"
CS25 = "CS-25 Amendment 27 (2021)"
HEAVILY = 2.0  # cycles to a tenth of the amplitude
DUTCH_ROLL = 7.0  # cycles to a tenth of the amplitude
DUTCH_ROLL_HEIGHT = 18_000 * 0.3048  # m; above it the seven cycles are not what is asked
_FREE = "controls free: hinge moments and friction are not in the model"


def certification(modes: Sequence[Mode], h: float) -> list[Judgment]:
    """CS-23.181 and CS-25.181 at height h, m; controls fixed judged, controls free named."""
    return [
        *_short_period(modes, CS23, "23.181(a)"),
        *_dutch_roll_23(modes, h),
        _phugoid_23(modes),
        *_short_period(modes, CS25, "25.181(a)"),
        *_dutch_roll_25(modes),
    ]


def _short_period(modes: Sequence[Mode], edition: str, paragraph: str) -> list[Judgment]:
    asked = Judgment(
        edition, paragraph, "short period heavily damped, controls fixed; cycles to 1/10 amplitude",
        "short_period", None, "cycles", f"<= {HEAVILY:g}", "not judged",
    )  # fmt: skip
    free = _free(asked)
    found = second_order(modes, "short_period")
    if found is None:
        third = of_family(modes, "short_period")
        if any(not m.stable for m in third):  # a root that grows is not damped, whatever else
            return [_with(asked, None, "not met", missing(modes, "short_period")), free]
        return [asked.unjudged(missing(modes, "short_period")), free]
    cycles = _cycles(found.damping)
    return [_with(asked, cycles, "met" if cycles <= HEAVILY else "not met"), free]


def _dutch_roll_23(modes: Sequence[Mode], h: float) -> list[Judgment]:
    asked = Judgment(
        CS23, "23.181(b)", "Dutch roll damped, controls fixed; cycles to 1/10 amplitude",
        "dutch_roll", None, "cycles", f"<= {DUTCH_ROLL:g}", "not judged",
    )  # fmt: skip
    free = _free(asked)
    found = second_order(modes, "dutch_roll")
    if found is None:
        return [asked.unjudged(missing(modes, "dutch_roll")), free]
    cycles = _cycles(found.damping)
    if h > DUTCH_ROLL_HEIGHT:
        why = f"above {DUTCH_ROLL_HEIGHT:.0f} m (18 000 ft) another number of cycles is asked"
        return [_with(asked, cycles, "not judged", why), free]
    return [_with(asked, cycles, "met" if cycles <= DUTCH_ROLL else "not met"), free]


def _phugoid_23(modes: Sequence[Mode]) -> Judgment:
    asked = Judgment(
        CS23, "23.181(d)", "phugoid not so unstable as to raise the workload; damping ratio",
        "phugoid", None, "1", "in words only; met where it is damped", "not judged",
    )  # fmt: skip
    found = second_order(modes, "phugoid")
    if found is None:
        return asked.unjudged(missing(modes, "phugoid"))
    if found.damping > 0.0:
        return _with(asked, found.damping, "met")
    return _with(asked, found.damping, "not judged", "how unstable is too much, a pilot says")


def _dutch_roll_25(modes: Sequence[Mode]) -> list[Judgment]:
    asked = Judgment(
        CS25, "25.181(b)", "Dutch roll positively damped with controls free",
        "dutch_roll", None, "1", "> 0", "not judged",
    )  # fmt: skip
    found = second_order(modes, "dutch_roll")
    if found is None:
        return [asked.unjudged(missing(modes, "dutch_roll"))]
    why = f"{_FREE}; with controls fixed the damping ratio is the value given"
    return [
        _with(asked, found.damping, "not judged", why),
        Judgment(
            CS25, "25.181(b)", "Dutch roll controllable by normal use of the controls",
            "dutch_roll", None, "", "in words only", "not judged",
            "a pilot says whether exceptional skill is needed",
        ),
    ]  # fmt: skip


def _free(asked: Judgment) -> Judgment:
    words = asked.requirement.replace("controls fixed", "controls free")
    return Judgment(
        asked.edition, asked.paragraph, words, asked.mode, None, asked.unit, asked.limits,
        "not judged", _FREE,
    )  # fmt: skip


def _cycles(damping: float) -> float:
    """Cycles to a tenth of the amplitude: ln 10 sqrt(1 - zeta^2)/(2 pi zeta); 0 from zeta = 1."""
    if damping <= 0.0:
        return inf
    return log(10.0) / (2.0 * pi) * sqrt(max(0.0, 1.0 - damping**2)) / damping


def _with(asked: Judgment, value: float | None, verdict: Verdict, why: str = "") -> Judgment:
    return Judgment(
        asked.edition, asked.paragraph, asked.requirement, asked.mode, value, asked.unit,
        asked.limits, verdict, why,
    )  # fmt: skip
