"""Dryden turbulence as flown, against the spectra of MIL-F-8785C (3.7.1.2, 3.7.3.4).

A body without forces or gravity keeps its speed and height; the turbulence it meets is what `fly`
reports as its inputs. The specification's spectra are written here a second time, as densities over
frequency, and compared with averaged periodograms. Sampling folds what lies above half its rate;
therefore the comparison ends at a tenth of it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import welch

from alula.base.arrays import Array
from alula.model import Reference, aero_model
from alula.simulate import Airframe, fly, initial_state
from alula.simulate.wind import Turbulence

FOOT, SPAN, STEP = 0.3048, 8.65, 0.01
COMPONENTS = ("u", "v", "w", "p", "q", "r")
TOLERANCE = 0.10
# Airspeed m/s, height m, W20 m/s, sigma m/s: below 1000 ft, above 2000 ft.
CONDITIONS = ((45.0, 150.0, 15.4, 0.0), (60.0, 1500.0, 0.0, 1.5))


def specified(f: Array, V: float, h: float, W20: float, sigma: float) -> Mapping[str, Array]:
    """One-sided densities (m/s)2/Hz and (rad/s)2/Hz of the six components at frequencies f, Hz."""
    if h < 1000.0 * FOOT:
        over = 0.177 + 0.000823 * h / FOOT
        scale = {"w": h, "u": h / over**1.2, "v": h / over**1.2}
        deviation = {"w": 0.1 * W20, "u": 0.1 * W20 / over**0.4, "v": 0.1 * W20 / over**0.4}
    else:
        scale = dict.fromkeys("uvw", 1750.0 * FOOT)
        deviation = dict.fromkeys("uvw", sigma)
    omega = 2.0 * np.pi * f / V  # spatial, rad/m
    out = {}
    for name in "uvw":
        L, variance = scale[name], deviation[name] ** 2
        x = (L * omega) ** 2
        shape = 1.0 / (1.0 + x) if name == "u" else 0.5 * (1.0 + 3.0 * x) / (1.0 + x) ** 2
        out[name] = variance * 2.0 * L / np.pi * shape * 2.0 * np.pi / V
    b, L, variance = SPAN, scale["w"], deviation["w"] ** 2
    roll = 0.8 * (np.pi * L / (4.0 * b)) ** (1.0 / 3.0) / (1.0 + (4.0 * b * omega / np.pi) ** 2)
    out["p"] = variance / L * roll * 2.0 * np.pi / V
    out["q"] = omega**2 / (1.0 + (4.0 * b * omega / np.pi) ** 2) * out["w"]
    out["r"] = omega**2 / (1.0 + (3.0 * b * omega / np.pi) ** 2) * out["v"]
    return out


def met(V: float, h: float, W20: float, sigma: float, seconds: float, seed: int) -> Array:
    """Turbulence (n, 6) that a body without forces meets."""
    model = aero_model("none", {"CX": "1"}, {"CX_0": 0.0}, Reference(10.0, SPAN, 1.25))
    body = Airframe(600.0, np.diag([600.0, 700.0, 1100.0]))
    t = np.arange(round(seconds / STEP) + 1) * STEP
    start = initial_state(V, 0.0, 0.0, h)
    wind = Turbulence(W20=W20, sigma=sigma, seed=seed)
    flight = fly(body, model, start, t, {}, gravity=0.0, turbulence=wind)
    return np.asarray(flight.inputs[:, 6:12])


def worst(seconds: float, lowest: float, seed: int = 3) -> dict[str, float]:
    """Largest relative departure in bands of a seventh of a decade above `lowest` Hz."""
    out = {}
    for V, h, W20, sigma in CONDITIONS:
        turbulence = met(V, h, W20, sigma, seconds, seed)
        for i, name in enumerate(COMPONENTS):
            f, found = welch(turbulence[:, i], 1.0 / STEP, nperseg=2**14, detrend=False)
            must = specified(f, V, h, W20, sigma)[name]
            keep = (f > lowest) & (f < 0.1 / STEP)
            band = np.floor(7.0 * np.log10(f[keep])).astype(int)
            ratio = [
                found[keep][band == k].sum() / must[keep][band == k].sum() for k in np.unique(band)
            ]
            out[f"{name} at {h:g} m"] = float(np.max(np.abs(np.array(ratio) - 1.0)))
    return out


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found, and whether every band is within a tenth of the specification."""
    # A short record has too few periods of the slow bands to judge them.
    lowest = 0.3 if quick else 0.03
    found = worst(4_000.0 if quick else 40_000.0, lowest)
    name = max(found, key=lambda n: found[n])
    return (
        f"largest departure of a band from {lowest:g} Hz to a tenth of the sampling rate: "
        f"{100 * found[name]:.1f} % ({name}); six components at {len(CONDITIONS)} heights",
        found[name] < TOLERANCE,
    )
