"""From a recorded maneuver to what the simulator flies: even time, start, driven coefficients."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.flight import Motion
from alula.model import AXES, AeroModel, Factor, Term
from alula.reconstruct.transfer import standard_density
from alula.validate.case import Case

STATES = ("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "psi", "h")
FORCES = ("ax", "ay", "az")
SPARE = ("df", "dt", "dr", "da", "de")  # inputs that can carry a recorded coefficient
LOWEST, HIGHEST = -2000.0, 80_000.0  # m, of the search for the height of a density
SAME_DENSITY = 1e-3  # relative; below the uncertainty of any recorded density


@dataclass(frozen=True)
class Recording:
    """A maneuver on even times t (n,): motion, controls and thrust as recorded, (n,) each.

    height_shift: m, added to h so that the standard atmosphere has the recorded density.
    coefficients: as measured, (n,) each.
    """

    t: Array
    channels: Mapping[str, Array]
    controls: Mapping[str, Array]
    thrust: Array
    coefficients: Mapping[str, Array]
    height_shift: float
    messages: tuple[Message, ...]


def recording(case: Case, horizon: float | None) -> Recording:
    """The maneuver, or its first `horizon` s, on even times, with what was done to it."""
    motion = case.motion
    where = f"maneuver {motion.maneuver.id}"
    n = len(motion.t)
    if horizon is not None:
        n = max(2, int(np.searchsorted(motion.t, motion.t[0] + horizon + 1e-9)))
    t_recorded = motion.t
    step = (t_recorded[-1] - t_recorded[0]) / (len(t_recorded) - 1)
    even = t_recorded[0] + step * np.arange(len(t_recorded))
    off = float(np.max(np.abs(t_recorded - even)))
    messages: list[Message] = []
    if off > 1e-6 * step:
        messages.append(
            note(
                "resampled",
                where=where,
                expected="evenly spaced samples, as the simulator steps",
                found=f"times up to {1e3 * off:.3g} ms off the even spacing of {1e3 * step:.5g} ms",
                do="Motion and controls were interpolated linearly to the even times.",
            )
        )

    def on(values: Array) -> Array:
        whole = values if off <= 1e-6 * step else np.interp(even, t_recorded, values)
        return np.asarray(whole[:n], dtype=np.float64)

    angles = {name: np.unwrap(getattr(motion, name)) for name in ("phi", "psi")}
    shift, said = _height_shift(motion, where)
    messages += said
    thrust = np.zeros(len(t_recorded)) if case.thrust is None else case.thrust
    return Recording(
        t=even[:n],
        channels={name: on(angles.get(name, getattr(motion, name))) for name in (*STATES, *FORCES)},
        controls={name: on(values) for name, values in motion.controls.items()},
        thrust=on(thrust),
        coefficients={name: on(values) for name, values in case.coefficients.items()},
        height_shift=shift,
        messages=tuple(messages),
    )


def _height_shift(motion: Motion, where: str) -> tuple[float, list[Message]]:
    """How far to lift the flight so that the standard atmosphere has the recorded density."""
    rho, h = float(motion.rho[0]), float(motion.h[0])
    standard = float(standard_density(np.array([h]))[0])
    if abs(rho / standard - 1.0) <= SAME_DENSITY:
        return 0.0, []

    def excess(height: float) -> float:
        return float(np.log(standard_density(np.array([height]))[0] / rho))

    if not excess(LOWEST) > 0.0 > excess(HIGHEST):
        raise refuse(
            "density",
            where=where,
            expected="an air density that the standard atmosphere has somewhere",
            found=f"{rho:g} kg/m3",
            do="Correct the channel 'rho' or its unit.",
        )
    shift = float(brentq(excess, LOWEST, HIGHEST, xtol=1e-3)) - h
    return shift, [
        note(
            "density_altitude",
            where=where,
            expected=f"the standard atmosphere's density at the height, {standard:.5g} kg/m3",
            found=f"{rho:.5g} kg/m3 at the start",
            do=f"Flown {shift:+.5g} m from there, where the standard atmosphere has it; "
            "heights are shown as recorded.",
        )
    ]


def driven(
    model: AeroModel, record: Recording, offsets: Mapping[str, float], where: str
) -> tuple[AeroModel, dict[str, Array], tuple[str, ...]]:
    """The model with its gaps filled from the recording, and the controls that it is flown with.

    A coefficient without a term becomes an input of its own that carries the recorded history.
    Returns (model, controls, coefficients as recorded). Raises BadInput where a control that the
    model needs, or a coefficient that it lacks, was not recorded.
    """
    used = {name for _, term in model.terms for f in term.factors for name in f.variables}
    if model.stall is not None:
        used |= {"alpha"}
    needed = [n for n in SPARE if n in used]
    without = [n for n in needed if n not in record.controls]
    if without:
        raise refuse(
            "missing_control",
            where=where,
            expected=f"recordings of {', '.join(needed)}, which the model '{model.name}' needs",
            found=f"none of {', '.join(without)}",
            do="Map them in [channels], or take a model without them.",
        )
    lacking = tuple(c for c in AXES[model.axes] if c not in model.coefficients)
    unknown = [c for c in lacking if c not in record.coefficients]
    if unknown:
        raise refuse(
            "coefficient_not_modeled",
            where=where,
            expected=f"a formula for every coefficient in the model '{model.name}', or a recording "
            "of those that it lacks",
            found=f"neither for {', '.join(unknown)}",
            do="Add them to [identify.models], or state mass and inertia in the aircraft file.",
        )
    spare = [n for n in SPARE if n not in used]
    if len(spare) < len(lacking):
        raise refuse(
            "coefficient_not_modeled",
            where=where,
            expected=f"a model of at least {len(AXES[model.axes]) - len(spare)} coefficients",
            found=f"none of {', '.join(lacking)}",
            do="Add formulas to [identify.models].",
        )
    controls = {n: record.controls[n] for n in needed}
    added: list[tuple[str, Term]] = []
    values: list[float] = []
    for coefficient, name in zip(lacking, spare, strict=False):
        controls[name] = record.coefficients[coefficient]
        added.append((coefficient, Term((Factor(name),))))
        values.append(1.0)
    for coefficient, value in offsets.items():
        added.append((coefficient, Term()))
        values.append(value)
    flown = replace(
        model,
        terms=(*model.terms, *added),
        values=np.concatenate([model.values, values]),
        covariance=None,
    )
    return flown, controls, lacking
