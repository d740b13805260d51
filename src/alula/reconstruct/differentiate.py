"""Smoothed local differentiation of a reconstructed signal, with its window and error stated."""

from __future__ import annotations

from dataclasses import dataclass

from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic


@dataclass(frozen=True)
class Derivative:
    """rates (n,): the derivative. se: standard deviation of the rates by the scatter about the
    local cubics. window_s: length of the window.
    """

    rates: Array
    se: float
    window_s: float


def differentiate(t: Array, x: Array, window_s: float = 0.0) -> Derivative:
    """Derivative of x (n,) at the stamps t (n,) s by local cubics; NaN is not allowed.

    window_s = 0 takes nine samples, but at least 0.12 s.
    """
    cubic = LocalCubic(t, window_s)
    return Derivative(cubic.derivative(x), cubic.derivative_se(x), cubic.window_s)
