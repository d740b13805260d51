"""What the vortex lattice found: coefficients, derivatives, loads, and the panels for drawing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.model import Reference
from alula.predict.derivatives import Derivatives, Estimate
from alula.predict.lattice_axes import LatticeAxes, coefficient_names, turned
from alula.predict.panels import Panels

# Coefficients and columns that are alive on a symmetric aircraft in symmetric flight.
_ALONG = (("CD", "CX", "CL", "CZ", "Cm"), ("alpha", "q", "de", "df"))
_ASIDE = (("CY", "Cl", "Cn"), ("beta", "p", "r", "da", "dr"))
ACCURACY = 0.1  # assumed: relative, of inviscid thin surfaces without body against flight


@dataclass(frozen=True)
class SpanLoad:
    """Load along one surface from its left (lower) to its right (upper) tip; k strips.

    position: (k, 3) m, quarter chord at mid-strip, body axes. chord, width: (k,) m. circulation:
    (k,) m, over V. c_l: (k,) = 2 circulation/chord. induced_angle: (k,) rad, positive where the
    wake's downwash at the surface takes lift; from the Trefftz plane.
    """

    surface: str
    position: Array
    chord: Array
    width: Array
    circulation: Array
    c_l: Array
    induced_angle: Array


@dataclass(frozen=True)
class LatticeResult:
    """Loads at one condition, n panels, with derivatives by `columns`.

    body_coefficients: (6,) CX CY CZ Cl Cm Cn; body_derivatives: (6, columns), per rad and hat.
    induced_drag: CD in the Trefftz plane. oswald: CL^2/(pi A CD), of the load named in oswald_of.
    neutral_point: (3,) m, body axes from the datum, on the line along x through `point`.
    circulation: (n,) m, over V; circulation_rates: (columns, n). force: (n, 3) over dynamic
    pressure and S, body axes. symmetric: one half was solved.
    """

    reference: Reference
    point: Array
    alpha: float
    beta: float
    mach: float
    core: float
    deflections: Mapping[str, float]
    spacing: str
    wake: str
    columns: tuple[str, ...]
    body_coefficients: Array
    body_derivatives: Array
    induced_drag: float
    oswald: float
    oswald_of: str
    neutral_point: Array
    symmetric: bool
    panels: Panels
    circulation: Array
    circulation_rates: Array
    force: Array
    span_loads: tuple[SpanLoad, ...]
    messages: tuple[Message, ...]

    def coefficients(self, axes: LatticeAxes = "model") -> dict[str, float]:
        """The six coefficients at the condition; for the axes see `lattice_axes`."""
        values, _ = turned(self.body_coefficients, self.body_derivatives, self.alpha, axes)
        return dict(zip(coefficient_names(axes), map(float, values), strict=True))

    def derivatives(
        self, axes: LatticeAxes = "model", *, per_degree: bool = False
    ) -> dict[str, float]:
        """Every derivative by name ('CL_alpha', 'Cm_q', 'Cn_dr'), zeros by symmetry left out.

        per_degree: to alpha, beta and controls per degree, as 'CL_alpha_per_deg'; rates stay per
        hat.
        """
        _, values = turned(self.body_coefficients, self.body_derivatives, self.alpha, axes)
        out = {}
        for i, coefficient in enumerate(coefficient_names(axes)):
            for j, column in enumerate(self.columns):
                if self.symmetric and not _alive(coefficient, column):
                    continue
                angle = column not in ("p", "q", "r")
                name, value = f"{coefficient}_{column}", float(values[i, j])
                if per_degree and angle:
                    name, value = f"{name}_per_deg", float(np.radians(value))
                out[name] = value
        return out

    def as_derivatives(self, mesh_error: Mapping[str, float] | None = None) -> Derivatives:
        """The value all predictors return, in the axes of models.

        CL_0, CY_0, Cl_0, Cm_0, Cn_0 are the tangent's values at zero alpha, beta and deflections.
        Each se is 10 % of the value, assumed for the method, with the mesh's error added
        (`mesh_error`, as of `mesh_study`); without that its share is not in it.
        """
        tangent = self.derivatives("model")
        at = {"alpha": self.alpha, "beta": self.beta, **self.deflections}
        values = {}
        for name, value in self.coefficients("model").items():
            if name == "CD" or (self.symmetric and name not in _ALONG[0]):
                continue  # friction is missing in the one, the others are zero
            values[f"{name}_0"] = value - sum(
                tangent.get(f"{name}_{column}", 0.0) * angle for column, angle in at.items()
            )
        values.update(tangent)
        reason = f"vortex lattice; se: {100 * ACCURACY:g} % assumed for the method"
        reason += ", mesh study" if mesh_error is not None else ", mesh error not studied"
        estimates = {
            name: Estimate(
                value, float(np.hypot(ACCURACY * value, (mesh_error or {}).get(name, 0.0))), reason
            )
            for name, value in values.items()
        }
        mesh = ", ".join(f"{name} {m} x {s}" for name, (m, s) in self.panels.mesh.items())
        x, y, z = self.point
        conditions = {
            "alpha_deg": f"{np.degrees(self.alpha):.6g}",
            "beta_deg": f"{np.degrees(self.beta):.6g}",
            "mach": f"{self.mach:g}",
            "moment_reference_m": f"{x:.6g}, {y:.6g}, {z:.6g} (body axes from the datum)",
            "panels": f"{mesh}; {self.spacing}",
            "wake": self.wake,
            "core_m": f"{self.core:g}",
        }
        for name, angle in self.deflections.items():
            conditions[f"{name}_deg"] = f"{np.degrees(angle):.6g}"
        notes = tuple(str(m) for m in self.messages if m.level != "info")
        return Derivatives("vortex lattice", estimates, conditions, notes, axes="model")

    def with_messages(self, messages: tuple[Message, ...]) -> LatticeResult:
        """The same with other messages."""
        return replace(self, messages=messages)


def _alive(coefficient: str, column: str) -> bool:
    return any(coefficient in rows and column in columns for rows, columns in (_ALONG, _ASIDE))
