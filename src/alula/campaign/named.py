"""A project's maneuvers by the ids that name them."""

from __future__ import annotations

from collections.abc import Sequence

from alula.base.messages import refuse
from alula.base.project import Project
from alula.flight import Maneuver


def named(project: Project, found: Sequence[Maneuver], ids: Sequence[str]) -> tuple[Maneuver, ...]:
    """The maneuvers of `ids`, by their own id or, where split at gaps, by the whole one's; all of
    them if there are no ids. Raises BadInput for an id that names none.
    """
    if not ids:
        return tuple(found)
    wholes = [m.id for m in project.maneuvers]
    names = {m.id: {m.id} for m in found}
    for maneuver in found:
        whole = maneuver.id.rpartition(".")[0]
        if whole in wholes and maneuver.id not in wholes:
            names[maneuver.id].add(whole)
    known = {name for group in names.values() for name in group}
    for id in ids:
        if id not in known:
            raise refuse(
                "unknown_maneuver",
                where="--maneuver",
                expected="one of " + (", ".join(sorted(known)) or "the project's, which has none"),
                found=f"'{id}'",
                do="Name a maneuver of the project file.",
            )
    return tuple(m for m in found if names[m.id] & set(ids))
