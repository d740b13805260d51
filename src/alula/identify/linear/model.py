"""Linear state equations with named parameters: dx/dt = A x + B u + b, y = C x + D u + d.

Dittrich 2016, Eq. (2.70) to (2.78). Every entry is a number plus factors times parameters, so the
matrices are affine in the parameters and their derivatives are constants. Sampled, the model is
exact for inputs that run straight between samples (first-order hold): with M = [[A, G], [0, 0]] and
so on, all from one matrix exponential (Van Loan 1978); derivatives of that by the same exponential
of a block matrix (Najfeld and Havel 1995, Eq. (10)).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.linalg import expm

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.identify.linear.formula import parse_row

Hold = Literal["linear", "zero"]


@dataclass(frozen=True)
class Matrices:
    """A (n, n), B (n, m + 1), C (k, n), D (k, m + 1): the last column of B and D is b and d.

    With a leading axis they are those of several parameter vectors, or derivatives.
    """

    A: Array
    B: Array
    C: Array
    D: Array


@dataclass(frozen=True)
class Sampled:
    """x[i+1] = phi x[i] + now w[i] + next w[i+1], w the inputs with a one behind them.

    phi (..., n, n), now and next (..., n, m + 1).
    """

    phi: Array
    now: Array
    next: Array


@dataclass(frozen=True)
class LinearModel:
    """States (n), inputs (m), outputs (k), parameters (j) by name; SI, rad.

    fixed: entries without parameter. slopes: (j, ...) derivative of each matrix by each parameter.
    rows: the text of each derivative ('pdot') and output. belongs: the row in which each parameter
    stands first.
    """

    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    parameters: tuple[str, ...]
    fixed: Matrices
    slopes: Matrices
    rows: Mapping[str, str]
    belongs: Mapping[str, str]

    def at(self, values: Array) -> Matrices:
        """The matrices for parameters (..., j)."""

        def sum_of(fixed: Array, slopes: Array) -> Array:
            out: Array = fixed + np.tensordot(values, slopes, axes=([-1], [0]))
            return out

        return Matrices(
            sum_of(self.fixed.A, self.slopes.A),
            sum_of(self.fixed.B, self.slopes.B),
            sum_of(self.fixed.C, self.slopes.C),
            sum_of(self.fixed.D, self.slopes.D),
        )


def linear_model(
    derivatives: Mapping[str, str],
    outputs: Mapping[str, str] | Sequence[str],
    inputs: Sequence[str],
) -> LinearModel:
    """A model from text.

    derivatives: by state, {"p": "Lp*p + Lda*da + L0", ...}, the right-hand side of dp/dt. outputs:
    by name, {"ay": "Yp*p + Y0"}; a state's own name or, with 'dot' behind it, its derivative needs
    no text and may stand in a plain list. inputs: names of what is measured and drives the model.
    Raises BadInput on a row that is not linear, a name used twice, or an output without text.
    """
    states, drives = tuple(derivatives), tuple(inputs)
    rates = {f"{s}dot": s for s in states}
    text = dict(outputs) if isinstance(outputs, Mapping) else dict.fromkeys(outputs, "")
    double = [n for n in drives if n in states or n in rates]
    if double or len(set(drives)) < len(drives) or not states or not text:
        raise refuse(
            "bad_model",
            where="linear model",
            expected="at least one state and output, and inputs that are no states",
            found=", ".join(double) or f"states {states}, outputs {tuple(text)}, inputs {drives}",
            do="Give every state one row and every input a name of its own.",
        )
    wording = {f"{s}dot": row for s, row in derivatives.items()}
    for name, row in text.items():
        wording[name] = row or (wording[name] if name in rates else name)
        if not row and name not in states and name not in rates:
            raise refuse(
                "missing_row",
                where=f"output {name}",
                expected=f"a formula, or one of {', '.join((*states, *rates))}",
                found="no formula",
                do=f'Write outputs = {{"{name}": "..."}}.',
            )
    variables = (*states, *drives)
    terms = {name: parse_row(name, row, variables) for name, row in wording.items()}
    names = tuple(
        dict.fromkeys(
            t.parameter for parsed in terms.values() for t in parsed if t.parameter is not None
        )
    )
    width = len(variables) + 1
    top = [f"{s}dot" for s in states]
    place = {v: i for i, v in enumerate(variables)}
    fixed = {name: np.zeros(width) for name in wording}
    slopes = {name: np.zeros((len(names), width)) for name in wording}
    for name, parsed in terms.items():
        for t in parsed:
            column = width - 1 if t.variable is None else place[t.variable]
            if t.parameter is None:
                fixed[name][column] += t.factor
            else:
                slopes[name][names.index(t.parameter), column] += t.factor
    n = len(states)
    upper, lower = np.array([fixed[r] for r in top]), np.array([fixed[r] for r in text])
    d_upper = np.stack([slopes[r] for r in top], axis=1)
    d_lower = np.stack([slopes[r] for r in text], axis=1)
    return LinearModel(
        states=states,
        inputs=drives,
        outputs=tuple(text),
        parameters=names,
        fixed=_split(upper, lower, n),
        slopes=_split(d_upper, d_lower, n),
        rows=wording,
        belongs={
            p: next(r for r, parsed in terms.items() if any(t.parameter == p for t in parsed))
            for p in names
        },
    )


def sample(matrices: Matrices, dt: float, hold: Hold = "linear") -> Sampled:
    """The model from one sample to the next, `dt` s later, exact; leading axes as in `matrices`."""
    return _from_exponential(_exponential(matrices, dt), matrices, hold)


def sample_derivatives(
    matrices: Matrices, slopes: Matrices, dt: float, hold: Hold = "linear"
) -> Sampled:
    """Derivatives (j, ...) of `sample` by parameters that change the matrices by `slopes`."""
    block = _block(matrices, dt)
    turn = _block(slopes, dt, derivative=True)
    j, size = len(turn), len(block)
    whole = np.zeros((j, 2 * size, 2 * size))
    whole[:, :size, :size] = whole[:, size:, size:] = block
    whole[:, :size, size:] = turn
    return _from_exponential(expm(whole)[:, :size, size:], matrices, hold)


def process_covariance(A: Array, intensity: Array, dt: float) -> Array:
    """(..., n, n) covariance that white noise of `intensity` (..., n, n) adds to x in `dt` s.

    intensity: F F', per second. The integral of exp(A s) F F' exp(A' s) over a step (Van Loan 1978,
    IEEE Trans. Automatic Control 23, p. 395).
    """
    n = A.shape[-1]
    block = np.zeros((*A.shape[:-2], 2 * n, 2 * n))
    block[..., :n, :n] = -A
    block[..., :n, n:] = intensity
    block[..., n:, n:] = np.swapaxes(A, -1, -2)
    e = expm(block * dt)
    out: Array = np.swapaxes(e[..., n:, n:], -1, -2) @ e[..., :n, n:]
    return 0.5 * (out + np.swapaxes(out, -1, -2))


def _split(upper: Array, lower: Array, n: int) -> Matrices:
    return Matrices(
        frozen(upper[..., :n]),
        frozen(upper[..., n:]),
        frozen(lower[..., :n]),
        frozen(lower[..., n:]),
    )


def _block(matrices: Matrices, dt: float, derivative: bool = False) -> Array:
    """[[A, B, 0], [0, 0, 1], [0, 0, 0]] dt, whose exponential has all that a linear hold needs."""
    n, m = matrices.B.shape[-2:]
    out = np.zeros((*matrices.A.shape[:-2], n + 2 * m, n + 2 * m))
    out[..., :n, :n] = matrices.A * dt
    out[..., :n, n : n + m] = matrices.B * dt
    if not derivative:
        out[..., n : n + m, n + m :] = np.eye(m)
    return out


def _exponential(matrices: Matrices, dt: float) -> Array:
    out: Array = expm(_block(matrices, dt))
    return out


def _from_exponential(e: Array, matrices: Matrices, hold: Hold) -> Sampled:
    n, m = matrices.B.shape[-2:]
    whole, ramp = e[..., :n, n : n + m], e[..., :n, n + m :]
    if hold == "zero":
        return Sampled(e[..., :n, :n], whole, np.zeros_like(whole))
    return Sampled(e[..., :n, :n], whole - ramp, ramp)
