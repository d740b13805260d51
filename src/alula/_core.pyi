"""
Alula's compiled core: kinematics, filters, estimators and equations of motion.
"""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy
from numpy.typing import NDArray


MAX_STATES: int = 24

MAX_OUTPUTS: int = 16

class PathModel:
    """Which unknowns and sensors a reconstruction has."""

    def __init__(self) -> None: ...

    @property
    def states(self) -> int: ...

    @states.setter
    def states(self, arg: int, /) -> None: ...

    @property
    def motion(self) -> int: ...

    @motion.setter
    def motion(self, arg: int, /) -> None: ...

    @property
    def dynamic(self) -> int: ...

    @dynamic.setter
    def dynamic(self, arg: int, /) -> None: ...

    @property
    def gravity(self) -> float: ...

    @gravity.setter
    def gravity(self, arg: float, /) -> None: ...

    @property
    def wind(self) -> bool: ...

    @wind.setter
    def wind(self, arg: bool, /) -> None: ...

    def set_unknown(self, unknown: int, slot: int, fixed: float = 0.0) -> None: ...

    def set_walk(self, state: int, walk: float) -> None: ...

    def set_input_sigma(self, sigma: Sequence[float]) -> None: ...

    def add_sensor(self, quantity: int, position: Sequence[float], sigma: float, reference: float = 0.0, scale: float = 0.0, bias: float = 0.0, scale_slot: int = -1, bias_slot: int = -1) -> None: ...

def path_ekf(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sigma0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], smooth: bool = False, keep_covariance: bool = False) -> dict[str, Any]:
    """
    Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start (n,)
    the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 motion)
    values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns
    histories; `done` < n where the filter lost its covariance, `unsettled` updates whose
    iteration did not converge.
    """

def path_iekf(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sigma0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], smooth: bool = False, keep_covariance: bool = False) -> dict[str, Any]:
    """
    Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start (n,)
    the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 motion)
    values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns
    histories; `done` < n where the filter lost its covariance, `unsettled` updates whose
    iteration did not converge.
    """

def path_ukf(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sigma0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], smooth: bool = False, keep_covariance: bool = False) -> dict[str, Any]:
    """
    Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start (n,)
    the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 motion)
    values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns
    histories; `done` < n where the filter lost its covariance, `unsettled` updates whose
    iteration did not converge.
    """

def path_srukf(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sigma0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], smooth: bool = False, keep_covariance: bool = False) -> dict[str, Any]:
    """
    Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start (n,)
    the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 motion)
    values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns
    histories; `done` < n where the filter lost its covariance, `unsettled` updates whose
    iteration did not converge.
    """

def path_readings(model: PathModel, inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """
    What the sensors read (n, sensors) under measured inputs (n, 6) and states x (n, states).
    """

def path_open_loop(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], held: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, jacobian: bool = True) -> dict[str, Any]:
    """
    Integrate the kinematics from x0 without using a measurement, with exact Jacobians.
    """

def linear_filter(transition: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], input: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], process: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], output: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], noise: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], P0: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], smooth: bool = False) -> dict[str, Any]:
    """
    Linear Kalman filter over z (samples, outputs), NaN for none, from x0 and P0 before the
    first reading; process is Lambda Q Lambda'. `done` < samples where it lost its covariance.
    """

def instruction_set() -> str:
    """What this module was compiled for: 'baseline' or 'x86-64-v3'."""

def has_x86_64_v3() -> bool:
    """True where the processor executes AVX2, FMA and BMI2 (x86-64-v3)."""

class TermTable:
    """
    An aerodynamic model as steps (operation, a, b, knot) or (operation, a,
    b, knot, c, table) and terms (coefficient, slot). Operations: 0 multiply,
    1 absolute, 2 ramp, 3 sign, 4 lookup of table number `table` at slots a,
    b, c (0 for axes it does not have), 5 the lift coefficient. tables: (breakpoints of each axis,
    values row by row, cubic, continued by lines); their numbers are copied.
    """

    def __init__(self, steps: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], terms: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], tables: Sequence[tuple[Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bool, bool]] = []) -> None: ...

    def evaluate(self, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], variables: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
        """
        Coefficients (n, 6) for variables (n, 14): 1 V alpha beta phat qhat rhat de da dr df
        dt mach wash; values: one per term.
        """

    @property
    def term_count(self) -> int: ...

    @property
    def step_count(self) -> int: ...

    @property
    def table_count(self) -> int: ...

