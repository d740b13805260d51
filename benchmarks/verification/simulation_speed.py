"""Speed of the simulator: SportStar with its engine and steady wind, beside JSBSim's c172p.

One thread, RK4, one Python call. The peers take turns within every round, so that a slow spell of
the machine hits both; the best round counts. JSBSim's c172p steps all of its models with its own
integrators (Adams-Bashforth and rectangles: one evaluation a step, RK4 has four).
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.core import ISA
from alula.model import AeroModel, load_model, lookup_table
from alula.simulate import airframe_of, fly, initial_state
from alula.simulate.airframe import Airframe
from alula.simulate.condition import Condition
from alula.simulate.trim import Trim, trim
from alula.simulate.wind import Turbulence

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
WIND = np.array([4.0, -3.0, 0.0])
STEP, PER_SAMPLE = 0.01, 10  # s; samples at 10 Hz
MUST, RATIO = 500_000.0, 25.0


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
        begin = time.perf_counter()
        fly(airframe, model, state, t, controls, wind=WIND, substeps=per_sample, **options)
        return time.perf_counter() - begin

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
    """The same for JSBSim's c172p in level flight with its engine running."""
    import jsbsim

    fdm = jsbsim.FGFDMExec(None)
    fdm.set_debug_level(0)
    fdm.load_model("c172p")
    fdm["ic/h-sl-ft"] = 3000.0
    fdm["ic/vc-kts"] = 90.0
    fdm.run_ic()
    fdm["propulsion/set-running"] = -1
    fdm["fcs/throttle-cmd-norm"] = 0.7
    fdm["fcs/mixture-cmd-norm"] = 0.9

    def run() -> float:
        begin = time.perf_counter()
        for _ in range(steps):
            fdm.run()
        return time.perf_counter() - begin

    return run


def measure(quick: bool = False) -> dict[str, float]:
    """Steps per second of the best of several rounds, by name; 'jsbsim' only where it is there."""
    steps, rounds = (20_000, 3) if quick else (50_000, 15)
    few = steps // 10
    run = {"ours": (ours(steps), steps)}
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
    """What was found in words, and whether speed and ratio hold."""
    found = measure(quick)
    speed, peer = found.pop("ours"), found.pop("jsbsim", None)
    ratio = speed / peer if peer else 0.0
    words = [f"{speed:.0f} steps/s ({ISA}), four evaluations of the equations each"]
    words.append(
        f"{ratio:.1f} times JSBSim's {peer:.0f}, which evaluates once a step (per evaluation "
        f"{4.0 * ratio:.0f} times)"
        if peer
        else "JSBSim is not there (pip install jsbsim)"
    )
    words += [f"{name}: {value:.0f}" for name, value in found.items()]
    return "; ".join(words), speed >= MUST and ratio >= RATIO


def bench_rows(rounds: int = 15) -> list[dict[str, Any]]:
    """The row of `make bench`: seconds of 50 000 steps, of ours and of JSBSim, in turn.

    That a flight allocates nothing is tested in core/tests/test_aircraft_states.cpp.
    """
    steps = 50_000
    run = {"ours": (ours(steps), 1), "jsbsim": (jsbsim_c172p(steps // 10), 10)}
    seconds: dict[str, list[float]] = {name: [] for name in run}
    for _ in range(rounds):
        for name, (function, k) in run.items():
            seconds[name].append(function() * k)
    best = {name: min(values) for name, values in seconds.items()}
    return [
        {
            "name": f"simulation_{ISA}",
            "ours_s": best["ours"],
            "peer": "JSBSim c172p",
            "peer_s": best["jsbsim"],
            "ratio": best["jsbsim"] / best["ours"],
            "allocations": None,
        }
    ]
