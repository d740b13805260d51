"""Small plans for tests of the virtual flight test."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from alula.simulate.virtual_loading import toml_text
from alula.simulate.virtual_plan import Plan, load_plan

AIRCRAFT = Path(__file__).parents[2] / "aircraft"


def plan_tree(**more: Any) -> dict[str, Any]:
    """One elevator doublet of the SportStar at 45 m/s, 6 s at 50 Hz, sensors without errors."""
    return {
        "schema": "alula.plan/1",
        "name": "small",
        "aircraft": str(AIRCRAFT / "sportstar.toml"),
        "model": str(AIRCRAFT / "sportstar_aero.toml"),
        "duration": 6.0,
        "engines": "given",
        "conditions": [{"V": 45.0, "h": 915.0}],
        "maneuvers": [{"id": "pull", "inputs": [doublet("de", 1.5)]}],
        **more,
    }


def doublet(control: str, amplitude_deg: float, **more: Any) -> dict[str, Any]:
    """A doublet's table."""
    return {
        "control": control, "kind": "doublet", "amplitude_deg": amplitude_deg, "start": 1.0,
        "width": 0.5, "ramp": 0.2, **more,
    }  # fmt: skip


def small_plan(folder: Path, **more: Any) -> Plan:
    """The plan of `plan_tree`, written and read."""
    path = folder / "plan.toml"
    path.write_text(toml_text(plan_tree(**more)))
    return load_plan(path)
