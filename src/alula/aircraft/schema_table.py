"""What every table of the aircraft file is made of: numbers within reason, no unknown keys."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

HUGE = 1e12  # beyond any aircraft in SI, and far from where squares overflow
Positive = Annotated[float, Field(gt=0.0, le=HUGE, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, le=HUGE, allow_inf_nan=False)]
Number = Annotated[float, Field(ge=-HUGE, le=HUGE, allow_inf_nan=False)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Range = Annotated[list[Number], Field(min_length=2, max_length=2)]


def check_order(key: str, limits: list[float] | None) -> None:
    """Raises ValueError unless [lowest, highest] are in that order; None passes."""
    if limits is not None and not limits[0] < limits[1]:
        raise ValueError(f"'{key}' as [lowest, highest]|{limits}")


class Table(BaseModel):
    """A table that knows its keys and takes no other; numbers are numbers, not text."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)
