"""What is needed to make a result again: versions, commit, instruction set, seed."""

from __future__ import annotations

import platform
import subprocess
import sys
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import alula

_LIBRARIES = ("numpy", "scipy", "pandas", "pyarrow", "h5py")


def provenance(seed: int | None) -> dict[str, Any]:
    """The envelope's `provenance`: alula, commit, isa, seed, versions."""
    from alula.core import ISA  # loads NumPy's part of the core only where a result is made

    return {
        "alula": alula.__version__,
        "commit": commit(),
        "isa": ISA,
        "seed": seed,
        "versions": versions(),
    }


def versions() -> dict[str, str]:
    """Versions of Python, the platform and the libraries that compute."""
    return {"python": platform.python_version(), "platform": sys.platform} | dict(_libraries())


@cache
def _libraries() -> tuple[tuple[str, str], ...]:
    """Name and version of each that is installed; a process cannot change them."""
    out = []
    for name in _LIBRARIES:
        try:
            out.append((name, metadata.version(name)))
        except metadata.PackageNotFoundError:
            continue
    return tuple(out)


def commit() -> str | None:
    """The checkout's commit where Alula runs from one, with '+' for uncommitted changes."""
    folder = Path(alula.__file__).parent
    # Another repository may lie around an installed Alula; its commit says nothing.
    if not (folder.parents[1] / ".git").exists():
        return None
    try:
        found = subprocess.run(
            ["git", "-C", str(folder), "describe", "--always", "--dirty=+", "--abbrev=12"],
            capture_output=True,
            text=True,
            timeout=5,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return None
    return found.stdout.strip() or None
