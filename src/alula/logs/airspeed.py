"""The airspeed against what else the log knows of it: knots taken for m/s, or the other way.

Pressure, Mach number and calibrated airspeed give it directly. Where there is none of them the
aircraft's own motion does: the velocity through the air changes by the specific force, gravity and
the turning of the axes (Etkin 1972, Eq. 5.6,2), in which everything but force and gravity grows
with V. Velocity over ground tells it less the wind.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.base.project import ChannelSpec, LogSpec
from alula.base.units import G0, to_si
from alula.flight import Channel
from alula.logs.changes import at, integral, together
from alula.logs.unit_message import other_unit_message

UNITS = ("m/s", "kt", "km/h", "ft/s")
FAR = 0.45  # of the ratio's logarithm: 1.57; kt for m/s is 1.94, an upwash or a wind less
NEAR = 0.3  # from the ratio of a unit
ALIKE = 0.9  # correlation of the motion's two accounts
WINDOW = 0.5  # s over which changes are compared: sensors' noise is small against them
STRONG = 20.0  # m/s, of wind: below, it may be what it is
TURNED = 0.3  # spread of the headings' cosines and sines above which wind and airspeed part
_R, _GAMMA = 287.053, 1.4
_SEA_LEVEL = 1.225


@dataclass(frozen=True)
class Other:
    """The unit that V's numbers look recorded in, by what; both median airspeeds, m/s."""

    unit: str
    by: str
    stated: float
    true: float


def airspeed(
    log: LogSpec, specs: Mapping[str, ChannelSpec], channels: Mapping[str, Channel]
) -> Message | None:
    """An error that names the other unit of V; a warning where the project confirms V."""
    if "V" not in channels or specs["V"].constant is not None:
        return None
    other = other_unit(channels, specs["V"].unit or "m/s")
    if other is None:
        return None
    return other_unit_message(
        log,
        "V",
        f"an airspeed of about {other.true:.3g} m/s, by {other.by}",
        f"{other.stated:.3g} m/s",
        other.unit,
        confirmed=specs["V"].confirmed,
    )


def other_unit(channels: Mapping[str, Channel], stated: str) -> Other | None:
    """What V looks recorded in, where an account of it contradicts `stated`."""
    V = channels["V"]
    good = np.isfinite(V.values)
    if good.sum() < 20:
        return None
    t, speed = V.t[good], V.values[good]
    flying = speed > 0.5 * float(np.quantile(speed, 0.95))
    if not flying.any() or float(np.median(speed[flying])) < 1.0:
        return None
    t, speed = t[flying], speed[flying]
    middle = float(np.median(speed))
    for words, ratio in _accounts(t, speed, channels):
        if math.isfinite(ratio):
            unit = _unit(ratio, to_si(stated).scale)
            if unit and abs(math.log(ratio)) > FAR:
                return Other(unit, words, middle, ratio * middle)
    return None


def _unit(ratio: float, scale: float) -> str:
    """The unit that the numbers would have been recorded in; '' where none fits."""
    if ratio <= 0.0:
        return ""
    off = {u: abs(math.log(to_si(u).scale / (ratio * scale))) for u in UNITS}
    best = min(off, key=lambda u: off[u])
    return best if off[best] < NEAR else ""


def _accounts(t: Array, V: Array, channels: Mapping[str, Channel]) -> Iterator[tuple[str, float]]:
    """What tells the airspeed, in words, and the true one over the recorded one by it."""

    rho, temperature, pressure, height, qbar, mach = (
        at(channels, n, t) for n in ("rho", "temperature", "pressure", "h", "qbar", "mach")
    )
    if rho is None and pressure is not None and temperature is not None:
        rho = pressure / (_R * temperature)
    if rho is None and height is not None:
        rho = _SEA_LEVEL * np.clip(1.0 - 2.2558e-5 * height, 0.05, 2.0) ** 4.2559
    if temperature is None and height is not None:
        temperature = np.clip(288.15 - 0.0065 * height, 216.65, None)
    if qbar is not None and rho is not None:
        yield "qbar and density", _ratio(np.sqrt(2.0 * np.clip(qbar, 0.0, None) / rho), V)
    if mach is not None and temperature is not None:
        yield "mach and temperature", _ratio(mach * np.sqrt(_GAMMA * _R * temperature), V)
    for name in ("V_cas", "V_ias"):
        other = at(channels, name, t)
        if other is not None and rho is not None:
            yield name, _ratio(other * np.sqrt(_SEA_LEVEL / rho), V)
    yield "the change of motion that accelerometers and gyros recorded", _by_motion(channels)
    yield from _over_ground(t, V, channels)


