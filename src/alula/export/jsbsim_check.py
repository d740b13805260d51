"""Flies an exported aircraft in JSBSim and in Alula under the same controls, and compares."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.export.jsbsim_engine import THRUST
from alula.export.jsbsim_property import COMMANDS, FT, PROPERTIES, norm_command
from alula.export.jsbsim_write import jsbsim_name, limits_of
from alula.model import AeroModel
from alula.simulate import Airframe, Condition, SimulatedFlight, Trim, fly, trim

V_TOLERANCE = 0.2  # m/s
ANGLE_TOLERANCE = float(np.radians(0.1))
ANGLES = ("alpha", "beta", "phi", "theta", "psi")
_LATITUDE = 0.8  # rad; anywhere but on a pole
_DT, _SUBSTEPS = 0.02, 20  # s; JSBSim's integrators are of low order: a step of 1 ms
_EARTH_RATE = 7.292115e-5  # rad/s
_OUTPUTS = {
    "V": ("velocities/vt-fps", FT),
    "alpha": ("aero/alpha-rad", 1.0),
    "beta": ("aero/beta-rad", 1.0),
    "phi": ("attitude/phi-rad", 1.0),
    "theta": ("attitude/theta-rad", 1.0),
    "psi": ("attitude/psi-rad", 1.0),
    "h": ("position/h-sl-ft", FT),
}


@dataclass(frozen=True)
class Comparison:
    """One maneuver flown twice. difference: largest of V (m/s), angles (rad), h (m), coefficients.

    ours, theirs: time histories (n,) by name over t (n,).
    """

    maneuver: str
    t: Array
    ours: Mapping[str, Array]
    theirs: Mapping[str, Array]
    difference: Mapping[str, float]

    @property
    def passed(self) -> bool:
        """Whether V is within 0.2 m/s and every angle within 0.1 deg."""
        d = self.difference
        return d["V"] <= V_TOLERANCE and all(d[a] <= ANGLE_TOLERANCE for a in ANGLES)


def require_jsbsim() -> None:
    """Raise BadInput where the consumer is not there to load the export."""
    if find_spec("jsbsim") is None:
        raise refuse(
            "jsbsim_missing",
            where="export to JSBSim",
            expected="JSBSim, to load and fly what is exported before it is called exported",
            found="no Python package 'jsbsim'",
            do="pip install 'alula[export]', or write it unchecked with --unchecked.",
        )


def entry_condition(aircraft: Aircraft, airframe: Airframe, model: AeroModel) -> Condition:
    """A level flight to compare in: inside the envelope, or at a lift coefficient of 0.5."""
    low, high = aircraft.envelope.h or (0.0, 2000.0)
    h = float(np.clip(1000.0, low, high))
    if aircraft.envelope.V is not None:
        V = float(np.sqrt(aircraft.envelope.V[0] * aircraft.envelope.V[1]))
    else:
        V = float(np.sqrt(2.0 * airframe.mass * 9.81 / (1.1 * model.reference.S * 0.5)))
    return Condition(V, h)


def compare_jsbsim(
    aircraft: Aircraft,
    airframe: Airframe,
    model: AeroModel,
    folder: Path,
    *,
    condition: Condition | None = None,
    duration: float = 20.0,
) -> tuple[Comparison, ...]:
    """Fly an elevator doublet and a rudder doublet from trim in both, `duration` s each.

    An aircraft whose model has no rudder flies the ailerons instead. folder: JSBSim's aircraft
    path. Alula flies over the turning WGS-84 Earth, as JSBSim does. Raises BadInput where there is
    no trim, or JSBSim does not take the file.
    """
    require_jsbsim()
    airframe = replace(airframe, earth="wgs84")
    condition = condition or entry_condition(aircraft, airframe, model)
    condition = replace(condition, place=(_LATITUDE, 0.0))
    limits = limits_of(aircraft)
    entry = trim(airframe, model, condition, limits=limits)
    t: Array = np.arange(round(duration / _DT) + 1, dtype=np.float64) * _DT
    out = []
    used = {v for _, term in model.terms for f in term.factors for v in f.variables}
    lateral = ("dr", 0.08) if "dr" in used or "da" not in used else ("da", 0.02)
    for control, size in (("de", 0.05), lateral):
        low, high = limits[control]
        base = entry.controls[control]
        size = min(size, 0.5 * (high - base), 0.5 * (base - low))
        step = 1.0  # s
        shape = np.where((t >= 1.0) & (t < 1.0 + step), 1.0, 0.0)
        shape -= np.where((t >= 1.0 + step) & (t < 1.0 + 2.0 * step), 1.0, 0.0)
        controls = {n: np.full(len(t), x) for n, x in entry.controls.items()}
        controls[control] = base + size * shape
        name = {"de": "elevator", "dr": "rudder", "da": "aileron"}[control] + " doublet"
        out.append(_flown_twice(name, aircraft, airframe, model, folder, entry, t, controls))
    return tuple(out)


def _flown_twice(
    name: str,
    aircraft: Aircraft,
    airframe: Airframe,
    model: AeroModel,
    folder: Path,
    entry: Trim,
    t: Array,
    controls: Mapping[str, Array],
) -> Comparison:
    inputs = {**controls, "thrust": np.full(len(t), entry.thrust)}
    flight = fly(airframe, model, entry.state, t, inputs, substeps=4)
    m = flight.motion
    ours = {n: np.asarray(getattr(m, n)) for n in _OUTPUTS} | dict(m.recorded)
    names = {n: p for n, (p, _) in _OUTPUTS.items()}
    names |= {c: f"aero/coefficient/{c}" for c in model.coefficients}
    limits = limits_of(aircraft)
    commands = {
        COMMANDS[n][0]: np.array([norm_command(n, x, limits[n]) for x in controls[n]])
        for n in COMMANDS
    }
    start = {THRUST: entry.thrust} | _states(
        airframe, {n: float(x[0]) for n, x in flight.states.items()}
    )
    values = _in_jsbsim(
        folder, jsbsim_name(aircraft), _initial(flight), start, commands, list(names.values())
    )
    scale = {n: s for n, (_, s) in _OUTPUTS.items()}
    theirs = {n: values[:, i] * scale.get(n, 1.0) for i, n in enumerate(names)}
    difference = {}
    for n in names:
        if n not in ours or (model.stall is not None and n in model.coefficients):
            continue  # with a stall Alula records the whole, JSBSim's function the attached flow
        gap = theirs[n] - ours[n]
        if n in ("phi", "psi"):
            gap = (gap + np.pi) % (2.0 * np.pi) - np.pi
        difference[n] = float(np.max(np.abs(gap)))
    return Comparison(name, t, ours, theirs, difference)


def _initial(f: SimulatedFlight) -> dict[str, float]:
    """JSBSim's initial conditions: place, attitude, velocity against the air, rates."""
    m, place = f.motion, f.position[0]
    phi, theta, psi = (float(x[0]) for x in (m.phi, m.theta, m.psi))
    # Rates are against the turning Earth there: its own rate, turned into the body, goes off.
    north, down = _EARTH_RATE * np.cos(place[0]), -_EARTH_RATE * np.sin(place[0])
    c, s = np.cos(psi) * north, -np.sin(psi) * north  # heading axes: forward, right
    x = c * np.cos(theta) - down * np.sin(theta)
    z0 = c * np.sin(theta) + down * np.cos(theta)
    y = s * np.cos(phi) + z0 * np.sin(phi)
    z = z0 * np.cos(phi) - s * np.sin(phi)
    u, v, w = (f.air_velocity[0] / FT).tolist()
    return {
        "ic/lat-geod-rad": float(place[0]),
        "ic/long-gc-rad": float(place[1]),
        "ic/h-sl-ft": float(place[2]) / FT,
        "ic/phi-rad": phi,
        "ic/theta-rad": theta,
        "ic/psi-true-rad": psi,
        "ic/u-fps": u,
        "ic/v-fps": v,
        "ic/w-fps": w,
        "ic/p-rad_sec": float(m.p[0] - x),
        "ic/q-rad_sec": float(m.q[0] - y),
        "ic/r-rad_sec": float(m.r[0] - z),
    }


