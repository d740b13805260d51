"""Propellers that the tests share."""

from __future__ import annotations

from typing import Any

import numpy as np

from alula.aircraft.blades import Blades, MomentumParameters
from alula.aircraft.load_blades import load_blades

PARAMETERS = MomentumParameters(c_l_alpha=5.2, alpha_max=0.25, c_d_alpha=1.1, pitch=0.3)


def table(**other: Any) -> dict[str, Any]:
    """[blades] of a two-blade propeller of 20 inches."""
    given: dict[str, Any] = {
        "name": "test",
        "count": 2,
        "diameter": 0.508,
        "r": [0.04, 0.08, 0.127, 0.18, 0.23, 0.254],
        "chord": [0.026, 0.038, 0.040, 0.034, 0.023, 0.010],
        "pitch": 0.254,
        "polar": {
            "c_l_0": 0.3,
            "c_l_alpha": 5.7,
            "c_l_min": -0.5,
            "c_l_max": 1.2,
            "c_d_0": 0.012,
            "c_d_2_upper": 0.01,
            "c_d_2_lower": 0.01,
            "c_l_cd0": 0.3,
            "reynolds": 1e5,
            "reynolds_power": -0.4,
        },
    }
    given.update(other)
    return {key: value for key, value in given.items() if value is not None}


def blades(**other: Any) -> Blades:
    """The same as a value."""
    return load_blades(table(**other), "test.toml, blades")


def toml(name: str = "test", **other: Any) -> str:
    """A propeller file of these blades; `other` goes into [blades]."""

    def value(x: Any) -> str:
        if isinstance(x, dict):
            return "{ " + ", ".join(f"{k} = {value(v)}" for k, v in x.items()) + " }"
        if isinstance(x, list | tuple | np.ndarray):
            return "[" + ", ".join(value(v) for v in x) + "]"
        if isinstance(x, str):
            return f'"{x}"'
        return str(x).lower() if isinstance(x, bool) else repr(x)

    lines = [f"{key} = {value(v)}" for key, v in table(**other).items()]
    return f'schema = "alula.propeller/1"\nname = "{name}"\n[blades]\n' + "\n".join(lines) + "\n"
