"""Kirchhoff parameters from simulated stalls of the SportStar, whose truth is its aircraft file.

One X for the whole wing. Dynamic: quick pulls of the elevator through the stall and back; quasi-
steady: one slow pull. Noise on CL, CD, Cm and on the angle of attack.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from alula.flight import Maneuver
from alula.identify import CoefficientData
from alula.identify.flown.stall import identify_stall
from alula.identify.result import Identification
from alula.simulate.inputs import Steps, Sum
from verification.estimation.noisy_flights import Aircraft, flown, sportstar

FORMULAS = {"CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}
NOISE = {"CL": 0.02, "CD": 0.005, "Cm": 0.005, "alpha": 3e-4}  # rad: what a smoother leaves
DEG = np.pi / 180.0
HOLD = {("de", "alpha"): -2.0, ("de", "q"): -0.5}  # he follows an angle of attack


def wing(gentle: bool = False) -> Aircraft:
    """The SportStar with one X for both wings; gentle: its nose does not drop, so that it can be
    flown through the stall slowly.
    """
    aircraft = sportstar(stall=True)
    stall = aircraft.model.stall
    assert stall is not None
    whole = replace(
        stall, y_station=0.0, alpha_star_difference=0.0, Cm_X=0.0 if gentle else stall.Cm_X
    )
    return replace(aircraft, model=replace(aircraft.model, stall=whole))


def stall_data(aircraft: Aircraft, kind: str, seed: int) -> CoefficientData:
    """One maneuver, 'dynamic' or 'quasi-steady', from level flight at 25 m/s."""
    random = np.random.default_rng(seed)
    if kind == "dynamic":
        pulls = tuple(
            Steps(-size * DEG, start, (width,), (1.0,), 0.3)
            for start, size, width in ((1.0, 12.0, 1.0), (5.0, 15.0, 0.8), (9.0, 10.0, 1.5))
        )
        seconds = 14.0
        flight = flown(
            aircraft, kind, {"de": Sum(pulls)}, V=25.0, seconds=seconds, aspect="longitudinal",
            substeps=4,
        )  # fmt: skip
    else:
        seconds = 30.0  # before the loop of pilot and separated flow begins to swing
        flight = flown(
            aircraft, kind, {}, V=25.0, seconds=seconds, aspect="longitudinal", gains=HOLD,
            follow={"alpha": Steps(13.0 * DEG, 1.0, (90.0,), (1.0,), 38.0)},
        )  # fmt: skip
    m, r = flight.motion, aircraft.model.reference
    n = len(m.t)
    return CoefficientData(
        maneuver=Maneuver(kind, kind, "stall", 0.0, seconds, "longitudinal"),
        t=np.array(m.t),
        coefficients={
            c: m.recorded[c] + NOISE[c] * random.standard_normal(n) for c in ("CL", "CD", "Cm")
        },
        variables={
            "alpha": m.alpha + NOISE["alpha"] * random.standard_normal(n),
            "qhat": m.q * r.c / (2.0 * m.V),
            "de": np.array(m.controls["de"]),
        },
    )


def identified(kinds: tuple[str, ...], seed: int, gentle: bool = False) -> Identification:
    """Stall parameters of the kinds together."""
    aircraft = wing(gentle)
    s = aircraft.model.stall
    assert s is not None
    truth = {**aircraft.model.params, "a1": s.a1, "alpha_star": s.alpha_star, "tau1": s.tau1,
             "tau2": s.tau2, "Cm_X": s.Cm_X}  # fmt: skip
    data = [stall_data(aircraft, kind, 10 * seed + i) for i, kind in enumerate(kinds)]
    return identify_stall(data, FORMULAS, truth=truth)


def stall_identification(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds for every seed."""
    runs, holds, lost = 2 if quick else 10, True, 0
    worst = dict.fromkeys(("a1", "alpha_star", "tau2"), 0.0)
    for seed in range(runs):
        dynamic = identified(("dynamic", "quasi-steady"), seed)
        for name, limit in (("a1", 0.1), ("alpha_star", 0.1), ("tau2", 0.2)):
            p = dynamic[name]
            off = abs(p.value / float(p.truth or np.nan) - 1.0)
            worst[name] = max(worst[name], off if np.isfinite(off) else np.inf)
            holds &= off < limit
        slow = identified(("quasi-steady",), seed, gentle=True)["tau2"]
        named = slow.verdict == "not_identifiable"
        lost += named
        holds &= named or abs(slow.value / float(slow.truth or np.nan) - 1.0) < 0.2
    return (
        f"{runs} seeds, dynamic and quasi-steady stall: largest errors a1 "
        f"{worst['a1']:.1%}, alpha_star {worst['alpha_star']:.1%}, tau2 {worst['tau2']:.1%}; "
        f"quasi-steady alone: tau2 reads not identifiable in {lost} of {runs}",
        bool(holds),
    )
