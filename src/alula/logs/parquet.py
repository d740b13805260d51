"""Parquet files: one table, its columns by name."""

from __future__ import annotations

import pyarrow as pa
import pyarrow.parquet as pq

from alula.base.messages import refuse
from alula.base.project import LogSpec
from alula.logs.columns import numbers
from alula.logs.table import Table, Tables
from alula.logs.text import name_and_unit


def read(log: LogSpec) -> Tables:
    """Read all columns. Bytes: a column has the compressed size of its chunks."""
    size = log.path.stat().st_size
    try:
        with pq.ParquetFile(log.path) as file:
            meta = file.metadata
            stored: dict[str, int] = {}
            for g in range(meta.num_row_groups):
                for k in range(meta.num_columns):
                    chunk = meta.row_group(g).column(k)
                    name = chunk.path_in_schema
                    stored[name] = stored.get(name, 0) + chunk.total_compressed_size
            table = file.read()
    except (pa.ArrowException, OSError, ValueError, MemoryError) as error:
        raise refuse(
            "corrupt_file",
            where=str(log.path),
            expected="a Parquet file",
            found=(str(error).splitlines() or [type(error).__name__])[0][:200],
            do="Copy or export the file again; it is damaged.",
        ) from None
    tables = []
    for k, label in enumerate(table.column_names):
        values, texts = numbers(table.column(k))
        name, unit = name_and_unit(label)
        not_numeric = {0: texts} if texts else {}
        tables.append(Table(label, (values,), (name,), (unit,), stored.get(label, 0), not_numeric))
    return Tables("parquet", tuple(tables), size)
