"""Where a reconstruction starts: motion and wind by the first readings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import Array
from alula.base.project import ReconstructSpec
from alula.reconstruct.record import Record
from alula.reconstruct.sensors import Sensor
from alula.reconstruct.unknowns import WIND, Unknown


def first_motion(
    record: Record, sensors: Sequence[Sensor], motion: int, free: Sequence[Unknown]
) -> Array:
    """Motion at the first sample from the first readings, and a generous deviation of each.

    (2 motion,): the states of `Problem`, then their deviations.
    """
    first = {}
    for i, sensor in enumerate(sensors):
        kind = sensor.kind.removesuffix("_linear")
        if kind not in first and np.isfinite(record.readings[:, i]).any():
            first[kind] = (first_reading(record.readings[:, i]), sensor.sigma)
    x, sd = np.zeros(motion), np.zeros(motion)
    for i, name in ((0, "h"), (4, "phi"), (5, "theta"), (6, "psi")):
        x[i], sigma = first.get(name, (0.0, 100.0 if name == "h" else 0.1))
        sd[i] = 5.0 * sigma
    if "psi" not in first:
        sd[6] = 1.0  # a radian is "unknown" to the filters
    ground = all(n in first for n in ("v_north", "v_east", "v_down"))
    windy = any(u.name == "wind_n" for u in free)
    if ground and (windy or "V" not in first):
        v_E = np.array([first[n][0] for n in ("v_north", "v_east", "v_down")])
        x[1:4] = _R_BE(*x[4:7]) @ v_E
        sd[1:4] = 5.0 * first["v_north"][1] + 5.0 * float(np.linalg.norm(v_E)) * sd[6] / 5.0
    else:
        V, sigma = first.get("V", (30.0, 10.0))
        alpha = first.get("alpha", (x[5], 0.05))
        beta = first.get("beta", first.get("beta_flank", (0.0, 0.05)))
        x[1:4] = V * np.array(
            [np.cos(alpha[0]) * np.cos(beta[0]), np.sin(beta[0]), np.sin(alpha[0])]
        )
        sd[1:4] = 5.0 * sigma + V * np.array([0.02, 5.0 * beta[1], 5.0 * alpha[1]])
        sd[1:4] += 0.05 * V * np.array([0.0, 1.0, 1.0])  # upwash, boom, bias
        if windy:
            sd[1:4] += 15.0
    for i, name in ((7, "north"), (8, "east")):
        if i < motion:
            x[i], sigma = first.get(name, (0.0, 100.0))
            sd[i] = 5.0 * sigma
    return np.concatenate([x, sd])


def windy_start(
    record: Record, sensors: Sequence[Sensor], free: tuple[Unknown, ...], spec: ReconstructSpec
) -> tuple[Unknown, ...]:
    """Wind by the first readings, where they tell it and the project does not.

    Started from calm air the filters would take the drift for sideslip and angle of attack: their
    first linearization then learns of sidewash and upwash what no reading ever told.
    """
    kinds = [s.kind.removesuffix("_linear") for s in sensors]
    needed = ("v_north", "v_east", "v_down", "V", "phi", "theta", "psi")
    if not all(name in kinds for name in needed):
        return free
    first = {kind: first_reading(record.readings[:, kinds.index(kind)]) for kind in kinds}
    alpha, beta = first.get("alpha", first["theta"]), first.get("beta", 0.0)
    v_B = first["V"] * np.array(
        [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)]
    )
    v_E = np.array([first[name] for name in needed[:3]])
    wind = v_E - _R_BE(first["phi"], first["theta"], first["psi"]).T @ v_B
    guess = dict(zip(WIND, wind.tolist(), strict=True))
    return tuple(
        replace(u, value=guess[u.name]) if u.name in WIND and u.name not in spec.unknowns else u
        for u in free
    )


def first_reading(values: Array) -> float:
    """The first that is a number, else zero."""
    valid = values[np.isfinite(values)]
    return float(valid[0]) if len(valid) else 0.0


def _R_BE(phi: float, theta: float, psi: float) -> Array:
    """Earth to body. ISO 1151; Euler angles 3-2-1."""
    sp, cp, st, ct, sy, cy = (f(a) for a in (phi, theta, psi) for f in (np.sin, np.cos))
    return np.array(
        [
            [ct * cy, ct * sy, -st],
            [sp * st * cy - cp * sy, sp * st * sy + cp * cy, sp * ct],
            [cp * st * cy + sp * sy, cp * st * sy - sp * cy, cp * ct],
        ]
    )
