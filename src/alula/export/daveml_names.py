"""Names, units and signs of AIAA S-119 signals, and what they are in Alula's notation."""

from __future__ import annotations

import re

from alula.aircraft.control_signs import sign_factor
from alula.base.messages import refuse
from alula.base.units import to_si
from alula.export.daveml_model import DaveVariable

# S-119 name -> (variable or reference length of Alula, unit the writer uses, sign it states).
INPUTS: dict[str, tuple[str, str, str]] = {
    "trueAirspeed": ("V", "m_s", "+FWD"),
    "angleOfAttack": ("alpha", "rad", "+ANU"),
    "angleOfSideslip": ("beta", "rad", "+ANL"),
    "bodyAngularRate_Roll": ("p", "rad_s", "+RWD"),
    "bodyAngularRate_Pitch": ("q", "rad_s", "+ANU"),
    "bodyAngularRate_Yaw": ("r", "rad_s", "+ANR"),
    "elevatorDeflection": ("de", "rad", "+TED"),
    "aileronDeflection": ("da", "rad", "+LWD"),
    "rudderDeflection": ("dr", "rad", "+TEL"),
    "flapDeflection": ("df", "rad", "+TED"),
    "throttlePosition": ("dt", "nd", "+FWD"),
    "mach": ("mach", "nd", "+INCR"),
}
REFERENCE: dict[str, tuple[str, str]] = {
    "referenceWingArea": ("S", "m2"),
    "referenceWingSpan": ("b", "m"),
    "referenceWingChord": ("c", "m"),
}
# Not of the standard: where the moments act, m in body axes from the aircraft file's datum.
POINT_NAMES = tuple(f"bodyPositionOfMrcWrtDatum_{axis}" for axis in "XYZ")
OUTPUTS: dict[str, tuple[str, str]] = {
    "aeroBodyForceCoefficient_X": ("CX", "+FWD"),
    "aeroBodyForceCoefficient_Y": ("CY", "+RT"),
    "aeroBodyForceCoefficient_Z": ("CZ", "+DWN"),
    "aeroBodyMomentCoefficient_Roll": ("Cl", "+RWD"),
    "aeroBodyMomentCoefficient_Pitch": ("Cm", "+ANU"),
    "aeroBodyMomentCoefficient_Yaw": ("Cn", "+ANR"),
    "totalCoefficientOfDrag": ("CD", "+AFT"),
    "totalCoefficientOfLift": ("CL", "+UP"),
}
# Other names of the same things, met in files.
ALIASES: dict[str, str] = {
    "dragCoefficient": "CD",
    "liftCoefficient": "CL",
    "sideForceCoefficient": "CY",
    "aeroStabilityForceCoefficient_Drag": "CD",
    "aeroStabilityForceCoefficient_Lift": "CL",
    "totalCoefficientOfSideForce": "CY",
    "totalCoefficientOfBodyRollingMoment": "Cl",
    "totalCoefficientOfBodyPitchingMoment": "Cm",
    "totalCoefficientOfBodyYawingMoment": "Cn",
}
_POSITIVE = {
    "CX": ("FWD", "FORWARD"),
    "CY": ("RT", "RIGHT"),
    "CZ": ("DWN", "DOWN"),
    "Cl": ("RWD", "RIGHT WING DOWN"),
    "Cm": ("ANU", "NOSE UP", "AIRCRAFT NOSE UP"),
    "Cn": ("ANR", "NOSE RIGHT", "AIRCRAFT NOSE RIGHT"),
    "CD": ("AFT", "DRAG"),
    "CL": ("UP", "LIFT"),
    "alpha": ("ANU", "NOSE UP", "AIRCRAFT NOSE UP"),
    "beta": ("ANL", "WIND IN RIGHT EAR", "RT", "NOSE LEFT", "AIRCRAFT NOSE LEFT"),
    "p": ("RWD", "RIGHT WING DOWN"),
    "q": ("ANU", "NOSE UP", "AIRCRAFT NOSE UP"),
    "r": ("ANR", "NOSE RIGHT", "AIRCRAFT NOSE RIGHT"),
    "V": ("FWD", "INCR"),
    "mach": ("INCR",),
}
_NEGATIVE = {
    "CX": ("AFT",),
    "CY": ("LT", "LEFT"),
    "CZ": ("UP",),
    "Cl": ("LWD", "LEFT WING DOWN"),
    "Cm": ("AND", "NOSE DOWN", "AIRCRAFT NOSE DOWN"),
    "Cn": ("ANL", "NOSE LEFT", "AIRCRAFT NOSE LEFT"),
    "beta": ("ANR", "WIND IN LEFT EAR", "LT", "NOSE RIGHT", "AIRCRAFT NOSE RIGHT"),
    "p": ("LWD", "LEFT WING DOWN"),
    "q": ("AND", "NOSE DOWN", "AIRCRAFT NOSE DOWN"),
    "r": ("ANL", "NOSE LEFT", "AIRCRAFT NOSE LEFT"),
}
_CONTROL_WORDS = {
    "TRAILING EDGE DOWN": "TED",
    "TRAILING EDGE UP": "TEU",
    "TRAILING EDGE LEFT": "TEL",
    "TRAILING EDGE RIGHT": "TER",
    "LEFT ROLL": "LWD",
    "RIGHT ROLL": "RWD",
    "LEFT WING DOWN": "LWD",
    "RIGHT WING DOWN": "RWD",
    "INCR": "FWD",
}


def unit_scale(units: str, si: str, where: str) -> float:
    """What a value in S-119 units ('ft_s', 'deg', 'nd') is multiplied by to be in `si`.

    Raises BadInput for a unit that is unknown or of another quantity.
    """
    text = re.sub(r"(?<=\w)_(?=\w)", "/", units.strip())
    text = {"frac": "1", "rad/s": "rad/s", "slug/ft2": "slug ft2"}.get(text, text)
    unit = to_si(text, where=where)
    if unit.si != si or unit.offset:
        raise refuse(
            "daveml_units",
            where=where,
            expected=f"a unit of {si}",
            found=f"'{units}'",
            do="Correct the units in the file.",
        )
    return unit.scale


def sign_of(v: DaveVariable, meaning: str, where: str) -> float:
    """+1 where the signal is positive as Alula's `meaning` is, -1 where it is opposite.

    A standard signal that states no sign is as the standard has it, which is Alula's. Raises
    BadInput for a sign that says nothing about it.
    """
    text = " ".join(v.sign.upper().replace("_", " ").split())
    outer = -1.0 if text.startswith("-") else 1.0
    text = text.lstrip("+-").strip()
    if not text:
        return 1.0
    if meaning in ("de", "da", "dr", "df", "dt"):
        return outer * sign_factor(meaning, "+" + _CONTROL_WORDS.get(text, text), where)
    if text in _POSITIVE.get(meaning, ()):
        return outer
    if text in _NEGATIVE.get(meaning, ()):
        return -outer
    raise refuse(
        "daveml_sign",
        where=where,
        expected=f"a sign of {meaning}: {', '.join('+' + x for x in _POSITIVE[meaning])}",
        found=f"'{v.sign}'",
        do="Correct the sign in the file.",
    )
