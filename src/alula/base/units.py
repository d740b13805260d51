"""Units met in flight logs, and the channels Alula knows with their SI units.

Units are converted once, where data enter; inside Alula every quantity is SI with radians.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from difflib import get_close_matches

from alula.base.messages import refuse

G0 = 9.80665  # m/s2, standard gravity (ISO 80000-3): the unit 'g', not the local gravity
FT = 0.3048  # m, international foot
LB = 0.45359237  # kg, avoirdupois pound
LBF = LB * G0  # N
SLUG = LBF / FT  # kg
DEG = math.pi / 180.0
KT = 1852.0 / 3600.0  # m/s


@dataclass(frozen=True)
class Unit:
    """value_SI = scale * value + offset, in the unit `si`."""

    scale: float
    offset: float
    si: str


# SI unit -> {spelling: factor}. Spellings are in the normal form of `_normal`.
_FACTORS: dict[str, dict[str, float]] = {
    "1": {
        "1": 1, "": 1, "-": 1, "--": 1, "~": 1, "none": 1, "nd": 1, "%": 0.01, "percent": 0.01,
        "pct": 0.01, "mach": 1, "norm": 1, "unitless": 1, "count": 1, "counts": 1, "bool": 1,
    },
    "s": {
        "s": 1, "sec": 1, "secs": 1, "second": 1, "seconds": 1, "ms": 1e-3, "msec": 1e-3,
        "millisecond": 1e-3, "milliseconds": 1e-3, "us": 1e-6, "usec": 1e-6, "microsecond": 1e-6,
        "microseconds": 1e-6, "ns": 1e-9, "nanosecond": 1e-9, "nanoseconds": 1e-9, "min": 60,
        "minute": 60, "minutes": 60, "h": 3600, "hr": 3600, "hour": 3600, "hours": 3600,
    },
    "Hz": {"Hz": 1, "1/s": 1, "kHz": 1e3},
    "m": {
        "m": 1, "meter": 1, "meters": 1, "metre": 1, "metres": 1, "cm": 0.01, "mm": 1e-3,
        "km": 1e3, "ft": FT, "feet": FT, "foot": FT, "in": FT / 12, "inch": FT / 12,
        "inches": FT / 12, "nmi": 1852, "NM": 1852, "kft": 1e3 * FT,
    },
    "m2": {"m2": 1, "ft2": FT**2, "sqft": FT**2, "in2": (FT / 12) ** 2},
    "rad": {
        "rad": 1, "rads": 1, "radian": 1, "radians": 1, "deg": DEG, "degs": DEG, "degree": DEG,
        "degrees": DEG, "mrad": 1e-3, "arcmin": DEG / 60, "arcsec": DEG / 3600, "rev": 2 * math.pi,
        "turn": 2 * math.pi,
    },
    "rad/s": {
        "rad/s": 1, "rads-1": 1, "deg/s": DEG, "degree/s": DEG, "degrees/s": DEG, "degs-1": DEG,
        "dps": DEG, "deg/h": DEG / 3600, "rpm": math.pi / 30, "rev/min": math.pi / 30,
        "1/min": math.pi / 30, "rev/s": 2 * math.pi, "rps": 2 * math.pi, "mrad/s": 1e-3,
    },
    "rad/s2": {"rad/s2": 1, "rads-2": 1, "deg/s2": DEG, "degs-2": DEG},
    "m/s": {
        "m/s": 1, "mps": 1, "ms-1": 1, "km/h": 1 / 3.6, "kph": 1 / 3.6, "kmh": 1 / 3.6,
        "kt": KT, "kts": KT, "kn": KT, "knot": KT, "knots": KT, "ktas": KT, "kcas": KT,
        "kias": KT, "ft/s": FT, "fps": FT, "ft/min": FT / 60, "fpm": FT / 60,
        "mph": 1609.344 / 3600, "mi/h": 1609.344 / 3600, "cm/s": 0.01, "mm/s": 1e-3, "km/s": 1e3,
    },
    "m/s2": {
        "m/s2": 1, "mps2": 1, "ms-2": 1, "g": G0, "gs": G0, "g0": G0, "gn": G0, "mg": 1e-3 * G0,
        "milli-g": 1e-3 * G0, "ft/s2": FT, "fps2": FT, "cm/s2": 0.01,
    },
    "Pa": {
        "Pa": 1, "N/m2": 1, "hPa": 100, "mbar": 100, "mb": 100, "millibar": 100, "kPa": 1e3,
        "bar": 1e5, "MPa": 1e6, "psi": LBF / (FT / 12) ** 2, "lbf/in2": LBF / (FT / 12) ** 2,
        "psf": LBF / FT**2, "lbf/ft2": LBF / FT**2, "lb/ft2": LBF / FT**2, "lbs/ft2": LBF / FT**2,
        "inHg": 3386.389, "mmHg": 133.322387415, "atm": 101325,
    },
    "K": {"K": 1, "kelvin": 1, "degK": 1, "degR": 5 / 9, "rankine": 5 / 9},
    "kg": {
        "kg": 1, "kilogram": 1, "gram": 1e-3, "grams": 1e-3, "t": 1e3, "tonne": 1e3, "lb": LB,
        "lbs": LB, "lbm": LB, "pound": LB, "pounds": LB, "slug": SLUG, "slugs": SLUG,
    },
    "N": {"N": 1, "newton": 1, "newtons": 1, "kN": 1e3, "daN": 10, "lbf": LBF, "kgf": G0},
    "N m": {"Nm": 1, "N m": 1, "ft lbf": FT * LBF, "ftlbf": FT * LBF, "lbf ft": FT * LBF},
    "kg/m3": {
        "kg/m3": 1, "kgm-3": 1, "slug/ft3": SLUG / FT**3, "slugs/ft3": SLUG / FT**3,
        "lb/ft3": LB / FT**3, "lbm/ft3": LB / FT**3, "gram/cm3": 1e3,
    },
    "kg m2": {
        "kg m2": 1, "kgm2": 1, "kg-m2": 1, "slug ft2": SLUG * FT**2, "slugft2": SLUG * FT**2,
        "slug-ft2": SLUG * FT**2, "slugs-ft2": SLUG * FT**2, "lb ft2": LB * FT**2,
    },
    "kg/s": {
        "kg/s": 1, "kg/h": 1 / 3600, "kg/min": 1 / 60, "gram/s": 1e-3, "lb/s": LB,
        "lb/h": LB / 3600, "lb/hr": LB / 3600, "lbs/h": LB / 3600, "lbs/hr": LB / 3600,
        "pph": LB / 3600, "lb/min": LB / 60,
    },
    "V": {"V": 1, "volt": 1, "volts": 1, "mV": 1e-3},
    "A": {"A": 1, "amp": 1, "amps": 1, "ampere": 1, "mA": 1e-3},
    "W": {"W": 1, "watt": 1, "kW": 1e3, "hp": 550 * FT * LBF},
    "T": {"T": 1, "tesla": 1, "mT": 1e-3, "uT": 1e-6, "nT": 1e-9, "gauss": 1e-4, "mgauss": 1e-7},
}  # fmt: skip

_TABLE: dict[str, Unit] = {
    spelling: Unit(float(factor), 0.0, si)
    for si, spellings in _FACTORS.items()
    for spelling, factor in spellings.items()
}
for _name in ("degC", "C", "celsius", "degcelsius"):
    _TABLE[_name] = Unit(1.0, 273.15, "K")
for _name in ("degF", "F", "fahrenheit", "degfahrenheit"):
    _TABLE[_name] = Unit(5 / 9, 459.67 * 5 / 9, "K")

_AMBIGUOUS = {"G": ["g", "gauss"], "M": ["m", "mach"], "S": ["s"], "H": ["h"], "MS": ["ms"]}
_LOWER: dict[str, list[str]] = {}
for _name in _TABLE:
    _LOWER.setdefault(_name.lower(), []).append(_name)


def _normal(unit: str) -> str:
    """One spelling for '[m/s^2]', 'm/s**2', 'm/s²', 'm/sec2' and 'm/s/s'."""
    text = unit.strip().strip("[](){}").strip()
    for old, new in (
        ("²", "2"), ("³", "3"), ("⁻¹", "-1"), ("⁻²", "-2"), ("**", ""), ("^", ""), ("µ", "u"),
        ("μ", "u"), ("°", "deg"), ("º", "deg"), ("·", " "), ("*", " "), ("_", " "),
    ):  # fmt: skip
        text = text.replace(old, new)
    text = re.sub(r"\s*/\s*", "/", text)
    text = re.sub(r"\bper\b", "/", text).replace(" / ", "/")
    text = re.sub(r"/(sec|second)s?(?=\d|/|$)", "/s", text, flags=re.IGNORECASE)
    text = re.sub(r"/s/s$", "/s2", text)
    text = re.sub(r"^deg\s+(?=[CFKR]$)", "deg", text)
    return re.sub(r"\s+", " ", text)


def find_unit(unit: str) -> Unit | None:
    """The unit of that spelling, or None. Case counts only where it changes the meaning."""
    text = _normal(unit)
    if text in _TABLE:
        return _TABLE[text]
    if text in _AMBIGUOUS:
        return None
    same = {_TABLE[name] for name in _LOWER.get(text.lower(), [])}
    return same.pop() if len(same) == 1 else None


def to_si(unit: str, *, where: str = "unit") -> Unit:
    """The conversion of `unit` to SI; raises BadInput with near matches for an unknown one."""
    found = find_unit(unit)
    if found is not None:
        return found
    text = _normal(unit)
    near = _AMBIGUOUS.get(text) or _LOWER.get(text.lower(), [])
    near = near or get_close_matches(text, [n for n in _TABLE if len(n) > 1], n=4, cutoff=0.5)
    hint = f"Did you mean {' or '.join(repr(n) for n in near)}?" if near else "See the table there."
    raise refuse(
        "unknown_unit",
        where=where,
        expected="a unit that Alula knows, such as 'deg/s', 'm/s2', 'kt', 'hPa' or '1'",
        found=f"'{unit}'",
        do=f"{hint} Or give scale and offset to a unit that is known.",
    )


@dataclass(frozen=True)
class KnownChannel:
    """A channel name of Alula's notation: its SI unit and what it means."""

    unit: str
    meaning: str
    also: tuple[str, ...] = ()  # units accepted as well, kept as they are


