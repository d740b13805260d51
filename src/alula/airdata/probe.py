"""Five-hole probe: pressures of a flow, flow of pressures, error map, domain, lookup table.

Fronts of core/include/alula/airdata/probe.hpp and probe_table.hpp. Angles rad, pressures Pa:
(n, 3) p0 less static, p1 - p2 (below less above), p3 - p4 (right less left).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from alula.airdata.cp_fit import Cp
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.core import core

STATUS = (
    "ok", "not_finite", "no_flow", "from_behind", "outside_domain", "not_converged", "saturated",
    "stuck",
)  # fmt: skip
_WORDS = {
    "not_finite": "a pressure that is not a number",
    "no_flow": "pressures too small for an angle (no airspeed)",
    "from_behind": "pressures of no flow from ahead (negative dynamic pressure)",
    "outside_domain": "a flow outside the domain of the probe",
    "not_converged": "no flow that gives these pressures",
    "saturated": "a pressure at the end of the sensor's range",
    "stuck": "a pressure that had not changed for too long",
}


@dataclass(frozen=True)
class ProbeFlow:
    """Flow at each sample, NaN where refused. status: (n,) index into STATUS."""

    q: Array
    alpha: Array
    beta: Array
    iterations: Array
    status: Any
    messages: tuple[Message, ...] = ()

    @property
    def valid(self) -> Any:
        """(n,) bool."""
        return self.status == 0

    def airspeed(self, density: ArrayLike) -> Array:
        """sqrt(2 q / rho), m/s; rho kg/m3."""
        return np.asarray(np.sqrt(2.0 * self.q / np.asarray(density, dtype=np.float64)))


@dataclass(frozen=True)
class FiveHoleProbe:
    """A probe: c_p of the side ports and of the center port, port angle from the tip, rad.

    With a fit whose phase is taken as a turned port, port_angle is the angle less the phase.
    center: None takes that of the side ports. domain: rad, largest alpha and beta reported.
    least: Pa, pressures below it are no flow. Raises BadInput for a c_p that does not tell angles
    apart.
    """

    side: Cp
    port_angle: float
    center: Cp | None = None
    domain: float = float(np.radians(35.0))
    least: float = 1.0
    _core: Any = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        center = self.side if self.center is None else self.center
        widest = self.side.high
        try:
            made = core.Probe(
                _flat(self.side.power), self.side.sine, _flat(center.power), center.sine,
                self.port_angle, widest, self.domain, self.least,
            )  # fmt: skip
        except ValueError as error:
            raise refuse(
                "no_probe",
                where="five-hole probe",
                expected="a c_p that falls from the tip, a port angle between 0 and 90 deg, a "
                "domain below 85 deg, at most 9 powers of cos(theta)",
                found=f"port angle {np.degrees(self.port_angle):.4g} deg: {error}",
                do="Look at the fit of c_p.",
            ) from None
        object.__setattr__(self, "_core", made)

    def pressures(self, q: ArrayLike, alpha: ArrayLike, beta: ArrayLike) -> Array:
        """Three pressure differences (n, 3) of flows (n,)."""
        flows = [np.ravel(a) for a in np.broadcast_arrays(q, alpha, beta)]
        out = np.empty((len(flows[0]), 3))
        self._core.forward(*(_flat(a) for a in flows), out)
        return out

    def flow(self, pressures: ArrayLike, *, single: bool = False) -> ProbeFlow:
        """Flow of pressure differences (n, 3). single: in float, as a flight computer has it.

        What cannot be a flow is NaN, and counted in the messages by reason.
        """
        p = _rows(pressures)
        out, status = np.empty((len(p), 4)), np.empty(len(p), dtype=np.int32)
        self._core.inverse(p, out, status, single)
        q, alpha, beta, iterations = (frozen(column) for column in out.T)
        messages = counted(status, "five-hole probe")
        return ProbeFlow(q, alpha, beta, iterations, status, messages)

    def errors(self, q: ArrayLike, alpha: ArrayLike, beta: ArrayLike, sigma: ArrayLike) -> Array:
        """Standard deviations (n, 3) of alpha, beta (rad) and q (Pa).

        sigma: of the three pressures, Pa, one or (3,). Independent errors, first order.
        """
        slopes = self._slopes(q, alpha, beta)
        each = np.broadcast_to(np.asarray(sigma, dtype=np.float64), (3,))
        return np.asarray(np.sqrt(np.einsum("nij,j->ni", slopes**2, each**2)))

    def _slopes(self, q: ArrayLike, alpha: ArrayLike, beta: ArrayLike) -> Array:
        flows = [_flat(a) for a in np.broadcast_arrays(q, alpha, beta)]
        slopes = np.empty((len(flows[0]), 3, 3))
        self._core.sensitivity(*flows, slopes)
        return slopes

    def error_map(
        self, q: float, sigma: ArrayLike, points: int = 29
    ) -> tuple[Array, tuple[Array, Array, Array]]:
        """Errors over alpha and beta: the axis (points,) and three maps [alpha, beta].

        The maps are the standard deviations of alpha, beta (rad) and q (Pa) at dynamic pressure q.
        """
        axis = np.linspace(-self.domain, self.domain, points)
        a, b = np.meshgrid(axis, axis, indexing="ij")
        errors = self.errors(q, a.ravel(), b.ravel(), sigma)
        shaped = errors.reshape(points, points, 3)
        return axis, (shaped[..., 0], shaped[..., 1], shaped[..., 2])

    def read_by(self, other: FiveHoleProbe, points: int = 29) -> tuple[Array, Array, Array, Array]:
        """What another calibration makes of this probe's pressures.

        Returns the axis (points,) and errors of alpha, beta (rad) and q (relative), each
        [alpha, beta], NaN where the other finds no flow.
        """
        axis = np.linspace(-self.domain, self.domain, points)
        a, b = (x.ravel() for x in np.meshgrid(axis, axis, indexing="ij"))
        found = other.flow(self.pressures(1000.0, a, b))
        return (
            axis,
            (found.alpha - a).reshape(points, points),
            (found.beta - b).reshape(points, points),
            (found.q / 1000.0 - 1.0).reshape(points, points),
        )

    def valid_angle(self, points: int = 61) -> float:
        """Largest angle, rad, up to which alpha and beta together are determined.

        Up to it no port leaves the range of the fit of c_p, and the three pressures keep telling
        the flow: the inverse finds what the forward model was given.
        """
        best = 0.0
        for edge in np.linspace(np.radians(1.0), np.radians(80.0), points):
            a, b = (x.ravel() for x in np.meshgrid(*[np.linspace(-edge, edge, 15)] * 2))
            wide = FiveHoleProbe(
                self.side, self.port_angle, self.center, min(1.48, 1.01 * edge), self.least
            )
            found = wide.flow(wide.pressures(1000.0, a, b))
            off = np.hypot(found.alpha - a, found.beta - b)
            if not (found.valid.all() and np.max(off) < 1e-6):
                break
            best = float(edge)
        return best

    def time_of_inverse(self, pressures: Array, rounds: int = 20, single: bool = False) -> float:
        """Least time of one inverse in the core, s, over `rounds` of all pressures (n, 3)."""
        return float(self._core.time(_rows(pressures), rounds, single))

    def start(self) -> tuple[float, float, float]:
        """A, B and K of the inverse's start (probe.hpp)."""
        out = np.empty(3)
        self._core.start(out)
        return float(out[0]), float(out[1]), float(out[2])

    def starts(self, pressures: Array) -> Array:
        """(n, 3) tangents v/u, w/u and q where the inverse starts."""
        out = np.empty((len(pressures), 3))
        self._core.starts(_rows(pressures), out)
        return out


