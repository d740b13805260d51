"""The lifting line of a mirrored surface, with what sweep and compressibility do to it."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

import numpy as np

from alula.base.arrays import Array
from alula.predict.handbook import Found, Range, found
from alula.predict.lift_slope import polhamus, prandtl_glauert
from alula.predict.lifting_line import LiftingLine, lifting_line
from alula.predict.surface_shape import SurfaceShape


@dataclass(frozen=True)
class WingLine:
    """A surface's lifting line beside its lift slope.

    slope: C_L_alpha by Polhamus's form. even, odd: what loads of the line are multiplied with,
    symmetric ones so that the slope is met, antisymmetric ones for sweep, (A + 4) cos(s)/(A + 4
    cos(s)) of Toll and Queijo, NACA TN 1581, 1948. error: relative, of antisymmetric loads.
    """

    shape: SurfaceShape
    line: LiftingLine
    slope: Found
    even: float
    odd: float

    def over_span(self, table: Array) -> Array:
        """A table over the half span at the line's stations, the same on both sides."""
        return np.interp(np.abs(self.line.eta), self.shape.eta, table)

    def odd_found(self, value: float, what: str, se: float = 0.06) -> Found:
        """An antisymmetric load's coefficient with its error. se: of the value."""
        shape = self.shape
        return found(
            self.odd * value,
            se * abs(value),
            f"{what} by the lifting line (Pearson and Jones, NACA TR 635), sweep of NACA TN 1581; "
            f"se {se:.0%}, our judgment against lattices",
            (
                Range("aspect ratio", shape.aspect, 4.0, 20.0),
                Range("quarter-chord sweep, rad", abs(shape.sweep_quarter), 0.0, 0.7),
            ),
        )


def wing_line(shape: SurfaceShape, mach: float) -> WingLine:
    """The lifting line of a mirrored surface at a Mach number below one."""
    section = shape.slope.value / prandtl_glauert(mach)
    line = lifting_line(shape.chord, shape.span, shape.area, section)
    slope = polhamus(shape.aspect, shape.slope.value, shape.sweep_half, mach)
    plain = line.lift(line.load(np.ones_like(line.eta)))
    c = cos(shape.sweep_quarter)
    odd = (shape.aspect + 4.0) * c / (shape.aspect + 4.0 * c)
    return WingLine(shape, line, slope, slope.value / plain, odd)
