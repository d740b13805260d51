"""NASA's check cases of a body over the turning Earth (NASA/TM-2015-218675): cases 1 to 9.

Case 1: a sphere dropped without air; 2 and 3: a tumbling brick without and with damping; 6 and 7: a
sphere dropped in still air and in wind; 9: a cannonball shot eastward. Numbers of sphere and brick
are read from the cases' own DAVE-ML files. The spread between NASA's simulators is the tolerance.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from alula.base.arrays import Array
from alula.model import AeroModel, Reference, aero_model, lookup_table
from alula.simulate import Airframe, SimulatedFlight, fly, initial_state
from alula.simulate.fly import attitudes
from verification.places import DATA

FT, SLUG = 0.3048, 14.593902937206364  # m, kg
SLUG_FT2 = SLUG * FT**2
EARTH_RATE = 7.292115e-5  # rad/s
WIND = np.array([0.0, 20.0 * FT, 0.0])  # case 7, toward the east


@dataclass(frozen=True)
class Case:
    """What is compared, against whom, and how far apart it may be."""

    folder: str
    body: str  # 'cannonball' or 'brick'
    air: bool
    quantity: str  # 'altitude' ft or 'pitch' deg
    against: tuple[str, ...]
    shown: tuple[str, ...]
    tolerance: float


# Tolerances: the spread between NASA's simulators, the narrower figure where there are two.
CASES = {
    1: Case("Atmos_01_DroppedSphere", "cannonball", False, "altitude", ("04",), ("06",), 0.002),
    2: Case(
        "Atmos_02_TumblingBrickNoDamping", "brick", False, "pitch", ("01", "04"), ("06",), 3e-9
    ),
    3: Case("Atmos_03_TumblingBrickDamping", "brick", True, "pitch", ("04",), ("06",), 0.08),
    6: Case(
        "Atmos_06_DroppedSphereEllipsoidalNoWind", "cannonball", True, "altitude", ("04",), ("06",),
        0.15,
    ),
    7: Case(
        "Atmos_07_DroppedSphereSteadyWind", "cannonball", True, "altitude", ("04",), ("06",), 0.15
    ),
    9: Case("Atmos_09_EastwardCannonball", "cannonball", True, "altitude", ("04",), ("06",), 0.3),
}  # fmt: skip


def numbers(path: Path) -> dict[str, float]:
    """The initial values of a DAVE-ML file by variable."""
    space = "{http://daveml.org/2010/DAVEML}"
    found = ElementTree.parse(path).iter(f"{space}variableDef")
    return {
        v.get("varID", ""): float(v.get("initialValue", "nan"))
        for v in found
        if v.get("initialValue") is not None
    }


def body_of(root: Path, case: Case) -> tuple[Airframe, AeroModel]:
    """Mass, inertia and coefficients of a case's body, from its DAVE-ML files."""
    models = root / "nesc_6dof" / "models"
    mass = numbers(models / f"{case.body}_inertia.dml")
    inertia = np.diag([mass["XIXX"], mass["XIYY"], mass["XIZZ"]]) * SLUG_FT2
    airframe = Airframe(mass["XMASS"] * SLUG, inertia, earth="wgs84")
    if not case.air:
        return airframe, aero_model("no air", {}, {}, Reference(1.0, 1.0, 1.0))
    aero = numbers(models / f"{case.body}_aero.dml")
    area, CD = aero["SWING"] * FT**2, {"CD_0": aero["CD"]}
    if case.body == "cannonball":
        # A sphere's drag is along the air's velocity, sideways too: CD cos(beta) in the plane of
        # symmetry and -CD sin(beta) across it, as cubic tables (error below 1e-11).
        beta = np.radians(np.linspace(-90.0, 90.0, 361))
        tables = {
            "along": lookup_table({"beta": beta}, np.cos(beta), "cubic"),
            "across": lookup_table({"beta": beta}, np.sin(beta), "cubic"),
        }
        return airframe, aero_model(
            case.body, {"CD": "along(beta)", "CY": "across(beta)"},
            {"CD_along": aero["CD"], "CY_across": -aero["CD"]}, Reference(area, 1.0, 1.0),
            axes="stability", tables=tables,
        )  # fmt: skip
    reference = Reference(area, aero["BSPAN"] * FT, aero["CBAR"] * FT)
    damping = {
        "Cl_p": aero["CLP_DAMPING"], "Cl_r": aero["CLR_DAMPING"], "Cm_q": aero["CMQ_DAMPING"],
        "Cn_p": aero["CNP_DAMPING"], "Cn_r": aero["CNR_DAMPING"],
    }  # fmt: skip
    # The recorded aerodynamic forces of case 3 are zero: the simulators flew an earlier revision of
    # the file, which had damping but no drag.
    CD["CD_0"] = 0.0
    formulas = {"CD": "1", "Cl": "phat + rhat", "Cm": "qhat", "Cn": "phat + rhat"}
    return airframe, aero_model(case.body, formulas, CD | damping, reference, axes="stability")


def recorded(root: Path, case: Case, sim: str) -> pd.DataFrame:
    """What one of NASA's simulators wrote."""
    folder = root / "nesc_6dof" / case.folder
    (path,) = folder.glob(f"*_sim_{sim}.csv")
    return pd.read_csv(path)