def counted(status: Any, where: str) -> tuple[Message, ...]:
    """One message for each reason why samples were refused."""
    return tuple(
        warn(
            f"probe_{STATUS[k]}",
            where=where,
            expected="a flow from ahead within the probe's domain",
            found=f"{_WORDS[STATUS[k]]} in {int(np.sum(status == k))} of {len(status)} samples",
            do="These samples are NaN; look at the pressure sensors and lines there.",
        )
        for k in range(1, len(STATUS))
        if np.any(status == k)
    )


def watched(
    pressures: ArrayLike, low: float, high: float, stuck_after: int = 0
) -> tuple[Array, tuple[Message, ...]]:
    """Pressures (n, 3) with saturated and stuck readings as NaN, and how many there were.

    low, high: Pa, ends of the sensors' range. stuck_after: repetitions of one reading after which
    a sensor counts as stuck; 0: not watched. The first readings before that are kept.
    """
    p = np.array(pressures, dtype=np.float64)
    status = np.zeros(len(p), dtype=np.int32)
    known = np.isfinite(p)
    saturated = (known & ((p <= low) | (p >= high))).any(axis=1)
    if stuck_after > 0:
        for column in p.T:
            new = np.r_[True, column[1:] != column[:-1]]
            since = np.arange(len(column)) - np.maximum.accumulate(
                np.where(new, np.arange(len(column)), 0)
            )
            status[since >= stuck_after] = STATUS.index("stuck")
    status[saturated] = STATUS.index("saturated")
    p[status != 0] = np.nan
    return p, counted(status, "pressure sensors")


def _flat(values: ArrayLike) -> Array:
    return np.ascontiguousarray(np.ravel(values), dtype=np.float64)


def _rows(pressures: ArrayLike) -> Array:
    p = np.ascontiguousarray(pressures, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] != 3:
        raise refuse(
            "probe_pressures",
            where="five-hole probe",
            expected="pressures of shape (n, 3): p0 - static, p1 - p2, p3 - p4",
            found=f"shape {p.shape}",
            do="Stack the three differences as columns.",
        )
    return p
