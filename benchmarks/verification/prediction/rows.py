"""Derivatives from geometry: each row's check in its own file."""

from __future__ import annotations

from verification.prediction import (
    apc_10x7sf,
    armhawk_aircraft,
    armhawk_surfaces,
    armhawk_tables,
    blade_element,
    lattice_reference,
    lattice_speed,
    slender_ellipsoid,
    sportstar_prediction,
)
from verification.registry import rows

ROWS = {
    "`vortex_lattice.json`, every value": (
        "to the printed digits, one unit in the last",
        lattice_reference.check,
    ),
    "ellipsoid given by 10, 20, 40 cross-sections": (
        "Cm_alpha converges to the reference in `vortex_lattice.json`, within 1 % at 20",
        slender_ellipsoid.slender_ellipsoid,
    ),
    "`blade_element.json`": (
        "general solver with its station rule: three speeds to 1e-5; QPROP case (`cam6x3.def`) "
        "within 3 %",
        blade_element.check,
    ),
    "APC 10x7SF, all runs": (
        "Pusztai's model with c_l_alpha, alpha_max, c_d_alpha and effective pitch: CT and CP "
        "rms under 9 % of their largest value for J < 0.9, the failure with three parameters "
        "shown; general solver without fitting: CT within 12 % of the largest; honest plot",
        apc_10x7sf.check,
    ),
    "ARM-Hawk appendix C, three surfaces": (
        "eta, A, taper, c_bar, C_DF as printed; y_MAC and k within .002; e within .008; "
        "downwash gradient 0.48 within 10 %",
        armhawk_surfaces.armhawk_surfaces,
    ),
    "ARM-Hawk whole aircraft": (
        "statically stable up to the angle the tail polar allows, reported beside his 20 deg; "
        "roll and yaw from full propwash at low speed with the signs and trend that the text of"
        " Figures C.7 to C.10 describes",
        armhawk_aircraft.armhawk_aircraft,
    ),
    "SportStar-like aircraft": (
        "CL_alpha and CL_de within 87 to 117 % of Dittrich's estimates (his band); the drag and"
        " damping gap shown with its ratio, not hidden",
        sportstar_prediction.sportstar_prediction,
    ),
    "speed, one thread, all derivatives": (
        "the design's table (174 / 2040 / 5044 panels: 0.004 / 0.6 / 8 s, the last in under 1 "
        "GB; at most 2.5 times the LU alone at 2040); growth shown",
        lattice_speed.check,
    ),
    "lookup tables of the ARM-Hawk": (
        "built in under 60 s on 2 cores; one lookup of all six coefficients under 2 µs, term "
        "table under 0.5 µs",
        armhawk_tables.armhawk_tables,
    ),
}
rows("prediction", ROWS)