def standard_atmosphere(h: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Temperature (K), pressure (Pa), density (kg/m3) and speed of sound (m/s) of the 1976
    standard atmosphere at geometric heights h (m), written to out (n, 4).
    """

def impact_ratio(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Impact over static pressure of Mach."""

def mach_of(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Mach of impact over static pressure."""

def impact_of_cas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Impact pressure of CAS."""

def cas_of_impact(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """CAS of impact pressure."""

def mach_of_cas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Mach of CAS and static pressure."""

def cas_of_mach(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """CAS of Mach and static pressure."""

def tas_of_cas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], c: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """TAS of CAS, pressure, temperature."""

def cas_of_tas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], c: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """CAS of TAS, pressure, temperature."""

def eas_of_tas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], c: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """EAS of TAS, pressure, temperature."""

def tas_of_eas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], c: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """TAS of EAS, pressure, temperature."""

def cas_of_ias(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """CAS of IAS and static-pressure error."""

def ias_of_cas(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """IAS of CAS and static-pressure error."""

def static_temperature(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], b: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], c: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Static temperature of total temperature, Mach, recovery factor."""

def pressure_altitude(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Geopotential, of pressure."""

def density_altitude(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Geopotential, of density."""

def pressure_at(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Pressure at a pressure altitude."""

def geometric_height(a: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Of a geopotential height."""

def static_pressure_correction(linear: float, quadratic: float, rho_0: float, fastest: float, U: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], rho: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Air's pressure less the port's, Pa."""

def vane_readings(alpha_vane: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], beta_vane: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], v: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], rates: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """Readings of both vanes at velocities (n, 3) and rates (n, 3)."""

def flow_from_vanes(alpha_vane: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], beta_vane: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], pitot: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], rates: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> int:
    """
    V, alpha, beta at the center of gravity of readings (n, 3): alpha vane, beta vane, V.
    Returns how many were refused; those are NaN.
    """

def monitor(sources: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], settings: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], health: Annotated[NDArray[numpy.int32], dict(shape=(None, None), order='C', device='cpu')], named: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')]) -> int:
    """
    Vote over readings (n, m), NaN where there is none: angle, sigma, used, split (n, 4).
    sources: white, slow, stuck_after. Returns how many steps were refused.
    """

class Probe:
    """Five-hole probe: see alula/airdata/probe.hpp."""

    def __init__(self, side: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], side_sine: float, center: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], center_sine: float, port_angle: float, widest: float, domain: float, least: float) -> None: ...

    def start(self, out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
        """A, B and K of the inverse's start."""

    def forward(self, q: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], alpha: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], beta: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
        """p0 - static, p1 - p2, p3 - p4 (n, 3)."""

    def inverse(self, pressures: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], status: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], single: bool) -> None:
        """q, alpha, beta, iterations (n, 4), and the status of each."""

    def sensitivity(self, q: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], alpha: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], beta: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')]) -> None:
        """Slopes of alpha, beta, q with the pressures (n, 3, 3)."""

    def starts(self, pressures: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
        """Y, Z, q (n, 3)."""

    def time(self, pressures: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], rounds: int, single: bool) -> float:
        """Least time of one inverse, s."""

def probe_lookup(data: Annotated[NDArray[numpy.float32], dict(shape=(None, None, None), order='C', device='cpu', writable=False)], half: float, start: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], least: float, domain: float, pressures: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], status: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """
    q, alpha, beta (n, 3) by the flight computer's table, in its float arithmetic.
    """

