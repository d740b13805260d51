"""From the motion of the inertial sensor to the motion at the center of gravity.

Velocity: v_G = v_S + w x r. Specific force: f_G = f_S + wdot x r + w x (w x r), with r from the
sensor to the center of gravity (Dittrich 2016, Eq. (3.3), (3.4)). Air data follow from the air
velocity at the center of gravity.
"""

from __future__ import annotations

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.base.rotation import rotated
from alula.core import core
from alula.flight import Flight, Motion
from alula.reconstruct.problem import Problem
from alula.reconstruct.record import Record, channel_on
from alula.reconstruct.unknowns import INERTIAL, WIND
from alula.reconstruct.vibration import lowpass

CONTROLS = ("de", "da", "dr", "df", "dt")


class Transfer:
    """Turns states of one record into Motion; what does not depend on the states is done once."""

    def __init__(
        self,
        problem: Problem,
        record: Record,
        flight: Flight,
        aircraft: Aircraft,
        window_s: float,
        vibration_filter_hz: float = 0.0,
    ) -> None:
        self.problem, self.record = problem, record
        t = record.t[record.base]
        fuel = fuel_on(flight, t)
        position = (
            aircraft.reference_point[None, :]
            if aircraft.mass is None
            else aircraft.mass_properties(fuel if fuel is not None else np.zeros(len(t))).cg
        )
        self.arm = position - problem.position
        self.still = not np.any(self.arm)
        self.t, self.maneuver = t, record.maneuver
        self.cubic = LocalCubic(t, window_s)
        self.controls = controls_on(flight, aircraft, t)
        if vibration_filter_hz > 0.0:
            self.controls = {
                name: lowpass(t, values, vibration_filter_hz)
                for name, values in self.controls.items()
            }
        self.thrust = thrust_on(flight, aircraft, t)
        self.fuel_used = fuel
        self.recorded = recorded_on(flight, t)
        self.rho = channel_on(flight, "rho", t) if "rho" in flight else None

    def motion(self, states: Array) -> Motion:
        """Motion at the center of gravity from states (n, k) at the record's stamps."""
        problem, base = self.problem, self.record.base
        x = states[base]
        fixed = {u.name: u.value for u in problem.fixed}

        def unknown(name: str) -> Array:
            column = problem.column(name)
            return np.full(len(x), fixed.get(name, 0.0)) if column is None else x[:, column]

        true = np.column_stack(
            [
                (self.record.inputs[base, i] - unknown(f"b_{n}")) / (1.0 + unknown(f"k_{n}"))
                for i, n in enumerate(INERTIAL)
            ]
        )
        f, rates = true[:, :3], true[:, 3:]
        t = self.t
        accelerations = np.column_stack(
            [self.cubic.derivative(np.ascontiguousarray(rates[:, i])) for i in range(3)]
        )
        phi, theta, psi = x[:, 4], x[:, 5], x[:, 6]
        v = x[:, 1:4] - rotated(phi, theta, psi, np.column_stack([unknown(n) for n in WIND]))
        h = x[:, 0]
        if not self.still:
            turn = np.cross(rates, self.arm)
            v = v + turn
            # Plain differences: noise in a measured force only widens error bars, smoothing would
            # blunt it against the controls and draw the estimates with it.
            sharp = np.gradient(rates, t, axis=0)
            f = f + np.cross(sharp, self.arm) + np.cross(rates, turn)
            h = h - _down(phi, theta, self.arm)
        u, side, w = v.T
        V = np.sqrt(np.sum(v**2, axis=1))
        return Motion(
            maneuver=self.maneuver,
            t=t,
            V=V,
            alpha=np.arctan2(w, u),
            beta=np.arcsin(np.clip(side / V, -1.0, 1.0)),
            p=rates[:, 0], q=rates[:, 1], r=rates[:, 2],
            pdot=accelerations[:, 0], qdot=accelerations[:, 1], rdot=accelerations[:, 2],
            ax=f[:, 0], ay=f[:, 1], az=f[:, 2],
            phi=phi, theta=theta, psi=psi, h=h,
            rho=standard_density(h) if self.rho is None else self.rho,
            controls=self.controls, thrust=self.thrust, fuel_used=self.fuel_used,
            window_s=self.cubic.window_s,
            recorded=self.recorded,
        )  # fmt: skip


def standard_density(h: Array) -> Array:
    """Density of the 1976 standard atmosphere, kg/m3, at heights h (n,) m."""
    out = np.empty((len(h), 4))
    core.standard_atmosphere(np.ascontiguousarray(h, dtype=np.float64), out)
    return out[:, 2].copy()


def _down(phi: Array, theta: Array, arm: Array) -> Array:
    """How far the point at `arm` lies below the sensor, m."""
    side = arm[:, 1] * np.sin(phi) + arm[:, 2] * np.cos(phi)
    return np.asarray(side * np.cos(theta) - arm[:, 0] * np.sin(theta))


def controls_on(flight: Flight, aircraft: Aircraft, t: Array) -> dict[str, Array]:
    """The recorded controls at t, in Alula's senses."""
    return {
        name: aircraft.control_sign(name) * channel_on(flight, name, t)
        for name in CONTROLS
        if name in flight
    }


def recorded_on(flight: Flight, t: Array) -> dict[str, Array]:
    """Coefficients and rates that the log itself holds, for identification from them."""
    names = ("CX", "CY", "CZ", "Cl", "Cm", "Cn", "CD", "CL", "CT", "phat", "qhat", "rhat")
    return {name: channel_on(flight, name, t) for name in names if name in flight}


def thrust_on(flight: Flight, aircraft: Aircraft, t: Array) -> Array | None:
    """All engines' thrust, N; None where one of them is not known."""
    total = np.zeros(len(t))
    for engine in aircraft.engines:
        if engine.channel is not None and engine.channel in flight:
            total += channel_on(flight, engine.channel, t)
        elif engine.thrust is not None:
            total += engine.thrust
        else:
            return None
    return total if aircraft.engines else None


def engines_on(flight: Flight, aircraft: Aircraft, t: Array) -> dict[str, Array]:
    """Each engine's thrust at t, N, by the engine's name; those not known are left out."""
    out = {}
    for engine in aircraft.engines:
        if engine.channel is not None and engine.channel in flight:
            out[engine.name] = channel_on(flight, engine.channel, t)
        elif engine.thrust is not None:
            out[engine.name] = np.full(len(t), engine.thrust)
    return out


def fuel_on(flight: Flight, t: Array) -> Array | None:
    """Fuel burned since the start of the flight, kg: the channel, or the sum of the tanks'."""
    names = [n for n in flight.channels if n.startswith("fuel_used")]
    if not names:
        return None
    if "fuel_used" in names:
        names = ["fuel_used"]
    return np.asarray(sum((channel_on(flight, n, t) for n in names), np.zeros(len(t))))