def _states(airframe: Airframe, at: Mapping[str, float]) -> dict[str, float]:
    """Rotors' speeds, actuators and separation points to start from, by property.

    at: Alula's further states by name.
    """
    out: dict[str, float] = {}
    for key, state, kinds in (
        ("omega", "omega-rad_s", ("piston", "electric")),
        ("power", "power", ("turbofan",)),
    ):
        having = [i for i, e in enumerate(airframe.engines) if e.kind in kinds]
        values = [x for n, x in at.items() if n.startswith(key)]
        out |= {f"alula/engine[{i}]/{state}": x for i, x in zip(having, values, strict=True)}
    out |= {PROPERTIES[n]: at[n] for n in airframe.actuators}
    sides = {"X": "alula/stall/X", "X_left": "alula/stall-left/X", "X_right": "alula/stall-right/X"}
    return out | {p: at[n] for n, p in sides.items() if n in at}


def _in_jsbsim(
    folder: Path,
    name: str,
    initial: Mapping[str, float],
    start: Mapping[str, float],
    commands: Mapping[str, Array],
    outputs: list[str],
) -> Array:
    with tempfile.TemporaryDirectory() as scratch:
        given, out = Path(scratch) / "in.npz", Path(scratch) / "out.npz"
        np.savez(
            given,
            initial_names=list(initial), initial=list(initial.values()),
            start_names=list(start), start=list(start.values()),
            command_names=list(commands), commands=np.array(list(commands.values())).T,
            dt=_DT, substeps=_SUBSTEPS, outputs=outputs,
        )  # fmt: skip
        # by its file, not as a module of the package, whose other modules take longer to load; -P:
        # the folder holds a jsbsim.py of Alula's own
        words = [sys.executable, "-P", str(Path(__file__).with_name("jsbsim_child.py"))]
        done = subprocess.run(
            [*words, str(folder), name, str(given), str(out)],
            capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip
        if done.returncode != 0 or not out.exists():
            said = (done.stderr or done.stdout).strip().splitlines()
            raise refuse(
                "jsbsim_refused",
                where=f"{folder / name / name}.xml",
                expected="a file that JSBSim loads and flies",
                found=said[-1] if said else f"exit {done.returncode}",
                do="Nothing was exported; please report it with the aircraft and the model.",
            )
        with np.load(out) as run:
            return np.asarray(run["values"], dtype=np.float64)
