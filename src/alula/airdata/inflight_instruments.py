"""What the pilot did, as instruments for the scale errors of the vanes.

An aircraft answers to gusts: it yields, so that the motion holds part of the gust with the other
sign, and a regression on the motion takes gusts for vane errors (an upwash of 0.1 read as -0.1 in
1 m/s of turbulence). Only the part of the motion that the pilot made tells a scale error. Two-stage
least squares (Angrist and Pischke, Mostly Harmless Econometrics, 2009, ch. 4) takes that part: the
motion is first fitted by what gusts of the respective angle do not drive,

    alpha: 1/(V^2 cos phi), the angle that turns and speed changes ask for, and the elevator,
    beta:  sin phi, rudder and ailerons,

each with its past of MEMORY seconds, and the fitted motion takes the place of the motion.
"""

from __future__ import annotations

import numpy as np

from alula.airdata.inflight_record import AirDataRecord
from alula.base.arrays import Array

MEMORY, STEP = 2.0, 0.2  # s
WEAKEST = 10.0  # F of the first stage below which nothing is told (Staiger and Stock 1997)
CONTROLS = {"alpha": ("de",), "beta": ("dr", "da")}


def instruments(record: AirDataRecord, kind: str, speed: Array) -> Array:
    """(n, k) for 'alpha' or 'beta', with their past; speed: (n,) m/s, by GPS less wind."""
    phi = record.readings["phi"]
    if kind == "alpha":
        usual = float(np.nanmedian(speed))
        columns = [usual**2 / (np.maximum(speed, 0.3 * usual) ** 2 * np.maximum(np.cos(phi), 0.2))]
    else:
        columns = [np.sin(phi)]
    columns += [record.readings[c] for c in CONTROLS[kind] if c in record.readings]
    each = max(1, round(STEP / float(np.median(np.diff(record.t)))))
    lags = range(0, round(MEMORY / STEP) + 1)
    out = []
    for column in columns:
        for lag in lags:
            moved = np.full_like(column, np.nan)
            moved[lag * each :] = column[: len(column) - lag * each]
            out.append(moved)
    return np.column_stack(out)


def first_stage(x: Array, others: Array, by: Array) -> tuple[Array, float]:
    """x (n,) as far as `others` (n, j) and instruments (n, k) tell it, and F of the instruments.

    All whitened; rows with NaN have been set to zero.
    """
    both = np.column_stack([others, by])
    scale = np.sqrt(np.mean(both**2, axis=0))
    both = both / np.where(scale > 0.0, scale, 1.0)
    fitted = both @ np.linalg.lstsq(both, x, rcond=1e-8)[0]
    alone = others @ np.linalg.lstsq(others, x, rcond=1e-8)[0]
    left, gained = float(np.sum((x - fitted) ** 2)), float(np.sum((fitted - alone) ** 2))
    dof = max(1, int(np.sum(x != 0.0)) - both.shape[1])
    return fitted, gained / by.shape[1] / max(left / dof, 1e-300)
