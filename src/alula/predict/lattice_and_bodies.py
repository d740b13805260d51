"""The lattice's derivatives with what bodies add: a whole aircraft, ready to be combined."""

from __future__ import annotations

from dataclasses import replace

from alula.aircraft.aircraft import Aircraft
from alula.predict.body_carry_over import bodies_at_wing
from alula.predict.combine import PAIRS, added
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.slender_body import slender_bodies

METHOD = "lattice and bodies"
_LAGS = tuple(partner for partner, _ in PAIRS.values())
# Proportional to lift: a lattice of flat sections at zero angle of attack knows nothing of them.
_OF_LIFT = ("CY_p", "Cl_r", "Cn_p", "Cn_da")
_ZERO = 0.5  # deg


def lattice_and_bodies(aircraft: Aircraft, lattice: Derivatives) -> Derivatives:
    """Lattice, slender bodies and what wing and body do to each other, about one point.

    lattice: of the aircraft's surfaces about its reference point. Left out is what would not be the
    aircraft's: derivatives to alphadot and betadot, of which a steady lattice has none; drag, which
    lacks friction; and at zero angle of attack what is proportional to lift. `combine` takes them
    from the handbook formulas.

    Use a lattice at zero angle of attack for the lateral derivatives: its wake leaves along the
    stream, and where it passes near the wing's own panels or the fin, a derivative to beta holds
    only for a sideslip much smaller than alpha and does not converge with the mesh.
    """
    parts = [lattice]
    if aircraft.geometry is not None and aircraft.geometry.bodies:
        parts.append(replace(_lumped(slender_bodies(aircraft)), axes=lattice.axes))
        if aircraft.geometry.surface("wing") is not None:
            joined = bodies_at_wing(aircraft, lattice.values["CL_alpha"].value)
            parts.append(replace(joined, axes=lattice.axes))
    whole = added(METHOD, parts)
    left_out = {*_LAGS, *(n for n in whole.values if n.startswith("CD_"))}
    if abs(float(lattice.conditions.get("alpha_deg", "0"))) < _ZERO:
        left_out |= set(_OF_LIFT)
    kept = {name: e for name, e in whole.values.items() if name not in left_out}
    return replace(whole, values=kept)


def _lumped(bodies: Derivatives) -> Derivatives:
    """The bodies' lags in their rates' derivatives: of a closed body the two cancel."""
    values = {name: e for name, e in bodies.values.items() if name not in _LAGS}
    for name, (partner, sign) in PAIRS.items():
        lag = bodies.values.get(partner)
        if lag is not None:
            own = values.get(name, Estimate(0.0, 0.0, lag.source))
            # One cause: their errors cancel as they do.
            values[name] = Estimate(
                own.value + sign * lag.value, abs(own.se - lag.se), f"{own.source}, with {partner}"
            )
    return replace(bodies, values=values)