class AircraftModel:
    """
    A rigid aircraft with its aerodynamic model, engines and what else has states.
    Positions are from the center of gravity, body axes, m; geometry: S, b, c.
    """

    def __init__(self, mass: float, inertia: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], geometry: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reference_point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], gravity: float, stability_axes: bool, table: TermTable, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], wgs84: bool = False) -> None: ...

    def add_given(self, point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], share: float) -> None:
        """An engine whose thrust is an input; share: its part of it."""

    def add_piston(self, point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], diameter: float, inertia: float, sense: float, J: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], CT: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], CP: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], omega: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], torque: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reduction: float, gear_sense: float, crank_inertia: float, friction: float, idle: float, consumption: float) -> None:
        """
        A piston engine with propeller: see propulsion/piston.hpp and propeller.hpp.
        """

    def add_electric(self, point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], diameter: float, inertia: float, sense: float, J: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], CT: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], CP: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], k_V: float, k_T: float, no_load_current: float, resistance: float, full_voltage: float, empty_voltage: float, capacity: float, most_current: float, most_regenerated_current: float) -> None:
        """
        An electric motor with propeller: see propulsion/electric.hpp and propeller.hpp.
        """

    def add_turbofan(self, point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], idle: tuple[Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bool, bool], military: tuple[Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bool, bool], maximum: tuple[Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bool, bool] | None, military_at: float, tau: float, consumption: float, angular_momentum: float, sense: float, idle_speed: float) -> None:
        """
        A turbofan; tables over Mach number and height, as TermTable takes them.
        """

    def set_actuator(self, control: int, tau: float, rate_limit: float, low: float, high: float, dead_band: float, tau_down: float) -> None:
        """The actuator of control 0 to 4: de da dr df dt."""

    def set_stall(self, a1: float, alpha_star: float, tau1: float, tau2: float, CL_alpha: float, alpha_0: float, CD_X: float, Cm_X: float, y_station: float, alpha_star_difference: float) -> None:
        """Separation of the flow: see aero/stall.hpp."""

    def set_fuel(self, mass: float, position: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inertia: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> None:
        """Fuel aboard that burns: kg, its center, its inertia about it."""

    def set_wind(self, steady: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], shear: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reference_height: float, logarithmic: bool, roughness: float, ground: float) -> None:
        """Wind, NED, the way it blows to: see motion/wind.hpp."""

    @property
    def further_states(self) -> list[str]:
        """Names of the states behind position, attitude, velocity and rates."""

    @property
    def state_count(self) -> int: ...

    @property
    def input_count(self) -> int: ...

    @property
    def output_count(self) -> int: ...

    def fly(self, x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], controls: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], dt: float, substeps: int, states: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], outputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], hold: bool = False, gusts: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, turbulence: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)] | None = None, normals: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, gains: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, limits: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, references: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, active: Annotated[NDArray[numpy.bool_], dict(shape=(None,), order='C', device='cpu', writable=False)] | None = None) -> int:
        """
        Fly from x0 (state_count) under controls (n, 6) with RK4; write states (n,
        state_count), outputs (n, 24) and inputs (n, 12) as flown; return the number of samples
        before the state stopped being finite. hold: controls stay between samples, else lines.
        gusts (n, 6); turbulence (span, W20, sigma) with normals ((n - 1) substeps + 1, 8); a
        pilot: gains (5, 10), limits (5, 2), references (n, 10), active (n).
        """

    def rates(self, x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], dx: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
        """
        State rates dx (state_count) and outputs y (24) at one state and input (6 or 12).
        """

    def jacobian(self, x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        A (n, n), B (n, 12), C (24, n), D (24, 12), exact, at a state and an input.
        """

    def settle(self, x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
        """
        The state with rotors, power, separation and actuators as they come to rest in this
        motion; x: 13 states or all.
        """

    def fly_many(self, starts: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], controls: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu', writable=False)], winds: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], logarithmic: bool, dt: float, substeps: int, states: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')], outputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')], flown: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', device='cpu')], hold: bool = False, gusts: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu', writable=False)] | None = None) -> None:
        """
        Fly k flights side by side, each as `fly` would: starts (k, state_count), controls and
        gusts (k or 1, n, 6), winds (k, 9): steady, shear, reference height, roughness, ground;
        write states (k, n, state_count), outputs (k, n, 24), inputs (k, n, 12), and the numbers
        of samples before a state stopped being finite into flown (k).
        """

def quaternion_from_euler(phi: float, theta: float, psi: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Quaternion (4,), scalar first, of Euler angles 3-2-1, rad."""

def ecef_state(latitude: float, longitude: float, height: float, phi: float, theta: float, psi: float, position: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], quaternion: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """
    Position (3,) m ECEF and quaternion (4,) from ECEF to body axes of a WGS-84 place
    (rad, rad, m) and Euler angles against north, east, down (rad).
    """

def attitudes(states: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], euler: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], rotation: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')], where: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], wgs84: bool) -> None:
    """
    Of states (n, 13 or more): Euler angles phi theta psi (n, 3), rad; R_BE (n, 3, 3) from
    north, east, down; and where (n, 3): north, east, height (m), or on WGS-84 latitude,
    longitude (rad), height (m).
    """

