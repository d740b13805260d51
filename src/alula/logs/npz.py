"""NumPy archives (.npz); never pickled objects."""

from __future__ import annotations

import zipfile
import zlib
from typing import Any

import numpy as np

from alula.base.messages import BadInput, Message, refuse, warn
from alula.base.project import LogSpec
from alula.logs.table import Table, Tables, matrix

MOST = 64  # an array may be this many times larger than the whole file, else it is not honest


def read(log: LogSpec) -> Tables:
    """Read every numeric array of one or two dimensions.

    Bytes: an array has the compressed size of its archive member; the archive's own tables and
    other arrays count as skipped, what lies outside of them as unknown.
    """
    size = log.path.stat().st_size
    tables: list[Table] = []
    messages: list[Message] = []
    try:
        with zipfile.ZipFile(log.path) as archive:
            known = (
                size
                - archive.start_dir
                + sum(_member_bytes(archive, i) for i in archive.infolist())
            )
            for item in archive.infolist():
                if not item.filename.endswith(".npy"):
                    continue
                name = item.filename.removesuffix(".npy")
                values, reason = _array(archive, item, size)
                if values is None:
                    messages.append(
                        warn(
                            "array_not_read",
                            where=f"{log.path}: {name}",
                            expected="numbers in one or two dimensions",
                            found=reason,
                            do="Nothing, unless it is needed; then save it as numbers.",
                        )
                    )
                    continue
                table, _ = matrix(name, values, item.compress_size)
                tables.append(table)
    except (
        zipfile.BadZipFile, zlib.error, OSError, ValueError, EOFError, NotImplementedError,
        RuntimeError, KeyError, OverflowError, MemoryError, SyntaxError, TypeError, UnicodeError,
    ) as error:  # fmt: skip
        raise corrupt(log, error) from None
    return Tables("npz", tuple(tables), size, max(size - known, 0), tuple(messages))


def corrupt(log: LogSpec, error: Exception) -> BadInput:
    """The refusal of an archive that cannot be decoded."""
    return refuse(
        "corrupt_file",
        where=str(log.path),
        expected="a NumPy archive as numpy.savez writes it",
        found=f"{type(error).__name__}: {str(error)[:200]}",
        do="Copy or export the file again; it is damaged.",
    )


def _member_bytes(archive: zipfile.ZipFile, item: zipfile.ZipInfo) -> int:
    """Local header and compressed data of one member (APPNOTE 4.3.7)."""
    assert archive.fp is not None
    archive.fp.seek(item.header_offset + 26)
    lengths = archive.fp.read(4)
    if len(lengths) < 4:
        raise zipfile.BadZipFile("header beyond the end of the file")
    return (
        30 + sum(int.from_bytes(lengths[k : k + 2], "little") for k in (0, 2)) + item.compress_size
    )


def _array(archive: zipfile.ZipFile, item: zipfile.ZipInfo, size: int) -> tuple[Any, str]:
    """The array, or None and why not. The header is checked before memory is taken."""
    with archive.open(item) as file:
        version = np.lib.format.read_magic(file)
        if version == (1, 0):
            shape, fortran, dtype = np.lib.format.read_array_header_1_0(file)
        else:
            shape, fortran, dtype = np.lib.format.read_array_header_2_0(file)
        if dtype.hasobject or dtype.kind not in "fiub":
            return None, f"type {dtype}"
        if len(shape) not in (1, 2) or 0 in shape:
            return None, f"shape {shape}"
        need = int(np.prod([float(n) for n in shape])) * dtype.itemsize
        if need > item.file_size or need > MOST * max(size, 1 << 20):
            raise ValueError(f"array '{item.filename}' of shape {shape} in {item.file_size} bytes")
        data = file.read(need)
    if len(data) != need:
        raise ValueError(f"array '{item.filename}' ends early")
    values = np.frombuffer(data, dtype).reshape(shape, order="F" if fortran else "C")
    return values.astype(np.float64), ""
