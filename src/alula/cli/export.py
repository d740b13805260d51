"""`alula export MODEL`: an aerodynamic model in the form that other programs take."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.condition import ActuatorsOption, Engines, EnginesOption, FuelOption
from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
    writable,
)

if TYPE_CHECKING:
    from alula.aircraft import Aircraft
    from alula.base.messages import Message
    from alula.flight import SourceFile
    from alula.model import AeroModel


class Form(StrEnum):
    """What is written."""

    jsbsim = "jsbsim"
    daveml = "daveml"
    model = "model"


def export(
    model: Annotated[
        Path, typer.Argument(metavar="MODEL", help="The model: Alula's file, or DAVE-ML.")
    ],
    to: Annotated[Form, typer.Option("--to", help="model: Alula's own file, of a DAVE-ML one.")],
    out: Annotated[
        Path, typer.Option("--out", metavar="FILE|DIR", help="DIR: JSBSim's aircraft path.")
    ],
    aircraft: Annotated[
        Path | None,
        typer.Option("--aircraft", metavar="FILE", help="The aircraft file, for JSBSim."),
    ] = None,
    fuel_used: FuelOption = 0.0,
    engines: EnginesOption = Engines.modeled,
    actuators: ActuatorsOption = False,
    V: Annotated[
        float | None,
        typer.Option("--V", metavar="M/S", help="Airspeed of the flights compared in JSBSim."),
    ] = None,
    h: Annotated[float | None, typer.Option("--h", metavar="M", help="Their height.")] = None,
    unchecked: Annotated[
        bool, typer.Option("--unchecked", help="Write without flying in JSBSim; the name says so.")
    ] = False,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Export a model to JSBSim or DAVE-ML, or import one of DAVE-ML.

    What is written has been loaded by its consumer and compared with the original. Exit 0:
    exported. 2: bad input, or it differs; nothing was written.
    """
    command = Command("export", json, seed, threads, quiet)
    with command.run():
        loaded, said, files = _load(model)
        if to is Form.jsbsim:
            result, more = _jsbsim(
                loaded, out, aircraft, files, command,
                fuel_used=fuel_used, engines=engines.value, actuators=actuators, V=V, h=h,
                unchecked=unchecked,
            )  # fmt: skip
        elif to is Form.daveml:
            result, more = _daveml(loaded, out)
        else:
            from alula.model import save_model

            writable(out, "model")
            save_model(loaded, out)
            result, more = {"files": [str(out)], "compared": []}, ()
        command.inputs = files
        command.messages = [*said, *more]
        command.result = {"to": to.value, "checked": not unchecked, **result}
        command.say(_text(result, unchecked))


def _load(path: Path) -> tuple[AeroModel, list[Message], list[SourceFile]]:
    from alula.cli.condition import source_of

    if path.suffix.lower() in (".dml", ".xml"):
        from alula.export.daveml_import import import_daveml
        from alula.export.daveml_read import read_daveml

        found = import_daveml(read_daveml(path))
        return found.model, list(found.messages), [source_of(path)]
    from alula.model import load_model

    return load_model(path), [], [source_of(path)]


def _daveml(model: AeroModel, out: Path) -> tuple[dict[str, Any], tuple[Message, ...]]:
    from alula.export.daveml import export_daveml

    _own(out)
    done = export_daveml(model, out)
    compared = [{"with": "read back, at 1000 points", "difference": done.difference}]
    return {"files": [str(f) for f in done.files], "compared": compared}, done.messages


def _jsbsim(
    model: AeroModel,
    out: Path,
    aircraft: Path | None,
    files: list[SourceFile],
    command: Command,
    *,
    fuel_used: float,
    engines: Any,
    actuators: bool,
    V: float | None,
    h: float | None,
    unchecked: bool,
) -> tuple[dict[str, Any], tuple[Message, ...]]:
    from dataclasses import replace

    from alula.aircraft import load_aircraft
    from alula.base.messages import refuse
    from alula.cli.condition import source_of
    from alula.export.jsbsim import export_jsbsim
    from alula.export.jsbsim_check import entry_condition
    from alula.export.jsbsim_write import jsbsim_name
    from alula.simulate import airframe_of

    if aircraft is None:
        raise refuse(
            "no_aircraft",
            where="alula export --to jsbsim",
            expected="--aircraft FILE: mass, engines and controls",
            found="none",
            do="Name the aircraft file.",
        )
    plane: Aircraft = load_aircraft(aircraft)
    files.append(source_of(aircraft))
    airframe = airframe_of(plane, fuel_used, engines=engines, actuators=actuators)
    condition = entry_condition(plane, airframe, model)
    condition = replace(condition, V=V or condition.V, h=condition.h if h is None else h)
    name = jsbsim_name(plane)
    _own(out / name / f"{name}.xml")
    if not unchecked:
        command.progress(f"flying in JSBSim, {condition.words}")
    done = export_jsbsim(plane, airframe, model, out, condition=condition, unchecked=unchecked)
    compared = [{"with": c.maneuver, "difference": dict(c.difference)} for c in done.comparisons]
    messages = (*plane.messages, *done.messages)
    return {"files": [str(done.path)], "compared": compared}, messages


def _own(path: Path) -> None:
    """Raise BadInput where a file is in the way that Alula did not write."""
    from alula.base.messages import refuse

    if path.is_file() and b"written by Alula" not in path.read_bytes()[:8192]:
        raise refuse(
            "output_not_writable",
            where=str(path),
            expected="a free name, or an export of Alula's to replace",
            found="another kind of file",
            do="Choose another path; nothing was done yet.",
        )
    if path.parent.is_dir():
        writable(path)


def _text(result: dict[str, Any], unchecked: bool) -> str:
    lines = [f"{'Written, unchecked' if unchecked else 'Exported'}: {f}" for f in result["files"]]
    for c in result["compared"]:
        apart = ", ".join(f"{n} {x:.2g}" for n, x in c["difference"].items())
        lines.append(f"  {c['with']}: largest differences (SI, rad) {apart}")
    return "\n".join(lines)
