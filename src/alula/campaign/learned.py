"""Which samples a model was estimated from, so that nothing else is called a validation."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from alula.flight import Flight, Maneuver
from alula.identify import CoefficientData
from alula.model import AeroModel

if TYPE_CHECKING:
    from alula.validate.result import Seen

LEARNED = "learned from"  # key of a model's provenance
_WINDOW = re.compile(r"\[([0-9a-f]{12}), (\S+) to (\S+) s\]")


def learned_from(data: Iterable[CoefficientData], flights: Mapping[str, Flight]) -> str:
    """The windows that a model is estimated from, by the hash of their log, for its provenance.

    'elevator [1f0c5a…, 0.0 to 25.0 s]; ...': twelve digits of the SHA-256 of the log's file.
    """
    parts = []
    for item in data:
        m = item.maneuver
        for file in flights[m.log].files:
            parts.append(f"{m.id} [{file.sha256[:12]}, {m.start!r} to {m.end!r} s]")
    return "; ".join(parts)


def seen_by(model: AeroModel, maneuver: Maneuver, flight: Flight) -> Seen:
    """Whether the model was estimated from samples of this maneuver, by its provenance.

    A model that does not name its windows but the hashes of its logs has seen all of them; one
    that names neither leaves it unknown.
    """
    hashes = {file.sha256 for file in flight.files}
    if LEARNED in model.provenance:
        for sha, start, end in _WINDOW.findall(model.provenance[LEARNED]):
            same = any(h.startswith(sha) for h in hashes)
            if same and float(start) < maneuver.end and float(end) > maneuver.start:
                return "yes"
        return "no"
    known = {v for v in model.provenance.values() if re.fullmatch(r"[0-9a-f]{64}", v)}
    if not known:
        return "unknown"
    return "yes" if hashes & known else "no"
