"""Output error with a model written as Python functions, where formulas do not reach.

x' = f(t, x, u, p), y = g(t, x, u, p); RK4 with one step a sample, inputs straight lines between
samples. Slopes are central differences, so a search takes some hundred times as long as with
formulas. Functions that take arrays of shape (s, c) for x and (c,) for each parameter are called
for all differences at once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, note, refuse
from alula.identify.flown.output_likelihood import likelihood_of
from alula.identify.flown.problem import Sums
from alula.identify.likelihood.optimizer import Algorithm, minimize
from alula.identify.likelihood.parameters import Fitted, assembled
from alula.identify.result import Identification

# (t, x (s,), u (m,), parameters by name) -> rates (s,) or outputs (k,)
Function = Callable[[float, Array, Array, Mapping[str, Any]], Any]
STEP = 1e-5  # of a parameter's size; central differences err by its square


@dataclass(frozen=True)
class FunctionManeuver:
    """One maneuver: t (n,) s, inputs (n, m), outputs (n, k) with NaN where none, x0 (s,)."""

    id: str
    t: Array
    inputs: Array
    outputs: Array
    x0: Array


class FunctionProblem:
    """Parameters by name with their start, and the initial states where they are estimated."""

    def __init__(
        self,
        f: Function,
        g: Function,
        maneuvers: Sequence[FunctionManeuver],
        parameters: Mapping[str, float],
        states: Sequence[str],
        initial: bool,
    ) -> None:
        self.f, self.g, self.maneuvers = f, g, tuple(maneuvers)
        self.parameters = list(parameters)
        self.names = list(parameters)
        start = [float(v) for v in parameters.values()]
        if initial:
            for m in maneuvers:
                self.names += [f"{name}(0)[{m.id}]" for name in states]
                start += [float(v) for v in m.x0]
        self.start, self.initial = np.array(start), initial
        self.readings = [m.outputs for m in maneuvers]
        self.size = np.maximum(np.abs(self.start), 1e-3 * max(float(np.abs(start).max()), 1e-6))
        self._many = self._takes_columns()

    def evaluate(self, theta: Array) -> Sums:
        """The sums over all maneuvers at the parameters (k,)."""
        k, m = len(self.names), self.readings[0].shape[1]
        sums = Sums(np.zeros((m, k, k)), np.zeros((m, k)), np.zeros(m), np.zeros(m), True)
        for i, z in enumerate(self.readings):
            y, J = self.flight(theta, i)
            if not np.isfinite(y).all() or not np.isfinite(J).all():
                return Sums(sums.information, sums.gradient, sums.squares, sums.counts, False)
            good = np.isfinite(z)
            e = np.where(good, z - y, 0.0)
            J = J * good[:, :, None]
            sums.information[:] += np.einsum("noi,noj->oij", J, J, optimize=True)
            sums.gradient[:] += np.einsum("noi,no->oi", J, e)
            sums.squares[:] += np.sum(e**2, axis=0)
            sums.counts[:] += good.sum(axis=0)
        return sums

    def flight(self, theta: Array, i: int) -> tuple[Array, Array]:
        """Outputs (n, m) of maneuver i and slopes (n, m, k) by central differences."""
        step = STEP * np.maximum(np.abs(theta), self.size)
        k = len(theta)
        points = theta[:, None] + np.hstack([np.zeros((k, 1)), np.diag(step), -np.diag(step)])
        if self._many:
            y = self._fly(points, i)
        else:
            y = np.stack([self._fly(points[:, c], i) for c in range(2 * k + 1)], axis=-1)
        return y[..., 0], (y[..., 1 : k + 1] - y[..., k + 1 :]) / (2.0 * step)

    def _fly(self, points: Array, i: int) -> Array:
        """Outputs (n, m) or (n, m, c) for parameters (k,) or (k, c)."""
        m, f, g = self.maneuvers[i], self.f, self.g
        p = dict(zip(self.parameters, points, strict=False))
        count = len(self.parameters)
        x = np.multiply.outer(m.x0, np.ones(points.shape[1:]))
        if self.initial:
            own = count + i * len(m.x0)
            x = points[own : own + len(m.x0)].copy()
        out = np.empty((len(m.t), m.outputs.shape[1], *points.shape[1:]))
        with np.errstate(all="ignore"):
            for n, t in enumerate(m.t):
                u = m.inputs[n]
                out[n] = np.stack(g(t, x, u, p))
                if n + 1 == len(m.t):
                    break
                h = m.t[n + 1] - t
                mid, end = 0.5 * (u + m.inputs[n + 1]), m.inputs[n + 1]
                k1 = np.stack(f(t, x, u, p))
                k2 = np.stack(f(t + 0.5 * h, x + 0.5 * h * k1, mid, p))
                k3 = np.stack(f(t + 0.5 * h, x + 0.5 * h * k2, mid, p))
                k4 = np.stack(f(t + h, x + h * k3, end, p))
                x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        return out

    def _takes_columns(self) -> bool:
        """Whether the functions give for two columns at once what they give for each alone."""
        m = self.maneuvers[0]
        p = dict(zip(self.parameters, self.start, strict=False))
        two = {name: np.array([v, 1.01 * v + 1e-3]) for name, v in p.items()}
        last = {name: float(v[1]) for name, v in two.items()}
        x = np.column_stack([m.x0, 1.01 * m.x0 + 1e-3])
        shapes = ((self.f, len(m.x0)), (self.g, m.outputs.shape[1]))
        for call, size in shapes:
            one = [np.stack(call(m.t[0], x[:, j], m.inputs[0], q)) for j, q in ((0, p), (1, last))]
            if one[0].shape != (size,):
                raise _wrong(f"{size} values", f"shape {one[0].shape}")
            try:
                both = np.stack(call(m.t[0], x, m.inputs[0], two))
            except (ValueError, TypeError, IndexError):
                return False
            if both.shape != (size, 2) or not np.allclose(both, np.column_stack(one), rtol=1e-12):
                return False
        return True


def identify_output_error_function(
    f: Function,
    g: Function,
    maneuvers: Sequence[FunctionManeuver],
    parameters: Mapping[str, float],
    *,
    states: Sequence[str],
    outputs: Sequence[str],
    initial: bool = True,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Parameters of a model in Python. parameters: by name with their start values.

    states, outputs: names, in the functions' order. initial: whether initial states are estimated;
    else x0 is taken as known. Raises BadInput where sizes do not fit; a search that fails is a
    result whose status says why.
    """
    for m in maneuvers:
        n = len(m.t)
        shapes = (m.inputs.shape[0], m.outputs.shape, m.x0.shape)
        if shapes != (n, (n, len(outputs)), (len(states),)) or not np.isfinite(m.inputs).all():
            raise _wrong(
                f"finite inputs ({n}, m), outputs ({n}, {len(outputs)}), x0 ({len(states)},)",
                f"maneuver {m.id}: {m.inputs.shape}, {m.outputs.shape}, {m.x0.shape}",
            )
    if not maneuvers or not parameters:
        raise _wrong("at least one maneuver and one parameter", "none")
    problem = FunctionProblem(f, g, maneuvers, parameters, states, initial)
    likelihood = likelihood_of(problem, None, False)
    found = minimize(likelihood, problem.start, algorithm=algorithm)
    blocks = likelihood.blocks(found.value) if found.converged else []
    fitted = []
    if found.converged:
        for i, m in enumerate(maneuvers):
            y = problem.flight(found.value, i)[0]
            fitted += [
                Fitted(name, m.id, m.t, m.outputs[:, o], y[:, o], False)
                for o, name in enumerate(outputs)
            ]
    said = note(
        "finite_differences",
        where="output error",
        expected="formulas, whose slopes are exact",
        found="Python functions" + ("" if problem._many else " that take one point at a time"),
        do="Nothing; slopes are central differences, and the search is slower for it.",
    )
    return assembled(
        "output error (Python function)",
        problem.names,
        {},
        blocks,
        found,
        fitted,
        {},
        scales=scales,
        truth=truth,
        messages=(said,),
    )


def _wrong(expected: str, found: str) -> BadInput:
    return refuse(
        "output_error_function",
        where="output error, Python function",
        expected=expected,
        found=found,
        do="f(t, x, u, p) returns a rate for each state, g(t, x, u, p) a value for each output.",
    )
