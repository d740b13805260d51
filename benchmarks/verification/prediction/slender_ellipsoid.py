"""An ellipsoid by 10, 20 and 40 cross-sections: Cm_alpha beside 2 volume/(S c)."""

from __future__ import annotations

import itertools
import json

import numpy as np

from alula.aircraft.geometry import Body, CrossSection
from alula.base.arrays import frozen
from alula.predict.slender_body import slender_body
from verification.places import DATA

LENGTH, DIAMETER, S, C = 6.0, 1.1, 10.6, 1.25  # m, m, m2, m: as the reference states them


def ellipsoid(n: int, cosine: bool) -> Body:
    """n stations from nose to tail, evenly or closer together at both ends."""
    xi = np.linspace(-1.0, 1.0, n)
    if cosine:
        xi = -np.cos(0.5 * np.pi * (xi + 1.0))
    d = DIAMETER * np.sqrt(np.maximum(1.0 - xi**2, 0.0))
    stations = (
        CrossSection(frozen([-0.5 * LENGTH * x, 0.0, 0.0]), float(w), float(w))
        for x, w in zip(xi, d, strict=True)
    )
    return Body("ellipsoid", tuple(stations))


def reference() -> float:
    """Cm_alpha of the reference, 1/rad."""
    path = DATA / "references" / "vortex_lattice.json"
    return float(json.loads(path.read_text())["slender_body"]["Cm_alpha"])


def slender_ellipsoid(quick: bool) -> tuple[str, bool]:
    """Both spacings converge, and are within 1 % at 20 cross-sections."""
    truth, words, good = reference(), [], True
    for cosine in (False, True):
        off = []
        for n in (10, 20, 40):
            found = slender_body(ellipsoid(n, cosine), S, 8.0, C, np.zeros(3))
            off.append(found.values["Cm_alpha"].value / truth - 1.0)
        # The reference is printed to five digits: half a unit is 1e-5 of it.
        falling = all(abs(b) <= abs(a) + 1e-5 for a, b in itertools.pairwise(off))
        good = good and abs(off[1]) < 0.01 and abs(off[2]) < 0.01 and falling
        words.append(
            f"{'cosine' if cosine else 'even'} spacing "
            + ", ".join(f"{truth * (1.0 + e):.5f} ({100 * e:+.3f} %)" for e in off)
        )
    return f"at 10, 20, 40 cross-sections, reference {truth:.5f}: " + "; ".join(words), good


if __name__ == "__main__":
    print(slender_ellipsoid(quick=False))
