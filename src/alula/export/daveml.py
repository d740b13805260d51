"""An AeroModel to a DAVE-ML file, read back and compared before it is called exported."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date as calendar
from pathlib import Path

import numpy as np

from alula.base.files import write_whole
from alula.base.messages import Message, refuse, warn
from alula.export.daveml_cases import model_variables, spread_points
from alula.export.daveml_import import import_daveml
from alula.export.daveml_read import parse_daveml
from alula.export.daveml_write import daveml_text
from alula.model import AeroModel

_AGREES = 1e-12  # of the largest coefficient: the same sums, rounded in another order
_POINTS = 1000


@dataclass(frozen=True)
class Exported:
    """What was written, and how it compared. difference: largest, by name of what was compared."""

    files: tuple[Path, ...]
    difference: dict[str, float]
    messages: tuple[Message, ...] = ()


def export_daveml(
    model: AeroModel, path: Path | str, *, author: str = "Alula", date: str | None = None
) -> Exported:
    """Write the model as DAVE-ML to `path`, whole or not at all.

    Before anything is written, the text is read by `read_daveml`, its check cases are run, and the
    model imported from it is compared: terms by name, values to the bit, coefficients at 1000
    points. date: ISO 8601, default today. Raises BadInput where the standard cannot hold the model.
    """
    path = Path(path)
    text = daveml_text(model, author=author, date=date or calendar.today().isoformat())
    difference = compare_daveml(model, text)
    write_whole(path, text)
    messages = []
    if model.stall is not None:
        messages.append(
            warn(
                "stall_left_out",
                where=str(path),
                expected="a model without states: DAVE-ML tables are static",
                found="[stall]",
                do="The file holds the attached flow's coefficients; do not fly it beyond them.",
            )
        )
    return Exported((path,), difference, tuple(messages))


def compare_daveml(model: AeroModel, text: str) -> dict[str, float]:
    """Largest differences between a model and its DAVE-ML text as read back, by coefficient.

    Raises BadInput where a check case fails, a value differs by a bit or a coefficient by more
    than 1e-12 of its size.
    """
    dave = parse_daveml(text)
    failed = [c for c in dave.check() if not c.passed]
    back = import_daveml(dave).model
    # A value of zero is no term in the file.
    kept = {n: v for n, v in model.params.items() if v != 0.0}
    points = model_variables(model, spread_points(model, _POINTS, seed=1))
    ours, theirs = model.evaluate(points), back.evaluate(points)
    difference = {c: float(np.max(np.abs(ours[c] - theirs[c]))) for c in model.coefficients}
    size = {c: max(1.0, float(np.max(np.abs(ours[c])))) for c in model.coefficients}
    apart = [c for c in difference if not difference[c] <= _AGREES * size[c]]
    read = {n: v for n, v in back.params.items() if v != 0.0}
    if failed or apart or read != kept:
        names = sorted(n for n in {*kept, *read} if kept.get(n) != read.get(n))
        raise refuse(
            "export_differs",
            where=f"DAVE-ML of '{model.name}'",
            expected="the model itself when read back",
            found=f"{len(failed)} check cases failed; coefficients apart: {apart or 'none'}; "
            f"values apart: {names or 'none'}",
            do="Nothing was written; please report it with the model.",
        )
    return difference