def tumbling_drift(inertia: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], rates: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], dt: float, steps: int) -> tuple[float, float, float]:
    """
    Largest relative drift, over a torque-free rotation, of energy, of the length of the
    angular momentum, and of its vector in inertial axes.
    """

def cosine_gust(t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], amplitude: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], start: float, length: float, speed: float, returns: bool, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    A gust of one minus cosine at times t (n,), into the first three columns of out.
    """

def specific_force_at(f: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w_dot: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], r: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """Specific force (n, 3) at r from the center of gravity."""

def velocity_at(v: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], r: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """Velocity (n, 3) at r from the center of gravity."""

def readings(truth: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], normal: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], scale: float, bias: float, sigma: float, step: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """What a sensor with these errors reads."""

MAX_RECURSIVE: int = 32

MAX_RESIDUAL_WINDOW: int = 512

MAX_FREQUENCIES: int = 64

MAX_FOURIER_CHANNELS: int = 16

def recursive_least_squares(x: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], z: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], variance: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bound: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reset: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], factor: float, directional: bool, window: int, least: float, usual: float, reset_ratio: float, value: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], se: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], gain: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], steps: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Recursive least squares of z (n,) on x (n, k) with forgetting. initial, variance, bound
    (k,): values and variances (of unit noise) at the start, and those that forgetting does
    not exceed. reset (n,): not zero where the variances start anew; or empty. Writes the
    histories value and se (n, k), gain (n, k) where it is not empty, and steps (n, 5):
    innovation, its variance over the noise's, forgetting factor used, whether the variances
    were reset, noise variance.
    """

def recursive_fourier(x: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], omega: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], dt: float, forgetting: float, every: int, value: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], se: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Sequential least squares in the frequency domain: the last column of x (n, c) on the
    others, at angular frequencies omega (m,), ascending, by recursive Fourier transforms.
    Writes value and se (n/every, c - 1), NaN where they are not determined yet.
    """

class ManeuverFit:
    """
    One maneuver and the model whose values are asked for. reference: S, b, c. body: mass
    (kg), gravity. arm: from the CG to the moments' reference point. states: indices into
    V alpha beta p q r phi theta; the others come from the inputs. pull (8): 1/s. outputs:
    indices into the same eight and ax ay az pdot qdot rdot. inputs (n, 28): the eight as
    measured, de da dr df dt, density, 1 / speed of sound, force (3), moment (3), measured
    coefficients (6), unused. measured (n, outputs): NaN where there is none. Copies are kept.
    """

    def __init__(self, aero: TermTable, stability_axes: bool, reference: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], body: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inertia: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], arm: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], states: Sequence[int], pull: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], outputs: Sequence[int], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], measured: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], substeps: int = 1) -> None: ...

    def columns(self, count: int, terms: Sequence[int], weights: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], initial: Sequence[int], bias: Sequence[int]) -> None:
        """
        Which column of the parameters each term, initial variable (8) and output's bias is;
        -1: fixed. A term's slope by its column is its weight.
        """

    def sums(self, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bias: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> tuple[int, NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.int64]]:
        """
        Samples flown (fewer than all: diverged), and by output: information (k, k),
        gradient (k,), squared residuals, samples.
        """

    def flight(self, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], bias: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sensitivity: bool = True) -> tuple[int, NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        Samples flown, outputs (n, outputs), their slopes (n, outputs, k), or (0, ...).
        """

    def innovations(self, values: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], process: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], noise: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> tuple[bool, NDArray[numpy.float64], NDArray[numpy.float64], NDArray[numpy.float64]]:
        """
        Of m extended filters: values (m, terms), initial and intensity F F' of the process
        noise (m, 8), variance of the sensors (m, outputs). Whether all came to the end,
        innovations, their covariances, predicted outputs.
        """

    @property
    def axes(self) -> str: ...

