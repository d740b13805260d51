"""A function of a DAVE-ML file: a gridded table with its way between and beyond breakpoints."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from alula.base.arrays import Array

INTERPOLATIONS = ("linear", "discrete", "floor", "ceiling")


@dataclass(frozen=True)
class Axis:
    """An independent variable, by varID, in its own units.

    low, high: limits of the argument. extrapolate: 'neither', 'min', 'max' or 'both'; else the
    edge's value holds. interpolate: 'linear'; 'discrete', the nearest breakpoint, a middle going
    up; 'floor', the breakpoint reached last; 'ceiling', the next one.
    """

    id: str
    breakpoints: Array
    low: float | None = None
    high: float | None = None
    extrapolate: str = "neither"
    interpolate: str = "linear"

    def nodes(self, x: Array) -> list[tuple[Any, Array]]:
        """Indices and weights (n,) of the two breakpoints that make the value at x (n,)."""
        b = self.breakpoints
        x = np.clip(x, -np.inf if self.low is None else self.low, self.high)
        low = -np.inf if self.extrapolate in ("min", "both") else b[0]
        high = np.inf if self.extrapolate in ("max", "both") else b[-1]
        x = np.clip(x, low, high)
        if len(b) == 1:
            return [(np.zeros(x.shape, dtype=np.intp), np.ones(x.shape))]
        cell = np.clip(np.searchsorted(b, x, side="right") - 1, 0, len(b) - 2)
        part = (x - b[cell]) / (b[cell + 1] - b[cell])
        if self.interpolate == "discrete":
            part = np.where(part >= 0.5, 1.0, 0.0)
        elif self.interpolate == "floor":
            part = np.where(part >= 1.0, 1.0, 0.0)
        elif self.interpolate == "ceiling":
            part = np.where(part > 0.0, 1.0, 0.0)
        return [(cell, 1.0 - part), (cell + 1, part)]


@dataclass(frozen=True)
class GriddedFunction:
    """Values over a grid; the last axis is the values' last. output: varID it gives."""

    name: str
    output: str
    axes: tuple[Axis, ...]
    values: Array
    description: str = ""

    def evaluate(self, *at: Array) -> Array:
        """The values (n,) at arguments (n,), one for each axis."""
        shape = np.broadcast_shapes(*(np.shape(x) for x in at))
        nodes = [a.nodes(np.broadcast_to(x, shape)) for a, x in zip(self.axes, at, strict=True)]
        out = np.zeros(shape)
        for corner in product(*nodes):
            weight = np.ones(shape)
            for _, w in corner:
                weight = weight * w
            out = out + weight * self.values[tuple(i for i, _ in corner)]
        return out
