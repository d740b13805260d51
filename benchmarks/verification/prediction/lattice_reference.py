"""Every value of the reference lattices, to the printed digits."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from verification.places import DATA, ROOT

sys.path.insert(0, str(ROOT / "tests" / "predict"))
from lattice_shapes import reference_case

from alula.predict.vortex_lattice import vortex_lattice

UNIT = 1e-6  # of the last printed digit; trailing zeros are not printed
# The reference's names, in Alula's: its elevator is positive as de is.
NAMES = {"CL_elevator_per_deg": "CL_de_per_deg", "Cm_elevator_per_deg": "Cm_de_per_deg"}


def compared(path: Path) -> Iterator[tuple[str, str, float, float]]:
    """Case with mesh, name, found and printed value of all that the file holds."""
    for case in json.loads(path.read_text())["cases"]:
        geometry, reference, point = reference_case(case)
        for expected in case["expected"]:
            mesh: dict[str, Any] = {k: tuple(v) for k, v in expected["panels"].items()}
            result = vortex_lattice(geometry, reference, point, panels=mesh)
            found = result.derivatives("stability")
            found |= result.derivatives("stability", per_degree=True)
            for name, value in expected.items():
                if name != "panels":
                    label = f"{case['name']}, {mesh}"
                    yield label, name, found[NAMES.get(name, name)], value


def units_apart(found: float, printed: float) -> int:
    """Units in the last printed digit between a value, rounded, and the printed one."""
    return abs(round(round(found, 6) / UNIT) - round(printed / UNIT))


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found in words, and whether every value is within one unit in the last digit."""
    rows = list(compared(DATA / "references" / "vortex_lattice.json"))
    off = [(label, name, f, p) for label, name, f, p in rows if units_apart(f, p) > 1]
    exact = sum(units_apart(f, p) == 0 for _, _, f, p in rows)
    words = f"{len(rows)} values, {exact} to the last digit, {len(off)} off by more than one unit"
    words += "".join(f"; {label}: {name} {f:.7f}, printed {p}" for label, name, f, p in off[:5])
    return words, bool(rows) and not off


if __name__ == "__main__":
    print(*check())
