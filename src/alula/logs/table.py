"""What a reader hands over: the arrays of one file as they stand there, and its bytes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from alula.base.arrays import Array
from alula.base.messages import Message


@dataclass(frozen=True)
class Table:
    """One array of a file: a matrix, a data set, or all columns of a text file.

    data: one (n,) array per column, in the file's own units; NaN where there is no number.
    columns, units: as the file names them, '' where it does not. bytes: what the array occupies
    in the file. not_numeric: for a column, how many entries were text and the first of them.
    """

    name: str
    data: tuple[Array, ...]
    columns: tuple[str, ...]
    units: tuple[str, ...]
    bytes: int
    not_numeric: Mapping[int, tuple[int, str]] = field(default_factory=dict)

    @property
    def rows(self) -> int:
        """Number of samples in each column."""
        return len(self.data[0]) if self.data else 0

    @property
    def shape(self) -> str:
        """'626 x 45', for messages."""
        return f"{self.rows} x {len(self.data)}" if len(self.data) != 1 else f"{self.rows}"


@dataclass(frozen=True)
class Tables:
    """All tables of one file.

    size: bytes of the file. unknown: bytes that the reader cannot explain. The tables that are
    mapped count as decoded; headers, containers, comments and what is not mapped as skipped.
    """

    format: str
    tables: tuple[Table, ...]
    size: int
    unknown: int = 0
    messages: tuple[Message, ...] = ()


def matrix(name: str, values: Array, bytes: int) -> tuple[Table, bool]:
    """A Table from a 1-D or 2-D array: samples run along the longer axis.

    Returns the table and whether the array was turned (stored with one row per channel).
    """
    turned = values.ndim == 2 and values.shape[1] > values.shape[0]
    columns = (values,) if values.ndim == 1 else tuple(values if turned else values.T)
    blank = ("",) * len(columns)
    return Table(name, columns, blank, blank, bytes), turned
