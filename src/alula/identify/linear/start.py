"""First values for a search: regression of the model's rows on measured states.

The equation-error method on every row whose variables are all measured (Dittrich 2016, Eq. (3.36)
to (3.45)); biased by noise, but near enough. Derivatives that are not measured are taken by local
cubics.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.identify.linear.model import LinearModel
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.regression.least_squares import least_squares
from alula.identify.regression.regressor_noise import rough_part

SAMPLES = 7  # of the local cubics
STARTS = 5  # samples whose mean is a state's first value


def first_values(model: LinearModel, records: Sequence[LinearRecord], unknowns: Unknowns) -> Array:
    """(free,) first values; zero for what the measurements do not tell."""
    out = np.zeros(len(unknowns.free))
    rows, measured = [], []
    for i, record in enumerate(records):
        known = measured_states(model, record)
        for state, series in known.items():
            name = f"{state}(0)[{record.id}]"
            if name in unknowns.free_names:
                start = series[np.isfinite(series)][:STARTS]
                out[unknowns.free_names.index(name)] = float(start.mean()) if len(start) else 0.0
        for lhs, x, fixed in _rows(model, record, known):
            matrix = unknowns.spread(i, np.hstack([x, np.zeros((len(x), len(model.states)))]))
            given = x @ unknowns.held(i)
            good = np.isfinite(lhs) & np.isfinite(matrix).all(axis=1)
            rest = (lhs - fixed - given)[good]
            size = float(np.std(rest)) or 1.0
            rows.append(matrix[good] / size)
            measured.append(rest / size)
    if not rows:
        return out
    matrix, y = np.vstack(rows), np.concatenate(measured)
    told = np.linalg.norm(matrix, axis=0) > 0.0
    if told.any() and len(y) > int(told.sum()):
        out[told] = least_squares(matrix[:, told], y).value
    return out


def measured_states(model: LinearModel, record: LinearRecord) -> dict[str, Array]:
    """The states (n,) that an output measures as they are."""
    out = {}
    for s in model.states:
        if model.rows.get(s) == s and s in model.outputs:
            out[s] = record.outputs[:, model.outputs.index(s)]
    return out


def white_noise(series: Array) -> float:
    """Standard deviation of the white part of a series (n,), by third differences."""
    good = series[np.isfinite(series)]
    rough = rough_part(good[:, None])
    return float(np.sqrt(np.sum(rough**2) / max(len(good), 1)))


def _rows(
    model: LinearModel, record: LinearRecord, known: dict[str, Array]
) -> list[tuple[Array, Array, Array]]:
    """Left side (n,), regressors (n, j) and fixed part (n,) of every row that can be regressed."""
    n = len(record.t)
    states = np.column_stack([known.get(s, np.zeros(n)) for s in model.states])
    missing = [i for i, s in enumerate(model.states) if s not in known]
    drive = record.drive
    out = []
    tops = [(f"{s}dot", model.slopes.A[:, i], model.slopes.B[:, i], model.fixed.A[i],
             model.fixed.B[i]) for i, s in enumerate(model.states)]  # fmt: skip
    lows = [(y, model.slopes.C[:, i], model.slopes.D[:, i], model.fixed.C[i], model.fixed.D[i])
            for i, y in enumerate(model.outputs) if y not in model.states]  # fmt: skip
    named = {name for name, *_ in tops}
    for name, dx, dw, x0, w0 in (*tops, *(row for row in lows if row[0] not in named)):
        if np.any(dx[:, missing]) or np.any(x0[missing]):
            continue
        if name in model.outputs:
            lhs = record.outputs[:, model.outputs.index(name)]
        elif name[:-3] in known and np.isfinite(known[name[:-3]]).all() and n > SAMPLES:
            lhs = LocalCubic(record.t, SAMPLES * record.dt).derivative(known[name[:-3]])
        else:
            continue
        out.append((lhs, states @ dx.T + drive @ dw.T, states @ x0 + drive @ w0))
    return out
