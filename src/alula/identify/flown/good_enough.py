"""Standard errors at which a parameter counts as known, whatever its value."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from alula.model import reference_scales

# Initial states: m/s; rad, rad/s.
_AIRSPEED, _OTHERS = 0.5, 0.01


def good_enough(models: Mapping[str, str], names: Iterable[str]) -> dict[str, float]:
    """By name: the scales that formulas state, and those of the initial states among `names`."""
    out = {n: scale for c, f in models.items() for n, scale in reference_scales(c, f).items()}
    return out | {n: _AIRSPEED if n.startswith("V(") else _OTHERS for n in names if "(0)" in n}
