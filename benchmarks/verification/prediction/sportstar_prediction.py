"""The SportStar-like aircraft predicted, beside what Dittrich found from flight.

Flown: Dittrich 2016, Tables 4.4 and 4.5, column Est., as in aircraft/sportstar_aero.toml. The shape
in aircraft/sportstar.toml is assumed but for span, area and mean chord. Like is compared with like:
flight shows Cm_q + Cm_alphadot, and its drag is a straight line over the angle of attack.
"""

from __future__ import annotations

import numpy as np

from alula.aircraft import Aircraft, load_aircraft
from alula.model import Reference, load_model
from alula.predict.combine import as_flown, combine
from alula.predict.derivatives import Derivatives
from alula.predict.flow import Flow
from alula.predict.lattice_and_bodies import lattice_and_bodies
from alula.predict.profile_drag import DragItem
from alula.predict.semi_empirical import semi_empirical
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
BAND = (0.87, 1.17)  # Dittrich 2016, sec. 4.6.3: lift as predicted by Tornado, AVL and Datcom
FLOW = Flow(V=45.0)  # m/s, inside the flown range of speeds
ALPHA = (-0.06, 0.19)  # rad, of the flown straight line
# Assumed: a fixed tricycle landing gear, wheels and legs by frontal area (Hoerner's values).
GEAR = (DragItem("wheels", 0.30, 0.125), DragItem("legs", 0.50, 0.060))


def predictions(aircraft: Aircraft) -> list[Derivatives]:
    """Handbook formulas, and lattice with bodies where the lattice is built."""
    handbook = semi_empirical(aircraft, FLOW, items=GEAR)
    lattice = lattice_of(aircraft)
    return [handbook] if lattice is None else [lattice_and_bodies(aircraft, lattice), handbook]


def lattice_of(aircraft: Aircraft) -> Derivatives | None:
    """The vortex lattice at zero angle of attack, where its axes do not matter."""
    try:
        from alula.predict.vortex_lattice import vortex_lattice
    except ImportError:
        return None
    reference = Reference(aircraft.S, aircraft.b, aircraft.c)
    assert aircraft.geometry is not None
    found = vortex_lattice(aircraft.geometry, reference, aircraft.reference_point)
    return found.as_derivatives()


def straight_drag(prediction: Derivatives, zero: float, slope: float) -> tuple[float, float]:
    """CD_0 and CD_alpha of the straight line through the predicted polar, as flight gave it.

    zero, slope: the flown CL_0 and CL_alpha, so that both sides have the same lift.
    """
    v = prediction.values
    induced = v["CD_alpha2"].value / v["CL_alpha"].value ** 2
    minimum = v["CD_0"].value - induced * v["CL_0"].value ** 2
    alpha = np.linspace(*ALPHA, 101)
    line = np.polyfit(alpha, minimum + induced * (zero + slope * alpha) ** 2, 1)
    return float(line[1]), float(line[0])


def sportstar_prediction(quick: bool) -> tuple[str, bool]:
    """Ratios predicted over flown; the row asks for lift, and shows drag and damping."""
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    flown = load_model(AIRCRAFT / "sportstar_aero.toml").params
    each = predictions(aircraft)
    whole = combine(each)
    sides = [*each, whole] if len(each) > 1 else each
    holds, said = True, []
    for d in sides:
        ratios = {n: d.values[n].value / flown[n] for n in ("CL_alpha", "CL_de")}
        holds &= all(BAND[0] <= x <= BAND[1] for x in ratios.values())
        said.append(f"{d.method} " + ", ".join(f"{n} {x:.0%}" for n, x in ratios.items()))
    shown = as_flown(whole)
    damping = next(e for n, e in shown.items() if n.startswith("Cm_q"))
    gaps = [f"Cm_q + Cm_alphadot {_ratio(damping.value, damping.se, flown['Cm_q'])}"]
    for n in ("Cm_alpha", "Cm_de"):
        gaps.append(f"{n} {_ratio(shown[n].value, shown[n].se, flown[n])}")
    for with_gear, items in (("bare", ()), ("with assumed gear", GEAR)):
        line = straight_drag(
            semi_empirical(aircraft, FLOW, items=items), flown["CL_0"], flown["CL_alpha"]
        )
        gaps.append(
            f"{with_gear} CD_0 {line[0] / flown['CD_0']:.0%}, "
            f"CD_alpha {line[1] / flown['CD_alpha']:.0%}"
        )
    return "; ".join(said) + ". Predicted over flown, 95 %: " + "; ".join(gaps), holds


def _ratio(value: float, se: float, flown: float) -> str:
    half = 1.96 * se / abs(flown)
    return f"{value / flown:.0%} ({value / flown - half:.0%} to {value / flown + half:.0%})"
