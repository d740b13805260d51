"""Speed of the simulator: SportStar with its engine and steady wind, beside JSBSim's c172p.

One thread, RK4, one Python call. Two figures: one flight alone (`fly`), and the steps of all
flights where several go side by side (`fly_many`, each with its own start, elevator and wind). The
peers take turns within every round, so that a slow spell of the machine hits all; the best round
counts. JSBSim's c172p starts anew in every round, steps all of its models with its own integrators
(Adams-Bashforth and rectangles: one evaluation a step, RK4 has four), and flies one flight.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.core import ISA
from alula.model import AeroModel, load_model, lookup_table
from alula.simulate import airframe_of, fly, fly_many, initial_state
from alula.simulate.airframe import Airframe
from alula.simulate.condition import Condition
from alula.simulate.trim import Trim, trim
from alula.simulate.wind import Turbulence
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
WIND = np.array([4.0, -3.0, 0.0])
STEP, PER_SAMPLE = 0.01, 10  # s; samples at 10 Hz
FLIGHTS = 8  # side by side
MUST, RATIO = 500_000.0, 25.0  # steps/s of one flight; times JSBSim of flights side by side


def sportstar() -> tuple[Airframe, AeroModel, Trim]:
    """SportStar with its piston engine, its attached aerodynamics, and level flight at 45 m/s."""
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    airframe = airframe_of(aircraft, engines="modeled")
    model = replace(load_model(AIRCRAFT / "sportstar_aero.toml"), stall=None)
    level = trim(airframe, model, Condition(45.0, 900.0), wind=WIND)
    return airframe, model, level


def ours(steps: int, per_sample: int = PER_SAMPLE, **options: Any) -> Callable[[], float]:
    """A function that flies `steps` steps with an elevator that never rests: seconds taken.

    options: of `fly`; 'model' and 'airframe' replace SportStar's.
    """
    airframe, model, level = sportstar()
    airframe = options.pop("airframe", airframe)
    model = options.pop("model", model)
    t = np.arange(steps // per_sample + 1) * (STEP * per_sample)
    state = initial_state(
        45.0, level.alpha, level.theta, 900.0, beta=level.beta, wind=WIND, earth=airframe.earth
    )
    controls: dict[str, Array | float] = {**level.controls}
    controls["de"] = level.controls["de"] + np.radians(0.5) * np.sin(2.0 * np.pi * t / 3.0)

    def run() -> float:
        begin = time.thread_time()
        fly(airframe, model, state, t, controls, wind=WIND, substeps=per_sample, **options)
        return time.thread_time() - begin

    return run


def side_by_side(steps: int, flights: int = FLIGHTS) -> Callable[[], float]:
    """A function that flies `steps` steps in all, split over several flights: seconds taken."""
    airframe, model, level = sportstar()
    t = np.arange(steps // flights // PER_SAMPLE + 1) * (STEP * PER_SAMPLE)
    each = np.arange(flights)
    wind = WIND + 0.5 * np.stack([each, -each, 0.0 * each], axis=1)
    state = np.stack(
        [
            initial_state(45.0 + i, level.alpha, level.theta, 900.0 + 20.0 * i, wind=wind[i])
            for i in each
        ]
    )
    controls: dict[str, Array | float] = {**level.controls}
    controls["de"] = level.controls["de"] + np.radians(0.5) * np.sin(
        2.0 * np.pi * t / 3.0 + 0.5 * each[:, None]
    )

    def run() -> float:
        begin = time.thread_time()
        fly_many(airframe, model, state, t, controls, wind=wind, substeps=PER_SAMPLE)
        return time.thread_time() - begin

    return run


def variants(steps: int) -> dict[str, Callable[[], float]]:
    """What else may be on, each alone: turbulence, stall states, a table, every step recorded."""
    airframe, model, _ = sportstar()
    stalling = load_model(AIRCRAFT / "sportstar_aero.toml")
    alpha, beta = np.radians(np.linspace(-10.0, 20.0, 13)), np.radians(np.linspace(-15.0, 15.0, 7))
    table = lookup_table(
        {"alpha": alpha, "beta": beta}, 0.01 * np.outer(alpha**2, np.cos(beta)), "linear"
    )
    return {
        "turbulence": ours(steps, turbulence=Turbulence(W20=5.0, sigma=1.5, seed=1)),
        "stall states": ours(steps, model=stalling),
        "a table of 13 x 7": ours(steps, model=_with_table(model, table)),
        "WGS-84": ours(steps, airframe=replace(airframe, earth="wgs84")),
        "every step recorded": ours(steps, per_sample=1),
    }


def _with_table(model: AeroModel, table: Any) -> AeroModel:
    from alula.model import aero_model

    formulas = model.formulas
    formulas["CD"] = formulas["CD"] + " + extra(alpha, beta)"
    return aero_model(
        model.name, formulas, {**model.params, "CD_extra": 1.0}, model.reference,
        axes=model.axes, reference_point=model.reference_point, tables={"extra": table},
    )  # fmt: skip


def jsbsim_c172p(steps: int) -> Callable[[], float]:
    """The same for JSBSim's c172p in level flight with its engine running, from 3000 ft anew."""
    import jsbsim

    fdm = jsbsim.FGFDMExec(None)
    fdm.set_debug_level(0)
    fdm.load_model("c172p")

    def run() -> float:
        fdm["ic/h-sl-ft"] = 3000.0
        fdm["ic/vc-kts"] = 90.0
        fdm.run_ic()
        fdm["propulsion/set-running"] = -1
        fdm["fcs/throttle-cmd-norm"] = 0.7
        fdm["fcs/mixture-cmd-norm"] = 0.9
        begin = time.thread_time()
        for _ in range(steps):
            fdm.run()
        seconds = time.thread_time() - begin
        if not fdm["position/h-agl-ft"] > 300.0:  # not a step on the ground was timed
            raise RuntimeError("JSBSim's c172p did not stay in the air")
        return seconds

    return run