MAX_ASSE_SAMPLES: int = 32

MAX_ZERO_ORDER: int = 4

def asse_zero_order(t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], V: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], V_dot: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], a: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], gained: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], offsets: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], every: int, threshold: float, equation_error: float, alpha: float, beta: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> tuple[int, int, int, int, int]:
    """
    Zero-order scheme over a recording. t, V, V_dot (n,); a, w, gained (n, 3): acceleration
    against the air, rates, integral of a since the start, body axes. offsets: samples back
    (negative: ahead) of the further equations. Solves at every `every`th sample from the last
    valid angles, first alpha, beta. out (n, 8): alpha, beta, their existence numbers, whether
    observable, age of the last valid values; NaN where nothing was solved. Returns counts of
    what was rejected: not finite, backward, slow, outlying, gaps.
    """

def asse_window(t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], f: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], gravity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], wind_rate: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], V: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], settings: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], capacity: int, every: int, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> tuple[int, int, int, int, int]:
    """
    Exact affine form over a recording. f, w, gravity, wind_rate (n, 3) body axes; V (n,) NaN
    where there is none. settings (17,) as AsseSettings; capacity: samples of the window. out
    (n, 13): V, alpha, beta, their covariance (6, upper triangle), observable (2), ages (2).
    Returns counts of what was rejected: not finite, backward, slow, outlying, gaps.
    """

def asse_filter(t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], f: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], gravity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], wind_rate: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], V: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], settings: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], alpha: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], alpha_sigma: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> tuple[int, int, int, int, int]:
    """
    Filter over a recording, arguments as asse_window. alpha (n,) or empty: angles of attack
    from elsewhere, NaN where there are none, of standard deviation alpha_sigma, rad.
    """

NAVIGATE_KINDS: str = 'position velocity field height V alpha beta'

NAVIGATE_TAKEN: str = ...

class JointNoise:
    """Noise and constants of the joint filter, SI."""

    def __init__(self) -> None: ...

    @property
    def gyro(self) -> float: ...

    @gyro.setter
    def gyro(self, arg: float, /) -> None: ...

    @property
    def gyro_walk(self) -> float: ...

    @gyro_walk.setter
    def gyro_walk(self, arg: float, /) -> None: ...

    @property
    def accelerometer(self) -> float: ...

    @accelerometer.setter
    def accelerometer(self, arg: float, /) -> None: ...

    @property
    def accelerometer_walk(self) -> float: ...

    @accelerometer_walk.setter
    def accelerometer_walk(self, arg: float, /) -> None: ...

    @property
    def wind_walk(self) -> float: ...

    @wind_walk.setter
    def wind_walk(self, arg: float, /) -> None: ...

    @property
    def height_walk(self) -> float: ...

    @height_walk.setter
    def height_walk(self, arg: float, /) -> None: ...

    @property
    def gravity(self) -> float: ...

    @gravity.setter
    def gravity(self, arg: float, /) -> None: ...

    @property
    def least_airspeed(self) -> float: ...

    @least_airspeed.setter
    def least_airspeed(self, arg: float, /) -> None: ...

    @property
    def longest_step(self) -> float: ...

    @longest_step.setter
    def longest_step(self, arg: float, /) -> None: ...

    @property
    def patience(self) -> float: ...

    @patience.setter
    def patience(self, arg: float, /) -> None: ...

    @property
    def gust(self) -> tuple[float, float, float]: ...

    @gust.setter
    def gust(self, arg: tuple[float, float, float], /) -> None: ...

    @property
    def gust_length(self) -> tuple[float, float, float]: ...

    @gust_length.setter
    def gust_length(self, arg: tuple[float, float, float], /) -> None: ...

    @property
    def field(self) -> tuple[float, float, float]: ...

    @field.setter
    def field(self, arg: tuple[float, float, float], /) -> None: ...

    @property
    def air_sensor(self) -> tuple[float, float, float]: ...

    @air_sensor.setter
    def air_sensor(self, arg: tuple[float, float, float], /) -> None: ...

    @property
    def antenna(self) -> tuple[float, float, float]: ...

    @antenna.setter
    def antenna(self, arg: tuple[float, float, float], /) -> None: ...

