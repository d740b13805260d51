"""Calibration of air data in flight: airspeed scale, upwash, vane bias, static-pressure error.

From any maneuvering flight with GPS velocity and attitude; the wind is solved along and no course
has to be flown. Prediction errors (Ljung, System Identification, 1999, ch. 7 and 13): the residual
of each reading, which is mostly gust, is whitened by an autoregression of its own, fitted along.
That keeps the estimate free of bias although the aircraft answers to the gusts, because it answers
after them. Errors with a known size only (attitude, vertical wind) enter with that size.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from scipy import stats

from alula.airdata.inflight_instruments import WEAKEST, first_stage, instruments
from alula.airdata.inflight_model import UNKNOWNS, Model, autoregression, model_of, whitened
from alula.airdata.inflight_motion import prepared
from alula.airdata.inflight_record import AirDataRecord
from alula.base.arrays import Array, frozen
from alula.base.coloured import coloured_covariance
from alula.base.messages import Message, refuse, warn

Verdict = Literal["ok", "weak", "not_identifiable"]
SOUGHT = ("k_V", "k_alpha", "b_alpha", "k_beta", "b_beta", "static_error")
WIND = ("wind_north", "wind_east", "wind_down")
# Standard error from which on a parameter is not determined; one that is fine for any value.
LIMITS = {"1": (0.04, 0.01), "rad": (0.02, 0.002), "m/s": (2.0, 0.3), "s": (0.5, 0.02),
          "m": (30.0, 1.0)}  # fmt: skip
# Standard errors of what sampling and the smoothing of the motion leave (calm air shows them).
FLOOR = {"1": 0.003, "rad": 3.5e-4}
SPREAD = 0.1  # 1 - |mean direction of flight|: headings over 45 deg to either side
TIED = 0.7  # correlation from which on a parameter is named
ITERATIONS, SETTLED = 15, 0.02  # of a standard error
LONGEST = 2.0  # s, of the autoregressions' memory


@dataclass(frozen=True)
class Parameter:
    """One parameter. value: NaN where the flight does not determine it."""

    name: str
    value: float
    se_white: float
    se: float
    ci95: tuple[float, float]
    unit: str
    verdict: Verdict
    tied_to: tuple[tuple[str, float], ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """As the envelope's `result.parameters[]` carries it."""
        return {
            "name": self.name, "value": self.value, "se_white": self.se_white, "se": self.se,
            "ci95": list(self.ci95), "verdict": self.verdict,
            "tied_to": [{"name": n, "weight": w} for n, w in self.tied_to], "unit": self.unit,
        }  # fmt: skip


