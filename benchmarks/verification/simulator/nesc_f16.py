"""NESC check case 11: the F-16 from its DAVE-ML files, trimmed and flown over the turning Earth.

NASA/TM-2015-218675. The case flies straight and level at 10013 ft with controls and throttle held
where they trim; they are not recorded and are solved for from the recorded initial state. Sim 04
records moments about the center of mass, sim 02 about the moment reference center; that the center
of mass lies at 25 % follows from sim 02's moment over its force.

The flight that is judged starts from sim 04's state. Sim 02's own start is flown too and shown: its
side force differs from the one its recorded sideslip gives, and its heading then goes another way.
Why is not known; its other forces and moments agree to 5e-5.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.optimize import least_squares

from alula.aircraft import EngineModel, Turbofan
from alula.base.arrays import Array, frozen
from alula.base.units import FT, LBF, SLUG
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import read_daveml
from alula.model import AeroModel
from alula.simulate import Airframe, fly, initial_state
from alula.simulate.airframe import core_model
from alula.simulate.fly import attitudes
from verification.places import DATA

SIMS = ("02", "04")
CG_PERCENT = 25.0  # sim 02's moment about 35 % is its force times a tenth of the chord
_COLUMNS = {
    "altitude": "altitudeMsl_ft",
    "yaw": "eulerAngle_deg_Yaw",
    "pitch": "eulerAngle_deg_Pitch",
    "roll": "eulerAngle_deg_Roll",
}


@dataclass(frozen=True)
class F16:
    """The aircraft of the case; reference point: the model's, from the center of mass, m."""

    airframe: Airframe
    model: AeroModel


def f16(models: Path) -> F16:
    """The F-16 of the folder's DAVE-ML files."""
    inertia = {
        k: float(x)
        for k, x in read_daveml(models / "F16_inertia.dml")
        .evaluate({"CG_PCT_MAC": CG_PERCENT})
        .items()
    }
    J = np.diag([inertia["XIXX"], inertia["XIYY"], inertia["XIZZ"]])
    J[0, 2] = J[2, 0] = -inertia["XIZX"]
    point = -FT * np.array([inertia["DXCG"], inertia["DYCG"], inertia["DZCG"]])
    tables = {f.output: f for f in read_daveml(models / "F16_prop.dml").functions}
    mach, height = tables["T_MIL"].axes
    thrust = {n: frozen(LBF * tables[f"T_{n}"].values) for n in ("IDLE", "MIL", "MAX")}
    engine = Turbofan(
        mach=mach.breakpoints,
        height=frozen(FT * height.breakpoints),
        idle=thrust["IDLE"],
        military=thrust["MIL"],
        maximum=thrust["MAX"],
        military_at=0.5,
        lag=1.0,
        angular_momentum=0.0,
        idle_speed=0.0,
        consumption=0.0,
    )
    forward = frozen([1.0, 0.0, 0.0])
    engines = (EngineModel("F100", frozen(np.zeros(3)), forward, None, None, 0.0, 1.0, engine),)
    airframe = Airframe(
        inertia["XMASS"] * SLUG, frozen(J * SLUG * FT**2), engines=engines, earth="wgs84"
    )
    aero = import_daveml(read_daveml(models / "F16_aero.dml"), reference_point=point).model
    return F16(airframe, aero)


def recorded_start(sim: pd.DataFrame) -> Array:
    """State (13,) of the first row of a sim."""
    row = sim.iloc[0]
    phi, theta, psi = np.radians([row[_COLUMNS[n]] for n in ("roll", "pitch", "yaw")])
    rates = [row[f"bodyAngularRateWrtEi_deg_s_{n}"] for n in ("Roll", "Pitch", "Yaw")]
    x = initial_state(
        1.0, 0.0, theta, FT * row["altitudeMsl_ft"], phi=phi, psi=psi,
        rates=tuple(np.radians(rates)), earth="wgs84",
        latitude=np.radians(row["latitude_deg"]), longitude=np.radians(row["longitude_deg"]),
    )  # fmt: skip
    velocity = FT * np.array([row[f"feVelocity_ft_s_{n}"] for n in "XYZ"])
    x[7:10] = attitudes(x[None], "wgs84")[1][0] @ velocity
    return x


