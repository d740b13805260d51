"""Prandtl's lifting line by Glauert's sine series: loads of an unswept wing of any chord and twist.

Glauert, The Elements of Aerofoil and Airscrew Theory, 1926, ch. XI; rolling and yawing wings as in
Pearson and Jones, NACA TR 635, 1938. With y = -(b/2) cos(theta) and the circulation
Gamma = 2 b V sum A_n sin(n theta), the sections' condition is
sum A_n sin(n theta) (sin(theta) + n mu) = mu alpha sin(theta), mu = c_l_alpha c/(4 b).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.predict.handbook import positive

TERMS = 120  # a jump of twist (dihedral, aileron) is then resolved within half a percent


@dataclass(frozen=True)
class Load:
    """A span load's coefficients of the sine series, (k,), per unit of what caused it."""

    A: Array


@dataclass(frozen=True)
class LiftingLine:
    """A wing's lifting line, ready to be solved for any twist.

    eta: (k,) stations 2 y/b from left to right tip. aspect: aspect ratio. theta: (k,).
    """

    eta: Array
    aspect: float
    theta: Array
    _mu: Array
    _inverse: Array

    def load(self, alpha: Array) -> Load:
        """The load of the angles of attack `alpha` (k,), rad, at the stations."""
        return Load(self._inverse @ (self._mu * alpha * np.sin(self.theta)))

    def lift(self, load: Load) -> float:
        """Lift coefficient."""
        return float(np.pi * self.aspect * load.A[0])

    def roll(self, load: Load) -> float:
        """Rolling moment coefficient (span as length): more lift on the right is negative."""
        return float(np.pi * self.aspect * load.A[1] / 4.0)

    def drag(self, load: Load) -> float:
        """Induced drag coefficient."""
        n = np.arange(1, load.A.size + 1)
        return float(np.pi * self.aspect * (n * load.A**2).sum())

    def carried(self, load: Load, x: Array) -> float:
        """Integral of the sections' lift times `x` (k,), as a coefficient."""
        step = np.pi / (self.theta.size + 1)
        arm = x * np.sin(self.theta) * self._circulation(load)
        return float(2.0 * self.aspect * arm.sum() * step)

    def yaw(self, load: Load, other: Load) -> float:
        """Yawing moment coefficient of induced drag that `other` adds to the wing with `load`."""
        g, h = self._circulation(load), self._circulation(other)
        drag = g * self._induced(other) + h * self._induced(load)
        return self._moment(drag)

    def tilted(self, load: Load, angle: Array) -> float:
        """Yawing moment coefficient when the load's lift tilts forward by `angle` (k,), rad."""
        return self._moment(-self._circulation(load) * angle)

    def slowed(self, load: Load, speed: Array) -> float:
        """Rolling moment when the load's circulation moves by `speed` (k,) V faster."""
        return -self._moment(self._circulation(load) * speed)

    def _circulation(self, load: Load) -> Array:
        n = np.arange(1, load.A.size + 1)
        out: Array = np.sin(np.outer(self.theta, n)) @ load.A  # over 2 b V
        return out

    def _induced(self, load: Load) -> Array:
        n = np.arange(1, load.A.size + 1)
        out: Array = np.sin(np.outer(self.theta, n)) @ (n * load.A) / np.sin(self.theta)
        return out

    def _moment(self, force: Array) -> float:
        """Integral of y times a force per span over 2 b rho V2, as a coefficient with the span."""
        step = np.pi / (self.theta.size + 1)
        arm = self.eta * np.sin(self.theta) * force
        return float(self.aspect * arm.sum() * step)


def lifting_line(
    chord: Callable[[Array], Array], span: float, area: float, slope: float | Array
) -> LiftingLine:
    """The line of a wing. chord: m at |2 y/b| (k,). slope: c_l_alpha, 1/rad, one or per station.

    Raises BadInput where span, area or slope are not positive.
    """
    positive("lifting line", span=span, area=area, slope=float(np.min(slope)))
    theta = np.arange(1, TERMS + 1) * np.pi / (TERMS + 1)
    eta = -np.cos(theta)
    mu = np.asarray(slope) * chord(np.abs(eta)) / (4.0 * span)
    n = np.arange(1, TERMS + 1)
    matrix = np.sin(np.outer(theta, n)) * (np.sin(theta)[:, None] + np.outer(mu, n))
    return LiftingLine(eta, span**2 / area, theta, mu, np.linalg.inv(matrix))


@dataclass(frozen=True)
class Correction:
    """How a wing's lift falls behind the elliptic one's (Glauert's delta and tau).

    delta: of induced drag, C_Di = C_L2 (1 + delta)/(pi A). tau: of the slope,
    C_L_alpha = c_l_alpha/(1 + c_l_alpha (1 + tau)/(pi A)).
    """

    slope: float
    delta: float
    tau: float


def correction(line: LiftingLine, slope: float) -> Correction:
    """Lift slope (1/rad), delta and tau of an untwisted wing with sections of `slope`."""
    load = line.load(np.ones_like(line.eta))
    lift = line.lift(load)
    delta = float(np.pi * line.aspect * line.drag(load) / lift**2 - 1.0)
    tau = float((slope / lift - 1.0) * np.pi * line.aspect / slope - 1.0)
    return Correction(lift, delta, tau)
