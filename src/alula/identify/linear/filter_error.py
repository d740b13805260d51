"""Filter error for linear models: output error that knows of turbulence.

dx = (A x + B u + b) dt + F dw, z = C x + D u + d + e: white process noise of intensity F (diagonal,
per square root of a second) enters the states, white measurement noise of standard deviation sigma
each output. A Kalman filter predicts every sample from those before; its innovations are white if
the parameters are right (Maine and Iliff 1981; Jategaonkar 2006, ch. 5). F and sigma are estimated
along with all else, on a logarithmic scale. The gain is that of the steady state (Riccati), or
varies with time; the latter also bridges missing samples. It begins with an estimated state that
has the process noise of one sample, as any prediction has: were it exact, it could meet a reading
exactly, and the likelihood would grow without bound as that sensor's noise goes to zero.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Literal

import numpy as np
from scipy.linalg import expm

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.likelihood.innovations import Innovations
from alula.identify.likelihood.optimizer import Algorithm
from alula.identify.likelihood.parameters import Prior
from alula.identify.likelihood.riccati import steady_covariance
from alula.identify.linear.model import LinearModel, process_covariance, sample
from alula.identify.linear.noise_search import (
    NoisyProblem,
    first_process_noises,
    first_sensor_noises,
    left_aside,
    search_noises,
    without_noises,
)
from alula.identify.linear.output_error import learned
from alula.identify.linear.record import LinearRecord, Unknowns
from alula.identify.linear.start import first_values, measured_states
from alula.identify.result import Identification

Gain = Literal["auto", "steady", "varying"]


def identify_filter_error(
    model: LinearModel,
    records: Sequence[LinearRecord],
    *,
    noisy: Collection[str] | None = None,
    gain: Gain = "auto",
    own: Collection[str] = (),
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    algorithm: Algorithm = "gauss_newton",
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Parameters of `model`, intensity of its process noise and deviation of its sensors' noise.

    noisy: the states that process noise drives, all by default. gain: 'steady', 'varying', or
    'auto', which varies only where samples are missing. own, start, fixed, bounds, priors: as in
    `identify_linear_output_error`; noises are named 'F_p' (per sqrt(s)) and 'sigma_ay'. The series
    of the result are predictions one sample ahead. Raises BadInput as the output error does.
    """
    learn = learned(records)
    unknowns = Unknowns(model, learn, own, without_noises(fixed), initial=True)
    driven = tuple(model.states if noisy is None else noisy)
    strange = [s for s in driven if s not in model.states]
    if strange or gain not in ("auto", "steady", "varying"):
        raise refuse(
            "unknown_option",
            where="filter error",
            expected=f"noisy states among {', '.join(model.states)}; gain auto, steady or varying",
            found=", ".join(strange) or repr(gain),
            do="Correct it.",
        )
    problem = FilterError(model, learn, unknowns, driven, gain, fixed or {}, start or {})
    return search_noises(
        "filter error", problem, model.outputs, model.rows, learn, bounds or {}, priors or {},
        algorithm, scales or {}, truth or {}, left_aside(records),
    )  # fmt: skip


class FilterError(NoisyProblem):
    """Kalman filters."""

    def __init__(
        self,
        model: LinearModel,
        records: Sequence[LinearRecord],
        unknowns: Unknowns,
        noisy: Sequence[str],
        gain: Gain,
        fixed: Mapping[str, float],
        start: Mapping[str, float],
    ) -> None:
        self.model, self.records, self.unknowns = model, records, unknowns
        holes = any(not np.isfinite(r.outputs).all() for r in records)
        if gain == "steady" and holes:
            raise refuse(
                "missing_samples",
                where="filter error",
                expected="every output at every sample for the steady-state gain",
                found="NaN",
                do="Use gain = 'varying' (or 'auto').",
            )
        self.varying = gain == "varying" or (gain == "auto" and holes)
        theta = unknowns.vector(without_noises(start), first_values(model, records, unknowns))
        super().__init__(
            unknowns, records, model.states, noisy, model.outputs, theta,
            {**self._first_noises(theta), **start}, fixed, model.belongs,
        )  # fmt: skip

    def filtered(
        self, maneuver: int, values: Array, x0: Array, intensity: Array, R: Array
    ) -> Innovations | None:
        """Innovations of a maneuver; None where there is no steady gain."""
        record = self.records[maneuver]
        m = self.model.at(values)
        step = sample(m, record.dt)
        k, s = m.C.shape[-2:]
        Q = process_covariance(m.A, intensity[:, :, None] * np.eye(s), record.dt)
        R = R[:, :, None] * np.eye(k)
        w = record.drive
        n = len(w)
        push = np.einsum("msc,nc->nms", step.now, w[:-1]) + np.einsum(
            "msc,nc->nms", step.next, w[1:]
        )
        direct = np.einsum("mkc,nc->nmk", m.D, w)
        good = np.isfinite(record.outputs)
        z = np.where(good, record.outputs, 0.0)
        turned, back = np.swapaxes(m.C, -1, -2), np.swapaxes(step.phi, -1, -2)
        v, y = np.empty((n, len(values), k)), np.empty((n, len(values), k))
        S = np.empty((n if self.varying else 1, len(values), k, k))
        x = x0
        P = Q
        if not self.varying:
            P = steady_covariance(step.phi, m.C, Q, R)
            if not np.isfinite(P).all():
                return None
            S[0] = m.C @ P @ turned + R
            K = np.swapaxes(np.linalg.solve(S[0], m.C @ P), -1, -2)
        for i in range(n):
            y[i] = (m.C @ x[:, :, None])[:, :, 0] + direct[i]
            v[i] = np.where(good[i], z[i] - y[i], 0.0)
            if self.varying:
                seen = m.C * good[i][:, None]
                S[i] = seen @ P @ np.swapaxes(seen, -1, -2)
                S[i] += np.where(good[i][:, None] & good[i], R, np.eye(k))
                K = np.swapaxes(np.linalg.solve(S[i], seen @ P), -1, -2)
                P = P - K @ S[i] @ np.swapaxes(K, -1, -2)
                P = step.phi @ P @ back + Q
            x = x + (K @ v[i][:, :, None])[:, :, 0]
            if i < n - 1:
                x = (step.phi @ x[:, :, None])[:, :, 0] + push[i]
        return Innovations(np.moveaxis(v, 0, 1), np.moveaxis(S, 0, 1), np.moveaxis(y, 0, 1))

    def _first_noises(self, theta: Array) -> dict[str, float]:
        """Sensors' noise by third differences, process noise by one-step errors of the states."""
        out = first_sensor_noises(self.model.outputs, self.records)
        errors: dict[str, list[Array]] = {}
        for i, r in enumerate(self.records):
            known = measured_states(self.model, r)
            m = self.model.at(self.unknowns.of(i, theta)[0])
            x = np.column_stack(
                [known.get(s, np.full(len(r.t), np.nan)) for s in self.model.states]
            )
            drift = np.where(np.isnan(x), 0.0, x) @ (expm(m.A * r.dt) - np.eye(len(m.A))).T
            drift = drift + r.dt * r.drive @ m.B.T
            e = (np.diff(x, axis=0) - drift[:-1]) / r.dt**0.5
            for j, s in enumerate(self.model.states):
                errors.setdefault(s, []).append(e[:, j][np.isfinite(e[:, j])])
        return {**out, **first_process_noises(errors, out, self.records[0].dt)}
