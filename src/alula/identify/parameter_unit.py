"""Units of everything that a search over outputs estimates: derivatives, states, biases, noises."""

from __future__ import annotations

from dataclasses import replace

from alula.base.units import expected_unit
from alula.identify.result import Identification
from alula.identify.typical import TYPICAL, unit


def parameter_unit(belongs: str, name: str) -> str:
    """Unit of a parameter; belongs: the coefficient, state or output that it stands in.

    'F_q' drives a state: the state's unit over the root of a second, 'rad/s^1.5'. 'sigma_q',
    'b_q' and 'q(0)[id]' have the unit of what they belong to, delays are in seconds. '' where that
    is not known, as of the parameters of a linear model's own rows.
    """
    if name.startswith("F_"):
        return _per_root_second(expected_unit(belongs) or "")
    if name.startswith(("sigma_", "b_")) or "(0)" in name:
        return expected_unit(belongs) or ""
    if name.startswith("delay_"):
        return "s"
    return unit(belongs, name) if belongs in TYPICAL else ""


def with_units(result: Identification) -> Identification:
    """The result with the unit of each parameter that states none."""
    return replace(
        result,
        parameters=tuple(
            p if p.unit else replace(p, unit=parameter_unit(p.coefficient, p.name))
            for p in result.parameters
        ),
    )


def _per_root_second(si: str) -> str:
    """'rad' becomes 'rad/s^0.5', 'rad/s' 'rad/s^1.5', 'rad/s2' 'rad/s^2.5'."""
    if not si:
        return ""
    head, over, power = si.partition("/s")
    whole = int(power or 1) if over else 0
    return f"{head}/s^{whole + 0.5:g}"
