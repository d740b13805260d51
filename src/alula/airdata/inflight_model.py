"""Air data as attitude and GPS velocity foretell them, for given errors and wind.

The air-relative velocity follows from what has nothing to do with air data,

    v_B = R_BE (v_GPS - W) + w x arm,

and each reading from it: V = (1 + k_V) |v_B|, alpha = (1 + k_alpha) atan(w/u) + b_alpha, and so
on. Gusts are then noise in the readings, not in the regressors: regressing the other way round, or
taking the measured angles as known, mistakes gusts for motion and underrates the upwash.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from alula.airdata.inflight_record import AirDataRecord
from alula.base.arrays import Array
from alula.base.rotation import rotated

G = 9.80665
OUTPUTS = ("V", "alpha", "beta", "beta_flank", "h")
# Unit; standard deviation of what is known before (None: nothing).
UNKNOWNS: dict[str, tuple[str, float | None]] = {
    "k_V": ("1", None),
    "k_alpha": ("1", None),
    "b_alpha": ("rad", None),
    "k_beta": ("1", None),
    "b_beta": ("rad", None),
    "static_error": ("1", None),
    "wind_north": ("m/s", None),
    "wind_east": ("m/s", None),
    "wind_down": ("m/s", 0.2),
    "b_phi": ("rad", float(np.radians(0.3))),
    "b_theta": ("rad", float(np.radians(0.3))),
    "b_psi": ("rad", float(np.radians(1.0))),
    "gps_delay": ("s", 0.3),
    "h_offset": ("m", None),
    "h_scale": ("1", 0.03),
}


@dataclass(frozen=True)
class Model:
    """Which outputs a record has, and which unknowns they need."""

    record: AirDataRecord
    outputs: tuple[str, ...]
    names: tuple[str, ...]

    def residuals(self, values: Array) -> Array:
        """Reading less foretold one, (n, m), for values of the unknowns (k,)."""
        p = dict(zip(self.names, values, strict=True))
        readings = self.record.readings
        rates = self.record.rates
        v = self.velocity(p)
        out = []
        for name in self.outputs:
            if name == "h":
                gps = readings["h_gps"]
                speed2 = np.sum(v**2, axis=1)
                foretold = gps + p["h_offset"] + p["h_scale"] * (gps - np.nanmean(gps))
                foretold = foretold - p["static_error"] * speed2 / (2.0 * G)
            else:
                place = "beta" if name == "beta_flank" else name
                there = v
                if place in self.record.arms:
                    there = v + np.cross(rates, np.asarray(self.record.arms[place]))
                foretold = _read(name, there, p)
            out.append(readings[name] - foretold)
        return np.column_stack(out)

    def velocity(self, p: dict[str, float]) -> Array:
        """Air-relative velocity of the center of gravity (n, 3), body axes."""
        readings, t = self.record.readings, self.record.t
        ground = np.column_stack([readings[f"v_{n}"] for n in ("north", "east", "down")])
        if p.get("gps_delay", 0.0) != 0.0:
            ground = _shifted(t, ground, p["gps_delay"])
        wind = np.array([p["wind_north"], p["wind_east"], p["wind_down"]])
        phi, theta, psi = (readings[n] - p.get(f"b_{n}", 0.0) for n in ("phi", "theta", "psi"))
        v = rotated(phi, theta, psi, ground - wind)
        if "gps" in self.record.arms:
            v = v - np.cross(self.record.rates, np.asarray(self.record.arms["gps"]))
        return v

    def jacobian(self, values: Array) -> Array:
        """Slopes (n, m, k) of what is foretold, by central differences."""
        out = []
        for k, name in enumerate(self.names):
            step = np.zeros(len(values))
            step[k] = 1e-2 if UNKNOWNS[name][0] in ("m/s", "m", "s") else 1e-4
            less = self.residuals(values - step) - self.residuals(values + step)
            out.append(less / (2.0 * step[k]))
        return np.stack(out, axis=2)


def model_of(record: AirDataRecord, without: tuple[str, ...] = ()) -> Model:
    """The model of a prepared record; `without`: unknowns that are taken as zero."""
    have = record.readings
    outputs = ["V"]
    names = ["k_V"]
    if "alpha" in have:
        outputs.append("alpha")
        names += ["k_alpha", "b_alpha"]
    side = next((n for n in ("beta", "beta_flank") if n in have), None)
    if side is not None:
        outputs.append(side)
        names += ["k_beta", "b_beta"]
    names += ["wind_north", "wind_east", "wind_down", "b_phi", "b_theta", "b_psi", "gps_delay"]
    if "h" in have and "h_gps" in have:
        outputs.append("h")
        names += ["static_error", "h_offset", "h_scale"]
    kept = tuple(n for n in names if n not in without or n.startswith("wind"))
    return Model(record, tuple(outputs), kept)


def _read(name: str, v: Array, p: dict[str, float]) -> Array:
    speed = np.sqrt(np.sum(v**2, axis=1))
    if name == "V":
        return np.asarray((1.0 + p.get("k_V", 0.0)) * speed)
    if name == "alpha":
        angle, kind = np.arctan2(v[:, 2], v[:, 0]), "alpha"
    elif name == "beta":
        angle, kind = np.arcsin(v[:, 1] / speed), "beta"
    else:
        angle, kind = np.arctan2(v[:, 1], v[:, 0]), "beta"
    return np.asarray((1.0 + p.get(f"k_{kind}", 0.0)) * angle + p.get(f"b_{kind}", 0.0))


def _shifted(t: Array, values: Array, delay: float) -> Array:
    """What a sensor that is `delay` s late will say of now: by its slope, smooth in the delay."""
    return values + delay * np.gradient(values, t, axis=0)


def autoregression(residual: Array, largest: int) -> Array:
    """Coefficients [1, a1, ..., ap] that make residual (n,) white; p by the Bayesian criterion.

    Least squares on the samples whose past is there; NaN splits the record.
    """
    n = len(residual)
    lags = np.column_stack([residual[largest - k : n - k] for k in range(largest + 1)])
    rows = lags[np.isfinite(lags).all(axis=1)]
    if len(rows) < 10 * largest:
        return np.array([1.0])
    best, chosen = np.inf, np.array([1.0])
    gram = rows.T @ rows / len(rows)
    for order in range(largest + 1):
        block = gram[1 : order + 1, 1 : order + 1]
        past = np.linalg.solve(block, gram[1 : order + 1, 0]) if order else np.zeros(0)
        variance = gram[0, 0] - past @ gram[1 : order + 1, 0]
        score = len(rows) * np.log(max(variance, 1e-300)) + order * np.log(len(rows))
        if score < best:
            best, chosen = score, np.concatenate([[1.0], -past])
    return chosen


def whitened(values: Array, filters: list[Array]) -> Array:
    """values (n, m) or (n, m, k) through the filter of each output; NaN where the past lacks."""
    out = np.empty_like(values)
    for j, a in enumerate(filters):
        column = values[:, j]
        known = np.isfinite(column)
        passed = lfilter(a, [1.0], np.where(known, column, 0.0), axis=0)
        rows = known if column.ndim == 1 else known.all(axis=1)
        whole = lfilter(np.ones(len(a)), [1.0], (~rows).astype(float)) < 0.5
        whole[: len(a) - 1] = False
        passed[~whole] = np.nan
        out[:, j] = passed
    return out
