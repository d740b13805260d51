"""What a positive control reading means, by code, and the factor to Alula's notation.

Codes are those of DAVE-ML and AIAA S-119: trailing edge down, up, left, right (TED TEU TEL TER),
aircraft nose up, down, left, right (ANU AND ANL ANR), right or left wing down (RWD LWD). Alula's
positive: elevator trailing edge down, rudder trailing edge left, da = (right - left)/2 with
trailing edge down positive. A positive deflection gives a negative moment.
"""

from __future__ import annotations

from alula.base.messages import refuse

_PITCH = {"TED": 1, "TEU": -1, "LEU": 1, "LED": -1, "AND": 1, "ANU": -1}
_ROLL = {"RTED": 1, "RTEU": -1, "LTED": -1, "LTEU": 1, "LWD": 1, "RWD": -1}
_YAW = {"TEL": 1, "TER": -1, "ANL": 1, "ANR": -1}
_FLAP = {"TED": 1, "TEU": -1}
_THROTTLE = {"FWD": 1, "AFT": -1}

_BY_STEM = {
    "de": _PITCH,
    "stabilizer": _PITCH,
    "da": _ROLL,
    "dr": _YAW,
    "df": _FLAP,
    "dt": _THROTTLE,
}
_ONE_SIDE = {"da_left": _FLAP, "da_right": _FLAP}  # a single aileron is a flap with a side
_ANY = _PITCH | _ROLL | _YAW | _FLAP | _THROTTLE


def codes(control: str) -> dict[str, int]:
    """The codes that make sense for a control, each with its sign in Alula's notation."""
    return _ONE_SIDE.get(control) or _BY_STEM.get(control.split("_")[0], _ANY)


def sign_factor(control: str, code: str, where: str = "aircraft file") -> float:
    """+1 or -1: what a reading of `control` is multiplied by to be in Alula's notation.

    code: what a positive reading means, '+TED'; '-TED' says that a negative one does. Raises
    BadInput for a code that is unknown or says nothing about this control.
    """
    known = codes(control)
    text = code.strip().upper()
    outer = -1 if text.startswith("-") else 1
    factor = known.get(text.lstrip("+-"))
    if factor is None or text[:1] not in ("+", "-"):
        hint = ""
        if control == "da" and text.lstrip("+-") in _FLAP:
            hint = " Ailerons move against each other: say which side, '+RTED' or '+LTED'."
        raise refuse(
            "control_sign_code",
            where=f"{where}, controls.{control}.sign",
            expected="one of " + ", ".join(f"+{name}" for name in known),
            found=repr(code),
            do=f"Write what a positive reading of '{control}' in the log means.{hint}",
        )
    return float(outer * factor)
