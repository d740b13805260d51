"""Makes the demo's flight logs: two maneuvers of a SportStar-like aircraft, flown by the core's
own equations of motion and recorded by sensors with errors, so that the truth is known.

`python examples/demo/make_logs.py FOLDER [SEED]` writes a project that stands on its own: two logs,
project file, aircraft file, truth.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from alula.aircraft import Aircraft, load_aircraft
from alula.base.arrays import Array
from alula.base.files import write_whole
from alula.flight import Maneuver
from alula.model import AeroModel, load_model
from alula.simulate import (
    SensorError,
    Signal,
    SimulatedFlight,
    Sum,
    airframe_of,
    bank_to_bank,
    doublet,
    flow_angles,
    fly,
    input_3211,
    readings,
    specific_force_at,
    trim_level,
    velocity_at,
)

HERE = Path(__file__).resolve().parent
AIRCRAFT = HERE.parents[1] / "aircraft"
RATE = 100.0  # Hz
AIRSPEED, HEIGHT = 45.0, 914.4  # m/s; m (3000 ft)
RAMP = 0.3  # s, of a pilot's hand
WIND = (4.0, -3.0, 0.0)  # m/s NED, the way it blows to
DEG = np.pi / 180.0

# Standard deviation of each sensor's white noise, SI.
NOISE: Mapping[str, float] = {
    "ax": 0.03, "ay": 0.03, "az": 0.03,
    "p": 0.05 * DEG, "q": 0.05 * DEG, "r": 0.05 * DEG,
    "phi": 0.1 * DEG, "theta": 0.1 * DEG, "psi": 0.1 * DEG,
    "V": 0.2, "alpha": 0.1 * DEG, "beta": 0.1 * DEG,
    "h": 0.3, "v_north": 0.1, "v_east": 0.1, "v_down": 0.1,
    "de": 0.02 * DEG, "da": 0.02 * DEG, "dr": 0.02 * DEG,
    "thrust": 3.0,
}  # fmt: skip

# Standard deviation, from seed to seed, of errors that stay constant in a flight: biases in SI,
# gains (k_) relative.
CONSTANTS: Mapping[str, float] = {
    "b_ax": 0.05, "b_ay": 0.05, "b_az": 0.05,
    "b_p": 0.1 * DEG, "b_q": 0.1 * DEG, "b_r": 0.1 * DEG,
    "b_alpha": 0.3 * DEG, "b_beta": 0.3 * DEG, "k_alpha": 0.05, "k_beta": 0.05,
}  # fmt: skip

UNITS: Mapping[str, tuple[str, float]] = {  # unit in the log and SI per unit
    **dict.fromkeys(("ax", "ay", "az"), ("m/s2", 1.0)),
    **dict.fromkeys(("p", "q", "r"), ("deg/s", DEG)),
    **dict.fromkeys(("phi", "theta", "psi", "alpha", "beta", "de", "da", "dr"), ("deg", DEG)),
    **dict.fromkeys(("V", "v_north", "v_east", "v_down"), ("m/s", 1.0)),
    "h": ("m", 1.0),
    "thrust": ("N", 1.0),
}


@dataclass(frozen=True)
class DemoFiles:
    """What `simulate_demo` wrote."""

    project: Path
    logs: tuple[Path, ...]
    truth: Path


def maneuvers() -> dict[str, tuple[Maneuver, dict[str, Signal]]]:
    """The maneuvers by id, and the control deflections (rad) that are added to the trim."""
    elevator = Sum(
        (
            input_3211(-2.0 * DEG, start=1.5, unit=0.45, ramp=RAMP),
            doublet(2.0 * DEG, start=9.0, width=0.6, ramp=RAMP),
            doublet(-3.0 * DEG, start=14.0, width=0.45, ramp=RAMP),
        )
    )
    aileron = Sum(
        (
            bank_to_bank(-8.0 * DEG, start=1.5, width=0.8, hold=0.8, ramp=RAMP),
            doublet(8.0 * DEG, start=21.0, width=0.45, ramp=RAMP),
        )
    )
    rudder = Sum(
        (
            doublet(4.5 * DEG, start=10.0, width=1.0, ramp=RAMP),
            doublet(-4.5 * DEG, start=16.0, width=0.7, ramp=RAMP),
        )
    )
    return {
        "longitudinal": (
            Maneuver("longitudinal", "longitudinal", "3211", 0.0, 20.0, "longitudinal"),
            {"de": elevator},
        ),
        "lateral": (
            Maneuver("lateral", "lateral", "bank_to_bank", 0.0, 25.0, "lateral"),
            {"da": aileron, "dr": rudder},
        ),
    }


def fly_demo(aircraft: Aircraft, model: AeroModel) -> dict[str, SimulatedFlight]:
    """The true motion of each maneuver, by id; nothing in it is random."""
    airframe, wind = airframe_of(aircraft), np.array(WIND)
    trim = trim_level(airframe, model, AIRSPEED, HEIGHT, psi=30.0 * DEG, wind=wind)
    flights = {}
    for id, (maneuver, signals) in maneuvers().items():
        t = np.arange(0.0, maneuver.end + 0.5 / RATE, 1.0 / RATE)
        controls: dict[str, Array | float] = {**trim.controls, "thrust": trim.thrust}
        for name, signal in signals.items():
            controls[name] = trim.controls[name] + signal.value(t)
        flights[id] = fly(
            airframe, model, trim.state, t, controls, wind=wind, substeps=2, maneuver=maneuver
        )
    return flights


def sensed(flight: SimulatedFlight, aircraft: Aircraft) -> dict[str, Array]:
    """What sensors without errors would read where they sit, SI, (n,) by channel."""
    motion = flight.motion
    cg = aircraft.mass_properties(np.zeros(1)).cg[0]
    rates = np.stack([motion.p, motion.q, motion.r], axis=1)
    accelerations = np.stack([motion.pdot, motion.qdot, motion.rdot], axis=1)
    force = specific_force_at(
        np.stack([motion.ax, motion.ay, motion.az], axis=1),
        rates,
        accelerations,
        aircraft.sensor_position("ax") - cg,
    )
    air = velocity_at(flight.air_velocity, rates, aircraft.sensor_position("alpha") - cg)
    V, alpha, beta = flow_angles(air)
    ground = velocity_at(np.zeros_like(rates), rates, aircraft.sensor_position("v_north") - cg)
    if np.any(ground):
        raise ValueError("the demo's satellite antenna is at the center of gravity")
    assert motion.thrust is not None
    return {
        "ax": force[:, 0], "ay": force[:, 1], "az": force[:, 2],
        "p": motion.p, "q": motion.q, "r": motion.r,
        "phi": motion.phi, "theta": motion.theta, "psi": motion.psi,
        "V": V, "alpha": alpha, "beta": beta, "h": motion.h,
        "v_north": flight.velocity[:, 0], "v_east": flight.velocity[:, 1],
        "v_down": flight.velocity[:, 2],
        "de": motion.controls["de"], "da": motion.controls["da"], "dr": motion.controls["dr"],
        "thrust": motion.thrust,
    }  # fmt: skip


def simulate_demo(seed: int, folder: Path) -> DemoFiles:
    """Write the demo's logs, project, aircraft file and truth to `folder`, the same for each seed.

    Raises BadInput where the folder cannot be written to.
    """
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    model = load_model(AIRCRAFT / "sportstar_aero.toml")
    random = np.random.default_rng(seed)
    constants = {name: float(random.normal(0.0, sigma)) for name, sigma in CONSTANTS.items()}
    folder.mkdir(parents=True, exist_ok=True)
    logs = []
    for id, flight in fly_demo(aircraft, model).items():
        columns = {
            name: readings(
                truth,
                SensorError(
                    scale=constants.get(f"k_{name}", 0.0),
                    bias=constants.get(f"b_{name}", 0.0),
                    sigma=NOISE[name],
                ),
                random,
            )
            for name, truth in sensed(flight, aircraft).items()
        }
        logs.append(folder / f"{id}.csv")
        write_whole(logs[-1], log_text(flight.motion.t, columns))
    project, truth = folder / "demo.toml", folder / "truth.json"
    shutil.copyfile(HERE / "demo.toml", project)
    shutil.copyfile(AIRCRAFT / "sportstar.toml", folder / "sportstar.toml")
    wind = dict(zip(("wind_n", "wind_e", "wind_d"), WIND, strict=True))
    write_whole(
        truth,
        json.dumps({"parameters": model.params, "constants": {**constants, **wind}}, indent=1),
    )
    return DemoFiles(project, tuple(logs), truth)


def log_text(t: Array, columns: Mapping[str, Array]) -> str:
    """A log as comma-separated text; each column's name ends with its unit."""
    header = ["t_s", *(f"{name}_{UNITS[name][0]}" for name in columns)]
    table = np.column_stack([t, *(values / UNITS[name][1] for name, values in columns.items())])
    rows = [",".join(f"{value:.7g}" for value in row) for row in table.tolist()]
    return "\n".join([",".join(header), *rows]) + "\n"


if __name__ == "__main__":
    files = simulate_demo(int(sys.argv[2]) if len(sys.argv) > 2 else 1, Path(sys.argv[1]))
    print(files.project)
