"""ARM-Hawk in flight: angles of the probe against the recorded state, and the wind over halves.

Real data (Pusztai 2018), airborne from 35 to 432 s; there is no inertial recording. The wind comes
from position and airspeed alone, with the airspeed's scale error solved along: the recorded heading
is off by tens of degrees at times, so no attitude is used. From 90 to 150 s it stood on the ground.
"""

from __future__ import annotations

import h5py
import numpy as np
from scipy.io import loadmat

from alula.airdata.inflight import calibrate_in_flight
from alula.airdata.inflight_record import AirDataRecord
from alula.airdata.inflight_result import InFlightCalibration
from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.simulate import flow_angles
from verification.places import DATA

AIRBORNE = (35.0, 432.0)  # s
RATE, FLYING = 10.0, 10.0  # Hz; m/s, slower it is on the ground
SPEED, ANGLE = 0.04, 0.1  # m/s, deg: rms
APART = 3.0  # standard errors that the halves may differ by


def recorded() -> tuple[Array, Array]:
    """The state (n, 16) and the probe's t, u, v, w (m, 4)."""
    folder = DATA / "armhawk" / "flight"
    with h5py.File(folder / "state.mat", "r") as file:
        state = np.array(file["state"], dtype=np.float64)
    state = state if state.shape[1] == 16 else state.T
    return state, np.asarray(loadmat(folder / "v_rel_V.mat")["v_rel_V"], dtype=np.float64).T


def agreement() -> dict[str, float]:
    """Rms of probe less state over the flight: V m/s, angles deg."""
    state, probe = recorded()
    probe = probe[np.linalg.norm(probe[:, 1:], axis=1) > 0.0]  # no direction before the start
    inside = (state[:, 0] >= AIRBORNE[0]) & (state[:, 0] <= AIRBORNE[1])
    t = state[inside, 0]
    out = {}
    for k, (name, values) in enumerate(
        zip(("V", "alpha", "beta"), flow_angles(probe[:, 1:]), strict=True)
    ):
        off = np.interp(t, probe[:, 0], values) - state[inside, (9, 7, 8)[k]]
        out[name] = float(np.sqrt(np.mean(off**2))) * (1.0 if name == "V" else 180.0 / np.pi)
    return out


def record(start: float, end: float) -> AirDataRecord:
    """The probe's airspeed and the slope of the position between two times."""
    state, probe = recorded()
    t = np.arange(start, end, 1.0 / RATE)
    cubic = LocalCubic(state[:, 0], 1.0)
    readings = {
        name: np.interp(t, state[:, 0], cubic.derivative(state[:, 1 + k]))
        for k, name in enumerate(("v_north", "v_east", "v_down"))
    }
    for name in ("phi", "theta", "psi"):
        readings[name] = np.zeros(len(t))  # the length of a velocity needs none
    probe = probe[np.linalg.norm(probe[:, 1:], axis=1) > 1.0]
    V = np.interp(t, probe[:, 0], np.linalg.norm(probe[:, 1:], axis=1))
    readings["V"] = np.where(V > FLYING, V, np.nan)
    return AirDataRecord(t, readings)


def wind(start: float, end: float) -> InFlightCalibration:
    """Wind and airspeed scale between two times; the slope of the position is no good GPS."""
    return calibrate_in_flight(record(start, end), white=False)


def winds() -> dict[str, InFlightCalibration]:
    """The calibration of the whole flight and of its halves."""
    start, end = AIRBORNE[0] + 5.0, AIRBORNE[1] - 5.0
    middle = 0.5 * (start + end)
    return {
        "whole": wind(start, end),
        "first half": wind(start, middle),
        "second half": wind(middle, end),
    }


def check(quick: bool = False) -> tuple[str, bool]:
    """Figures in words, and whether they hold."""
    rms = agreement()
    good = rms["V"] <= SPEED and rms["alpha"] <= ANGLE and rms["beta"] <= ANGLE
    words = [f"rms V {rms['V']:.3f} m/s, alpha {rms['alpha']:.3f}°, beta {rms['beta']:.3f}°"]
    found = winds()
    for name, one in found.items():
        n, e = one["wind_north"], one["wind_east"]
        good &= n.verdict != "not_identifiable" and e.verdict != "not_identifiable"
        words.append(
            f"wind, {name}: {n.value:.2f} ± {n.se:.2f} m/s north, {e.value:.2f} ± {e.se:.2f} east"
        )
    apart = [
        abs(a.value - b.value) / np.hypot(a.se, b.se)
        for a, b in (
            (found["first half"][k], found["second half"][k]) for k in ("wind_north", "wind_east")
        )
    ]
    scale = found["whole"]["k_V"]
    words.append(f"halves {apart[0]:.1f} and {apart[1]:.1f} standard errors apart")
    words.append(f"airspeed scale {scale.value:+.3f} ± {scale.se:.3f}")
    return "; ".join(words), bool(good and max(apart) <= APART)