class AttitudeNoise:
    """Noise of the attitude filter, SI."""

    def __init__(self) -> None: ...

    @property
    def gyro(self) -> float: ...

    @gyro.setter
    def gyro(self, arg: float, /) -> None: ...

    @property
    def gyro_walk(self) -> float: ...

    @gyro_walk.setter
    def gyro_walk(self, arg: float, /) -> None: ...

    @property
    def longest_step(self) -> float: ...

    @longest_step.setter
    def longest_step(self, arg: float, /) -> None: ...

    @property
    def patience(self) -> float: ...

    @patience.setter
    def patience(self, arg: float, /) -> None: ...

    @property
    def measured(self) -> tuple[float, float, float]: ...

    @measured.setter
    def measured(self, arg: tuple[float, float, float], /) -> None: ...

class PositionNoise:
    """Noise of the position filter, SI."""

    def __init__(self) -> None: ...

    @property
    def accelerometer(self) -> float: ...

    @accelerometer.setter
    def accelerometer(self, arg: float, /) -> None: ...

    @property
    def accelerometer_walk(self) -> float: ...

    @accelerometer_walk.setter
    def accelerometer_walk(self, arg: float, /) -> None: ...

    @property
    def gravity(self) -> float: ...

    @gravity.setter
    def gravity(self, arg: float, /) -> None: ...

    @property
    def longest_step(self) -> float: ...

    @longest_step.setter
    def longest_step(self, arg: float, /) -> None: ...

    @property
    def patience(self) -> float: ...

    @patience.setter
    def patience(self, arg: float, /) -> None: ...

def navigate_joint(noise: JointNoise, start_state: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], start_sigma: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], t0: float, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], rate: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], force: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], events: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], every: int = 1) -> dict[str, Any]:
    """
    The joint filter over t (n,), rate and force (n, 3), and events (m, 9) in the order of
    their arrival: kind, t of arrival, t measured, z (3), sigma (3). start_state: quaternion,
    velocity, position, wind (13,); start_sigma: tilt, heading, velocity, position, gyro bias,
    accelerometer bias, wind, height bias. Every so many samples: t (k,), x (k, 26),
    covariance (k, 22, 22); of each event what became of it, nis, deviation of innovations.
    """

def navigate_pair(attitude: AttitudeNoise, position: PositionNoise, field: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], steps: int, start_state: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], start_sigma: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], t0: float, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], rate: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], force: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], events: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], every: int = 1) -> dict[str, Any]:
    """
    Attitude and position filter in turn; as navigate_joint, with x (k, 16) and covariance
    (k, 15, 15): turn, gyro bias, position, velocity, accelerometer bias. start_sigma: tilt,
    heading, velocity, position, gyro bias, accelerometer bias. steps: inertial samples for one
    step of the position filter.
    """

def measured_attitude(gravity_B: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], field_B: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], field_E: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], gravity: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Attitude from gravity and magnetic field as seen in body axes (n, 3). Writes out (n, 6):
    phi theta psi (rad), acceleration gain, whether the heading and the whole is valid.
    """

def wind_from(velocity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sigma_velocity: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], q: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sigma_turn: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], air: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sigma_air: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], wind: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], covariance: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')]) -> None:
    """
    Wind (n, 3) NED, m/s, the way it blows to, with covariance (n, 3, 3), from velocity (n, 3)
    NED, attitude q (n, 4), air (n, 3): V, alpha, beta; NaN where there is no airspeed.
    """

def air_from_wind(velocity: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sigma_velocity: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], q: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sigma_turn: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], wind: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], wind_covariance: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Airspeed and flow angles without air-data sensors where the wind is known. Writes out
    (n, 6): V, alpha, beta and their standard deviations; NaN where there is no airspeed.
    """

