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
    histories; `done` < n where the filter lost its covariance.
    """

def path_ukf(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], readings: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], start: Annotated[NDArray[numpy.int32], dict(shape=(None,), order='C', writable=False)], initial: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], sigma0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], smooth: bool = False, keep_covariance: bool = False) -> dict[str, Any]:
    """
    Filter a record: t (n,), inputs (n, 6), readings (n, sensors) with NaN for none, start (n,)
    the row of `initial` where a maneuver begins and -1 elsewhere, initial (maneuvers, 2 motion)
    values and standard deviations, x0 and sigma0 (states,) the constants' prior. Returns
    histories; `done` < n where the filter lost its covariance.
    """

def path_readings(model: PathModel, inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> NDArray[numpy.float64]:
    """
    What the sensors read (n, sensors) under measured inputs (n, 6) and states x (n, states).
    """

def path_open_loop(model: PathModel, t: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], held: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)] | None = None, jacobian: bool = True) -> dict[str, Any]:
    """
    Integrate the kinematics from x0 without using a measurement, with exact Jacobians.
    """

def has_x86_64_v3() -> bool:
    """True where the processor executes AVX2, FMA and BMI2 (x86-64-v3)."""

class TermTable:
    """
    An aerodynamic model as steps (operation, a, b, knot) and terms
    (coefficient, slot). Operations: 0 multiply, 1 absolute, 2 ramp.
    """

    def __init__(self, steps: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], terms: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)]) -> None: ...

    def evaluate(self, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], variables: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
        """
        Coefficients (n, 6) for variables (n, 13): 1 V alpha beta phat qhat rhat de da dr df
        dt mach; values: one per term.
        """

    @property
    def term_count(self) -> int: ...

    @property
    def step_count(self) -> int: ...

def standard_atmosphere(h: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """
    Temperature (K), pressure (Pa), density (kg/m3) and speed of sound (m/s) of the 1976
    standard atmosphere at geometric heights h (m), written to out (n, 4).
    """

class AircraftModel:
    """
    A rigid aircraft with its aerodynamic model; positions from the center of
    gravity, body axes; geometry: S, b, c.
    """

    def __init__(self, mass: float, inertia: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], geometry: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], reference_point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], thrust_point: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], thrust_direction: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], wind: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], gravity: float, stability_axes: bool, table: TermTable, values: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)]) -> None: ...

    def fly(self, x0: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], inputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], dt: float, substeps: int, states: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], outputs: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> int:
        """
        Fly from x0 (13) under inputs (n, 6) with RK4; write states (n, 13) and outputs
        (n, 17); return the number of samples before the state stopped being finite.
        """

    def rates(self, x: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], u: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], dx: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')], y: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
        """State rates dx (13) and outputs y (17) at one state and input."""

def quaternion_from_euler(phi: float, theta: float, psi: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """Quaternion (4,), scalar first, of Euler angles 3-2-1, rad."""

def attitudes(states: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], euler: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')], rotation: Annotated[NDArray[numpy.float64], dict(shape=(None, None, None), order='C', device='cpu')]) -> None:
    """
    Euler angles phi theta psi (n, 3), rad, and R_BE (n, 3, 3) of states (n, 13).
    """

def specific_force_at(f: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w_dot: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], r: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """Specific force (n, 3) at r from the center of gravity."""

def velocity_at(v: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], w: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu', writable=False)], r: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], out: Annotated[NDArray[numpy.float64], dict(shape=(None, None), order='C', device='cpu')]) -> None:
    """Velocity (n, 3) at r from the center of gravity."""

def readings(truth: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], normal: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu', writable=False)], scale: float, bias: float, sigma: float, step: float, out: Annotated[NDArray[numpy.float64], dict(shape=(None,), order='C', device='cpu')]) -> None:
    """What a sensor with these errors reads."""