def measure(quick: bool = False) -> dict[str, float]:
    """Steps per second of the best of several rounds, by name; 'jsbsim' only where it is there."""
    steps, rounds = (20_000, 3) if quick else (50_000, 15)
    few = steps // 10
    all_steps = FLIGHTS * steps // 2  # a call of about the same length
    run = {"ours": (ours(steps), steps), "side_by_side": (side_by_side(all_steps), all_steps)}
    with contextlib.suppress(ModuleNotFoundError):
        run["jsbsim"] = (jsbsim_c172p(few), few)
    best = dict.fromkeys(run, 0.0)
    for _ in range(rounds):
        for name, (function, n) in run.items():
            best[name] = max(best[name], n / function())
    for name, function in variants(steps).items():
        best[name] = max(steps / function() for _ in range(3))
    return best


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found in words, and whether one flight's speed and the others' ratio hold."""
    found = measure(quick)
    one, many = found.pop("ours"), found.pop("side_by_side")
    peer = found.pop("jsbsim", None)

    def beside(speed: float) -> str:
        return f" ({speed / peer:.1f} times JSBSim)" if peer else ""

    words = [
        f"one flight: {one:.0f} steps/s{beside(one)}",
        f"{FLIGHTS} flights side by side in one call, steps of all: {many:.0f} steps/s"
        f"{beside(many)}",
        f"{ISA}, one thread, four evaluations of the equations a step",
        f"JSBSim's c172p: {peer:.0f} steps/s of one flight, one evaluation a step"
        if peer
        else "JSBSim is not there (pip install jsbsim)",
    ]
    words.append("one flight with " + ", ".join(f"{name}: {found[name]:.0f}" for name in found))
    return "; ".join(words), one >= MUST and peer is not None and many / peer >= RATIO


def bench_rows(rounds: int = 15) -> list[dict[str, Any]]:
    """The rows of `make bench`: seconds of 50 000 steps, of ours and of JSBSim, in turn.

    That a flight allocates nothing is tested in core/tests/test_aircraft_states.cpp and
    test_flights_run.cpp.
    """
    steps = 50_000
    run = {
        "simulation": (ours(steps), 1.0),
        "simulation_side_by_side": (side_by_side(FLIGHTS * steps), 1.0 / FLIGHTS),
        "jsbsim": (jsbsim_c172p(steps // 10), 10.0),
    }
    seconds: dict[str, list[float]] = {name: [] for name in run}
    for _ in range(rounds):
        for name, (function, k) in run.items():
            seconds[name].append(function() * k)
    best = {name: min(values) for name, values in seconds.items()}
    peer = best.pop("jsbsim")
    return [
        {
            "name": f"{name}_{ISA}",
            "ours_s": ours_s,
            "peer": "JSBSim c172p",
            "peer_s": peer,
            "ratio": peer / ours_s,
            "allocations": None,
        }
        for name, ours_s in best.items()
    ]
