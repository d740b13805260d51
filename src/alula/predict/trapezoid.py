"""Area, aspect ratio and mean chord of a trapezoidal wing in closed form.

Schmidt, Modern Flight Dynamics, 2012, as used by Pusztai 2018, appendix C.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2

from alula.predict.handbook import positive


@dataclass(frozen=True)
class Trapezoid:
    """A mirrored trapezoidal wing. span: m, tip to tip. root, tip: chords, m.

    A fin is half of one: its `span` is twice its height and `area` twice the fin's.
    """

    span: float
    root: float
    tip: float

    def __post_init__(self) -> None:
        positive("trapezoidal wing", span=self.span, root=self.root, tip=self.tip)

    @property
    def area(self) -> float:
        """m2, both halves."""
        return 0.5 * self.span * (self.root + self.tip)

    @property
    def aspect(self) -> float:
        """Aspect ratio, span squared over area."""
        return self.span**2 / self.area

    @property
    def taper(self) -> float:
        """Tip chord over root chord."""
        return self.tip / self.root

    @property
    def mean_chord(self) -> float:
        """Mean aerodynamic chord, m: the integral of chord squared over the area."""
        t = self.taper
        return 2.0 / 3.0 * self.root * (1.0 + t + t**2) / (1.0 + t)

    @property
    def mean_station(self) -> float:
        """Distance from the plane of symmetry at which the chord is the mean chord, m.

        In the form that also holds without taper, where (c - c_r)/(c_t - c_r) is 0/0.
        """
        t = self.taper
        return self.span / 6.0 * (1.0 + 2.0 * t) / (1.0 + t)

    def sweep_at(self, leading: float, fraction: float) -> float:
        """Sweep, rad, of the line at `fraction` of the chord; leading: tip's setback, m."""
        setback = leading + fraction * (self.tip - self.root)
        return atan2(setback, 0.5 * self.span)
