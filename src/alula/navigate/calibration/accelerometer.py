"""Accelerometer from static positions: f = C (f_acc - f_0), twelve parameters.

Pusztai 2018, Eq. (3.15); NXP AN4399. At rest the specific force has the length of gravity,
whatever the position, and its direction as well as the position was set by hand. So the lengths
give the offset and the matrix but for a rotation, nine parameters, and the directions the rotation:
an error of a position then turns the axes by its mean and does not bend them. With few positions
lengths alone do not suffice, and all twelve come from lengths and directions alike.
"""

from __future__ import annotations

from itertools import product
from typing import Literal

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, note, refuse, warn
from alula.navigate.calibration.ellipsoid import PLANAR, ellipsoid, flatness
from alula.navigate.calibration.linear_sensor import linear_sensor
from alula.navigate.calibration.procrustes import align
from alula.navigate.calibration.result import SensorCalibration, length_errors
from alula.navigate.calibration.samples import usable
from alula.navigate.calibration.undetermined import undetermined
from alula.navigate.calibration.vector_fit import VectorFit, fit_vectors

Nearest = Literal["faces", "faces_and_edges"]
FAR = np.radians(20.0)  # from the nearest nominal direction: halfway between face and edge is 22.5
LEAST_LENGTHS = 10  # nine parameters and one to judge by
ENOUGH_LENGTHS = 12  # from which on lengths alone give the nine
LEAST_POSITIONS = 6  # with directions: twelve parameters, eighteen equations


def calibrate_accelerometer(
    positions: Array,
    gravity: float,
    directions: Array | Nearest | None = None,
    *,
    limit: float | None = None,
    where: str = "accelerometer",
) -> SensorCalibration:
    """Matrix and offset from mean readings at rest.

    positions: (n, 3) m/s2 (or any unit: the matrix converts). gravity: local, m/s2. directions: of
    the specific force in body axes (level: [0, 0, -1]), (n, 3), or the nearest of a cube's faces
    (and edges); None: lengths only, the matrix is then symmetric. limit: end of the range.

    Raises BadInput for too few positions, readings that are no numbers, a direction that is not
    clear, an ellipsoid that is none. Positions that do not determine a parameter give the verdict
    'not_identifiable'.
    """
    good, said = usable(positions, where, limit)
    f = positions[good]
    given = None
    if isinstance(directions, str):
        given = nearest_directions(f, directions, where)
    elif directions is not None:
        given = _unit(np.asarray(directions, dtype=np.float64), len(positions), where)[good]
    least = LEAST_LENGTHS if given is None else LEAST_POSITIONS
    if len(f) < least:
        raise refuse(
            "too_few_positions",
            where=where,
            expected=f"{least} positions or more"
            + (", or their directions and then six" if given is None else ""),
            found=str(len(f)),
            do="Add positions: six faces and twelve edges of a cube are a good set.",
        )
    flat, normal = flatness(f if given is None else given)
    if flat < PLANAR:
        said.append(planar_message(normal, "positions", where))
    size = float(np.mean(np.linalg.norm(f, axis=1)))
    apart = given is None or (len(f) >= ENOUGH_LENGTHS and flat >= PLANAR)
    sensor = linear_sensor(not apart, "none", gravity / size, size)
    length = np.full(len(f), gravity)
    across = float("nan")
    if given is None or apart:
        first = None if flat < PLANAR else ellipsoid(f, gravity)
        if first is None:
            return undetermined("accelerometer", sensor, f, length, said, where, flat < PLANAR)
        start = np.concatenate([first[0][np.triu_indices(3)], first[0] @ first[1]])
        fit = fit_vectors(sensor.problem(f, length, None), start)
    else:
        known = np.column_stack([f, -np.ones(len(f))])
        found = np.linalg.lstsq(known, gravity * given, rcond=None)[0]
        start = np.concatenate([found[:3].T.ravel(), found[3]])
        fit = fit_vectors(sensor.problem(f, length, given), start)
        across = fit.across
    if apart and given is not None:
        C, offset, parameters, covariance, rotation = align(
            sensor, fit, f, gravity * given, ("1", "m/s2", "1"), where
        )
        across = rotation.sigma
    else:
        C, offset, _ = sensor.unpack(fit.values)
        parameters, covariance = sensor.parameters(fit, ("1", "m/s2", "1"))
    calibrated = (f - offset) @ C.T
    said += fit_messages(fit, where)
    if given is None:
        said.append(
            note(
                "no_alignment",
                where=where,
                expected="directions of the positions",
                found="lengths only",
                do="The matrix is taken symmetric; a rotation of the sensor in its housing stays.",
            )
        )
    return SensorCalibration(
        "accelerometer", frozen(C), frozen(offset), parameters, frozen(covariance),
        length_errors(f, length), length_errors(calibrated, length), frozen(f), frozen(calibrated),
        frozen(length), fit.along, across, messages=tuple(said),
    )  # fmt: skip


