"""A table over one to three variables, as a factor of a model's terms: `cxt(alpha, de)`."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, refuse
from alula.model.variables import LIFT, SHORT, VARIABLES

Interpolation = Literal["linear", "cubic"]
Outside = Literal["hold", "line"]

MAX_AXES = 3
MAX_BREAKPOINTS = 1000  # of one axis
MAX_VALUES = 100_000  # of one table; the F-16's largest has 84
_RESERVED = {"abs", "sign", LIFT, *VARIABLES, *SHORT.values()}


@dataclass(frozen=True, eq=False)
class LookupTable:
    """Values over a grid of one to three variables.

    variables: their names, in the order of the axes. breakpoints: one increasing array for each,
    in the variable's unit (V m/s, angles rad). values: (n1, ...), one axis for each. Between the
    breakpoints: 'linear', or 'cubic', a cubic in each cell whose slopes at the breakpoints are
    those of the parabolas through three neighbors. Outside: the edge's value ('hold') or the
    straight line through the edge with the slope there ('line').
    """

    variables: tuple[str, ...]
    breakpoints: tuple[Array, ...]
    values: Array
    interpolation: Interpolation = "linear"
    outside: Outside = "hold"

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, LookupTable)
            and self.variables == other.variables
            and self.interpolation == other.interpolation
            and self.outside == other.outside
            and np.array_equal(self.values, other.values)
            and all(map(np.array_equal, self.breakpoints, other.breakpoints))
        )

    def __hash__(self) -> int:
        return hash((self.variables, self.values.shape, self.values.tobytes()))

    def evaluate(self, *at: Array) -> Array:
        """The values (n,) at points (n,), one array for each axis, in the breakpoints' units."""
        shape = np.broadcast_shapes(*(np.shape(x) for x in at))
        weigh = _linear if self.interpolation == "linear" else _cubic
        line = self.outside == "line"
        axes = [
            weigh(b, np.broadcast_to(np.asarray(x, dtype=np.float64), shape), line)
            for b, x in zip(self.breakpoints, at, strict=True)
        ]
        return self._sum(axes, (), np.ones(shape))

    def _sum(
        self, axes: list[list[tuple[Any, Array]]], index: tuple[Any, ...], weight: Array
    ) -> Array:
        if len(index) == len(axes):
            out: Array = weight * self.values[index]
            return out
        out = np.zeros(weight.shape)
        for node, part in axes[len(index)]:
            out = out + self._sum(axes, (*index, node), weight * part)
        return out


def lookup_table(
    axes: Mapping[str, Sequence[float] | Array],
    values: Any,
    interpolation: Interpolation = "linear",
    outside: Outside = "hold",
    *,
    where: str = "table",
) -> LookupTable:
    """A LookupTable of breakpoints by variable and nested values, the last axis innermost.

    Raises BadInput at `where`: an unknown variable, breakpoints that do not increase, values that
    are not finite or not of the axes' shape, more than three axes, 1000 breakpoints or 100000
    values.
    """

    def wrong(expected: str, found: str, do: str) -> BadInput:
        return refuse("lookup_table", where=where, expected=expected, found=found, do=do)

    if not 1 <= len(axes) <= MAX_AXES:
        raise wrong(
            f"one to {MAX_AXES} axes", f"{len(axes)}", "Give axes = { alpha = [...], ... }."
        )
    breakpoints = []
    for name, given in axes.items():
        if name not in VARIABLES:
            raise wrong(
                f"axes over {', '.join(VARIABLES)}", f"'{name}'", "Use one of these variables."
            )
        b = frozen(given)
        if b.ndim != 1 or not 2 <= len(b) <= MAX_BREAKPOINTS or not np.isfinite(b).all():
            raise wrong(
                f"2 to {MAX_BREAKPOINTS} finite breakpoints of '{name}'",
                f"{b.size}" if np.isfinite(b).all() else "some that are not finite",
                "Correct the axis.",
            )
        if not (np.diff(b) > 0.0).all():
            at = int(np.argmin(np.diff(b) > 0.0))
            raise wrong(
                f"increasing breakpoints of '{name}'",
                f"{float(b[at])!r} before {float(b[at + 1])!r}",
                "Sort the axis and the values with it.",
            )
        breakpoints.append(b)
    shape = tuple(len(b) for b in breakpoints)
    try:
        table = frozen(values)
    except (ValueError, TypeError):
        raise wrong(
            f"values of shape {shape}", "rows of different length", "Give one value per point."
        ) from None
    if table.shape != shape or table.size > MAX_VALUES:
        raise wrong(
            f"values of shape {shape}, at most {MAX_VALUES}",
            f"shape {table.shape}",
            "Give one value per point; the last axis varies fastest.",
        )
    if not np.isfinite(table).all():
        at_point = tuple(int(i) for i in np.argwhere(~np.isfinite(table))[0])
        raise wrong(
            "finite values",
            f"{float(table[at_point])!r} at {list(at_point)} (counted from 0)",
            "Fill the hole or cut the axis there: a table cannot guess.",
        )
    return LookupTable(tuple(axes), tuple(breakpoints), table, interpolation, outside)