def _channels() -> dict[str, KnownChannel]:
    table: dict[str, KnownChannel] = {}

    def add(unit: str, also: tuple[str, ...] = (), **meanings: str) -> None:
        for name, meaning in meanings.items():
            table[name] = KnownChannel(unit, meaning, also)

    add("s", t="time of the log")
    add(
        "m/s2",
        ax="specific force along body x (forward)",
        ay="specific force along body y (right)",
        az="specific force along body z (down); level flight reads -9.81",
    )
    add("rad/s", p="roll rate", q="pitch rate", r="yaw rate")
    add("rad/s2", pdot="roll acceleration", qdot="pitch acceleration", rdot="yaw acceleration")
    add("rad", phi="bank angle", theta="pitch attitude", psi="true heading")
    add("rad", psi_mag="magnetic heading")
    add(
        "m/s",
        u="air-relative velocity along body x",
        v="air-relative velocity along body y",
        w="air-relative velocity along body z",
        V="true airspeed",
        V_cas="calibrated airspeed",
        V_ias="indicated airspeed",
        v_north="velocity against the Earth, north",
        v_east="velocity against the Earth, east",
        v_down="velocity against the Earth, down",
        v_ground="ground speed",
        climb_rate="rate of climb",
        wind_north="velocity of the air, north",
        wind_east="velocity of the air, east",
        wind_down="velocity of the air, down",
    )
    add("1", mach="Mach number", load_factor="load factor")
    add("Pa", qbar="dynamic pressure", pressure="static pressure", pressure_total="total pressure")
    add(
        "rad",
        alpha="angle of attack",
        beta="angle of sideslip, asin(v/V)",
        beta_flank="flank angle, atan(v/u)",
    )
    add("rad/s", alpha_dot="rate of angle of attack", beta_dot="rate of sideslip")
    add(
        "m",
        h="altitude, barometric",
        h_gps="altitude by satellite",
        h_radio="height above ground",
        north="position north",
        east="position east",
        down="position down",
    )
    add("rad", lat="latitude", lon="longitude")
    add("kg/m3", rho="density of the air")
    add("K", temperature="static temperature", temperature_total="total temperature")
    add(
        "rad",
        ("1",),
        de="elevator, trailing edge down positive",
        da="aileron, (right - left)/2, trailing edge down positive",
        dr="rudder, trailing edge left positive",
        df="flap",
        da_left="left aileron",
        da_right="right aileron",
        stabilizer="stabilizer",
        de_trim="elevator trim tab",
        da_trim="aileron trim tab",
        dr_trim="rudder trim tab",
        spoiler_left="left spoiler",
        spoiler_right="right spoiler",
    )
    add("1", dt="throttle, 0 to 1", gear="landing gear, 0 up, 1 down")
    add("N", thrust="thrust", thrust_left="thrust, left", thrust_right="thrust, right")
    add("N", ("N m",), stick_force="stick force", pedal_force="pedal force")
    add("kg", fuel_used="fuel used", fuel_used_left="fuel used, left")
    add("kg", fuel_used_right="fuel used, right", mass="mass")
    add("kg/s", fuel_flow="fuel flow", fuel_flow_left="fuel flow, left")
    add("kg/s", fuel_flow_right="fuel flow, right")
    add("kg m2", Ixx="moment of inertia", Iyy="moment of inertia", Izz="moment of inertia")
    add("kg m2", Ixz="product of inertia", Ixy="product of inertia", Iyz="product of inertia")
    add("m", x_cg="center of gravity, x", y_cg="center of gravity, y", z_cg="center of gravity, z")
    add("rad/s", ("1", "Hz"), engine_speed="engine speed", engine_speed_left="engine speed, left")
    add("rad/s", ("1", "Hz"), engine_speed_right="engine speed, right")
    add(
        "1",
        CX="recorded force coefficient, body x",
        CY="recorded force coefficient, body y",
        CZ="recorded force coefficient, body z",
        Cl="recorded rolling moment coefficient",
        Cm="recorded pitching moment coefficient",
        Cn="recorded yawing moment coefficient",
        CD="recorded drag coefficient",
        CL="recorded lift coefficient",
        CT="recorded thrust coefficient",
        phat="pb/2V",
        qhat="qc/2V",
        rhat="rb/2V",
    )
    add("T", mag_x="magnetic field, body x", mag_y="magnetic field, body y")
    add("T", mag_z="magnetic field, body z")
    return table


CHANNELS: dict[str, KnownChannel] = _channels()


def known_channel(name: str) -> KnownChannel | None:
    """The known channel of that name; 'alpha_2' is a second sensor of 'alpha'."""
    return CHANNELS.get(name) or CHANNELS.get(re.sub(r"_\d+$", "", name))


def expected_unit(name: str) -> str | None:
    """SI unit of a known channel name, None for a name of the user's own."""
    known = known_channel(name)
    return known.unit if known else None