@dataclass(frozen=True)
class InFlightCalibration:
    """Errors of the air data: reading = (1 + k) truth + b, port pressure = p + static_error q.

    parameters: sought ones, wind, and what was known before (attitude biases, GPS delay), each
    with interval and verdict. covariance: of them, in their order. spread: 1 - |mean direction|,
    0 for a straight flight. resid: (n, m) reading less foretold one, by `outputs`. used: samples.
    gps_delay: s, that was found and removed beforehand; None where it is a parameter.
    """

    parameters: tuple[Parameter, ...]
    covariance: Array
    spread: float
    t: Array
    outputs: tuple[str, ...]
    resid: Array
    used: int
    iterations: int
    gps_delay: float | None = None
    messages: tuple[Message, ...] = ()

    def __getitem__(self, name: str) -> Parameter:
        """The parameter of that name; raises BadInput naming those there are."""
        for p in self.parameters:
            if p.name == name:
                return p
        raise refuse(
            "unknown_parameter",
            where="in-flight calibration",
            expected=", ".join(p.name for p in self.parameters),
            found=f"'{name}'",
            do="Name one of these.",
        )

    @property
    def rich(self) -> bool:
        """Whether the flight told airspeed error and wind apart."""
        return self["k_V"].verdict != "not_identifiable"

    @property
    def determined(self) -> bool:
        """Whether every sought parameter is."""
        return all(
            p.verdict != "not_identifiable" for p in self.parameters if p.name in (*SOUGHT, *WIND)
        )

    def corrected(self, readings: Mapping[str, Array]) -> dict[str, Array]:
        """Readings 'V', 'alpha', 'beta' or 'beta_flank' without their errors.

        Raises BadInput where the flight did not determine what is needed.
        """
        out = {}
        for name, values in readings.items():
            kind = "beta" if name == "beta_flank" else name
            scale, bias = (
                self[n].value if any(p.name == n for p in self.parameters) else 0.0
                for n in (f"k_{kind}", f"b_{kind}")
            )
            if not np.isfinite(scale + bias):
                raise refuse(
                    "flight_not_rich",
                    where=f"in-flight calibration, {name}",
                    expected="a flight that determines its errors",
                    found=f"headings spread {self.spread:.2g}; "
                    f"se {', '.join(f'{p.name} {p.se:.2g}' for p in self.parameters[:5])}",
                    do="Fly turns, and maneuvers in pitch and yaw.",
                )
            out[name] = (np.asarray(values) - bias) / (1.0 + scale)
        return out

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it."""
        return {
            "parameters": [p.as_dict() for p in self.parameters],
            "rich": self.rich,
            "heading_spread": self.spread,
            "samples": self.used,
            "outputs": list(self.outputs),
            "resid_rms": {
                n: float(np.sqrt(np.nanmean(self.resid[:, j] ** 2)))
                for j, n in enumerate(self.outputs)
            },
            "iterations": self.iterations,
            "gps_delay": self.gps_delay,
        }

    def summary(self) -> str:
        """The parameters as text; angles in deg."""
        lines = [f"{'parameter':<14}{'value':>11}{'se':>10}   95 % interval          verdict"]
        for p in self.parameters:
            k, unit = (np.degrees(1.0), "deg") if p.unit == "rad" else (1.0, p.unit)
            low, high = (k * x for x in p.ci95)
            lines.append(
                f"{p.name:<14}{k * p.value:>11.4g}{k * p.se:>10.2g}   {low:>9.4g} to {high:<9.4g}"
                f"  {p.verdict.replace('_', ' ')}"
                + (f"  [{unit}]" if unit != "1" else "")
                + (", tied to " + ", ".join(n for n, _ in p.tied_to) if p.tied_to else "")
            )
        return "\n".join(lines)


def calibrate_in_flight(
    record: AirDataRecord,
    *,
    known: Mapping[str, float | None] | None = None,
    without: tuple[str, ...] = (),
    white: bool = True,
) -> InFlightCalibration:
    """Estimate the errors of the air data of a record, wind along.

    known: standard deviations of what is known before, SI, by parameter, instead of the defaults
    (vertical wind 0.2 m/s, attitude biases 0.3, 0.3, 1 deg, GPS delay 0.3 s); None: nothing.
    without: unknowns that are taken as zero. white: False leaves the residuals coloured: wider
    intervals, for GPS velocities so poor that what is fast in them is mostly error. Raises BadInput where the fit does not settle. A
    parameter that the flight does not determine reads 'not_identifiable' and has no value.
    """
    record, delay = prepared(record)
    model = model_of(record, without if delay is None else (*without, "gps_delay"))
    sizes = {name: UNKNOWNS[name][1] for name in model.names}
    for name, size in (known or {}).items():
        if name not in UNKNOWNS or (size is not None and not size > 0.0):
            raise refuse(
                "known_error",
                where="in-flight calibration",
                expected="positive standard deviations of " + ", ".join(UNKNOWNS),
                found=f"{name} = {size}",
                do="Correct the name or the value.",
            )
        if name in sizes:
            sizes[name] = size
    prior = np.array([0.0 if sizes[n] is None else 1.0 / float(sizes[n] or 1.0) ** 2
                      for n in model.names])  # fmt: skip
    values, fit, iterations = _fitted(model, prior, white)
    white, covariance, dof = _covariance(fit, prior, model.names)
    spread = _spread(model, values)
    residuals = model.residuals(values)
    found = InFlightCalibration(
        _parameters(model.names, values, white, covariance, dof, spread, fit.strength),
        frozen(covariance), spread, record.t, model.outputs, frozen(residuals),
        int(np.sum(np.isfinite(fit.residual).any(axis=1))), iterations, delay, record.messages,
    )  # fmt: skip
    return replace(found, messages=(*record.messages, *_remarks(found)))


@dataclass(frozen=True)
class _Fit:
    residual: Array  # (n, m), whitened, unit variance
    slopes: Array  # (n, m, k)
    dispersion: Array  # (k, k)
    strength: dict[str, float]  # F of the instruments by scale error


def _fitted(model: Model, prior: Array, white: bool) -> tuple[Array, _Fit, int]:
    """Plain weights first; then whitened by what they leave, twice.

    Estimated together, a long autoregression would rather foretell the readings by themselves.
    """
    values, used = np.zeros(len(model.names)), 0
    largest = round(LONGEST / float(np.median(np.diff(model.record.t))))
    filters = [np.array([1.0]) for _ in model.outputs]
    for stage in range(3 if white else 1):
        if stage:
            filters = [
                autoregression(r, 3 if name == "h" else largest)  # heights are smooth anyway
                for name, r in zip(model.outputs, model.residuals(values).T, strict=True)
            ]
        fit, size = None, np.inf
        for _ in range(ITERATIONS):
            used += 1
            fit, step = _step(model, values, prior, filters)
            step *= min(1.0, 20.0 / max(1e-12, float(np.max(np.abs(step)))))  # 20 m/s: far enough
            values = values + step
            se = np.sqrt(np.maximum(np.diag(fit.dispersion), 1e-300))
            size = float(np.max(np.abs(step) / se))
            if size <= SETTLED:
                break
        else:
            raise refuse(
                "not_settled",
                where="in-flight calibration",
                expected=f"a fit that settles in {ITERATIONS} steps",
                found=f"a last step of {size:.2g} standard errors",
                do="Look at the mapping of signs and units; cut what is not flight.",
            )
    assert fit is not None
    return values, fit, used


def _step(
    model: Model, values: Array, prior: Array, filters: list[Array]
) -> tuple[_Fit, Array]:
    """One step of Gauss and Newton."""
    r, x = whitened(model.residuals(values), filters), whitened(model.jacobian(values), filters)
    good = np.isfinite(r) & np.isfinite(x).all(axis=2)
    r, x = np.where(good, r, 0.0), np.where(good[..., None], x, 0.0)
    size = np.sqrt(np.sum(r**2, axis=0) / np.maximum(1, np.sum(good, axis=0)))
    size = np.where(size > 0.0, size, 1.0)
    r, x = r / size, x / size[:, None]
    z, strength = _instrumented(model, values, x, good, filters)
    information = np.einsum("nmi,nmj->ij", z, z) + np.diag(prior)
    scale = 1.0 / np.sqrt(np.maximum(np.diag(information), 1e-300))
    # What nothing determines is left where it is: its variance is what tells.
    inverse = np.linalg.pinv(information * np.outer(scale, scale), rcond=1e-12, hermitian=True)
    dispersion = inverse * np.outer(scale, scale)
    step = dispersion @ (np.einsum("nmi,nm->i", z, r) - prior * values)
    return _Fit(np.where(good, r, np.nan), z, dispersion, strength), np.asarray(step)


def _instrumented(
    model: Model, values: Array, x: Array, good: Any, filters: list[Array]
) -> tuple[Array, dict[str, float]]:
    """Slopes (n, m, k) whose vane columns are the pilot's doing only, and how strong that is."""
    out, strength = x.copy(), {}
    speed = np.linalg.norm(model.velocity(dict(zip(model.names, values, strict=True))), axis=1)
    for j, output in enumerate(model.outputs):
        kind = "beta" if output == "beta_flank" else output
        name = f"k_{kind}"
        if kind not in ("alpha", "beta") or name not in model.names:
            continue
        by = instruments(model.record, kind, speed)
        by = whitened(by[:, None, :], [filters[j]])[:, 0]
        known = good[:, j] & np.isfinite(by).all(axis=1)
        k = model.names.index(name)
        others = np.delete(x[:, j], k, axis=1)
        others = others[:, np.any(others[known] != 0.0, axis=0)]
        fitted, strength[name] = first_stage(x[known, j, k], others[known], by[known])
        out[:, j, k] = 0.0
        out[known, j, k] = fitted
    return out, strength


