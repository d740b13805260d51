"""Airspeeds, Mach number and altitudes from pressures; subsonic, compressible.

Fronts of core/include/alula/airdata/conversions.hpp, over numbers or arrays that go together
(they are broadcast). SI: m/s, Pa, K, kg/m3, m. Where an argument lies outside the domain (Mach
above 1, a pressure or temperature that is not positive, NaN) the result is NaN there, and nowhere
else.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from alula.base.arrays import Array
from alula.core import core


def _apply(function: Callable[..., Any], *arguments: ArrayLike) -> Array:
    given = np.broadcast_arrays(*(np.asarray(a, dtype=np.float64) for a in arguments))
    flat = [np.ascontiguousarray(a).reshape(-1) for a in given]
    out = np.empty(flat[0].shape)
    function(*flat, out)
    return out.reshape(given[0].shape)


def impact_ratio(mach: ArrayLike) -> Array:
    """Impact pressure over static pressure of a Mach number, 0 to 1."""
    return _apply(core.impact_ratio, mach)


def mach_of(ratio: ArrayLike) -> Array:
    """Mach number of impact over static pressure."""
    return _apply(core.mach_of, ratio)


def impact_of_cas(cas: ArrayLike) -> Array:
    """Impact pressure, Pa, that a calibrated airspeed stands for."""
    return _apply(core.impact_of_cas, cas)


def cas_of_impact(impact: ArrayLike) -> Array:
    """Calibrated airspeed of an impact pressure, Pa."""
    return _apply(core.cas_of_impact, impact)


def mach_of_cas(cas: ArrayLike, pressure: ArrayLike) -> Array:
    """Mach number of a calibrated airspeed at a static pressure."""
    return _apply(core.mach_of_cas, cas, pressure)


def cas_of_mach(mach: ArrayLike, pressure: ArrayLike) -> Array:
    """Calibrated airspeed of a Mach number at a static pressure."""
    return _apply(core.cas_of_mach, mach, pressure)


def tas_of_cas(cas: ArrayLike, pressure: ArrayLike, temperature: ArrayLike) -> Array:
    """True airspeed of a calibrated one."""
    return _apply(core.tas_of_cas, cas, pressure, temperature)


def cas_of_tas(tas: ArrayLike, pressure: ArrayLike, temperature: ArrayLike) -> Array:
    """Calibrated airspeed of a true one."""
    return _apply(core.cas_of_tas, tas, pressure, temperature)


def eas_of_tas(tas: ArrayLike, pressure: ArrayLike, temperature: ArrayLike) -> Array:
    """Equivalent airspeed of a true one."""
    return _apply(core.eas_of_tas, tas, pressure, temperature)


def tas_of_eas(eas: ArrayLike, pressure: ArrayLike, temperature: ArrayLike) -> Array:
    """True airspeed of an equivalent one."""
    return _apply(core.tas_of_eas, eas, pressure, temperature)


def cas_of_ias(ias: ArrayLike, static_error: ArrayLike) -> Array:
    """Calibrated airspeed of an indicated one; static_error: port less air pressure, Pa."""
    return _apply(core.cas_of_ias, ias, static_error)


def ias_of_cas(cas: ArrayLike, static_error: ArrayLike) -> Array:
    """Indicated airspeed of a calibrated one; static_error: port less air pressure, Pa."""
    return _apply(core.ias_of_cas, cas, static_error)


def static_temperature(total: ArrayLike, mach: ArrayLike, recovery: ArrayLike = 1.0) -> Array:
    """Static temperature of a total one; recovery: the probe's recovery factor, 0 to 1."""
    return _apply(core.static_temperature, total, mach, recovery)


def pressure_altitude(pressure: ArrayLike) -> Array:
    """Pressure altitude (geopotential) of a static pressure."""
    return _apply(core.pressure_altitude, pressure)


def density_altitude(density: ArrayLike) -> Array:
    """Density altitude (geopotential) of a density."""
    return _apply(core.density_altitude, density)


def pressure_at(altitude: ArrayLike) -> Array:
    """Static pressure at a pressure altitude (geopotential)."""
    return _apply(core.pressure_at, altitude)


def geometric_height(altitude: ArrayLike) -> Array:
    """Geometric height of a geopotential one."""
    return _apply(core.geometric_height, altitude)