def flown(root: Path, number: int, step: float, end: float = 30.0) -> dict[str, Array]:
    """Our flight from the first row of sim 04, every 0.1 s: time, altitude (ft), angles (deg).

    Damping of case 3: sim 04 takes the rates against inertial space, so that its brick stops
    turning among the stars; sim 06 and we take those against the air, which turns with the Earth.
    For the comparison with 04 the air is stopped by a gust that turns against the Earth, found by
    flying three times.
    """
    case = CASES[number]
    airframe, model = body_of(root, case)
    first = recorded(root, case, "04").iloc[0]
    roll, pitch, yaw = (np.radians(first[f"eulerAngle_deg_{n}"]) for n in ("Roll", "Pitch", "Yaw"))
    rates = [np.radians(first[f"bodyAngularRateWrtEi_deg_s_{n}"]) for n in ("Roll", "Pitch", "Yaw")]
    x0 = initial_state(
        0.0, 0.0, pitch, first["altitudeMsl_ft"] * FT, phi=roll, psi=yaw,
        rates=(rates[0], rates[1], rates[2]),
        wind=np.array([first[f"feVelocity_ft_s_{n}"] for n in "XYZ"]) * FT,  # velocity, NED
        earth="wgs84", latitude=np.radians(first["latitude_deg"]),
        longitude=np.radians(first["longitude_deg"]),
    )  # fmt: skip
    every = 10  # samples in 0.1 s
    t = np.arange(round(end / 0.1) * every + 1) * (0.1 / every)

    def once(gusts: Array | None) -> SimulatedFlight:
        return fly(
            airframe, model, x0, t, {}, wind=WIND if number == 7 else None, gusts=gusts,
            substeps=max(1, round(0.1 / every / step)),
        )  # fmt: skip

    flight = once(None)
    against_air = flight
    if number == 3:
        for _ in range(2):
            flight = once(_stopped_air(flight))
    out = _columns(flight, every)
    if number == 3:
        out |= {f"{n} (against the air)": v for n, v in _columns(against_air, every).items()}
    return out


def _stopped_air(flight: SimulatedFlight) -> Array:
    """Gusts (n, 6) that take the Earth's rotation out of the air along a flight."""
    turn = np.empty((len(flight.mach), 3))
    _, R = attitudes(flight.plant_states, "wgs84")
    latitude = flight.position[:, 0]
    turn[:, 0], turn[:, 1], turn[:, 2] = np.cos(latitude), 0.0, -np.sin(latitude)
    gusts = np.zeros((len(turn), 6))
    gusts[:, 3:] = -EARTH_RATE * np.einsum("nij,nj->ni", R, turn)
    return gusts


def _columns(flight: SimulatedFlight, every: int) -> dict[str, Array]:
    m = flight.motion
    columns = {
        "time": m.t,
        "altitude": m.h / FT,
        "roll": np.degrees(m.phi),
        "pitch": np.degrees(m.theta),
        "yaw": np.degrees(m.psi),
        "latitude": np.degrees(flight.position[:, 0]),
        "longitude": np.degrees(flight.position[:, 1]),
    }
    return {name: column[::every] for name, column in columns.items()}


COLUMNS = {
    "altitude": "altitudeMsl_ft",
    "roll": "eulerAngle_deg_Roll",
    "pitch": "eulerAngle_deg_Pitch",
    "yaw": "eulerAngle_deg_Yaw",
    "latitude": "latitude_deg",
    "longitude": "longitude_deg",
}


def apart(
    root: Path, number: int, sim: str, ours: dict[str, Array], variant: str = ""
) -> dict[str, float]:
    """The largest difference from one of NASA's simulators, by quantity: ft, deg."""
    table = recorded(root, CASES[number], sim)
    n = len(ours["time"])
    out = {}
    for name, column in COLUMNS.items():
        off = ours[name + variant] - table[column].to_numpy()[:n]
        if name != "altitude":
            off = (off + 180.0) % 360.0 - 180.0
        out[name] = float(np.max(np.abs(off)))
    return out


def check(quick: bool = False) -> tuple[str, bool]:
    """All cases: what was found in words, and whether each is inside its tolerance."""
    holds, words = True, []
    for number, case in CASES.items():
        ours = flown(DATA, number, 0.01 if quick else 0.002)
        unit = "ft" if case.quantity == "altitude" else "deg"
        for sim in (*case.against, *case.shown):
            own = " (against the air)" if number == 3 and sim == "06" else ""
            off = apart(DATA, number, sim, ours, own)[case.quantity]
            judged = sim in case.against
            holds &= off <= case.tolerance or not judged
            words.append(
                f"case {number} {case.quantity} from {sim}: {off:.2g} {unit}"
                + (f" (may be {case.tolerance:g})" if judged else " (shown)")
            )
        if number == 3:
            off = apart(DATA, 3, "04", ours, " (against the air)")["pitch"]
            words.append(f"case 3 with the damping of rates against the air: {off:.2g} deg from 04")
    return "; ".join(words), holds
