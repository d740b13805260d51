"""What the names mean, in words, and the unit of those states that carry none."""

from __future__ import annotations

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
    "thrust": "thrust",
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

_UNITS = {
    "m/s": "u v w V V_cas V_ias v_north v_east v_down wind_n wind_e wind_d wind_x wind_y wind_z",
    "rad": "phi theta psi alpha beta beta_flank de da dr df b_alpha b_beta b_phi b_theta b_psi",
    "rad/s": "p q r b_p b_q b_r",
    "rad/s2": "pdot qdot rdot",
    "m/s2": "ax ay az b_ax b_ay b_az",
    "m": "h h_gps x y z north east down b_h",
    "N": "thrust",
    "kg/m3": "rho",
}
_UNIT = {name: unit for unit, names in _UNITS.items() for name in names.split()}


def unit_of(name: str) -> str:
    """SI unit of a state or channel by its name; dimensionless where the name is not known."""
    return _UNIT.get(name, "1")


def titled(name: str) -> str:
    """'alpha, angle of attack'; the bare name where it has no words."""
    return f"{name}, {WORDS[name]}" if name in WORDS else name
