"""The unknowns a reconstruction can estimate: biases, scale errors, upwash, wind.

A sensor reads `reference + (1 + k)(true - reference) + b`; an inertial sensor and an air-data
sensor share this form. Upwash is the scale error `k_alpha` (van den Hoek 2017, Eq. (5): C_up),
sidewash `k_beta`. Dittrich 2016, Eq. (3.1), (3.2).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from alula.base.messages import refuse
from alula.base.project import UnknownSpec
from alula.reconstruct.sensors import AIRDATA, GROUND, Sensor

INERTIAL = ("ax", "ay", "az", "p", "q", "r")
WIND = ("wind_n", "wind_e", "wind_d")
# Order of `PathUnknown` in core/include/alula/filters/path_model.hpp.
COMMON = tuple(f"b_{x}" for x in INERTIAL) + tuple(f"k_{x}" for x in INERTIAL) + WIND

# Standard deviation before the data are seen, where the project states none: generous, so that a
# well observed unknown does not feel it; one the data cannot tell stays about as uncertain.
_PRIOR = {"m/s2": 0.5, "rad/s": 0.02, "m/s": 3.0, "rad": 0.05, "m": 50.0}
_PRIOR_SCALE, _PRIOR_WIND = 0.2, 15.0


@dataclass(frozen=True)
class Unknown:
    """One unknown: free, or fixed at `value`. walk: per square root of a second; 0 is constant."""

    name: str
    unit: str
    free: bool
    value: float
    prior: float
    walk: float

    @property
    def inertial(self) -> bool:
        """Whether it enters the equations of motion."""
        return self.name in COMMON and self.name not in WIND


def choose_unknowns(
    sensors: Sequence[Sensor], specs: Mapping[str, UnknownSpec]
) -> tuple[Unknown, ...]:
    """All unknowns of this sensor set in the order of the state; unless the project says otherwise
    the six inertial biases are free, and the wind where air data meet ground speed.

    Raises BadInput for a name that this sensor set does not have.
    """
    kinds = {s.kind.removesuffix("_linear") for s in sensors}
    windy = bool(kinds & set(AIRDATA)) and bool(kinds & set(GROUND))
    units = {f"b_{x}": "m/s2" if x.startswith("a") else "rad/s" for x in INERTIAL}
    units |= {f"k_{x}": "1" for x in INERTIAL} | dict.fromkeys(WIND, "m/s")
    for sensor in sensors:
        units[f"k_{sensor.channel}"] = "1"
        units[f"b_{sensor.channel}"] = sensor.unit
    for name in specs:
        if name not in units:
            raise refuse(
                "unknown_unknown",
                where=f"reconstruct.unknowns.{name}",
                expected="one of " + ", ".join(units),
                found=f"'{name}'",
                do="b_ is a bias, k_ a scale error (upwash), of a sensor that is used.",
            )
    out = []
    for name, unit in units.items():
        spec = specs.get(name)
        default = (name.startswith("b_") and name in COMMON) or (name in WIND and windy)
        free = default if spec is None else spec.state != "off"
        spec = spec or UnknownSpec()
        prior = _PRIOR_WIND if name in WIND else _PRIOR_SCALE if unit == "1" else _PRIOR[unit]
        out.append(
            Unknown(
                name,
                unit,
                free,
                spec.in_si(spec.value),
                prior if spec.prior is None else spec.in_si(spec.prior),
                _walk(name, spec),
            )
        )
    # Inertial unknowns first: only they enter the rates.
    return tuple(sorted(out, key=lambda u: not u.inertial))


def _walk(name: str, spec: UnknownSpec) -> float:
    if spec.state != "walk":
        return 0.0
    if spec.walk is None:
        raise refuse(
            "missing_walk",
            where=f"reconstruct.unknowns.{name}",
            expected="'walk', the standard deviation gained in one second",
            found='state = "walk" without it',
            do='Add for example walk = 1e-4, or take state = "constant".',
        )
    return spec.in_si(spec.walk)
