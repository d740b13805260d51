"""What the names mean, in words, and the unit of those states that carry none."""

from __future__ import annotations

from alula.base.units import expected_unit

WORDS = {
    "u": "velocity forward",
    "v": "velocity right",
    "w": "velocity down",
    "p": "roll rate",
    "q": "pitch rate",
    "r": "yaw rate",
    "pdot": "roll acceleration",
    "qdot": "pitch acceleration",
    "rdot": "yaw acceleration",
    "phi": "bank angle",
    "theta": "pitch angle",
    "psi": "heading",
    "V": "true airspeed",
    "V_cas": "calibrated airspeed",
    "V_ias": "indicated airspeed",
    "alpha": "angle of attack",
    "beta": "sideslip",
    "beta_flank": "flank angle",
    "ax": "specific force forward",
    "ay": "specific force right",
    "az": "specific force down",
    "h": "altitude",
    "h_gps": "GPS altitude",
    "north": "position north",
    "east": "position east",
    "v_north": "velocity north",
    "v_east": "velocity east",
    "v_down": "velocity down",
    "wind_n": "wind to north",
    "wind_e": "wind to east",
    "wind_d": "wind down",
    "de": "elevator",
    "da": "aileron",
    "dr": "rudder",
    "df": "flap",
    "dt": "throttle",
    "thrust": "all engines",
    "CX": "force forward",
    "CY": "force right",
    "CZ": "force down",
    "CD": "drag",
    "CL": "lift",
    "CT": "thrust",
    "Cl": "rolling moment",
    "Cm": "pitching moment",
    "Cn": "yawing moment",
}

_STATES = {"x": "m", "y": "m", "z": "m", "wind_n": "m/s", "wind_e": "m/s", "wind_d": "m/s"}


def unit_of(name: str) -> str:
    """SI unit of a state, constant or channel by its name; dimensionless where it is not known.

    'b_alpha' is a bias in the unit of alpha, 'k_alpha' a scale error.
    """
    if name.startswith("k_"):
        return "1"
    base = name.removeprefix("b_")
    return _STATES.get(base) or expected_unit(base) or "1"


def meaning(name: str) -> str:
    """'bias of angle of attack' for 'b_alpha'; empty where the name has no words.

    One that belongs to a single maneuver says so: 'bias of sideslip, rudder' for 'b_beta[rudder]'.
    """
    base, bracket, owner = name.partition("[")
    if bracket:
        return f"{meaning(base)}, {owner.removesuffix(']')}" if meaning(base) else ""
    for start, kind in (("b_", "bias of "), ("k_", "scale error of ")):
        if name.startswith(start):
            base = name.removeprefix(start)
            return kind + WORDS.get(base, base)
    return WORDS.get(name, "")


def titled(name: str) -> str:
    """'alpha, angle of attack'; the bare name where it has no words."""
    return f"{name}, {meaning(name)}" if meaning(name) else name