def _covariance(
    fit: _Fit, prior: Array, names: tuple[str, ...]
) -> tuple[Array, Array, Array]:
    """Plain and coloured covariance (k, k) and degrees of freedom (k,)."""
    D, known = fit.dispersion, np.isfinite(fit.residual)
    r = np.where(known, fit.residual, 0.0)
    found = coloured_covariance([(fit.slopes, r)], D)
    before = D @ np.diag(prior) @ D
    whole = found.corrected + before
    # Never below what white residuals give: the colour that is left is estimated, too.
    grown = np.sqrt(np.maximum(1.0, np.diag(D) / np.maximum(np.diag(whole), 1e-300)))
    covariance = whole * np.outer(grown, grown)
    covariance[np.diag_indices_from(covariance)] += [
        FLOOR.get(UNKNOWNS[n][0], 0.0) ** 2 if n in SOUGHT else 0.0 for n in names
    ]
    # What was known before is known exactly: degrees of freedom of the flight's share only.
    share = np.clip(np.diag(found.corrected) / np.maximum(np.diag(whole), 1e-300), 1e-3, 1.0)
    return D, covariance, np.minimum(found.dof / share**2, 1e6)


def _spread(model: Model, values: Array) -> float:
    """1 - length of the mean direction of flight through the air, level part."""
    p, r = dict(zip(model.names, values, strict=True)), model.record.readings
    level = np.column_stack([r[f"v_{n}"] - p[f"wind_{n}"] for n in ("north", "east")])
    level = level / np.maximum(np.linalg.norm(level, axis=1, keepdims=True), 1e-9)
    level = level[np.isfinite(level).all(axis=1) & np.isfinite(r["V"])]
    return float(1.0 - np.linalg.norm(np.mean(level, axis=0)))


