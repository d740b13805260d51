"""Levels of MIL-F-8785C, Flying Qualities of Piloted Airplanes, 5 November 1980.

Level 1 is adequate for the mission, level 2 with more workload, level 3 controllable. The limits
are those of Tables IV (short period damping), VI (Dutch roll), VII (roll), VIII (spiral) and of
Figures 1 to 3 (short period frequency); class II is the land-based one. In Table VII level 3 is
10 s throughout.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from alula.simulate.modes import Mode
from alula.simulate.requirement import Judgment, Verdict, missing, of_family, second_order

EDITION = "MIL-F-8785C (5 November 1980)"
CLASSES = ("I", "II", "III", "IV")
CATEGORIES = ("A", "B", "C")
_LEVELS: tuple[Verdict, ...] = ("level 1", "level 2", "level 3")
_LIGHT = ("I", "IV")

# omega^2/(n/alpha), 1/(g s2): lowest and highest by level; Figures 1 to 3.
_CAP = {
    "A": ((0.28, 3.6), (0.16, 10.0), (0.16, inf)),
    "B": ((0.085, 3.6), (0.038, 10.0), (0.038, inf)),
    "C": ((0.16, 3.6), (0.096, 10.0), (0.096, inf)),
}
_DAMPING = {  # Table IV
    "A": ((0.35, 1.30), (0.25, 2.00), (0.15, inf)),
    "B": ((0.30, 2.00), (0.20, 2.00), (0.15, inf)),
    "C": ((0.35, 1.30), (0.25, 2.00), (0.15, inf)),
}
_SPIRAL = {"A": (12.0, 8.0, 4.0), "B": (20.0, 8.0, 4.0), "C": (12.0, 8.0, 4.0)}  # Table VIII
_ROLL_SPIRAL = (0.5, 0.3, 0.15)


def military(
    modes: Sequence[Mode], n_alpha: float | None, aircraft_class: str, category: str
) -> list[Judgment]:
    """Every paragraph that the modes of fixed controls tell. n_alpha: n/alpha, 1/rad."""
    return [
        _static(modes),
        _phugoid(modes),
        *_short_period(modes, n_alpha, aircraft_class, category),
        _dutch_roll(modes, aircraft_class, category),
        _roll(modes, aircraft_class, category),
        _spiral(modes, category),
        *_roll_spiral(modes, category),
    ]


def _level(*held: bool) -> Verdict:
    """The first level whose condition holds."""
    return next((n for n, h in zip(_LEVELS, held, strict=True) if h), "below level 3")


def _static(modes: Sequence[Mode]) -> Judgment:
    families = ("short_period", "phugoid", "third_oscillation")
    diverging = [m for m in modes if m.family in families and m.form == "aperiodic"]
    times = [m.time_to_double for m in diverging if m.time_to_double is not None]
    worst = min(times, default=inf)
    return Judgment(
        EDITION,
        "3.2.1.1",
        "no aperiodic divergence of airspeed; time to double",
        next((m.name for m in diverging if m.time_to_double == worst), "longitudinal"),
        worst if times else None,
        "s",
        "levels 1 and 2: none; level 3: >= 6 s",
        _level(not times, not times, worst >= 6.0),
    )


def _phugoid(modes: Sequence[Mode]) -> Judgment:
    found = [m for m in of_family(modes, "phugoid") if m.damping is not None]
    asked = Judgment(
        EDITION, "3.2.1.2", "phugoid damping ratio", "phugoid", None, "1",
        "level 1: >= 0.04; level 2: >= 0; level 3: time to double >= 55 s", "not judged",
    )  # fmt: skip
    if not found:
        return asked.unjudged(missing(modes, "phugoid"))
    zeta, double = found[0].damping or 0.0, found[0].time_to_double
    verdict = _level(zeta >= 0.04, zeta >= 0.0, double is None or double >= 55.0)
    return _with(asked, zeta, verdict)


def _short_period(
    modes: Sequence[Mode], n_alpha: float | None, aircraft_class: str, category: str
) -> list[Judgment]:
    found = second_order(modes, "short_period")
    heavy = aircraft_class in ("II", "III")
    cap, damping = _CAP[category], _DAMPING[category]
    lowest = {  # rad/s; then n/alpha, 1/rad: the figures' ends at the left and at the bottom
        "A": ((1.0, 0.6, 0.0), (0.0, 0.0, 0.0)),
        "B": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        "C": (
            (0.7, 0.4, 0.0) if heavy else (0.87, 0.6, 0.0),
            (2.0, 1.0, 0.0) if heavy else (2.7, 1.8, 0.0),
        ),
    }[category]
    words = _ranges(cap)
    if category != "B":
        words += "; frequency >= " + ", ".join(f"{w:g}" for w in lowest[0][:2]) + " rad/s"
    if category == "C":
        words += "; n/alpha >= " + ", ".join(f"{n:g}" for n in lowest[1][:2]) + " 1/rad"
    asked_cap = Judgment(
        EDITION, "3.2.2.1.1", f"short period omega^2/(n/alpha), category {category}",
        "short_period", None, "1/(g s2)", words, "not judged",
    )  # fmt: skip
    asked_damping = Judgment(
        EDITION, "3.2.2.1.2", f"short period damping ratio, category {category}",
        "short_period", None, "1", _ranges(damping), "not judged",
    )  # fmt: skip
    if found is None:
        why = missing(modes, "short_period")
        return [asked_cap.unjudged(why), asked_damping.unjudged(why)]
    zeta = found.damping
    out = [_with(asked_damping, zeta, _level(*(low <= zeta <= high for low, high in damping)))]
    if n_alpha is None or n_alpha <= 0.0:
        return [asked_cap.unjudged("n/alpha has no positive value here"), *out]
    value = found.frequency**2 / n_alpha
    verdict = _level(
        *(
            low <= value <= high and found.frequency >= w and n_alpha >= n
            for (low, high), w, n in zip(cap, *lowest, strict=True)
        )
    )
    return [_with(asked_cap, value, verdict), *out]


def _dutch_roll(modes: Sequence[Mode], aircraft_class: str, category: str) -> Judgment:
    light = aircraft_class in _LIGHT
    # damping ratio, damping times frequency (rad/s), frequency (rad/s) of level 1; Table VI
    first = {
        "A": (0.19, 0.35, 1.0 if light else 0.4),
        "B": (0.08, 0.15, 0.4),
        "C": (0.08, 0.15, 1.0) if light else (0.08, 0.10, 0.4),
    }[category]
    least = (first, (0.02, 0.05, 0.4), (0.0, -inf, 0.4))
    found = [m for m in of_family(modes, "dutch_roll") if m.frequency is not None]
    asked = Judgment(
        EDITION, "3.3.1.1",
        f"Dutch roll damping ratio, class {aircraft_class}, category {category}",
        "dutch_roll", None, "1", "", "not judged",
    )  # fmt: skip
    if not found:
        return asked.unjudged(missing(modes, "dutch_roll"))
    omega, zeta = found[0].frequency or 0.0, found[0].damping or 0.0
    ratio = bank_to_sideslip(found[0])
    # What rolls much must be damped more.
    excess = max(0.0, omega**2 * (ratio or 0.0) - 20.0)
    product = [least[i][1] + c * excess for i, c in enumerate((0.014, 0.009, 0.005))]
    product[2] = 0.005 * excess if excess > 0.0 else -inf
    damping = [max(z, p / omega) for (z, _, _), p in zip(least, product, strict=True)]
    if aircraft_class == "III":
        damping = [min(z, 0.7) for z in damping]
    words = "; ".join(
        f"{level}: >= {z:.3g} with frequency >= {row[2]:g} rad/s"
        for level, z, row in zip(_LEVELS, damping, least, strict=True)
    )
    held = (zeta >= z and omega >= row[2] for z, row in zip(damping, least, strict=True))
    verdict = _level(*held)
    return Judgment(
        EDITION, asked.paragraph, asked.requirement, found[0].name, zeta, "1", words, verdict
    )


def _roll(modes: Sequence[Mode], aircraft_class: str, category: str) -> Judgment:
    quick = aircraft_class in _LIGHT and category != "B"
    limits = (1.0, 1.4, 10.0) if quick else (1.4, 3.0, 10.0)
    asked = Judgment(
        EDITION, "3.3.1.2", f"roll time constant, class {aircraft_class}, category {category}",
        "roll", None, "s", _steps(limits, "<=", "s"), "not judged",
    )  # fmt: skip
    found = of_family(modes, "roll")
    if len(found) != 1 or found[0].form != "aperiodic":
        return asked.unjudged(missing(modes, "roll"))
    tau = found[0].time_constant
    if tau is None:
        return _with(asked, None, "below level 3")
    return _with(asked, tau, _level(*(0.0 < tau <= t for t in limits)))


def _spiral(modes: Sequence[Mode], category: str) -> Judgment:
    limits = _SPIRAL[category]
    asked = Judgment(
        EDITION, "3.3.1.3", f"spiral, time to double, category {category}",
        "spiral", None, "s", _steps(limits, ">=", "s"), "not judged",
    )  # fmt: skip
    found = of_family(modes, "spiral")
    if len(found) != 1 or found[0].form != "aperiodic":
        return asked.unjudged(missing(modes, "spiral"))
    double = found[0].time_to_double
    return _with(asked, double, _level(*(double is None or double >= t for t in limits)))


def _roll_spiral(modes: Sequence[Mode], category: str) -> list[Judgment]:
    found = of_family(modes, "roll_spiral")
    if not found:
        return []
    value = -found[0].eigenvalue.real
    asked = Judgment(
        EDITION, "3.3.1.4",
        f"coupled roll and spiral, damping times frequency, category {category}",
        "roll_spiral", value, "rad/s", _steps(_ROLL_SPIRAL, ">", "rad/s"), "not judged",
    )  # fmt: skip
    if category == "A":
        return [asked.unjudged("not allowed where the flight phase maneuvers more than gently")]
    return [_with(asked, value, _level(*(value > t for t in _ROLL_SPIRAL)))]


def bank_to_sideslip(mode: Mode) -> float | None:
    """|phi/beta| of an oscillation, rad/rad; None where it has no sideslip."""
    phi, beta = mode.shape.get("phi"), mode.shape.get("beta")
    if phi is None or beta is None or abs(beta) < 1e-9:
        return None
    return abs(phi) / abs(beta)


def _with(asked: Judgment, value: float | None, verdict: Verdict) -> Judgment:
    return Judgment(
        asked.edition, asked.paragraph, asked.requirement, asked.mode, value, asked.unit,
        asked.limits, verdict,
    )  # fmt: skip


def _ranges(limits: Sequence[tuple[float, float]]) -> str:
    return "; ".join(
        f"{level}: {low:g} to {high:g}" if high < inf else f"{level}: >= {low:g}"
        for level, (low, high) in zip(_LEVELS, limits, strict=True)
    )


def _steps(limits: Sequence[float], sign: str, unit: str) -> str:
    return "; ".join(
        f"{level}: {sign} {t:g} {unit}" for level, t in zip(_LEVELS, limits, strict=True)
    )
