"""What the core's own benchmark programs (core/bench) print: times without Python in between."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
BUILD = ROOT / "build" / "bench"


def run(subject: str, isa: str, *arguments: object) -> dict[str, Any]:
    """The numbers of core/bench/`subject`.cpp for an instruction set, built where it is not yet.

    Raises subprocess.CalledProcessError and OSError where it cannot be built or fails.
    """
    beside = Path(sys.executable).with_name("cmake")
    cmake = str(beside) if beside.exists() else "cmake"
    name = f"{subject}_{isa}"
    configure = ["-DALULA_PYTHON=OFF", "-DALULA_BENCH=ON", "-DCMAKE_BUILD_TYPE=Release"]
    for command in (
        [cmake, "-S", ROOT, "-B", BUILD, *configure],
        [cmake, "--build", BUILD, "--target", name],
    ):
        subprocess.run(command, check=True, capture_output=True)
    program = [BUILD / "core" / "bench" / name, *map(str, arguments)]
    found = subprocess.run(program, check=True, capture_output=True).stdout
    return dict(json.loads(found))