def _parameters(
    names: tuple[str, ...],
    values: Array,
    white: Array,
    covariance: Array,
    dof: Array,
    spread: float,
    strength: Mapping[str, float],
) -> tuple[Parameter, ...]:
    se = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    plain = np.sqrt(np.maximum(np.diag(white), 0.0))
    straight = spread < SPREAD
    out = []
    for k, name in enumerate(names):
        unit, _ = UNKNOWNS[name]
        lost, fine = LIMITS[unit]
        value, verdict = float(values[k]), "weak"
        tied: list[tuple[str, float]] = []
        half = float(stats.t.ppf(0.975, dof[k])) * float(se[k])
        # On one heading a wind along the flight does what an airspeed error does.
        apart = name not in ("k_V", "wind_north", "wind_east") or not straight
        apart &= strength.get(name, np.inf) > WEAKEST
        if not (se[k] <= lost and apart):
            verdict = "not_identifiable"
            with np.errstate(all="ignore"):
                row = covariance[k] / (se[k] * se)
            tied = [
                (n, float(c))
                for n, c in zip(names, row, strict=True)
                if n != name and abs(c) > TIED
            ]
            if not apart and not tied and name in ("k_V", *WIND):
                tied = [(n, 1.0) for n in ("k_V", *WIND[:2]) if n != name]
        elif abs(value) > 2.0 * se[k] or se[k] < fine:
            verdict = "ok"
        if verdict == "not_identifiable":
            value, interval = float("nan"), (float("-inf"), float("inf"))
        else:
            interval = (value - half, value + half)
        out.append(
            Parameter(
                name, value, float(plain[k]), float(se[k]), interval, unit,
                verdict, tuple(tied),  # type: ignore[arg-type]
            )
        )  # fmt: skip
    return tuple(out)


def _remarks(found: InFlightCalibration) -> list[Message]:
    out = []
    lost = [p.name for p in found.parameters if p.verdict == "not_identifiable"]
    if not found.rich:
        out.append(
            warn(
                "flight_not_rich",
                where="in-flight calibration",
                expected="headings over 45 deg to either side, which tell wind from airspeed error",
                found=f"1 - |mean direction| = {found.spread:.2g} (needed {SPREAD:g}), standard "
                f"error of the airspeed scale {found['k_V'].se:.2g}",
                do="Fly turns, best a full circle; any course will do.",
            )
        )
    if lost:
        out.append(
            warn(
                "not_identifiable",
                where="in-flight calibration",
                expected="a flight that determines every parameter",
                found="not determined: " + ", ".join(lost),
                do="Pitch and yaw maneuvers determine vanes, changes of speed the static error.",
            )
        )
    return out
