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
from typing import Any

import numpy as np
from scipy import stats

from alula.airdata.inflight_instruments import WEAKEST, first_stage, instruments
from alula.airdata.inflight_model import UNKNOWNS, Model, autoregression, model_of, whitened
from alula.airdata.inflight_motion import prepared
from alula.airdata.inflight_record import AirDataRecord
from alula.airdata.inflight_result import SOUGHT, InFlightCalibration, Parameter, Verdict
from alula.base.arrays import Array, frozen
from alula.base.coloured import coloured_covariance
from alula.base.messages import Message, refuse, warn

# Standard error from which on a parameter is not determined; one that is fine for any value.
LIMITS = {"1": (0.04, 0.01), "rad": (0.02, 0.002), "m/s": (2.0, 0.3), "s": (0.5, 0.02),
          "m": (30.0, 1.0)}  # fmt: skip
# Standard errors of what sampling and the smoothing of the motion leave (calm air shows them).
FLOOR = {"1": 0.003, "rad": 3.5e-4}
# What is not known either where a scale error is not.
GO_WITH = {"k_V": ("wind_north", "wind_east", "static_error"), "k_alpha": ("b_alpha",),
           "k_beta": ("b_beta",)}  # fmt: skip
SPREAD = 0.1  # 1 - |mean direction of flight|: headings over 45 deg to either side
HELD = 1e8  # information on what is kept at zero
TIED = 0.7  # correlation from which on a parameter is named
ITERATIONS, SETTLED, FAR = 20, 0.02, 0.25  # of a standard error; FAR: has not settled at all
LONGEST = 2.0  # s, of the autoregressions' memory


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
    intervals, for GPS velocities so poor that what is fast in them is mostly error. Raises
    BadInput where the fit does not settle. A parameter that the flight does not determine reads
    'not_identifiable' and has no value.
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
    plain, covariance, dof = _covariance(fit, prior, model.names)
    spread = _spread(model, values)
    residuals = model.residuals(values)
    found = InFlightCalibration(
        _parameters(model.names, values, plain, covariance, dof, fit.held),
        frozen(covariance), spread, record.t, model.outputs, frozen(residuals),
        int(np.sum(np.isfinite(fit.residual).any(axis=1))), iterations, delay, record.messages,
    )  # fmt: skip
    return replace(found, messages=(*record.messages, *_remarks(found)))


@dataclass(frozen=True)
class _Fit:
    """A step's equations. held: what the flight cannot tell, kept at zero."""

    residual: Array  # (n, m), whitened, unit variance
    slopes: Array  # (n, m, k)
    dispersion: Array  # (k, k)
    strength: dict[str, float]  # F of the instruments by scale error
    held: frozenset[str] = frozenset()


def _fitted(model: Model, prior: Array, white: bool) -> tuple[Array, _Fit, int]:
    """Plain weights first; then whitened by what they leave, twice.

    Estimated together, a long autoregression would rather foretell the readings by themselves. On
    one heading there is nothing to be gained by whitening, and plain weights stay.
    """
    start = np.zeros(len(model.names))
    filters = [np.array([1.0]) for _ in model.outputs]
    held = _untold(model, start, _step(model, start, prior, filters)[0].strength)
    values, fit, used, size = _settled(model, start, prior, filters, held)
    if size > FAR and "k_V" in held:  # nor do the vanes' scales settle on one heading
        held = held | {n for n in ("k_alpha", "k_beta") if n in model.names}
        values, fit, used, size = _settled(model, start, prior, filters, held)
    largest = round(LONGEST / float(np.median(np.diff(model.record.t))))
    for _ in range(2 if white and "k_V" not in held else 0):
        filters = [
            autoregression(r, 3 if name == "h" else largest)  # heights are smooth anyway
            for name, r in zip(model.outputs, model.residuals(values).T, strict=True)
        ]
        held = _untold(model, values, _step(model, values, prior, filters)[0].strength)
        values, fit, more, size = _settled(model, values, prior, filters, held)
        used += more
    if not size <= FAR:
        raise refuse(
            "not_settled",
            where="in-flight calibration",
            expected=f"a fit that settles in {ITERATIONS} steps",
            found=f"a last step of {size:.2g} standard errors",
            do="Look at the mapping of signs and units; cut what is not flight.",
        )
    return values, fit, used


def _settled(
    model: Model, values: Array, prior: Array, filters: list[Array], held: frozenset[str]
) -> tuple[Array, _Fit, int, float]:
    """Values, equations, number of steps and the last one's size in standard errors."""
    known = np.where([n in held for n in model.names], HELD, prior)
    size, share, used = np.inf, 1.0, 0
    while used < ITERATIONS and size > SETTLED:
        used += 1
        fit, step = _step(model, values, known, filters)
        step *= min(1.0, 20.0 / max(1e-12, float(np.max(np.abs(step)))))  # 20 m/s: far enough
        values = values + share * step
        se = np.sqrt(np.maximum(np.diag(fit.dispersion), 1e-300))
        before, size = size, float(np.max(np.abs(step) / se))
        if size > 0.7 * before:  # swings about the solution
            share = max(0.3, 0.7 * share)
    return values, replace(fit, held=held), used, size


def _untold(model: Model, values: Array, strength: Mapping[str, float]) -> frozenset[str]:
    """Scale errors that this flight cannot tell: on one heading, or without the pilot's doing.

    Left in, they would wander along what they are tied to and never settle.
    """
    straight = {"k_V"} if _spread(model, values) < SPREAD else set()
    return frozenset(straight | {n for n, f in strength.items() if not f > WEAKEST})


def _step(model: Model, values: Array, prior: Array, filters: list[Array]) -> tuple[_Fit, Array]:
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


def _covariance(fit: _Fit, prior: Array, names: tuple[str, ...]) -> tuple[Array, Array, Array]:
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
    held: frozenset[str],
) -> tuple[Parameter, ...]:
    se = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    plain = np.sqrt(np.maximum(np.diag(white), 0.0))
    out = []
    for k, name in enumerate(names):
        unit, _ = UNKNOWNS[name]
        lost, fine = LIMITS[unit]
        value = float(values[k])
        verdict: Verdict = "weak"
        tied: list[tuple[str, float]] = []
        half = float(stats.t.ppf(0.975, dof[k])) * float(se[k])
        with_it = [n for n in held if n == name or name in GO_WITH[n]]
        if with_it:  # known only if what is held were known
            se[k] = plain[k] = np.inf
            verdict = "not_identifiable"
            tied = [(n, 1.0) for n in (*with_it, *(GO_WITH[name] if name in held else ()))
                    if n != name and n in names]  # fmt: skip
        elif not se[k] <= lost:
            verdict = "not_identifiable"
            finite = np.isfinite(se) & (se > 0.0)
            tied = [
                (n, float(covariance[k, i] / (se[k] * se[i])))
                for i, n in enumerate(names)
                if i != k and finite[i] and abs(covariance[k, i]) > TIED * se[k] * se[i]
            ]
        elif abs(value) > 2.0 * se[k] or se[k] < fine:
            verdict = "ok"
        if verdict == "not_identifiable":
            value, interval = float("nan"), (float("-inf"), float("inf"))
        else:
            interval = (value - half, value + half)
        out.append(
            Parameter(
                name, value, float(plain[k]), float(se[k]), interval, unit,
                verdict, tuple(tied),
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
