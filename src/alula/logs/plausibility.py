"""Values that cannot be what the project says they are: asked, not assumed.

Each rule looks at the bulk of a channel, not at single samples, and refuses with the line to
write. `confirmed = true` for a channel turns the refusal into a warning.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, warn
from alula.base.project import ChannelSpec, LogSpec
from alula.flight import Channel
from alula.logs.airspeed import airspeed
from alula.logs.height import heights
from alula.logs.incidence import flow_angles
from alula.logs.still import resting
from alula.logs.unit_message import other_unit_message


@dataclass(frozen=True)
class Doubt:
    """Why a channel cannot be right and what to write if so."""

    code: str
    expected: str
    found: str
    do: str


Rule = Callable[[Array], Doubt | None]


def _bulk(values: Array) -> float:
    """The 99.9 percentile of the magnitude: high, and not moved by a few spikes."""
    return float(np.quantile(np.abs(values), 0.999))


def _limit(most: float, unit: str, looks: str) -> Rule:
    def rule(x: Array) -> Doubt | None:
        top = _bulk(x)
        if top <= most:
            return None
        return Doubt(
            "unit_implausible",
            f"values within {most:.3g} {unit}",
            f"up to {top:.4g} {unit}: it looks like {looks}",
            f"If so, write unit = '{looks}'.",
        )

    return rule


def _middle(low: float, high: float, unit: str, looks: Mapping[str, tuple[float, float]]) -> Rule:
    def rule(x: Array) -> Doubt | None:
        value = float(np.median(x))
        if low <= value <= high:
            return None
        guess = [u for u, (a, b) in looks.items() if a <= value <= b]
        hint = f"If so, write unit = '{guess[0]}'." if guess else "Correct source or unit."
        found = f"a median of {value:.4g} {unit}"
        found += f": it looks like {guess[0]}" if guess else ""
        return Doubt("unit_implausible", f"{low:g} to {high:g} {unit}", found, hint)

    return rule


def _vertical(x: Array) -> Doubt | None:
    """Specific force along z, most of a flight near -9.81 m/s2."""
    value = float(np.median(x))
    expected = "a median near -9.81 m/s2 (specific force, z down)"
    if 0.5 < abs(value) < 1.6:
        turn = " and sign = -1 (z points up)" if value > 0 else ""
        return Doubt(
            "unit_implausible",
            expected,
            f"{value:.3g}: it looks like g",
            f"If so, write unit = 'g'{turn}.",
        )
    if 22.0 < abs(value) < 45.0:
        return Doubt(
            "unit_implausible",
            expected,
            f"{value:.3g}: it looks like ft/s2",
            "If so, write unit = 'ft/s2'" + (" and sign = -1." if value > 0 else "."),
        )
    if 60.0 < abs(value) < 150.0:
        return Doubt(
            "unit_implausible",
            expected,
            f"{value:.3g}: it looks like m/s2 taken for g",
            "If so, write unit = 'm/s2'" + (" and sign = -1." if value > 0 else "."),
        )
    if abs(value) < 0.3:
        return Doubt(
            "gravity_removed",
            expected,
            f"{value:.2g} m/s2: it looks as if gravity was taken out",
            "If so, put it back: offset = -1 with unit 'g', before sign; or -9.81 with 'm/s2'.",
        )
    if value > 5.0:
        return Doubt(
            "axes_z_up",
            expected,
            f"{value:+.3g} m/s2: the z axis points up",
            "Write sign = -1 for az; then y (ay, q, r) of that frame may point left as well.",
        )
    return None


_RATE = _limit(10.0, "rad/s", "deg/s")
_HALF_CIRCLE = _limit(math.pi / 2 + 0.05, "rad", "deg")
_CIRCLE = _limit(2 * math.pi + 0.05, "rad", "deg")


def _incidence(x: Array) -> Doubt | None:
    """A vane on the ground points anywhere, so the median counts besides the circle."""
    middle = float(np.median(np.abs(x)))
    if middle <= 0.8:
        return _CIRCLE(x)
    return Doubt(
        "unit_implausible",
        "an angle of attack under 0.8 rad (46 deg) most of the time",
        f"a median magnitude of {middle:.3g} rad: it looks like deg",
        "If so, write unit = 'deg'.",
    )


RULES: dict[str, Rule] = {
    "az": _vertical,
    **dict.fromkeys(("ax", "ay"), _limit(150.0, "m/s2", "ft/s2")),
    **dict.fromkeys(("p", "q", "r"), _RATE),
    **dict.fromkeys(("pdot", "qdot", "rdot"), _limit(200.0, "rad/s2", "deg/s2")),
    **dict.fromkeys(("theta", "lat", "beta"), _HALF_CIRCLE),
    "alpha": _incidence,
    **dict.fromkeys(("phi", "psi", "psi_mag", "lon", "beta_flank"), _CIRCLE),
    "V": _limit(1000.0, "m/s", "ft/s or km/h"),
    "climb_rate": _limit(300.0, "m/s", "ft/min"),
    **dict.fromkeys(
        ("fuel_flow", "fuel_flow_left", "fuel_flow_right"), _limit(30.0, "kg/s", "lb/h")
    ),
    "mach": _limit(10.0, "", "%"),
    "dt": _limit(2.0, "", "%"),
    "rho": _middle(0.01, 2.0, "kg/m3", {"slug/ft3": (1e-5, 0.004)}),
    "temperature": _middle(170.0, 340.0, "K", {"degC": (-90, 60), "degF": (-120, 140)}),
    "pressure": _middle(1e3, 1.1e5, "Pa", {"hPa": (150, 1100), "kPa": (5, 110), "inHg": (1, 33)}),
}
_CONTROL = _HALF_CIRCLE


def check(
    log: LogSpec, specs: Mapping[str, ChannelSpec], channels: Mapping[str, Channel]
) -> list[Message]:
    """Warnings about the channels; raises BadInput where a unit or an axis cannot be right."""
    messages, problems = [], []
    for name, channel in channels.items():
        spec = specs[name]
        if spec.constant is not None:
            continue
        values = channel.values[np.isfinite(channel.values)]
        where = f"{log.path}: channel {name}"
        doubt = doubt_of(name, channel.unit, values)
        if doubt is not None:
            if spec.confirmed:
                said = warn(
                    doubt.code,
                    where=where,
                    expected=doubt.expected,
                    found=f"{doubt.found}; the project says 'confirmed'",
                    do="Nothing, if you are sure.",
                )
                messages.append(said)
            else:
                do = f"{doubt.do} If it is right as it is, write confirmed = true."
                problems.append(
                    Message(doubt.code, "error", where, doubt.expected, doubt.found, do)
                )
        messages += resting(name, where, channel)
    problems += _times(log, specs, channels)
    for angle, rate in (("phi", "p"), ("theta", "q")):
        if angle in channels and rate in channels:
            confirmed = specs[angle].confirmed or specs[rate].confirmed
            told = _agree(log, channels[angle], channels[rate])
            if told is not None:
                if confirmed:
                    told = replace(told, level="warning")
                (problems if told.level == "error" else messages).append(told)
    if not problems:
        for told in (*heights(log, specs, channels), *flow_angles(log, specs, channels)):
            (problems if told.level == "error" else messages).append(told)
    if not problems:  # a wrong unit elsewhere would be taken for V's
        told = airspeed(log, specs, channels)
        if told is not None:
            (problems if told.level == "error" else messages).append(told)
    if problems:
        raise BadInput(*problems)
    return messages


def doubt_of(name: str, unit: str, values: Array) -> Doubt | None:
    """Why finite SI values (n,) cannot be those of the channel `name`; None if they can."""
    base = name.rstrip("0123456789").rstrip("_") if name[-1:].isdigit() else name
    rule = RULES.get(base)
    if rule is None and base in ("de", "da", "dr", "df") and unit == "rad":
        rule = _CONTROL
    return rule(values) if rule and len(values) else None


def _times(
    log: LogSpec, specs: Mapping[str, ChannelSpec], channels: Mapping[str, Channel]
) -> list[Message]:
    """A median interval of five seconds or more: the stamps look like ms, us or ns."""
    if "t" in specs and specs["t"].confirmed:
        return []
    for channel in channels.values():
        if len(channel.t) < 3:
            continue
        dt = float(np.median(np.diff(channel.t)))
        looks = next((u for u, m in (("ns", 1e6), ("us", 5e2), ("ms", 5.0)) if dt >= m), None)
        if looks:
            found = f"a sample every {dt:.4g} s"
            return [other_unit_message(log, "t", "intervals under 5 s", found, looks)]
    return []


def _agree(log: LogSpec, angle: Channel, rate: Channel) -> Message | None:
    """Compare the changes of an attitude angle with its rate integrated, over half a second each.

    For moderate attitudes d(phi)/dt is about p and d(theta)/dt about q; a slope of 57 or 1/57 is
    degrees taken for radians, a negative one a sign.
    """
    a, r = np.isfinite(angle.values), np.isfinite(rate.values)
    if a.sum() < 20 or r.sum() < 20:
        return None
    t, x = rate.t[r], rate.values[r]
    integral = np.concatenate(([0.0], np.cumsum(0.5 * (x[1:] + x[:-1]) * np.diff(t))))
    start, end = max(t[0], angle.t[a][0]), min(t[-1], angle.t[a][-1])
    if not 4.0 <= end - start <= 500_000.0:  # s; stamps in another unit may span ages
        return None
    grid = np.arange(start, end, 0.5)
    turned = np.diff(np.interp(grid, t, integral))
    changed = np.diff(np.interp(grid, angle.t[a], angle.values[a]))
    level = np.abs(changed) < 3.0  # a heading or bank that wraps around is no change
    turned, changed = turned[level], changed[level]
    if len(turned) < 8 or np.std(turned) == 0 or np.std(changed) == 0:
        return None
    correlation = float(np.corrcoef(turned, changed)[0, 1])
    slope = float(np.std(changed) / np.std(turned))
    where = f"{log.path}: channels {angle.name}, {rate.name}"
    expected = f"{angle.name} to change as {rate.name} integrated"
    if abs(correlation) > 0.7 and not 1 / 25 < slope < 25:
        which = f"{angle.name} in deg" if slope > 1 else f"{rate.name} in deg/s"
        return Message(
            "unit_implausible",
            "error",
            where,
            expected,
            f"{slope:.3g} times as much: it looks like {which}",
            "Correct the unit of one of them. If it is right as it is, write confirmed = true.",
        )
    if correlation < -0.7:
        return warn(
            "sign_contradiction",
            where=where,
            expected=expected,
            found=f"the opposite sign (correlation {correlation:.2f})",
            do=f"Write sign = -1 for {angle.name} or {rate.name}, whichever is not Alula's.",
        )
    return None
