"""What output error compares with: one maneuver's sensors and all that the model is driven by.

Outputs are readings, each corrected by the constants that reconstruction found (bias, upwash,
position of the sensor), never its smoothed states: a smoother's output has forgotten its noise.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.flight import Maneuver, Motion
from alula.identify.coefficients import Reference, Thrust, body_coefficients

STATES = ("V", "alpha", "beta", "p", "q", "r", "phi", "theta")  # in the core's order
OUTPUTS = (*STATES, "ax", "ay", "az", "pdot", "qdot", "rdot")
CONTROLS = ("de", "da", "dr", "df", "dt")
GRAVITY = 9.80665  # m/s2


@dataclass(frozen=True)
class MeasuredManeuver:
    """One maneuver for output error; arrays (n,), SI and radians, body axes.

    outputs: by name, of `OUTPUTS`; V alpha beta against the air, ax ay az specific force, all at
    the center of gravity; NaN where a sensor says nothing. motion: the eight of `STATES` as
    measured, which stand in for those that are not states of the model. controls: de da dr df dt.
    coefficients: as measured, which stand in for those that have no formula. force (n, 3) N and
    moment (n, 3) N m about the center of gravity: engines. inertia: (3, 3) kg m2, products with
    their minus signs. arm: (3,) m from the center of gravity to the moments' reference point.
    """

    maneuver: Maneuver
    t: Array
    outputs: Mapping[str, Array]
    motion: Mapping[str, Array]
    controls: Mapping[str, Array]
    rho: Array
    reference: Reference
    mass: float
    inertia: Array
    speed_of_sound: Array
    force: Array
    moment: Array
    arm: Array
    coefficients: Mapping[str, Array] = field(default_factory=dict)
    gravity: float = GRAVITY

    def __post_init__(self) -> None:
        n = len(self.t)
        where = f"maneuver {self.maneuver.id}"
        for name in self.outputs:
            if name not in OUTPUTS:
                raise refuse(
                    "unknown_output",
                    where=where,
                    expected=f"outputs of {', '.join(OUTPUTS)}",
                    found=f"'{name}'",
                    do="Name what was measured by one of these.",
                )
        every = {
            **{f"output {k}": v for k, v in self.outputs.items()},
            **self.motion,
            **self.controls,
            **{f"measured {k}": v for k, v in self.coefficients.items()},
            "rho": self.rho,
            "speed_of_sound": self.speed_of_sound,
            "force": self.force,
            "moment": self.moment,
        }
        for name, values in every.items():
            if len(values) != n:
                raise refuse(
                    "wrong_length",
                    where=f"{where}, {name}",
                    expected=f"{n} samples",
                    found=f"{len(values)}",
                    do="Give one value per sample.",
                )
            if not name.startswith("output ") and not np.isfinite(values).all():
                raise refuse(
                    "not_finite",
                    where=f"{where}, {name}",
                    expected="finite numbers at every sample",
                    found=f"{int(np.sum(~np.isfinite(values)))} that are not",
                    do="Choose a window without invalid samples: inputs cannot have gaps.",
                )
        if n < 2 or not (np.diff(self.t) > 0.0).all():
            raise refuse(
                "uneven_time",
                where=where,
                expected="at least two samples, time increasing",
                found=f"{n} samples",
                do="Choose another window.",
            )
        if not (self.mass > 0.0 and np.linalg.eigvalsh(self.inertia).min() > 0.0):
            raise refuse(
                "mass_properties",
                where=where,
                expected="a positive mass and a positive definite inertia tensor",
                found=f"mass {self.mass}, inertia {np.diag(self.inertia)}",
                do="State the aircraft's mass properties.",
            )


def measured_maneuver(
    motion: Motion,
    reference: Reference,
    *,
    mass: Array,
    cg: Array,
    inertia: Array,
    thrust: Sequence[Thrust] = (),
    readings: Mapping[str, Array] | None = None,
    outputs: Sequence[str] = OUTPUTS,
    gravity: float = GRAVITY,
) -> MeasuredManeuver:
    """The maneuver of a motion. Mass properties: their mean over the maneuver is taken.

    mass (n,) or (1,) kg, cg (n, 3) m, inertia (n, 3, 3) kg m2 as `coefficients_from_motion` takes
    them. readings: the sensors' own values (n,) by name where the motion holds smoothed ones; for
    outputs that they lack the motion's are taken. Raises BadInput for what does not fit.
    """
    n = len(motion.t)
    given = readings or {}
    center = np.mean(cg, axis=0)
    force, moment = np.zeros((n, 3)), np.zeros((n, 3))
    for engine in thrust:
        pull = engine.force[:, None] * engine.direction
        force += pull
        moment += np.cross(engine.position - cg, pull)
    temperature = np.maximum(288.15 - 0.0065 * motion.h, 216.65)  # ISO 2533
    coefficients = {**body_coefficients(motion, reference, mass, cg, inertia, thrust)}
    coefficients.update({k: v for k, v in motion.recorded.items() if k in coefficients})
    return MeasuredManeuver(
        maneuver=motion.maneuver,
        t=motion.t,
        outputs={name: frozen(given.get(name, getattr(motion, name))) for name in outputs},
        motion={name: frozen(getattr(motion, name)) for name in STATES},
        controls={k: v for k, v in motion.controls.items() if k in CONTROLS},
        rho=motion.rho,
        reference=reference,
        mass=float(np.mean(mass)),
        inertia=frozen(np.mean(inertia, axis=0)),
        speed_of_sound=frozen(np.sqrt(1.4 * 287.05287 * temperature)),
        force=frozen(force),
        moment=frozen(moment),
        arm=frozen(np.asarray(reference.point) - center),
        coefficients={name: frozen(v) for name, v in coefficients.items()},
        gravity=gravity,
    )
