"""`alula schema`: JSON schemas of the files that people write or carry on, for editors."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
)


class Kind(StrEnum):
    """The files that have a schema."""

    project = "project"
    aircraft = "aircraft"
    plan = "plan"
    propeller = "propeller"
    calibration = "calibration"


def schema(
    kind: Annotated[
        Kind, typer.Argument(metavar="KIND", help="Which file's schema.")
    ] = Kind.project,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Print the JSON schema of a project, aircraft, plan, propeller or IMU calibration file.

    Editors that know JSON schemas for TOML complete and check the files with it.
    """
    command = Command("schema", json, seed, threads, quiet)
    with command.run():
        import json as text

        if kind is Kind.project:
            from alula.base.project import Project

            found = Project.model_json_schema()
        elif kind is Kind.plan:
            from alula.simulate.virtual_plan import Plan

            found = Plan.model_json_schema()
        elif kind is Kind.propeller:
            from alula.aircraft.schema_blades import PropellerFile

            found = PropellerFile.model_json_schema(by_alias=True)
        elif kind is Kind.calibration:
            from alula.navigate.calibration.file import CalibrationFile

            found = CalibrationFile.model_json_schema(by_alias=True)
        else:
            from alula.aircraft import aircraft_schema

            found = aircraft_schema()
        command.result = found
        command.say(text.dumps(found, indent=2))
