"""An aircraft with its model to a JSBSim aircraft, flown there before it is called exported."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from datetime import date as calendar
from pathlib import Path

import numpy as np

from alula.aircraft import Aircraft
from alula.base.files import write_whole
from alula.base.messages import Message, refuse, warn
from alula.export.jsbsim_check import (
    ANGLES,
    Comparison,
    compare_jsbsim,
    require_jsbsim,
)
from alula.export.jsbsim_write import jsbsim_name, jsbsim_text
from alula.model import AeroModel
from alula.simulate import Airframe, Condition


@dataclass(frozen=True)
class JsbsimExport:
    """The file written, and the flights that were flown in both; none where it is unchecked."""

    path: Path
    comparisons: tuple[Comparison, ...]
    messages: tuple[Message, ...]


def export_jsbsim(
    aircraft: Aircraft,
    airframe: Airframe,
    model: AeroModel,
    folder: Path | str,
    *,
    condition: Condition | None = None,
    author: str = "Alula",
    date: str | None = None,
    unchecked: bool = False,
) -> JsbsimExport:
    """Write FOLDER/NAME/NAME.xml, which JSBSim loads with FOLDER as its aircraft path.

    airframe: the loading, with engines and actuators as they shall be. JSBSim flies a doublet of
    the elevator and one of the rudder for 20 s from trim (condition; default level, inside the
    envelope) beside Alula first; nothing is written where V departs by more than 0.2 m/s or an
    angle by more than 0.1 deg. unchecked: write NAME_unchecked without flying. Raises BadInput
    where JSBSim is missing, refuses the file, flies otherwise, or cannot hold the model.
    """
    folder = Path(folder)
    if not unchecked:
        require_jsbsim()
    text = jsbsim_text(
        aircraft, airframe, model, author=author, date=date or calendar.today().isoformat()
    )
    name = jsbsim_name(aircraft)
    comparisons: tuple[Comparison, ...] = ()
    if not unchecked:
        with tempfile.TemporaryDirectory() as scratch:
            _write(Path(scratch), name, text)
            comparisons = compare_jsbsim(
                aircraft, airframe, model, Path(scratch), condition=condition
            )
        for c in comparisons:
            if not c.passed:
                raise _differs(aircraft, c)
    path = _write(folder, f"{name}_unchecked" if unchecked else name, text)
    return JsbsimExport(path, comparisons, tuple(_remarks(path, unchecked)))


def _write(folder: Path, name: str, text: str) -> Path:
    path = folder / name / f"{name}.xml"
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise refuse(
            "output_not_writable",
            where=str(path.parent),
            expected="a folder that can be made",
            found=error.strerror or str(error),
            do="Choose another folder; nothing was written.",
        ) from None
    write_whole(path, text)
    return path


def _differs(aircraft: Aircraft, c: Comparison) -> Exception:
    d = c.difference
    worst = max(ANGLES, key=lambda n: d[n])
    return refuse(
        "export_differs",
        where=f"{aircraft.name} in JSBSim, {c.maneuver}",
        expected="V within 0.2 m/s and angles within 0.1 deg of Alula's own flight over 20 s",
        found=f"V apart by {d['V']:.3g} m/s, {worst} by {np.degrees(d[worst]):.3g} deg",
        do="Nothing was written. An aircraft that diverges by itself cannot be compared in this "
        "condition: choose another one.",
    )


def _remarks(path: Path, unchecked: bool) -> list[Message]:
    out = []
    if unchecked:
        out.append(
            warn(
                "export_unchecked",
                where=str(path),
                expected="a flight in JSBSim beside Alula's",
                found="none, as asked",
                do="Check it before you trust it.",
            )
        )
    return out