def trimmed(plane: F16, x: Array) -> tuple[dict[str, float], Array, Array]:
    """Controls and throttle that leave no angular and no forward acceleration at a state.

    Also the aerodynamic force (3,) lbf and its moment about the reference point (3,) ft lbf.
    """
    plant = core_model(plane.airframe, plane.model)
    dx, y = np.empty(plant.state_count), np.empty(plant.output_count)

    def rates(z: Array) -> Array:
        u, state = np.zeros(plant.input_count), np.zeros(plant.state_count)
        u[[0, 1, 2, 4]] = z
        plant.settle(x, u, state)
        plant.rates(state, u, dx, y)
        return dx[[10, 11, 12, 7]]

    found = least_squares(
        rates, [-0.05, 0.0, 0.0, 0.14], x_scale=0.01, xtol=1e-15, ftol=1e-15, gtol=1e-15
    )
    rates(found.x)
    r = plane.model.reference
    pressure_area = 0.5 * y[10] * y[6] ** 2 * r.S / LBF
    force = pressure_area * y[11:14]
    moment = pressure_area / FT * y[14:17] * np.array([r.b, r.c, r.b])
    controls = dict(zip(("de", "da", "dr", "dt"), found.x.tolist(), strict=True))
    return controls, force, moment


def sims(folder: Path) -> dict[str, pd.DataFrame]:
    """The two recordings of the case."""
    return {n: pd.read_csv(folder / f"Atmos_11_sim_{n}.csv") for n in SIMS}


def flown(plane: F16, x: Array, controls: dict[str, float], seconds: int = 20) -> dict[str, Array]:
    """Altitude (ft) and Euler angles (deg) at 10 Hz, controls held."""
    t = np.arange(10 * seconds + 1) * 0.1
    flight = fly(plane.airframe, plane.model, x, t, controls, substeps=10)
    m = flight.motion
    angles = {"yaw": m.psi, "pitch": m.theta, "roll": m.phi}
    return {
        "altitude": flight.position[:, 2] / FT,
        **{n: np.degrees(a) for n, a in angles.items()},
    }


def beside(
    ours: dict[str, Array], recorded: dict[str, pd.DataFrame]
) -> dict[str, tuple[float, float]]:
    """Largest distance to the nearer sim, and the part of the sims' own spread that it is.

    The spread is the one at that time: 1 means that we are as far from the nearer of them as they
    are from each other.
    """
    out = {}
    for name, values in ours.items():
        a, b = (recorded[n][_COLUMNS[name]].to_numpy()[: len(values)] for n in SIMS)
        distance, spread = np.minimum(abs(values - a), abs(values - b)), abs(a - b)
        # Both print their first row with ten digits.
        floor = 1e-9 * np.max(np.abs(values)) + 1e-12
        out[name] = float(np.max(distance)), float(np.max(distance / (spread + floor)))
    return out


def nesc_f16(quick: bool) -> tuple[str, bool]:
    """The row 'NESC 11': trim and forces as recorded, 20 s inside the spread of sims 02 and 04."""
    data = DATA / "nesc_6dof"
    plane, recorded = f16(data / "models"), sims(data / "Atmos_11_TrimCheckSubsonicF16")
    worst, words = {}, []
    for n in SIMS:
        row = recorded[n].iloc[0]
        _, force, moment = trimmed(plane, recorded_start(recorded[n]))
        wanted = np.array([row[f"aero_bodyForce_lbf_{a}"] for a in "XYZ"])
        if n == "04":  # about the center of mass
            moment = moment + np.cross(plane.model.reference_point / FT, force)
        M = np.array([row[f"aero_bodyMoment_ftlbf_{a}"] for a in "LMN"])
        off = float(np.linalg.norm(force - wanted) / np.linalg.norm(wanted))
        # of the force times the chord
        turned = float(np.linalg.norm(moment - M) / np.linalg.norm(wanted) / 11.32)
        worst[n] = max(off, turned)
        words.append(f"sim {n} force {off:.1e}, moment {turned:.1e}")
        if n == "02":
            words.append(f"of it side force {force[1]:.2f} for {wanted[1]:.2f} lbf")
    x = recorded_start(recorded["04"])
    controls, _, _ = trimmed(plane, x)
    gaps = beside(flown(plane, x, controls), recorded)
    words += [
        f"{n} {d:.2g} {'ft' if n == 'altitude' else 'deg'} ({100 * part:.2g} % of the spread)"
        for n, (d, part) in gaps.items()
    ]
    x = recorded_start(recorded["02"])
    again = flown(plane, x, trimmed(plane, x)[0])
    apart = {
        n: float(np.max(abs(v - recorded["02"][_COLUMNS[n]].to_numpy()[: len(v)])))
        for n, v in again.items()
    }
    shown = ", ".join(f"{n} {d:.2g}" for n, d in apart.items())
    words.append(f"shown: from sim 02's own start, apart from sim 02 by {shown} (ft, deg)")
    # Bounds of the order found: density differs by 5e-7 from sim 04's, 4e-6 from sim 02's.
    good = worst["04"] < 2e-6 and worst["02"] < 1e-4 and all(p <= 1.0 for _, p in gaps.values())
    return "; ".join(words), good
