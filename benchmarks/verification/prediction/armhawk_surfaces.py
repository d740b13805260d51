"""The ARM-Hawk's three lifting surfaces and its parasitic drag from Pusztai's own inputs.

Inputs and printed results: Pusztai 2018, appendix C (tables C.1 to C.4). The fin is half of a
mirrored wing: b and A are the mirrored wing's.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from alula.predict.downwash import datcom, gradient, horseshoe
from alula.predict.oswald import effective_aspect, lift_correction, lifting_line_factor
from alula.predict.profile_drag import DragItem, drag_of_items
from alula.predict.trapezoid import Trapezoid


@dataclass(frozen=True)
class Printed:
    """What a table prints, as text where the digits count."""

    eta: str
    aspect: str
    taper: str
    mean_chord: str
    station: float | None
    k: float
    e: float


SURFACES = {
    "wing": (
        Trapezoid(1.5, 0.335, 0.260), 5.73,
        Printed("0.912", "5.04", "0.776", "0.299", 0.360, 0.714, 0.981),
    ),
    "tailplane": (
        Trapezoid(0.65, 0.174, 0.174), 5.90,
        Printed("0.939", "3.74", "1.000", "0.174", None, 0.639, 0.976),
    ),
    "fin": (
        Trapezoid(0.56, 0.200, 0.115), 6.07,
        Printed("0.966", "3.56", "0.575", "0.161", 0.128, 0.639, 0.995),
    ),
}  # fmt: skip

PARTS = (
    DragItem("fuselage", 0.20, 0.0141),
    DragItem("landing gear", 0.15, 0.0045),
    DragItem("main wheels", 0.35, 0.011),
    DragItem("tail gear and wheel", 0.30, 0.0013),
    DragItem("antennas", 2.0, 0.00069),
    DragItem("control horns", 0.2, 0.0010),
    DragItem("servos and linkage", 1.1, 0.0015),
    DragItem("air data sensor", 0.1, 0.0041),
    DragItem("motor", 0.5, 0.0028),
)
WING_AREA = 0.446  # m2
C_DF = "0.029"

X_WING = -0.22 - 0.100  # m, aerodynamic centers: X_LE less X_ac
X_TAIL = -1.21 - 0.0435
DOWNWASH = 0.48

STATION, K, E, GRADIENT = 0.002, 0.002, 0.008, 0.10  # what the row allows; the last relative


def downwash_gradient() -> tuple[float, float, float]:
    """d epsilon/d alpha: predicted, by the Datcom's form and by the horseshoe vortex.

    The tailplane's height is not published; it is taken in the wing's plane. As he does, the
    chart's aspect ratio is that of the elliptic wing with the same induced drag.
    """
    wing, section, _ = SURFACES["wing"]
    arm = X_WING - X_TAIL
    slope = lift_correction(wing, section) * section
    sweep = wing.sweep_at(0.053, 0.25)  # 4.04 deg at the leading edge: 53 mm at the tip
    chart = datcom(effective_aspect(wing, section), wing.taper, sweep, wing.span, arm)
    vortex = horseshoe(slope, wing.aspect, wing.span, arm)
    return gradient((chart, vortex)).value, chart.value, vortex.value


def armhawk_surfaces(quick: bool) -> tuple[str, bool]:
    """Every printed value of the three surfaces beside Alula's."""
    good, station, k, e = True, 0.0, 0.0, 0.0
    for wing, section, p in SURFACES.values():
        shown = (
            f"{section / (2.0 * pi):.3f}", f"{wing.aspect:.2f}",
            f"{wing.taper:.3f}", f"{wing.mean_chord:.3f}",
        )  # fmt: skip
        good &= shown == (p.eta, p.aspect, p.taper, p.mean_chord)
        if p.station is not None:
            station = max(station, abs(wing.mean_station - p.station))
        k = max(k, abs(lift_correction(wing, section) - p.k))
        e = max(e, abs(lifting_line_factor(wing, section).value - p.e))
    drag = drag_of_items(PARTS, WING_AREA).value
    good &= f"{drag:.3f}" == C_DF
    total, chart, vortex = downwash_gradient()
    holds = (
        good and station < STATION and k < K and e < E
        and abs(total / DOWNWASH - 1.0) < GRADIENT
    )  # fmt: skip
    printed = "as printed" if good else "NOT as printed"
    return (
        f"eta, A, taper, c_bar, C_DF {printed} (C_DF {drag:.4f});"
        f" y_MAC within {station:.4f}, k within {k:.4f}, e within {e:.4f}; downwash gradient "
        f"{total:.3f} ({total / DOWNWASH - 1.0:+.1%}; Datcom {chart:.3f}, horseshoe {vortex:.3f})",
        holds,
    )