def _ratio(other: Array, V: Array) -> float:
    use = np.isfinite(other) & (other > 0.0)
    return float(np.median(other[use] / V[use])) if use.sum() >= 20 else math.nan


def _by_motion(channels: Mapping[str, Channel]) -> float:
    """The ratio from the equations of the velocity sideways and down, integrated over windows.

    Of the two the one whose sides go together better; a vane far out on the wing, whose angle
    follows the roll, parts them. Along the axis forward the airspeed's own noise does.
    """
    names = ("ay", "az", "p", "q", "r", "phi", "theta", "alpha", "V")
    if any(n not in channels for n in names):
        return math.nan
    V = channels["V"]
    base = max((channels[n] for n in ("az", "q", "alpha")), key=lambda c: len(c.t))
    begin = max(float(channels[n].t[0]) for n in names)
    end = min(float(channels[n].t[-1]) for n in names)
    t = base.t[(base.t >= begin) & (base.t <= end)]
    if len(t) < 50 or end - begin < 10.0 * WINDOW:
        return math.nan
    got = {n: at(channels, n, t, angle=n == "phi") for n in (*names, "beta")}
    if any(got[n] is None for n in names):
        return math.nan
    ay, az, p, q, r, phi, theta, alpha, speed = (np.asarray(got[n]) for n in names)
    beta = np.zeros(len(t)) if got["beta"] is None else np.asarray(got["beta"])
    u = speed * np.cos(alpha) * np.cos(beta)
    v, w = speed * np.sin(beta), speed * np.sin(alpha) * np.cos(beta)
    force = (ay + G0 * np.sin(phi) * np.cos(theta), az + G0 * np.cos(phi) * np.cos(theta))
    turning = (r * u - p * w, p * v - q * u)
    grid = np.arange(float(t[0]), float(t[-1]), WINDOW)
    whole = _covered(V.t[np.isfinite(V.values)], grid)
    if whole.sum() < 10:
        return math.nan
    best, ratio = ALIKE, math.nan
    for f, turn, side in zip(force, turning, (v, w), strict=True):
        y = np.diff(np.interp(grid, t, integral(t, f)))[whole]
        x = np.diff(np.interp(grid, t, integral(t, turn) + side))[whole]
        alike, size = together(y, x)
        if alike > best:
            best, ratio = alike, size
    return ratio


def _covered(t: Array, grid: Array) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Whether each window of the grid has samples."""
    counts = np.searchsorted(t, grid)
    return np.array([b > a for a, b in pairwise(counts.tolist())], dtype=bool)


def _over_ground(
    t: Array, V: Array, channels: Mapping[str, Channel]
) -> Iterator[tuple[str, float]]:
    """By velocity over ground: with the wind where the flight turned, else where it would blow
    beyond reason."""
    north, east, psi = (at(channels, n, t, n == "psi") for n in ("v_north", "v_east", "psi"))
    if north is None or east is None or psi is None:
        return
    ahead = np.column_stack([np.cos(psi), np.sin(psi)])
    ground = np.column_stack([north, east])
    if float(np.min(np.std(ahead, axis=0))) > TURNED:
        matrix = np.zeros((2 * len(t), 3))
        matrix[0::2, 0], matrix[1::2, 0] = V * ahead[:, 0], V * ahead[:, 1]
        matrix[0::2, 1] = matrix[1::2, 2] = 1.0
        found, *_ = np.linalg.lstsq(matrix, ground.reshape(-1), rcond=None)
        yield "v_north, v_east and psi, whatever the wind", float(found[0])
        return
    wind = {
        k: float(np.median(np.hypot(*(ground - k * V[:, None] * ahead).T)))
        for k in (1.0, *(to_si(a).scale / to_si(b).scale for a in UNITS for b in UNITS))
    }
    best = min(wind, key=lambda k: wind[k])
    if wind[1.0] > STRONG and wind[best] < 0.4 * wind[1.0]:
        words = f"v_north, v_east and psi, unless the wind blew {wind[1.0]:.0f} m/s"
        yield words, best
