"""A propeller's description from any file that Alula reads."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from alula.aircraft.blades import Blades
from alula.aircraft.load_blades import blades_of
from alula.aircraft.propeller_files import read_blades
from alula.aircraft.schema_blades import FitTable, PropellerFile, StaticTestTable, TestTable
from alula.base.messages import refuse
from alula.base.project_messages import read_toml, validated


@dataclass(frozen=True)
class PropellerDescription:
    """Blades with what else their file says: tests, what a fit holds, speed and air density."""

    blades: Blades
    test: TestTable | None = None
    static_test: StaticTestTable | None = None
    fit: FitTable = field(default_factory=FitTable)
    rpm: float | None = None
    density: float = 1.225


def load_propeller(
    path: Path, diameter: float | None = None, count: int | None = None
) -> PropellerDescription:
    """A TOML file of schema alula.propeller/1, QPROP's .def, APC's .PE0 or UIUC's geometry.

    diameter (m) and count complete UIUC's geometry, which states neither; count is 2 if not given.
    Raises BadInput with one message per thing that is wrong.
    """
    if path.suffix.lower() != ".toml":
        return PropellerDescription(read_blades(path, diameter, 2 if count is None else count))
    if diameter is not None or count is not None:
        raise refuse(
            "bad_option",
            where=str(path),
            expected="diameter and blades as the TOML file states them",
            found="--diameter or --blades",
            do="Leave the options out; they are for geometry files that state neither.",
        )
    text, tables, _ = read_toml(path)
    file = validated(PropellerFile, tables, path, text)
    table = file.blades.model_copy(update={"name": file.blades.name or file.name})
    rpm = file.rpm if file.rpm is not None or file.test is None else file.test.rpm
    return PropellerDescription(
        blades_of(table, str(path)), file.test, file.static_test, file.fit, rpm, file.density
    )
