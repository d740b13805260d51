"""The lattice's derivatives with what bodies add: a whole aircraft, ready to be combined."""

from __future__ import annotations

from dataclasses import replace

from alula.aircraft.aircraft import Aircraft
from alula.predict.body_carry_over import bodies_at_wing
from alula.predict.combine import PAIRS, added
from alula.predict.derivatives import Derivatives
from alula.predict.slender_body import slender_bodies

METHOD = "lattice and bodies"
_LAGS = tuple(partner for partner, _ in PAIRS.values())


def lattice_and_bodies(aircraft: Aircraft, lattice: Derivatives) -> Derivatives:
    """Lattice, slender bodies and what wing and body do to each other, about one point.

    lattice: of the aircraft's surfaces about its reference point. Derivatives to alphadot and
    betadot are left out: a steady lattice has none, and the bodies' share alone would read as the
    aircraft's. Take them from the handbook formulas, by `combine`.
    """
    parts = [lattice]
    if aircraft.geometry is not None and aircraft.geometry.bodies:
        parts.append(replace(slender_bodies(aircraft), axes=lattice.axes))
        if aircraft.geometry.surface("wing") is not None:
            joined = bodies_at_wing(aircraft, lattice.values["CL_alpha"].value)
            parts.append(replace(joined, axes=lattice.axes))
    whole = added(METHOD, parts)
    kept = {name: e for name, e in whole.values.items() if name not in _LAGS}
    return replace(whole, values=kept)
