"""A finished prediction with all that it rests on: what the command prints and the page shows."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, radians

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import Message
from alula.model import AeroModel, Reference
from alula.predict.axes import along
from alula.predict.derivatives import Derivatives, PredictionAxes
from alula.predict.flow import Flow
from alula.predict.lattice_result import LatticeResult
from alula.predict.mesh_study import MeshStudy

_COEFFICIENTS = ("CL", "CD", "Cm", "CY", "Cl", "Cn")
_LABELS = ("0", "alpha", "alpha2", "alphadot", "beta", "betadot", "p", "q", "r",
           "de", "da", "dr", "df")  # fmt: skip
ANGLES = frozenset({"alpha", "beta", "de", "da", "dr", "df"})


@dataclass(frozen=True)
class Prediction:
    """derivatives: the answer, in stability axes; parts: the methods that it is made of.

    method: as asked for. h: m; alpha: rad. model: as the simulator flies it, None where the method
    does not give the whole aircraft. lattice, study: of the surfaces, None where there is none;
    loads: the lattice at `alpha`, for span loads.
    neutral_point: (3,) m, with fixed controls, None without CL_alpha; neutral_se: m, of its x.
    """

    aircraft: Aircraft
    method: str
    h: float
    flow: Flow
    alpha: float
    derivatives: Derivatives
    parts: tuple[Derivatives, ...]
    model: AeroModel | None
    lattice: LatticeResult | None
    study: MeshStudy | None
    loads: LatticeResult | None
    neutral_point: Array | None
    neutral_se: float
    messages: tuple[Message, ...]

    @property
    def reference(self) -> Reference:
        """What the coefficients refer to."""
        return Reference(self.aircraft.S, self.aircraft.b, self.aircraft.c)

    @property
    def margin(self) -> float | None:
        """From the center of gravity back to the neutral point, over c; None without either."""
        if self.neutral_point is None or self.aircraft.mass is None:
            return None
        return float(self.aircraft.mass.cg[0] - self.neutral_point[0]) / self.aircraft.c

    def along(self, axes: PredictionAxes, *, per_degree: bool = False) -> Derivatives:
        """The derivatives with rates and moments along these axes; '..._per_deg' where asked."""
        turned = along(self.derivatives, axes)
        ordered = sorted(turned.values, key=_order)
        turned = replace(turned, values={n: turned.values[n] for n in ordered})
        return per_deg(turned) if per_degree else turned

    def conventions(self, axes: PredictionAxes, *, per_degree: bool = False) -> tuple[str, ...]:
        """What the numbers mean, in sentences."""
        a = self.aircraft
        x, y, z = a.reference_point
        which = {
            "stability": "stability axes (x along the stream in the plane of symmetry)",
            "model": "body axes (x forward, y right, z down)",
        }[axes]
        angle = "per degree (names end in _per_deg)" if per_degree else "per rad"
        return (
            f"{a.name} at V {self.flow.V:.6g} m/s, h {self.h:.6g} m, Mach {self.flow.mach:.3g}, "
            f"alpha {degrees(self.alpha):.4g} deg.",
            f"CD, CY, CL along stability axes, moments and rates along {which}; angles and "
            f"deflections {angle}, rates per hat: pb/2V, qc/2V, rb/2V.",
            f"S {a.S:g} m2, b {a.b:g} m, c {a.c:g} m; moments about ({x:g}, {y:g}, {z:g}) m, "
            f"from the {a.datum}. A positive deflection gives a negative moment.",
        )


def per_deg(derivatives: Derivatives) -> Derivatives:
    """The same with derivatives to angles and deflections per degree, named '..._per_deg'."""
    values = {}
    for name, e in derivatives.values.items():
        label = name.partition("_")[2]
        power = 2 if label == "alpha2" else int(label in ANGLES)
        factor = radians(1.0) ** power
        shown = f"{name}_per_deg" + ("2" if power == 2 else "") if power else name
        values[shown] = replace(e, value=factor * e.value, se=factor * e.se)
    return replace(derivatives, values=values)


def _order(name: str) -> tuple[int, int]:
    coefficient, _, label = name.partition("_")
    return _COEFFICIENTS.index(coefficient), _LABELS.index(label)
