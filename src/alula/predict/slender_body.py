"""Forces and moments of a fuselage or nacelle by slender-body theory.

Munk 1924, NACA Report 184, and Jones 1946, NACA Report 835: the cross-flow of velocity w gives
each cross-section the momentum rho A w of the air beside it, A being the circle over the width
for w and over the height for v; the force per length is its rate of change D(rho A w)/Dt with
D/Dt = d/dt + V d/ds. A body closed at both ends so has a moment and no force. What is left at a
base, where the flow leaves, is lift.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from alula.aircraft import Aircraft
from alula.aircraft.geometry import Body
from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.predict.body_shape import BodyShape
from alula.predict.derivatives import Derivatives, Estimate

# Of the moment. The theory is exact as the body becomes thin; where it is not, the apparent-mass
# factor measures what is missing, and this the rest (noncircular sections, thick flow at the tail).
_SHARE = 0.10
# Of a base's area, and of the largest cross-section: where the flow leaves a tail is not known.
_BASE_SHARE = 0.5
_LEAVES = 0.1
_SLENDER = 4.0  # length over diameter from which the theory is used without a remark


def apparent_mass_factor(fineness: float) -> float:
    """k2 - k1 of a prolate spheroid of this length over diameter, 0 to 1.

    Munk 1924, NACA Report 184, Table I, by Lamb, Hydrodynamics, Art. 114: the moment of a body
    that is not thin is this factor of the thin one's.
    """
    if fineness <= 1.0:
        return 0.0
    e = np.sqrt(1.0 - fineness**-2)
    log = np.log((1.0 + e) / (1.0 - e))
    along = 2.0 * (1.0 - e * e) / e**3 * (0.5 * log - e)
    across = 1.0 / (e * e) - (1.0 - e * e) / (2.0 * e**3) * log
    return float(across / (2.0 - across) - along / (2.0 - along))


def slender_body(
    body: Body,
    S: float,
    b: float,
    c: float,
    point: Array,
    *,
    apparent_mass: bool = False,
    base: bool = True,
) -> Derivatives:
    """Derivatives of one body alone, about `point` (3,) m.

    apparent_mass: the moments times k2 - k1 of the spheroid of equal fineness; without it
    Cm_alpha of a body of revolution is 2 volume/(S c). base: whether the last cross-section's
    area counts as a base; without, the body ends closed there.
    """
    shape = BodyShape(body)
    s0, z0 = shape.x_nose - float(point[0]), float(point[2])
    fineness = shape.length / shape.diameter
    factor = apparent_mass_factor(fineness)
    k = factor if apparent_mass else 1.0
    q = 0.25 * np.pi

    def moments(square: Callable[[Array], Array]) -> tuple[float, float]:
        """Of the circles over width or height: volume, and first moment aft of the point."""
        whole = shape.integral(lambda s: q * square(s))
        return whole, shape.integral(lambda s: q * square(s) * (s - s0))

    flat, flat_first = moments(shape.width2)
    tall, tall_first = moments(shape.height2)
    wide, high = q * shape.width**2, q * shape.height**2
    arm = shape.length - s0  # from the point back to the base
    z = float(shape.stations[-1, 2]) - z0
    slope_z = np.diff(shape.stations[:, 2]) / np.diff(shape.s)

    def dz(s: Array) -> Array:
        piece = np.clip(np.searchsorted(shape.s, s) - 1, 0, len(slope_z) - 1)
        return np.asarray(slope_z[piece])

    # Integral of (z - z0) dA, by parts: the base's part less this.
    bent = shape.integral(lambda s: q * shape.height2(s) * dz(s))
    # The closed body's part, to which the apparent mass belongs, and what a base adds per area.
    parts = {
        "CL_alpha": (0.0, 2.0 / S),
        "CL_q": (0.0, 4.0 * arm / (S * c)),
        "CL_alphadot": (4.0 * flat / (S * c), 0.0),
        "Cm_alpha": (2.0 * flat / (S * c), -2.0 * arm / (S * c)),
        "Cm_q": (4.0 * flat_first / (S * c * c), -4.0 * arm**2 / (S * c * c)),
        "Cm_alphadot": (-4.0 * flat_first / (S * c * c), 0.0),
        "CY_beta": (0.0, -2.0 / S),
        "CY_r": (0.0, 4.0 * arm / (S * b)),
        "CY_betadot": (-4.0 * tall / (S * b), 0.0),
        "Cn_beta": (-2.0 * tall / (S * b), 2.0 * arm / (S * b)),
        "Cn_r": (4.0 * tall_first / (S * b * b), -4.0 * arm**2 / (S * b * b)),
        "Cn_betadot": (4.0 * tall_first / (S * b * b), 0.0),
        "Cl_beta": (-2.0 * bent / (S * b), 2.0 * z / (S * b)),
    }
    words = (
        f"slender-body theory, {'with' if apparent_mass else 'without'} apparent-mass factor "
        f"{factor:.3f}; se: the factor's effect, {100 * _SHARE:.0f} % of the closed body's part, "
        f"a base uncertain by {100 * _BASE_SHARE:.0f} % of its area and {100 * _LEAVES:.0f} % of "
        "the largest cross-section (Alula's estimate)"
    )
    values = {}
    for name, (closed, slope) in parts.items():
        circles = wide if name[:2] in ("CL", "Cm") else high
        area = float(circles[-1]) if base else 0.0
        unsure = _BASE_SHARE * float(circles[-1]) + _LEAVES * float(circles.max())
        terms = ((1.0 - factor) * closed, _SHARE * closed, unsure * slope)
        values[name] = Estimate(k * closed + area * slope, float(np.hypot.reduce(terms)), words)
    notes: tuple[str, ...] = ()
    if fineness < _SLENDER:
        notes = (
            f"'{body.name}' is {fineness:.2g} times as long as thick; slender-body theory is for "
            f"{_SLENDER:g} and more.",
        )
    conditions = {
        "body": body.name,
        "alone": "no wing, no tail; attached flow, alpha and beta small",
        "volume": f"{shape.volume:.6g} m3",
        "length over diameter": f"{fineness:.3g}",
        "apparent-mass factor": f"{factor:.4g}, " + ("applied" if apparent_mass else "not applied"),
        "moments about": ", ".join(f"{x:.4g}" for x in point) + " m",
    }
    return Derivatives("slender body", values, conditions, notes)


def slender_bodies(
    aircraft: Aircraft,
    point: Array | None = None,
    *,
    apparent_mass: bool = False,
    base: bool = True,
) -> Derivatives:
    """Derivatives of all bodies of an aircraft, each as if alone, about its reference point.

    Standard errors add up: the theory misses the same things in each body. Raises BadInput where
    the aircraft file has no body.
    """
    about = aircraft.reference_point if point is None else point
    if aircraft.geometry is None or not aircraft.geometry.bodies:
        raise refuse(
            "missing_bodies",
            where=aircraft.path,
            expected="[[geometry.bodies]] with cross-sections from nose to tail",
            found="none",
            do="Add the fuselage's stations to the aircraft file.",
        )
    found = [
        slender_body(
            body, aircraft.S, aircraft.b, aircraft.c, about, apparent_mass=apparent_mass, base=base
        )
        for body in aircraft.geometry.bodies
    ]
    values = {
        name: Estimate(
            sum(d.values[name].value for d in found),
            sum(d.values[name].se for d in found),
            found[0].values[name].source,
        )
        for name in found[0].values
    }
    conditions = found[0].conditions if len(found) == 1 else {
        "bodies": ", ".join(d.conditions["body"] for d in found),
        "moments about": found[0].conditions["moments about"],
    }  # fmt: skip
    return Derivatives("slender body", values, conditions, tuple(n for d in found for n in d.notes))
