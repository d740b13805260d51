"""What every source of a flow angle needs of one log, on common times; and how flow is carried."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from alula.aircraft import Aircraft
from alula.airdata.angles import on_grid
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.base.project import Project
from alula.flight import Channel, Flight

RATE = 50.0  # Hz of the common times, at most
SLOWEST = 5.0  # m/s: below it the aircraft stands on the ground
HOLE = 0.5  # s: nothing is drawn through a longer one
INERTIAL = ("ax", "ay", "az", "p", "q", "r")
_BASES = ("ax", "alpha", "beta", "beta_flank", "V")


@dataclass(frozen=True)
class Board:
    """One log. t (n,): the common times, in flight; V (n,) m/s, NaN in holes; rates (n, 3) rad/s,
    zero where the log has none.
    """

    project: Project
    aircraft: Aircraft | None
    flight: Flight
    t: Array
    V: Array
    rates: Array

    @property
    def V_filled(self) -> Array:
        """V (n,) with holes bridged, for what depends on it weakly; NaN without any."""
        good = np.isfinite(self.V)
        return np.interp(self.t, self.t[good], self.V[good]) if good.any() else self.V

    def arm(self, channel: str) -> Array:
        """Where its sensor sits from the center of gravity, (3,) m."""
        return arm_of(self.aircraft, channel)

    def sensors(self, *names: str) -> list[str]:
        """Channels of these names and of second sensors, as 'alpha_2', that have numbers."""
        found = [n for n in self.flight.channels if re.sub(r"_\d+$", "", n) in names]
        return sorted(n for n in found if _numbers(self.flight[n]))

    def has(self, *names: str) -> bool:
        """Whether all these channels are there, with numbers."""
        return all(n in self.flight and _numbers(self.flight[n]) for n in names)

    def need(self, what: str, *names: str) -> None:
        """Refuse where one of these channels is not there, or has no number."""
        missing = [n for n in names if not self.has(n)]
        if missing:
            raise refuse(
                "missing_channel",
                where=f"log {self.flight.id}, {what}",
                expected=", ".join(names),
                found="no " + ", ".join(missing),
                do="Map them in [channels] if they were recorded.",
            )

    def on(self, name: str, t: Array) -> Array:
        """A channel (k,) at times t, straight between its samples, NaN in holes and outside."""
        return samples(self.flight[name], t)

    def columns(self, names: tuple[str, ...], t: Array) -> Array:
        """Several of them, (k, m)."""
        return np.column_stack([self.on(n, t) for n in names])

    def fresh(self, name: str) -> Array:
        """A channel at the common times, at those next to one of its samples only."""
        return on_grid(self.t, self.flight[name].t, self.flight[name].values)

    def sigma(self, channel: str) -> float | None:
        """The project's standard deviation of a sensor, SI."""
        for sensors in (self.project.navigate.sensors, self.project.reconstruct.sensors):
            if channel in sensors and sensors[channel].sigma_si is not None:
                return sensors[channel].sigma_si
        return None

    @property
    def inertial_times(self) -> Array:
        """Times of the inertial sensor (m,) from the first to the last common time."""
        return _within(self.flight["ax"].t, float(self.t[0]), float(self.t[-1]))


def board_of(
    project: Project,
    aircraft: Aircraft | None,
    flight: Flight,
    start: float | None = None,
    end: float | None = None,
) -> Board:
    """Common times are the inertial sensor's, else the vane's, thinned to RATE, in flight.

    Raises BadInput where the log has neither inertial sensors nor a flow angle, or does not fly in
    that part.
    """
    base = next((n for n in _BASES if n in flight), None)
    t = np.zeros(0) if base is None else _within(flight[base].t, start, end)
    found = "no such channel" if base is None else f"{len(t)} samples of {base}"
    V = np.zeros(0)
    if len(t) > 1:
        every = max(1, int(np.ceil(1.0 / (RATE * float(np.median(np.diff(t)))) - 1e-6)))
        t = t[::every]
        V = samples(flight["V"], t) if "V" in flight else np.full(len(t), np.nan)
        if "V" in flight:
            with np.errstate(invalid="ignore"):
                stands = V <= SLOWEST  # a pitot tube that fell silent does not stand
                fast = int(np.sum(V > SLOWEST))
            found += f", {fast} above {SLOWEST:g} m/s"
            t, V = (t[~stands], V[~stands]) if fast else (t[:0], V[:0])
    if len(t) < 2:
        raise refuse(
            "no_angles",
            where=f"log {flight.id}",
            expected="alpha or beta, or inertial sensors with V, in flight",
            found=found,
            do="Map them in [channels], and see --start and --end.",
        )
    none = np.zeros(len(t))
    rates = [np.nan_to_num(samples(flight[n], t)) if n in flight else none for n in ("p", "q", "r")]
    return Board(
        project, aircraft, flight, frozen(t), frozen(V), frozen(np.column_stack(rates)),
    )  # fmt: skip


def samples(channel: Channel, t: Array) -> Array:
    """A channel (k,) at times t, straight between its samples, NaN in holes and outside."""
    good = np.isfinite(channel.values)
    at, values = channel.t[good], channel.values[good]
    if len(channel.t) == 1 and len(at) == 1:
        return np.full(len(t), values[0])
    if len(at) < 2:
        return np.full(len(t), np.nan)
    if channel.name == "psi":
        values = np.unwrap(values)
    out = np.interp(t, at, values, left=np.nan, right=np.nan)
    after = np.clip(np.searchsorted(at, t), 1, len(at) - 1)
    out[at[after] - at[after - 1] > max(HOLE, 1.5 * float(np.median(np.diff(at))))] = np.nan
    return out


def arm_of(aircraft: Aircraft | None, channel: str) -> Array:
    """Where a channel's sensor sits from the center of gravity, (3,) m; at it without [mass]."""
    if aircraft is None or aircraft.mass is None:
        return np.zeros(3)
    center = aircraft.mass_properties(np.zeros(1)).cg[0]
    return np.asarray(aircraft.sensor_position(channel) - center)


def velocity(V: Array | float, alpha: Array, beta: Array) -> Array:
    """(n, 3) in body axes."""
    return np.column_stack(
        [V * np.cos(alpha) * np.cos(beta), V * np.sin(beta), V * np.sin(alpha) * np.cos(beta)]
    )


def carried(V: Array, alpha: Array, beta: Array, rates: Array, arm: Array) -> tuple[Array, Array]:
    """alpha, beta (n,) at a place `arm` (3,) m away from where they are given."""
    if not np.any(arm):
        return alpha, beta
    v = velocity(V, alpha, beta) + np.cross(rates, arm)
    with np.errstate(invalid="ignore", divide="ignore"):
        side = np.arcsin(np.clip(v[:, 1] / np.linalg.norm(v, axis=1), -1.0, 1.0))
        return np.arctan2(v[:, 2], v[:, 0]), np.asarray(side)


def _within(t: Array, start: float | None, end: float | None) -> Array:
    low, high = -np.inf if start is None else start, np.inf if end is None else end
    return t[(t >= low) & (t <= high)]


def _numbers(channel: Channel) -> bool:
    return bool(np.isfinite(channel.values).any())
