"""JSBSim's properties and units for what Alula calls otherwise."""

from __future__ import annotations

from alula.base.units import FT, LB, LBF, SLUG

INCH = FT / 12.0  # m

# What the model's variables are in JSBSim; those of 'alula/' are made by the exported file.
PROPERTIES: dict[str, str] = {
    "V": "alula/V-m_s",
    "alpha": "aero/alpha-rad",
    "beta": "aero/beta-rad",
    "phat": "alula/phat",
    "qhat": "alula/qhat",
    "rhat": "alula/rhat",
    "de": "fcs/elevator-pos-rad",
    "da": "alula/aileron-pos-rad",
    "dr": "fcs/rudder-pos-rad",
    "df": "fcs/flap-pos-rad",
    "dt": "alula/throttle-pos",
    "mach": "velocities/mach",
}
# Commands of the pilot, and the factor from JSBSim's sense to Alula's: its aileron command rolls
# right; elevator trailing edge down and rudder trailing edge left are positive in both.
COMMANDS: dict[str, tuple[str, float]] = {
    "de": ("fcs/elevator-cmd-norm", 1.0),
    "da": ("fcs/aileron-cmd-norm", -1.0),
    "dr": ("fcs/rudder-cmd-norm", 1.0),
    "df": ("fcs/flap-cmd-norm", 1.0),
    "dt": ("fcs/throttle-cmd-norm", 1.0),
}
# Where the aircraft file states no limits, rad; throttle 0 to 1.
DEFAULT_LIMITS: dict[str, tuple[float, float]] = {
    "de": (-0.5236, 0.5236),
    "da": (-0.5236, 0.5236),
    "dr": (-0.5236, 0.5236),
    "df": (0.0, 0.6981),
    "dt": (0.0, 1.0),
}
POUNDS_PER_SLUG = 32.174049  # JSBSim's own constant, FGJSBBase

__all__ = [
    "COMMANDS",
    "DEFAULT_LIMITS",
    "FT",
    "INCH",
    "LB",
    "LBF",
    "POUNDS_PER_SLUG",
    "PROPERTIES",
    "SLUG",
    "norm_command",
]


def norm_command(control: str, position: float, limits: tuple[float, float]) -> float:
    """JSBSim's command, -1 to 1 (flap and throttle 0 to 1), that gives this position.

    position, limits: in Alula's notation. Zero is zero; each side has its own scale.
    """
    factor = COMMANDS[control][1]
    low, high = limits
    side = high if position > 0.0 else -low
    return 0.0 if position == 0.0 or side == 0.0 else factor * position / side
