"""The rotation between two sets of vectors, and a symmetric calibration turned by it.

Orthogonal Procrustes: M that minimizes sum |a_i - M b_i|^2 is U diag(1, 1, det(U V')) V' with
U S V' = sum a_i b_i' (Schoenemann 1966; Kabsch 1976). Pusztai 2018, Eq. (3.20), is the same for
det > 0, written with a matrix square root.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.navigate.calibration.linear_sensor import LinearSensor
from alula.navigate.calibration.result import Parameter
from alula.navigate.calibration.vector_fit import VectorFit

SPAN = (
    0.02  # second singular value over the first, below which a rotation about the vectors is free
)
STEP = 1e-6  # of the typical size, for derivatives of the rotation
MIRROR = 4.0  # times smaller residual with mirrored axes: then they are mirrored


@dataclass(frozen=True)
class Rotation:
    """matrix: (3, 3), a = M b. covariance: (3, 3) rad^2, of small turns about the axes of a.

    sigma: standard deviation of one component of a - M b. residual: (n, 3). dof: of sigma.
    """

    matrix: Array
    covariance: Array
    sigma: float
    residual: Array
    dof: float


def rotation_between(a: Array, b: Array, where: str = "alignment") -> Rotation:
    """The rotation M with a = M b, (n, 3) each.

    Raises BadInput where all vectors are parallel (a turn about them is free), and where only a
    reflection explains them.
    """
    if len(a) < 2 or np.linalg.svd(a, compute_uv=False)[1] < SPAN * np.linalg.norm(a, 2):
        raise refuse(
            "parallel_references",
            where=where,
            expected="two reference vectors or more that are not parallel",
            found=f"{len(a)}, all parallel",
            do="Add readings in other positions; a turn about the common direction is free.",
        )
    matrix = _nearest(a, b, True)
    residual = a - b @ matrix.T
    free = _nearest(a, b, False)
    if np.linalg.det(free) < 0.0:
        mirrored = float(np.sum((a - b @ free.T) ** 2))
        spatial = np.linalg.svd(a, compute_uv=False)[2] > SPAN * np.linalg.norm(a, 2)
        if spatial and np.sum(residual**2) > MIRROR * mirrored:
            raise refuse(
                "mirrored_axes",
                where=where,
                expected="right-handed axes",
                found="readings that fit the references only as a mirror image",
                do="Check the signs and the order of the three columns.",
            )
    dof = float(3 * len(a) - 3)
    sigma = float(np.sqrt(np.sum(residual**2) / dof))
    turned = b @ matrix.T
    information = np.sum(turned**2) * np.eye(3) - turned.T @ turned
    covariance = np.asarray(sigma**2 * np.linalg.inv(information), dtype=np.float64)
    return Rotation(matrix, covariance, sigma, residual, dof)


def _nearest(a: Array, b: Array, proper: bool) -> Array:
    u, _, vt = np.linalg.svd(a.T @ b)
    last = np.linalg.det(u @ vt) if proper else 1.0
    out: Array = (u * np.array([1.0, 1.0, last])) @ vt
    return out


def align(
    sensor: LinearSensor,
    fit: VectorFit,
    raw: Array,
    reference: Array,
    units: tuple[str, str, str],
    where: str,
) -> tuple[Array, Array, tuple[Parameter, ...], Array, Rotation]:
    """A symmetric calibration turned so that it takes `raw` (n, 3) to `reference` (n, 3).

    Returns matrix, offset, parameters, their covariance (from the lengths' fit and from the
    references' scatter), and the rotation.
    """

    def turned(p: Array) -> tuple[Array, Rotation]:
        C, offset, _ = sensor.unpack(p)
        rotation = rotation_between(reference, (raw - offset) @ C.T, where)
        return np.concatenate([(rotation.matrix @ C).ravel(), offset]), rotation

    values, rotation = turned(fit.values)
    step = STEP * sensor.typical
    shifts = np.diag(step)
    columns = [
        (turned(fit.values + d)[0] - turned(fit.values - d)[0]) / (2.0 * h)
        for d, h in zip(shifts, step, strict=True)
    ]
    derivative = np.column_stack(columns)
    C = values[:9].reshape(3, 3)
    by_turn = np.zeros((12, 3))
    for k in range(3):
        by_turn[:9, k] = np.cross(np.eye(3)[k], C.T).T.ravel()
    added = by_turn @ rotation.covariance @ by_turn.T
    parameters, covariance = sensor.assess(fit, values, derivative, units, added)
    return C, values[9:], parameters, covariance, rotation
