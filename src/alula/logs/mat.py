"""MATLAB files 5 and 7.3 and HDF5, decoded in a child process with limits.

The decoders are large C libraries that can crash or take all memory on a damaged file; a child
that does so costs a message, not the session. Nothing is unpickled: arrays come back as .npz.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from alula.base.messages import BadInput, Message, note, refuse
from alula.base.project import LogSpec
from alula.logs.sniff import kind
from alula.logs.table import Tables, matrix

SECONDS = 120
MEMORY = 2 << 30  # bytes, and 20 times the file besides


def read(log: LogSpec) -> Tables:
    """Read every numeric array of one or two dimensions, fields of structures as 'name.field'.

    Bytes: an array of MATLAB 5 has the size of its element, of HDF5 the storage of its data set;
    headers and what is not mapped count as skipped, bytes after the last element as unknown.
    """
    found, _ = kind(log.path)
    with tempfile.TemporaryDirectory(prefix="alula-") as folder:
        out = Path(folder) / "arrays.npz"
        index = _run(log, found, out)
        with np.load(out, allow_pickle=False) as arrays:
            loaded = [(item, arrays[f"a{i}"]) for i, item in enumerate(index["arrays"])]
    messages: list[Message] = []
    tables = []
    for item, values in loaded:
        table, turned = matrix(item["name"], values, item["bytes"])
        tables.append(table)
        if turned and table.rows > 1:
            messages.append(
                note(
                    "turned",
                    where=f"{log.path}: {item['name']}",
                    expected="samples along the rows",
                    found=f"{values.shape[0]} x {values.shape[1]}",
                    do="Its rows are taken as the channels; 'column' counts them from 1.",
                )
            )
    if index["left"]:
        messages.append(
            note(
                "array_not_read",
                where=str(log.path),
                expected="numbers in one or two dimensions",
                found=", ".join(index["left"][:20]),
                do="Nothing, unless one of them is needed; then save it as numbers.",
            )
        )
    return Tables("mat", tuple(tables), log.path.stat().st_size, index["unknown"], tuple(messages))


def _run(log: LogSpec, found: str, out: Path) -> dict[str, Any]:
    size = log.path.stat().st_size
    child = Path(__file__).with_name("mat_child.py")
    command = [sys.executable, "-I", str(child), found, str(log.path.absolute()), str(out)]
    limits = [str(MEMORY + 20 * size), str(SECONDS)]
    quiet = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            [*command, *limits], capture_output=True, timeout=2 * SECONDS, env=quiet, check=False
        )
    except subprocess.TimeoutExpired:
        raise _corrupt(log, f"no end after {2 * SECONDS} s") from None
    if done.returncode < 0:
        raise _corrupt(log, f"the decoder crashed (signal {-done.returncode})")
    if done.returncode or not out.exists():
        lines = done.stderr.decode(errors="replace").strip().splitlines()
        raise _corrupt(log, lines[-1][:200] if lines else f"exit {done.returncode}")
    index: dict[str, Any] = json.loads(done.stdout)
    return index


def _corrupt(log: LogSpec, found: str) -> BadInput:
    return refuse(
        "corrupt_file",
        where=str(log.path),
        expected="a MATLAB file that can be decoded",
        found=found,
        do="Copy the file again, or save it anew from MATLAB (-v7 or -v7.3).",
    )
