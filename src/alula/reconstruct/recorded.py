"""The motion as recorded: no filter, every channel taken at its word (`filter = "none"`).

For data that were reconstructed elsewhere, and to see what reconstruction changes. Air data and
inertial sensors count as being at the center of gravity.
"""

from __future__ import annotations

import numpy as np

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.base.messages import Message, note, refuse, warn
from alula.flight import Flight, Maneuver, Motion
from alula.reconstruct.record import channel_on
from alula.reconstruct.transfer import (
    controls_on,
    fuel_on,
    recorded_on,
    standard_density,
    thrust_on,
)

_NEEDED = ("V", "alpha")


def recorded_motion(
    flight: Flight, maneuver: Maneuver, aircraft: Aircraft, window_s: float
) -> tuple[Motion, list[Message]]:
    """Motion from the channels as they are; zeros, with a warning, for those that are missing.

    Raises BadInput where airspeed or angle of attack is not recorded.
    """
    for name in _NEEDED:
        _ = flight[name]
    fastest = max(_NEEDED, key=lambda n: len(flight[n].t))
    t = flight[fastest].t
    t = t[(t >= maneuver.start) & (t <= maneuver.end)]
    if len(t) < 2:
        raise refuse(
            "too_few_samples",
            where=f"maneuver {maneuver.id}",
            expected=f"samples of {fastest} between {maneuver.start:g} and {maneuver.end:g} s",
            found=str(len(t)),
            do="Correct the window.",
        )
    missing: list[str] = []
    said: list[Message] = []

    def get(name: str) -> Array:
        if name in flight:
            return channel_on(flight, name, t)
        missing.append(name)
        return np.zeros(len(t))

    rates = {name: get(name) for name in ("p", "q", "r")}
    given = all(f"{name}dot" in flight for name in rates)
    cubic = LocalCubic(t, window_s)
    accelerations = {
        f"{name}dot": channel_on(flight, f"{name}dot", t) if given else cubic.derivative(rate)
        for name, rate in rates.items()
    }
    h = get("h")
    if "rho" in flight:
        rho = channel_on(flight, "rho", t)
    else:
        rho = standard_density(h)
        said.append(
            note(
                "standard_atmosphere",
                where=f"maneuver {maneuver.id}",
                expected="a channel 'rho'",
                found="none; the standard atmosphere's density at h is taken",
                do="Map rho where temperature and pressure were recorded.",
            )
        )
    motion = Motion(
        maneuver=maneuver,
        t=t,
        V=get("V"),
        alpha=get("alpha"),
        beta=get("beta"),
        **rates,
        **accelerations,
        **{name: get(name) for name in ("ax", "ay", "az", "phi", "theta", "psi")},
        h=h,
        rho=rho,
        controls=controls_on(flight, aircraft, t),
        thrust=thrust_on(flight, aircraft, t),
        fuel_used=fuel_on(flight, t),
        window_s=0.0 if given else cubic.window_s,
        recorded=recorded_on(flight, t),
    )
    if missing:
        said.append(
            warn(
                "channels_taken_as_zero",
                where=f"maneuver {maneuver.id}",
                expected="all channels of the motion",
                found="not recorded: " + ", ".join(missing),
                do="They count as zero; terms that need them are not excited.",
            )
        )
    return motion, said