def check_table_name(name: str, where: str) -> None:
    """Raise BadInput unless a formula can call a table by this name."""
    if re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,39}", name) is None or name in _RESERVED:
        raise refuse(
            "lookup_table",
            where=f"{where}, tables",
            expected="names of letters, digits and underscores that are no variable's",
            found=f"'{name}'",
            do="Rename the table.",
        )


def _cells(b: Array, x: Array, line: bool) -> tuple[Any, Array]:
    """Index of the cell (n,), and x with the outside brought to the edge where it is held."""
    cell = np.clip(np.searchsorted(b, x, side="right") - 1, 0, len(b) - 2)
    return cell, x if line else np.clip(x, b[0], b[-1])


def _linear(b: Array, x: Array, line: bool) -> list[tuple[Any, Array]]:
    """Nodes and weights of the straight line in each point's cell."""
    cell, x = _cells(b, x, line)
    part = (x - b[cell]) / (b[cell + 1] - b[cell])
    return [(cell, 1.0 - part), (cell + 1, part)]


def _slopes(b: Array) -> Array:
    """(n, n): the slope at each breakpoint as weights of the values: parabolas, Hermite 1878."""
    n = len(b)
    out = np.zeros((n, n))
    h = np.diff(b)
    if n == 2:
        out[:] = [-1.0 / h[0], 1.0 / h[0]]
        return out
    for i in range(n):
        j = min(max(i, 1), n - 2)  # middle of the three
        u, v = h[j - 1], h[j]
        e = b[i] - b[j]
        # derivative at b[i] of the parabola through j-1, j, j+1 (Newton's form)
        out[i, j - 1] = (2.0 * e - v) / (u * (u + v))
        out[i, j] = (v - u - 2.0 * e) / (u * v)
        out[i, j + 1] = (2.0 * e + u) / (v * (u + v))
    return out


def _cubic(b: Array, x: Array, line: bool) -> list[tuple[Any, Array]]:
    """Every node and its weight; outside, the line with the edge's slope."""
    cell, inside = _cells(b, x, False)
    h = b[cell + 1] - b[cell]
    s = (inside - b[cell]) / h
    beyond = x - inside if line else np.zeros_like(x)
    low, high = beyond * (beyond < 0.0), beyond * (beyond > 0.0)
    slopes = _slopes(b)
    at_left = h * s * (1.0 - s) ** 2 + low
    at_right = -h * s * s * (1.0 - s) + high
    weights = slopes[cell] * at_left[..., None] + slopes[cell + 1] * at_right[..., None]
    nodes = np.arange(len(b))
    weights += (nodes == cell[..., None]) * ((1.0 + 2.0 * s) * (1.0 - s) ** 2)[..., None]
    weights += (nodes == cell[..., None] + 1) * (s * s * (3.0 - 2.0 * s))[..., None]
    # A cell's four nearest nodes carry all the weight: its ends and one neighbor on either side.
    first = np.clip(cell - 1, 0, max(len(b) - 4, 0))
    near = [first + k for k in range(min(4, len(b)))]
    return [(i, np.take_along_axis(weights, i[..., None], axis=-1)[..., 0]) for i in near]
