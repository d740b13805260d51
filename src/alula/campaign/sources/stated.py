"""What a source states, in its own conventions, and what everything is brought to.

Compared are values as an aerodynamic model of Alula holds them: drag and lift along stability axes,
rates and moments along body axes, per rad and hat, about one point, on one reference.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse
from alula.identify.compare import Entry
from alula.model import Reference
from alula.predict.derivatives import PredictionAxes

COEFFICIENTS = ("CD", "CY", "CL", "Cl", "Cm", "Cn")
LARGEST = 20_000_000  # bytes of a table


@dataclass(frozen=True)
class Stated:
    """entries: by Alula's names, per rad and hat, signs as Alula has them.

    kind: 'prediction', 'avl', 'datcom', 'table'. axes: of rates and moments. alpha: rad, at which
    the derivatives hold; None where it is not said. point: (3,) m, of the moments, body axes from
    the aircraft's datum; aft: the same in the program's own axes (x aft, y right, z up) and unit,
    whose origin the aircraft file does not know.
    """

    name: str
    kind: str
    method: str
    entries: Mapping[str, Entry]
    axes: PredictionAxes
    alpha: float | None = None
    reference: Reference | None = None
    point: Array | None = None
    aft: tuple[float, float, float] | None = None
    se_is: str = ""
    messages: tuple[Message, ...] = field(default=())


def not_a_table(where: str, expected: str, found: str, do: str = "") -> BadInput:
    """The refusal that readers of other programs' output share."""
    return refuse(
        "unreadable_derivatives",
        where=where,
        expected=expected,
        found=found,
        do=do or "Give the file as the program wrote it, or a table (docs/methods/prediction.md).",
    )