def power_train(motor: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], noise: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], throttle: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], speed: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Motor speed, current and battery over t (n,) from throttle and speed readings (NaN: none).
    motor: k_V k_T no_load_current resistance full_voltage empty_voltage capacity most_current
    most_regenerated_current; noise: jerk, decay, sensor. Writes out (n, 9): speed,
    acceleration, standard deviation of the speed, motor current, battery current, charge
    drawn, voltage, share left, what became of the sample.
    """

MAX_BLADE_STATIONS: int = 64

class BladeShape:
    """Blades by stations; lengths over the tip's radius."""

    def __init__(self, count: int, radius: float, hub: float, helix: float, r: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], chord: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], pitch: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None:
        """
        count: of blades; radius: m; hub: where they begin, over the radius; helix: geometric
        pitch over the radius, 0: the stations' pitch (rad) counts; r, chord over the radius.
        """

    @property
    def helix(self) -> float: ...

def blade_integrals(blade: BladeShape, alpha_max: float, J1: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Integrals of one blade at advance ratios of the disk: out (n, 18), the loads F_x, F_yV,
    F_yQ, M_x, M_yV, M_yQ, each with its parts of stalled lift, attached lift and drag.
    """

def momentum_disk(blade: BladeShape, c_l_alpha: float, alpha_max: float, c_d_alpha: float, J: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    The momentum disk at advance ratios J = V/(n D): out (n, 10): J0, J1, w'/w, the six hub
    coefficients, the regime (0 inside, 1 standing, 2 reverse, 3 windmill, 4 unsolved).
    """

def windmill_J(blade: BladeShape, c_l_alpha: float, alpha_max: float, c_d_alpha: float) -> float:
    """
    Advance ratio behind which the air drives the shaft; 0 without a solution.
    """

class MomentumTable:
    """The momentum disk tabulated for flight."""

    def __init__(self, blade: BladeShape, c_l_alpha: float, alpha_max: float, c_d_alpha: float, sense: float) -> None: ...

    @property
    def last(self) -> float:
        """J at the windmill"""

    def loads(self, omega: float, v: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], density: float) -> tuple[float, float, float, float, float, float, float, int]:
        """
        Force (3), moment (3), shaft torque and regime at the hub; see hub_loads.
        """

def blade_element_loads(blade: BladeShape, polars: Sequence[tuple[Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]]], axial_speed: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], omega: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], density: float, viscosity: float, sound: float, tip_loss: bool, hub_loss: bool, swirl: bool, at_stations: bool, out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Thrust N, shaft torque N m and regime (as momentum_disk) by blade elements: out (n, 3).
    """

def slipstream(axial_speed: float, thrust: float, torque: float, density: float, radius: float, sense: float) -> tuple[float, float, float, float, float, bool]:
    """
    Speeds through the disk and far behind it (m/s), turning there (rad/s, along the thrust),
    radius far behind (m), whether the model holds.
    """

class StripAircraft:
    """
    Lifting surfaces by strips: see aero/strip_theory.hpp.
    surfaces (m, 7): first strip, count, k, 1/(pi e A), k c_l_alpha, downwash
    gradient, 1 for a wing. strips (n, 19): point, chord axis, normal, length,
    area, half width, c_l_delta, c_m_delta, c_l_alpha, gains of de da dr df.
    sections: per surface (3, n), c_l c_d c_m over -pi to pi.
    """

    def __init__(self, reference: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], CD_body: float, center: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], hub: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], incidence: float, downwash_by_angle: bool, surfaces: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], strips: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], sections: Sequence[Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]]) -> None: ...

    def evaluate(self, flows: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], stability_axes: bool) -> None:
        """
        Coefficients (n, 6) for flows (n, 12): alpha beta phat qhat rhat de da dr df, and of
        the slipstream (U_i - u_0)/V, Omega_i/V (1/m), R_i (m).
        """

    @property
    def strip_count(self) -> int: ...

LATTICE_PANELS: int = 15000

def vortex_lattice(panels: object, alpha: float, beta: float, mach: float, rate: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reference: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], core: float, turning: bool) -> dict[str, Any]:
    """
    Loads of a lattice (alula.predict.panels.Panels) and their derivatives to alpha, beta, phat, qhat, rhat and controls, body axes; see core/host/include/alula/host/vortex_lattice.hpp.
    """

def lattice_factor_time(n: int) -> float:
    """
    Processor time (s) of the factorization alone of a full matrix of order n.
    """
