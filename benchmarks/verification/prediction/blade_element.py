"""Blade elements against the reference of blade_element.json and QPROP's case of a CAM 6x3.

The reference's station rule: the loads at eleven evenly spaced stations, the first and the last one
in full, each times the stations' distance. The same propeller by the default quadrature is given
beside it. QPROP uses another form of the wake (Drela's induced velocity and tip factor).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft.blades import Blades
from alula.aircraft.load_blades import load_blades
from alula.aircraft.propeller_files import read_qprop
from alula.predict.propeller_blade_element import blade_element_loads
from verification.places import DATA

RPM, DENSITY = 2100.0, 1.225
TOLERANCE, QPROP_TOLERANCE = 1e-5, 0.03


def reference_blades() -> Blades:
    """Two blades of constant chord and geometric pitch; cd = 0.008 - 0.003 cl + 0.01 cl^2."""
    radius = 0.8
    return load_blades(
        {
            "count": 2,
            "diameter": 2.0 * radius,
            "r": np.linspace(radius / 10.0, radius, 11).tolist(),
            "chord": [0.1] * 11,
            "pitch": 1.0,
            "polar": {
                "c_l_alpha": 6.2,
                "c_l_min": -99.0,
                "c_l_max": 99.0,
                "c_d_0": 0.008 - 0.01 * 0.15**2,
                "c_d_2_upper": 0.01,
                "c_d_2_lower": 0.01,
                "c_l_cd0": 0.15,
                "mach_corrected": False,
            },
        },
        "blade_element.json",
    )


def worst(reference: dict[str, Any]) -> float:
    """Largest relative difference of all values of the three speeds."""
    blades = reference_blades()
    n = RPM / 60.0
    omega = 2.0 * np.pi * n
    errors = []
    for case in reference["expected"]:
        (T,), (Q,) = blade_element_loads(
            blades, [case["V"]], [omega], density=DENSITY, tip_loss=False, rule="stations"
        )
        found = {
            "T": T,
            "Q": Q,
            "CT": T / (DENSITY * n**2 * blades.diameter**4),
            "CQ": Q / (DENSITY * n**2 * blades.diameter**5),
            "eta": T * case["V"] / (Q * omega),
        }
        errors += [abs(found[k] / case[k] - 1.0) for k in case if k != "V"]
    return float(max(errors))


def qprop(reference: dict[str, Any], path: Path) -> tuple[float, float]:
    """Thrust and torque over QPROP's, at 14020 rpm and 5 m/s."""
    (T,), (Q,) = blade_element_loads(read_qprop(path), [5.0], [2.0 * np.pi * 14020.0 / 60.0])
    return float(T / reference["T"]), float(Q / reference["Q"])


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found, and whether it holds."""
    reference = json.loads((DATA / "references" / "blade_element.json").read_text())
    error = worst(reference)
    T, Q = qprop(reference["qprop"], DATA / "propellers" / "cam6x3.def")
    omega = 2.0 * np.pi * RPM / 60.0
    smooth, _ = blade_element_loads(reference_blades(), [5.0], [omega], tip_loss=False)
    holds = error < TOLERANCE and max(abs(T - 1.0), abs(Q - 1.0)) < QPROP_TOLERANCE
    return (
        f"three speeds, station rule: largest difference {error:.1e}; QPROP's CAM 6x3: thrust "
        f"{100 * (T - 1):+.1f} %, torque {100 * (Q - 1):+.1f} %; by quadrature the thrust at "
        f"5 m/s is {smooth[0]:.1f} N for the station rule's {reference['expected'][1]['T']:.1f} N",
        holds,
    )
