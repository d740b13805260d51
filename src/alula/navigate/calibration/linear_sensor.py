"""A sensor's model v = C a - b T - G e, linear in C, b and G, and its natural parameters.

a: reading, or its integral over the time T; e: what else acts, with coefficients G. Natural are
C, the offset C^-1 b and G. Without reference directions a rotation of v cannot be told: C is then
taken symmetric (Pusztai 2018, Eq. (3.19): a scale matrix that contains no rotation).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.navigate.calibration.result import AXES, Parameter, parameters_of
from alula.navigate.calibration.vector_fit import INVOLVED, VectorFit, VectorProblem

Coupling = Literal["none", "diagonal", "full"]


@dataclass(frozen=True)
class LinearSensor:
    """matrix, coupling: (P, 3, 3) what each parameter adds to C and to G; offset: (P, 3) to b."""

    matrix: Array
    offset: Array
    coupling: Array
    coupled: Coupling
    scale: float  # typical element of C
    bias: float  # typical offset, raw
    other: float  # typical element of G

    @property
    def typical(self) -> Array:
        """(P,) sizes that matter, of C, b and G."""
        in_matrix = np.any(self.matrix != 0.0, axis=(1, 2))
        in_offset = np.any(self.offset != 0.0, axis=1)
        return np.where(
            in_matrix, self.scale, np.where(in_offset, self.scale * self.bias, self.other)
        )

    def problem(
        self,
        a: Array,
        length: Array,
        direction: Array | None,
        *,
        time: Array | None = None,
        e: Array | None = None,
        ordered: bool = False,
    ) -> VectorProblem:
        """The fit of readings a (n, 3) to references of that length (n,) and direction (n, 3)."""
        t = np.ones(len(a)) if time is None else time
        jacobian = np.einsum("pij,nj->nip", self.matrix, a) - np.einsum("pi,n->nip", self.offset, t)
        if e is not None:
            jacobian -= np.einsum("pij,nj->nip", self.coupling, e)
        to_raw = np.transpose(self.matrix, (1, 2, 0))
        return VectorProblem(jacobian, length, direction, to_raw, self.typical, ordered)

    def unpack(self, p: Array) -> tuple[Array, Array, Array]:
        """C (3, 3), offset C^-1 b (3,), G (3, 3)."""
        C = np.einsum("p,pij->ij", p, self.matrix)
        b = p @ self.offset
        return C, np.linalg.solve(C, b), np.einsum("p,pij->ij", p, self.coupling)

    def natural(self, p: Array) -> tuple[Array, Array]:
        """(Q,) natural parameters and their derivatives (Q, P) by the fitted ones."""
        C, offset, G = self.unpack(p)
        d_offset = np.linalg.solve(C, (self.offset - self.matrix @ offset).T)  # (3, P)
        pick = {"none": [], "diagonal": [0, 4, 8], "full": list(range(9))}[self.coupled]
        count = len(p)
        derivative = np.concatenate(
            [
                self.matrix.reshape(count, 9).T,
                d_offset,
                self.coupling.reshape(count, 9).T[pick],
            ]
        )
        return np.concatenate([C.ravel(), offset, G.ravel()[pick]]), derivative

    def names(self) -> tuple[str, ...]:
        """Of the natural parameters: C_xx to C_zz by rows, offset_x.., G_x.. or G_xx.."""
        square = tuple(f"{i}{j}" for i in AXES for j in AXES)
        coupled = {"none": (), "diagonal": AXES, "full": square}[self.coupled]
        return (
            *(f"C_{k}" for k in square),
            *(f"offset_{k}" for k in AXES),
            *(f"G_{k}" for k in coupled),
        )

    def parameters(
        self, fit: VectorFit, units: tuple[str, str, str]
    ) -> tuple[tuple[Parameter, ...], Array]:
        """Natural parameters and their covariance. units: of C, of the offset, of G."""
        return self.assess(fit, *self.natural(fit.values), units)

    def assess(
        self,
        fit: VectorFit,
        values: Array,
        derivative: Array,
        units: tuple[str, str, str],
        added: Array | None = None,
    ) -> tuple[tuple[Parameter, ...], Array]:
        """Parameters `values` (Q,), `derivative` (Q, P) by the fitted ones, with verdicts.

        added: (Q, Q) covariance from elsewhere.
        """
        lost = ~np.isfinite(np.diag(fit.covariance))
        known = np.where(lost[:, None] | lost[None, :], 0.0, fit.covariance)
        covariance = derivative @ known @ derivative.T
        if added is not None:
            covariance = covariance + added
        names, typical = self.names(), self.natural_typical()
        touched = np.abs(derivative[:, lost]) * self.typical[lost] > INVOLVED * typical[:, None]
        gone = touched.any(axis=1)
        covariance[gone, :] = covariance[:, gone] = np.nan
        covariance[gone, gone] = np.inf
        along_weak = derivative @ (fit.weakest * self.typical) / typical
        size = float(np.linalg.norm(along_weak)) or 1.0
        ties = {n: float(w) / size for n, w in zip(names, along_weak, strict=True)}
        nominal = np.concatenate([self.scale * np.eye(3).ravel(), np.zeros(len(names) - 9)])
        unit = (units[0],) * 9 + (units[1],) * 3 + (units[2],) * (len(names) - 12)
        found = parameters_of(names, values, covariance, typical, nominal, unit, fit.dof, ties)
        return found, covariance

    def natural_typical(self) -> Array:
        """(Q,) sizes that matter, of the natural parameters."""
        further = len(self.names()) - 12
        return np.array([self.scale] * 9 + [self.bias] * 3 + [self.other] * further)


def linear_sensor(
    full: bool, coupled: Coupling, scale: float, bias: float, other: float = 1.0
) -> LinearSensor:
    """full: nine elements of C, else the six of a symmetric one."""
    unit = np.eye(9).reshape(9, 3, 3)
    symmetric = np.array(
        [0.5 * (unit[3 * i + j] + unit[3 * j + i]) * (1 if i == j else 2)
         for i in range(3) for j in range(i, 3)]
    )  # fmt: skip
    C = unit if full else symmetric
    G = {"none": unit[:0], "diagonal": unit[[0, 4, 8]], "full": unit}[coupled]
    count = len(C) + 3 + len(G)
    matrix, coupling = np.zeros((count, 3, 3)), np.zeros((count, 3, 3))
    offset = np.zeros((count, 3))
    matrix[: len(C)] = C
    offset[len(C) : len(C) + 3] = np.eye(3)
    coupling[len(C) + 3 :] = G
    return LinearSensor(matrix, offset, coupling, coupled, scale, bias, other)