def nearest_directions(f: Array, of: Nearest, where: str) -> Array:
    """(n, 3) the nominal direction next to each reading; BadInput where it is not clear which."""
    cube = np.array([d for d in product((-1.0, 0.0, 1.0), repeat=3) if 1 <= np.abs(d).sum() <= 2])
    if of == "faces":
        cube = cube[np.abs(cube).sum(axis=1) == 1.0]
    cube /= np.linalg.norm(cube, axis=1)[:, None]
    cosine = (f @ cube.T) / np.linalg.norm(f, axis=1)[:, None]
    best = cosine.argmax(axis=1)
    angle = np.arccos(np.clip(cosine.max(axis=1), -1.0, 1.0))
    if np.any(angle > FAR):
        k = int(angle.argmax())
        raise refuse(
            "direction_not_clear",
            where=f"{where}: position {k + 1}",
            expected=f"within {np.degrees(FAR):.0f} deg of a cube's {of.replace('_', ' ')}",
            found=f"{np.degrees(angle[k]):.1f} deg",
            do="Give 'directions', one for each position, or directions = 'none'.",
        )
    return np.asarray(cube[best])


def _unit(directions: Array, count: int, where: str) -> Array:
    size = np.linalg.norm(directions, axis=-1) if directions.ndim == 2 else np.zeros(1)
    if directions.shape != (count, 3) or not np.all(np.isfinite(size)) or np.any(size == 0.0):
        raise refuse(
            "bad_directions",
            where=where,
            expected=f"a direction of three numbers, not all zero, for each of {count} positions",
            found=f"{' x '.join(map(str, directions.shape))}",
            do="List them in the order of the positions.",
        )
    return np.asarray(directions / size[:, None])


def planar_message(normal: Array, what: str, where: str) -> Message:
    """The warning that all vectors lie in one plane."""
    axis = ", ".join(f"{v:+.2f}" for v in normal * np.sign(normal[np.argmax(np.abs(normal))]))
    return warn(
        f"coplanar_{what}",
        where=where,
        expected=f"{what} in all directions of space",
        found=f"all close to one plane, normal to [{axis}]",
        do="Turn the sensor out of that plane as well; scale and offset along the normal "
        "cannot be told apart.",
    )


def fit_messages(fit: VectorFit, where: str) -> list[Message]:
    """What a fit has to say for itself."""
    said = []
    if not fit.converged:
        said.append(
            warn(
                "not_converged",
                where=where,
                expected="a fit that settles",
                found="the search ended at its bound of evaluations",
                do="Check the readings for outliers; do not use these values.",
            )
        )
    if fit.common:
        said.append(
            note(
                "one_variance",
                where=where,
                expected="12 or more vectors, to tell the error of length and direction apart",
                found=str(len(fit.residual)),
                do="Length and direction count alike: ordinary least squares.",
            )
        )
    return said
