"""What `alula new` proposes to estimate: sensor errors and formulas, by the channels there are."""

from __future__ import annotations


def reconstruct_lines(names: set[str]) -> list[str]:
    """What is estimated of the sensors, and the entries that a vane most often needs."""
    vanes = [name for name in ("alpha", "beta", "beta_flank") if name in names]
    if not vanes:
        return []
    lines = [
        "",
        "# Estimated by default: biases of the inertial sensors, and the wind where ground speed",
        "# is recorded. Gain (k_) and bias (b_) of a vane, where the maneuvers can tell them:",
        "# [reconstruct.unknowns]",
    ]
    for name in vanes:
        lines += [f"# k_{name} = {{prior = 0.1}}", f'# b_{name} = {{prior = 0.5, unit = "deg"}}']
    return lines


def model_lines(names: set[str]) -> list[str]:
    """A formula for each coefficient: linear in what is there."""
    longitudinal = "1 + alpha + qhat" + (" + de" if "de" in names else "")
    da, dr = (" + da" if "da" in names else ""), (" + dr" if "dr" in names else "")
    return [
        'CX = "1 + alpha + alpha^2"',
        f'CZ = "{longitudinal}"',
        f'Cm = "{longitudinal}"',
        f'CY = "1 + beta + phat + rhat{dr}"',
        f'Cl = "1 + beta + phat + rhat{da}{dr}"',
        f'Cn = "1 + beta + phat + rhat{da}{dr}"',
    ]
