"""The child process that decodes a MATLAB file: run as a script, imports nothing of Alula.

Arguments: kind, file, output .npz, memory limit in bytes, processor time limit in seconds.
Prints the index of the arrays as JSON.
"""

import contextlib
import json
import struct
import sys
from typing import Any

import numpy as np


def limit(memory: int, seconds: int) -> None:
    """Limits that turn a runaway decoder into a MemoryError or a signal.

    Where the system has none (Windows) or not all of them (macOS), the parent's clock is the limit.
    """
    try:
        import resource
    except ImportError:
        return
    for kind, most in (("AS", memory), ("CPU", seconds), ("CORE", 0)):
        with contextlib.suppress(ValueError, OSError):
            resource.setrlimit(getattr(resource, f"RLIMIT_{kind}"), (most, most))


def flatten(name: str, value: Any, left: list[str]) -> list[tuple[str, Any]]:
    """Numeric arrays of one or two dimensions in a variable; the names of the rest to `left`."""
    if isinstance(value, np.ndarray) and value.dtype.names and value.size == 1:
        record = value.reshape(-1)[0]
        out = []
        for field in value.dtype.names:
            out += flatten(f"{name}.{field}", record[field], left)
        return out
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub" and value.size:
        value = np.asarray(value, dtype=np.float64)
        if value.ndim == 2 and 1 in value.shape:
            value = value.reshape(-1)
        if value.ndim in (1, 2):
            return [(name, value)]
    left.append(name)
    return []


def elements(path: str) -> tuple[list[int], int]:
    """Sizes of the top-level elements of a MATLAB 5 file, and the bytes after the last whole one.

    MAT-File Format (MathWorks), 'Level 5 MAT-File Format': 128-byte header, then tags of data
    type and byte count, four bytes each; compressed elements are not padded.
    """
    with open(path, "rb") as file:
        data = file.read()
    order = ">" if data[126:128] == b"MI" else "<"
    sizes, at = [], 128
    while at + 8 <= len(data):
        kind, count = struct.unpack_from(order + "II", data, at)
        if kind not in (14, 15) or at + 8 + count > len(data):
            break
        sizes.append(8 + count)
        at += 8 + count
    return sizes, len(data) - at


def mat5(path: str) -> tuple[list[tuple[str, Any, int]], list[str], int]:
    """Arrays, names left out, unknown bytes."""
    from scipy.io import loadmat, whosmat

    names = [name for name, _, _ in whosmat(path)]
    sizes, unknown = elements(path)
    content = loadmat(path)
    left: list[str] = []
    arrays = []
    for i, name in enumerate(names):
        if name not in content or name.startswith("__"):
            continue
        found = flatten(name, content[name], left)
        size = sizes[i] if len(sizes) >= len(names) else 0
        for k, (inner, value) in enumerate(found):  # a structure's bytes are shared out evenly
            share = size // len(found) + (size % len(found) if k == 0 else 0)
            arrays.append((inner, value, share))
    return arrays, left, unknown


def mat73(path: str) -> tuple[list[tuple[str, Any, int]], list[str], int]:
    """Arrays of an HDF5 file; groups are joined by dots. Unknown bytes: none can be told."""
    import h5py

    left: list[str] = []
    arrays: list[tuple[str, Any, int]] = []
    with h5py.File(path, "r") as file:

        def visit(name: str, item: Any) -> None:
            if not isinstance(item, h5py.Dataset) or name.startswith("#refs#"):
                return
            label = name.replace("/", ".")
            plain = item.dtype.kind in "fiub" and item.ndim in (1, 2) and item.size
            if not plain or item.attrs.get("MATLAB_class") in (
                b"char",
                b"cell",
                b"function_handle",
            ):
                left.append(label)
                return
            found = flatten(label, item[()], left)
            arrays.extend((n, v, int(item.id.get_storage_size())) for n, v in found)

        file.visititems(visit)
    return arrays, left, 0


def main() -> None:
    """Decode and write; an error becomes the last line of stderr and exit code 1."""
    kind, path, out, memory, seconds = sys.argv[1:]
    limit(int(memory), int(seconds))
    try:
        arrays, left, unknown = (mat5 if kind == "mat5" else mat73)(path)
        np.savez(out, **{f"a{i}": value for i, (_, value, _) in enumerate(arrays)})
    except Exception as error:
        print(f"{type(error).__name__}: {error}".splitlines()[0], file=sys.stderr)
        sys.exit(1)
    index = [{"name": name, "bytes": size} for name, _, size in arrays]
    print(json.dumps({"arrays": index, "left": left, "unknown": unknown}))


if __name__ == "__main__":
    main()
