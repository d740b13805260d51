"""What the schemas of TOML files share: strict values, units, the file that was read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr

from alula.base.units import to_si

Identifier = Annotated[str, Field(pattern=r"^[\w][\w .+-]*$", max_length=80)]


class Strict(BaseModel):
    """Unknown keys are errors and values do not change once they are read."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, allow_inf_nan=False, strict=True
    )


class Quantity(Strict):
    """Base of entries that state their numbers in a unit; none means SI."""

    unit: str | None = None

    def in_si(self, value: float) -> float:
        """`value` by the scale of the unit (an offset, as of degC, does not apply)."""
        return value * to_si(self.unit).scale if self.unit else value


class ReadFile(Strict):
    """A file as it was read."""

    _path: Path = PrivateAttr(default=Path())
    _sha256: str = PrivateAttr(default="")

    @property
    def path(self) -> Path:
        """The file that was read."""
        return self._path

    @property
    def sha256(self) -> str:
        """Hexadecimal SHA-256 of the file that was read."""
        return self._sha256
