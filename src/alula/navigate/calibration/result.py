"""What a calibration gives: matrix, offset and the rest with standard errors and verdicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
from scipy import stats

from alula.base.arrays import Array, frozen
from alula.base.messages import Message

Verdict = Literal["ok", "weak", "not_identifiable"]
AXES = ("x", "y", "z")
UNITS = {"accelerometer": "m/s2", "gyro": "rad/s", "magnetometer": "T"}
LOST = 0.1  # standard error in typical sizes beyond which a parameter is not determined
FINE = 0.005  # standard error in typical sizes that is good enough whatever the value
TIED = 0.3  # share in the weakest direction from which on a parameter is named


@dataclass(frozen=True)
class Parameter:
    """One parameter. value, se: NaN and infinite where the data do not determine it."""

    name: str
    value: float
    se: float
    ci95: tuple[float, float]
    unit: str
    verdict: Verdict
    tied_to: tuple[tuple[str, float], ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """As the envelope's `result.parameters[]` carries it."""
        return {
            "name": self.name,
            "value": self.value,
            "se": self.se,
            "ci95": list(self.ci95),
            "verdict": self.verdict,
            "tied_to": [{"name": n, "weight": w} for n, w in self.tied_to],
            "unit": self.unit,
        }


@dataclass(frozen=True)
class Errors:
    """Relative error of the vector's length: largest and rms."""

    largest: float
    rms: float


@dataclass(frozen=True)
class SensorCalibration:
    """calibrated = matrix (raw - offset - I current) - g_sensitivity f, in SI.

    matrix: (3, 3). offset: (3,) as the raw readings. g_sensitivity: (3, 3) rad/s per m/s2, f the
    calibrated specific force. current: (3,) T/A. covariance: of `parameters`, in their order.
    raw: (n, 3) what was used; length: (n,) of the reference (m/s2, T; rad of a turn). before,
    after: error of the length. along, across: standard deviation of one sample's length and of its
    direction, as vector component. Pusztai 2018, Eq. (3.15), (3.17), (3.21).
    """

    sensor: str
    matrix: Array
    offset: Array
    parameters: tuple[Parameter, ...]
    covariance: Array
    before: Errors
    after: Errors
    raw: Array
    calibrated: Array
    length: Array
    along: float = float("nan")
    across: float = float("nan")
    g_sensitivity: Array = field(default_factory=lambda: frozen(np.zeros((3, 3))))
    current: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    messages: tuple[Message, ...] = ()

    @property
    def unit(self) -> str:
        """SI unit of readings and calibrated values."""
        return UNITS[self.sensor]

    @property
    def determined(self) -> bool:
        """Whether every parameter is."""
        return all(p.verdict != "not_identifiable" for p in self.parameters)

    def __getitem__(self, name: str) -> Parameter:
        """The parameter of that name: 'C_xy', 'offset_z', 'G_x', 'current_y'."""
        return next(p for p in self.parameters if p.name == name)

    def correct(
        self, raw: Array, force: Array | None = None, amperes: Array | None = None
    ) -> Array:
        """Calibrated (n, 3) of raw (n, 3). force: (n, 3) calibrated specific force, m/s2, for a
        gyro with g-sensitivity; amperes: (n,) motor current for a magnetometer."""
        return corrected(
            raw, self.matrix, self.offset, self.g_sensitivity, self.current, force, amperes
        )

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it."""
        return {
            "matrix": self.matrix.tolist(),
            "offset": self.offset.tolist(),
            "g_sensitivity": self.g_sensitivity.tolist(),
            "current": self.current.tolist(),
            "unit": self.unit,
            "n": len(self.raw),
            "before": {"largest": self.before.largest, "rms": self.before.rms},
            "after": {"largest": self.after.largest, "rms": self.after.rms},
            "along": self.along,
            "across": self.across,
            "parameters": [p.as_dict() for p in self.parameters],
        }


def corrected(
    raw: Array,
    matrix: Array,
    offset: Array,
    g_sensitivity: Array,
    current: Array,
    force: Array | None = None,
    amperes: Array | None = None,
) -> Array:
    """matrix (raw - offset - I current) - g_sensitivity force; what is None counts as zero."""
    taken = raw - offset
    if amperes is not None:
        taken = taken - np.outer(amperes, current)
    out: Array = taken @ matrix.T
    return out if force is None else out - force @ g_sensitivity.T


def length_errors(vectors: Array, length: Array) -> Errors:
    """|v| over the reference's length, less one, where the reference has a length."""
    turned = length > 0.0
    relative = np.linalg.norm(vectors[turned], axis=1) / length[turned] - 1.0
    return Errors(float(np.max(np.abs(relative))), float(np.sqrt(np.mean(relative**2))))


def parameters_of(
    names: tuple[str, ...],
    values: Array,
    covariance: Array,
    typical: Array,
    nominal: Array,
    units: tuple[str, ...],
    dof: float,
    ties: Mapping[str, float],
) -> tuple[Parameter, ...]:
    """Each parameter with interval (Student's t) and verdict.

    'not_identifiable': a standard error over a tenth of the typical size (a scale known to 10 %,
    an offset of a tenth of the field), or none at all. 'ok': differs from its nominal value by two
    standard errors, or known to 0.5 % of the typical size. 'weak': neither.
    """
    t = float(stats.t.ppf(0.975, dof)) if dof >= 1.0 else float("inf")
    out = []
    for k, name in enumerate(names):
        se = float(np.sqrt(covariance[k, k])) if covariance[k, k] >= 0.0 else float("inf")
        value = float(values[k])
        verdict: Verdict = "weak"
        tied: tuple[tuple[str, float], ...] = ()
        if not se <= LOST * typical[k] or dof <= 0.0:
            verdict, value = "not_identifiable", float("nan")
            tied = tuple((n, w) for n, w in ties.items() if n != name and abs(w) > TIED)
        elif abs(value - nominal[k]) > 2.0 * se or se < FINE * typical[k]:
            verdict = "ok"
        half = t * se if np.isfinite(se) else float("inf")
        interval = (value - half, value + half)
        out.append(Parameter(name, value, se, interval, units[k], verdict, tied))
    return tuple(out)
