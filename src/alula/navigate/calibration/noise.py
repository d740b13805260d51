"""White noise, bias instability and random walk of a sensor from its Allan variance.

    sigma^2(tau) = N^2/tau + (2 ln 2/pi) B^2 + K^2 tau/3        (IEEE Std 952-1997, annex C)

fitted at averaging times an octave apart, each component as the discrete spectrum

    S(f) = N^2/dt + B^2/(2 pi f) + K^2 dt/(2 sin(pi f))^2        (f in cycles per sample)

gives it, weighted by the covariance of the estimates (allan.py) at the values found, iterated.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats
from scipy.optimize import nnls

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.navigate.calibration.allan import (
    allan_variance,
    averaging_lengths,
    covariance,
    expected,
    frequencies,
    transfer,
)
from alula.navigate.calibration.result import Parameter, Verdict
from alula.navigate.calibration.stillness import moves

ROUNDS = 8
LEAST = 512  # samples: seven averaging times for three unknowns
NAMES = ("white_noise", "bias_instability", "random_walk")
MISFIT = 1e-3  # probability of so large a misfit by chance


@dataclass(frozen=True)
class AxisNoise:
    """One axis at rest. tau: (k,) s. deviation: (k,) Allan deviation. error: (k,) its standard
    error. model: (k,) fitted. parameters: N (unit/sqrt(Hz)), B (unit), K (unit/s/sqrt(Hz)).
    upper: 95 % bound of each. rate: Hz. mean: of the readings."""

    tau: Array
    deviation: Array
    error: Array
    model: Array
    parameters: tuple[Parameter, ...]
    upper: tuple[float, float, float]
    rate: float
    mean: float
    messages: tuple[Message, ...] = ()

    def __getitem__(self, name: str) -> Parameter:
        return next(p for p in self.parameters if p.name.endswith(name))

    @property
    def sigma(self) -> float:
        """Standard deviation of the white noise in one sample at the recording's rate."""
        return self["white_noise"].value * float(np.sqrt(self.rate))

    def as_dict(self) -> Mapping[str, object]:
        """As the envelope carries it."""
        return {
            "rate": self.rate,
            "sigma": self.sigma,
            "mean": self.mean,
            "parameters": [
                {**p.as_dict(), "upper95": u}
                for p, u in zip(self.parameters, self.upper, strict=True)
            ],
            "allan": {
                "tau": self.tau.tolist(),
                "deviation": self.deviation.tolist(),
                "se": self.error.tolist(),
                "model": self.model.tolist(),
            },
        }


def axis_noise(
    y: Array, rate: float, unit: str, *, name: str = "", where: str = "still log"
) -> AxisNoise:
    """Noise parameters of one axis at rest. y: (n,) evenly sampled at `rate` Hz, in `unit`.

    Raises BadInput for a record that is too short, has holes, stands still altogether, or moves.
    A component that the record does not show is 'weak', with its upper bound; one that no averaging
    time tells is 'not_identifiable'.
    """
    _check(y, where)
    said = moves(y, rate, where)
    dt = 1.0 / rate
    lengths = averaging_lengths(len(y))
    measured = allan_variance(y, lengths)
    f = frequencies(len(y))
    gain = transfer(lengths, f)
    parts = np.array([np.ones_like(f) / dt, 0.5 / (np.pi * f), dt / (2 * np.sin(np.pi * f)) ** 2])
    model = np.column_stack([expected(gain, s, f) for s in parts])  # (k, 3), of N2, B2, K2
    squares = nnls(model / measured[:, None], np.ones(len(lengths)))[0]
    for _ in range(ROUNDS):
        spread = covariance(gain, squares @ parts, f, len(y), lengths)
        root = np.linalg.cholesky(spread)
        rows, wanted = np.linalg.solve(root, model), np.linalg.solve(root, measured)
        scale = np.linalg.norm(rows, axis=0)
        before, squares = squares, nnls(rows / scale, wanted)[0] / scale
        if np.allclose(squares, before, rtol=1e-6, atol=0.0):
            break
    chi2 = float(np.sum((wanted - rows @ squares) ** 2))
    dof = len(lengths) - 3
    told = np.linalg.inv((rows / scale).T @ (rows / scale)) / np.outer(scale, scale)
    if stats.chi2.sf(chi2, dof) < MISFIT:
        told = told * chi2 / dof
        said.append(
            warn(
                "allan_misfit",
                where=where,
                expected="white noise, bias instability and random walk",
                found=f"an Allan variance that they do not explain (chi2 {chi2:.0f} for {dof})",
                do="Look at the picture: a low-pass in the sensor, quantization, vibration or "
                "temperature. Standard errors were widened by the misfit.",
            )
        )
    parameters, upper = _parameters(squares, told, dof, unit, name)
    error = 0.5 * np.sqrt(np.diag(spread)) / np.sqrt(measured)
    return AxisNoise(
        frozen(lengths * dt), frozen(np.sqrt(measured)), frozen(error),
        frozen(np.sqrt(model @ squares)), parameters, upper, rate, float(y.mean()), tuple(said),
    )  # fmt: skip


def _parameters(
    squares: Array, told: Array, dof: int, unit: str, name: str
) -> tuple[tuple[Parameter, ...], tuple[float, float, float]]:
    """Square roots with their errors and 95 % bounds.

    A component held at zero by its bound has no standard error from derivatives; its own unbounded
    one says how large it could be.
    """
    units = (f"{unit}/sqrt(Hz)", unit, f"{unit}/s/sqrt(Hz)")
    found, bounds = [], []
    for k, label in enumerate(NAMES):
        s2, se2 = float(squares[k]), float(np.sqrt(told[k, k]))
        high = float(np.sqrt(s2 + 1.645 * se2))
        low95, high95 = (float(np.sqrt(max(s2 + z * se2, 0.0))) for z in (-1.96, 1.96))
        value = float(np.sqrt(s2))
        se = se2 / (2.0 * value) if s2 > se2 else high95 - value
        verdict: Verdict = "ok" if s2 > 2.0 * se2 else "weak"
        found.append(Parameter(f"{name}{label}", value, se, (low95, high95), units[k], verdict))
        bounds.append(high)
    return tuple(found), (bounds[0], bounds[1], bounds[2])


def _check(y: Array, where: str) -> None:
    bad = int((~np.isfinite(y)).sum())
    if bad:
        raise refuse(
            "not_finite",
            where=where,
            expected="a number in every sample: averages have no holes",
            found=f"{bad} of {len(y)} are none",
            do="Cut the recording before the hole.",
        )
    if len(y) < LEAST:
        raise refuse(
            "too_few_samples",
            where=where,
            expected=f"{LEAST} samples or more, better an hour",
            found=str(len(y)),
            do="Record longer.",
        )
    if np.unique(y).size < 3:
        raise refuse(
            "dead_sensor",
            where=where,
            expected="readings that show noise",
            found=f"{np.unique(y).size} different reading(s)",
            do="Record more digits, or check the sensor: it does not move at all.",
        )
