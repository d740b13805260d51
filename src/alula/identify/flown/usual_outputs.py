"""Which readings tell of which motion, where nobody chooses."""

from __future__ import annotations

from collections.abc import Mapping

USUAL_OUTPUTS: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("V", "alpha", "theta", "q", "ax", "az"),
    "lateral": ("beta", "p", "r", "phi", "ay"),
    "six": ("V", "alpha", "beta", "p", "q", "r", "phi", "theta", "ax", "ay", "az"),
}
