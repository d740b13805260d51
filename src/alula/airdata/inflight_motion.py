"""The motion that foretells the air data, free of the noise of GPS and attitude.

Noise in what foretells draws scale errors toward -1: the vanes then seem to turn too little. With
accelerometers and gyros the motion between the GPS's samples is theirs: what GPS (attitude) and
the integral of the accelerations (rates) differ by drifts slowly, and only that drift is taken from
the GPS, smoothed over DRIFT seconds by local parabolas, forward and backward alike. Without them
the readings themselves are smoothed over PLAIN seconds, which leaves more noise.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.signal import savgol_filter

from alula.airdata.inflight_record import AirDataRecord
from alula.base.arrays import Array, frozen
from alula.base.messages import note

G = 9.80665
DRIFT, PLAIN = 8.0, 1.0  # s
RATE = 10.0  # Hz of the fit: faster, gusts and vane noise are all there is
INERTIAL = ("ax", "ay", "az", "p", "q", "r")
ATTITUDE, GROUND = ("phi", "theta", "psi"), ("v_north", "v_east", "v_down")


def prepared(record: AirDataRecord) -> tuple[AirDataRecord, float | None]:
    """The record at RATE or less with the motion smoothed, and the delay of the GPS, s.

    The delay is None where there are no accelerometers to tell it. Samples that were NaN stay so.
    """
    dt = float(np.median(np.diff(record.t)))
    raw = {name: np.asarray(values) for name, values in record.readings.items()}
    turned = np.isfinite(raw["psi"])
    raw["psi"] = np.array(raw["psi"])
    raw["psi"][turned] = np.unwrap(raw["psi"][turned])
    known = np.all([np.isfinite(raw[n]) for n in (*ATTITUDE, *GROUND)], axis=0)
    full = {n: _filled(record.t, raw[n]) for n in (*ATTITUDE, *GROUND, *INERTIAL) if n in raw}
    aided = all(n in full and np.isfinite(full[n]).all() for n in INERTIAL)
    delay = None
    if aided:
        rates = np.column_stack([full[n] for n in ("p", "q", "r")])
        for name, slope in zip(ATTITUDE, _euler_rates(full, rates), strict=True):
            full[name] = _blended(full[name], slope, dt)
        force = np.column_stack([full[n] for n in ("ax", "ay", "az")])
        if "imu" in record.arms:
            arm = np.asarray(record.arms["imu"])
            turning = np.gradient(rates, dt, axis=0)
            force = force - np.cross(turning, arm) - np.cross(rates, np.cross(rates, arm))
        # The GPS sits at its own place; its velocity is moved to the center of gravity first.
        swing = np.zeros_like(rates)
        if "gps" in record.arms:
            swing = to_earth(full, np.cross(rates, np.asarray(record.arms["gps"])))
        a = to_earth(full, force) + np.array([0.0, 0.0, G])
        ground = np.column_stack([full[n] for n in GROUND])
        delay = _delay(ground - swing, a, record.t, dt)
        late = np.column_stack([np.interp(record.t + delay, record.t, v) for v in ground.T])
        for k, name in enumerate(GROUND):
            full[name] = _blended(late[:, k] - swing[:, k], a[:, k], dt)
    else:
        for name in (*ATTITUDE, *GROUND):
            full[name] = _smooth(full[name], dt, PLAIN)
    if "h_gps" in raw:  # between its samples the height is the integral of the climb
        height = _filled(record.t, raw["h_gps"])
        if np.isfinite(height).all():
            raw["h_gps"] = np.where(
                np.isfinite(raw["h_gps"]),
                _blended(
                    np.interp(record.t + (delay or 0.0), record.t, height), -full["v_down"], dt
                ),
                np.nan,
            )
    for name in (*ATTITUDE, *GROUND):
        raw[name] = np.where(known, full[name], np.nan)
    arms = {k: v for k, v in record.arms.items() if not (aided and k == "gps")}
    message = note(
        "motion_smoothed",
        where="in-flight calibration",
        expected="GPS velocity and attitude without noise",
        found="recorded ones" + (", accelerometers and gyros" if aided else " alone"),
        do=(
            f"Blended with the inertial sensors over {DRIFT:g} s; GPS delay {delay:.3f} s removed."
            if aided
            else f"Smoothed over {PLAIN:g} s; map ax ay az p q r for estimates with less bias."
        ),
    )
    each = max(1, round(1.0 / (RATE * dt)))
    length = len(record.t) // each * each
    kept = {n: frozen(v[:length].reshape(-1, each).mean(axis=1)) for n, v in raw.items()}
    t = record.t[:length].reshape(-1, each).mean(axis=1)
    return (
        replace(record, t=t, readings=kept, arms=arms, messages=(*record.messages, message)),
        delay,
    )


def to_earth(angles: dict[str, Array], v_B: Array) -> Array:
    """R_EB v_B, (n, 3), of Euler angles in a table 'phi', 'theta', 'psi'."""
    sp, cp, st, ct, sy, cy = (f(angles[n]) for n in ATTITUDE for f in (np.sin, np.cos))
    x, y, z = v_B.T
    level = x * ct + (y * sp + z * cp) * st
    side = y * cp - z * sp
    return np.column_stack(
        [level * cy - side * sy, level * sy + side * cy, (y * sp + z * cp) * ct - x * st]
    )


def _euler_rates(full: dict[str, Array], rates: Array) -> tuple[Array, Array, Array]:
    p, q, r = rates.T
    phi, theta = full["phi"], full["theta"]
    turning = q * np.sin(phi) + r * np.cos(phi)
    cos = np.maximum(np.cos(theta), 0.05)  # near the vertical the drift takes it up
    return p + turning * np.sin(theta) / cos, q * np.cos(phi) - r * np.sin(phi), turning / cos


def _blended(slow: Array, slope: Array, dt: float) -> Array:
    fast = cumulative_trapezoid(slope, dx=dt, initial=0)
    return np.asarray(fast + _smooth(slow - fast, dt, DRIFT))


def _smooth(x: Array, dt: float, window: float) -> Array:
    width = min(2 * round(window / dt / 2.0) + 1, (len(x) - 1) // 2 * 2 + 1)
    return x if width < 5 else np.asarray(savgol_filter(x, width, 2))


def _delay(v: Array, a: Array, t: Array, dt: float) -> float:
    """How late v (n, 3) comes behind the integral of a (n, 3), s: least squares on what is fast."""
    fast = cumulative_trapezoid(a, dx=dt, axis=0, initial=0)
    total = 0.0
    for _ in range(4):
        late = np.column_stack([np.interp(t + total, t, x) for x in v.T])
        d, slope = late - fast, a
        d = d - np.column_stack([_smooth(x, dt, DRIFT / 2.0) for x in d.T])
        slope = slope - np.column_stack([_smooth(x, dt, DRIFT / 2.0) for x in slope.T])
        power = float(np.sum(slope**2))
        if power <= 0.0:
            break
        total = float(np.clip(total - np.sum(d * slope) / power, -1.0, 1.0))
    return total


def _filled(t: Array, x: Array) -> Array:
    good = np.isfinite(x)
    if np.sum(good) < 2:
        return x
    return np.interp(t, t[good], x[good])
