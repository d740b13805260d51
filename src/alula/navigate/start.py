"""Where to start: attitude from gravity and field, velocity and position from the satellites."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.navigate.attitude import attitude_from_vectors, gravity_seen
from alula.navigate.result import quaternion, rotations
from alula.navigate.samples import Inertial, Readings

SPAN = 1.0  # s of samples that are looked at
UNKNOWN = 1.8  # rad: of a heading that may be any, pi over the root of 3
TILT = 0.15  # rad: what turbulence leaves of a second's mean gravity
DRIFT = 0.5  # rad: of a heading taken from the course over ground


@dataclass(frozen=True)
class Start:
    """State at time t, s, and its standard deviations.

    euler: phi theta psi, rad; velocity, position, wind: NED. The wind should agree with the others
    and the first air data; see `first_state`. sigma_tilt,
    sigma_heading: rad, of bank and pitch and about the vertical; the others in SI.
    """

    t: float
    euler: tuple[float, float, float]
    velocity: Array
    position: Array
    wind: Array = field(default_factory=lambda: frozen(np.zeros(3)))
    sigma_tilt: float = 0.1
    sigma_heading: float = 0.3
    sigma_velocity: float = 1.0
    sigma_position: float = 5.0
    sigma_gyro_bias: float = 0.01
    sigma_force_bias: float = 0.1
    sigma_wind: float = 10.0
    sigma_height_bias: float = 5.0

    def state(self) -> Array:
        """q, velocity, position, wind (13,)."""
        return np.concatenate([quaternion(*self.euler), self.velocity, self.position, self.wind])


def first_state(
    inertial: Inertial,
    readings: Sequence[Readings],
    field_E: Array | None = None,
    gravity: float = 9.80665,
    heading: float | None = None,
) -> tuple[Start, tuple[Message, ...]]:
    """A start from the first second: bank and pitch from the mean specific force less what a turn
    at the first airspeed (or ground speed) adds, heading from the
    field, else as given, else from the course over ground, else unknown.

    field_E: (3,) T, NED. heading: rad. Raises BadInput where no inertial sample is a number.
    """
    t = inertial.t
    good = np.isfinite(t) & np.isfinite(inertial.force).all(axis=1)
    if not good.any():
        raise refuse(
            "no_inertial_sample",
            where="navigation, start",
            expected="specific force",
            found="no sample that is a number",
            do="Check the channels ax, ay, az.",
        )
    t0 = float(t[good][0])
    now = good & (t <= t0 + SPAN)
    by_kind = {r.kind: _mean(r, t0) for r in reversed(readings)}
    velocity, airspeed = by_kind.get("velocity"), by_kind.get("V")
    ahead = 0.0 if velocity is None else float(np.linalg.norm(velocity))
    ahead = ahead if airspeed is None else float(airspeed[0])
    rate = np.nan_to_num(np.nanmean(inertial.rate[now], axis=0))
    gravity_B = gravity_seen(
        np.mean(inertial.force[now], axis=0), rate, np.array([max(ahead, 0.0), 0.0, 0.0])
    )
    position = by_kind.get("position")
    seen = by_kind.get("field")
    messages: list[Message] = []
    sigma_heading = UNKNOWN
    if seen is not None and field_E is not None:
        found = attitude_from_vectors(gravity_B[None], seen[None], field_E, gravity)
        euler = tuple(found.euler[0])
        if found.heading[0]:
            euler = tuple(_along_field(gravity_B, seen, field_E))
        # the dip turns an error of bank into one of heading
        dip = abs(float(field_E[2])) / max(float(np.hypot(field_E[0], field_E[1])), 1e-12)
        sigma_heading = min(float(np.hypot(0.1, TILT * dip)), UNKNOWN)
        sigma_heading = sigma_heading if found.heading[0] else UNKNOWN
    else:
        euler = (
            float(np.arctan2(gravity_B[1], gravity_B[2])),
            float(np.arctan2(-gravity_B[0], np.hypot(gravity_B[1], gravity_B[2]))),
            0.0,
        )
    if sigma_heading == UNKNOWN and heading is not None and np.isfinite(heading):
        euler = (euler[0], euler[1], heading)
        sigma_heading = 0.1
    if sigma_heading == UNKNOWN and velocity is not None and np.hypot(*velocity[:2]) > 5.0:
        euler = (euler[0], euler[1], float(np.arctan2(velocity[1], velocity[0])))
        sigma_heading = DRIFT
    if sigma_heading == UNKNOWN:
        messages.append(
            warn(
                "unknown_heading",
                where="navigation, start",
                expected="a magnetic field or a course over ground in the first second",
                found="neither",
                do="If the flight turns, nothing: the heading is found when it speeds up.",
            )
        )
    wind = np.zeros(3)
    if "V" in by_kind and velocity is not None:
        wind = _wind(by_kind, velocity, euler)
    height, off = by_kind.get("height"), 0.0
    if height is not None and position is None:  # counted from where it starts
        position = np.array([0.0, 0.0, -float(height[0])])
    elif height is not None and position is not None:  # two datums: the barometer is off by it
        off = float(height[0] + position[2])
    start = Start(
        t=t0,
        euler=(float(euler[0]), float(euler[1]), float(euler[2])),
        velocity=np.zeros(3) if velocity is None else velocity,
        position=np.zeros(3) if position is None else position,
        wind=wind,
        sigma_tilt=TILT,
        sigma_heading=sigma_heading,
        sigma_velocity=20.0 if velocity is None else 1.0,
        sigma_position=1000.0 if position is None else 10.0,
        sigma_height_bias=5.0 + abs(off),
    )
    return start, tuple(messages)


def _along_field(gravity_B: Array, field_B: Array, field_E: Array) -> Array:
    """phi theta psi (3,): the field exactly as seen, gravity for the turn about it alone. What is
    wrong with gravity then stays where the magnetometer says nothing.
    """

    def base(field: Array, gravity: Array) -> Array:
        first = field / np.linalg.norm(field)
        second = np.cross(first, gravity)
        second = second / np.linalg.norm(second)
        return np.column_stack([first, second, np.cross(first, second)])

    R = base(field_B, gravity_B) @ base(field_E, np.array([0.0, 0.0, 1.0])).T
    theta = np.arctan2(-R[0, 2], np.hypot(R[0, 0], R[0, 1]))
    return np.array([np.arctan2(R[1, 2], R[2, 2]), theta, np.arctan2(R[0, 1], R[0, 0])])


def _wind(seen: Mapping[str, Array | None], velocity: Array, euler: Sequence[float]) -> Array:
    """Wind that agrees with the first readings; level flight where there are no flow angles."""

    def of(name: str, without: float) -> float:
        value = seen.get(name)
        return without if value is None else float(value[0])

    V, alpha, beta = of("V", 0.0), of("alpha", float(euler[1])), of("beta", 0.0)
    if not V > 0.0:
        return np.zeros(3)
    air = V * np.array([np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)])
    R = rotations(quaternion(*euler)[None])[0]
    # up and down the air stands nearly still; a first pitch is known less well than that
    return np.asarray((velocity - R.T @ air) * [1.0, 1.0, 0.0])


def _mean(r: Readings, t0: float) -> Array | None:
    """Mean of the readings in the first second; where none is, the first that is a number."""
    values = np.asarray(r.values, dtype=np.float64).reshape(len(r.values), -1)
    good = np.isfinite(values).all(axis=1)
    now = good & (r.t >= t0 - SPAN) & (r.t <= t0 + SPAN)
    if r.kind == "position" and now.any():  # what moves is not averaged
        return np.asarray(values[now][0])
    return np.asarray(values[now].mean(axis=0)) if now.any() else None
