"""Speed of the vortex lattice: all derivatives of an airplane with four controls, one thread.

A wing with twist, dihedral, ailerons and flaps, a tailplane and a fin at 2.3 deg, so that every
part of the work is there: trailing legs that turn, forces with the induced velocity. Beside it the
LU factorization alone of one full matrix of as many panels, by the same code in the same run; one
half solved (the default on a symmetric airplane) and both. Processor time of the whole call from
Python, the shape's checks included; the best of several, in turn.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from verification.places import ROOT

sys.path.insert(0, str(ROOT / "tests" / "predict"))
from lattice_shapes import light_airplane

from alula.core import host
from alula.predict.vortex_lattice import vortex_lattice

# Panels in all: (chordwise, spanwise of the half) of wing, tailplane and fin.
MESHES = {
    174: ((7, 9), (3, 4), (4, 6)),
    2040: ((24, 26), (12, 20), (13, 24)),
    5044: ((36, 44), (20, 30), (26, 26)),
}
MUST = {174: 0.004, 2040: 0.6, 5044: 8.0}  # s
TIMES_LU, AT = 2.5, 2040
MEMORY = 1e9  # bytes, of the whole process at the largest


def ours(panels: int, symmetry: bool = True) -> Callable[[], float]:
    """A function that solves a lattice of so many panels: seconds of processor time."""
    shape, reference, point = light_airplane()
    mesh = dict(zip(("wing", "tailplane", "fin"), MESHES[panels], strict=True))

    def run() -> float:
        begin = time.process_time()
        result = vortex_lattice(shape, reference, point, alpha=0.04, panels=mesh, symmetry=symmetry)
        seconds = time.process_time() - begin
        if result.panels.count != panels or result.symmetric != symmetry:
            raise RuntimeError(f"{result.panels.count} panels, symmetric {result.symmetric}")
        return seconds

    return run


def measure(panels: int, rounds: int) -> dict[str, float]:
    """Best seconds of one half solved, of both, and of the LU alone."""
    runs = {
        "half": ours(panels),
        "both": ours(panels, symmetry=False),
        "lu": lambda: host.lattice_factor_time(panels),
    }
    best = dict.fromkeys(runs, float("inf"))
    for _ in range(rounds):
        for name, run in runs.items():
            best[name] = min(best[name], run())
    return best


def most_memory() -> int:
    """Bytes that this process held at most since it began."""
    status = Path("/proc/self/status")  # getrusage counts what the parent held, too
    if status.exists():
        return int(status.read_text().split("VmHWM:")[1].split()[0]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # macOS: bytes


def peak_memory(panels: int, symmetry: bool) -> int:
    """Bytes that a process of its own held at most while it solved."""
    code = (
        f"from {__name__} import most_memory, ours; ours({panels}, {symmetry})(); "
        "print(most_memory())"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=ROOT / "benchmarks",
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        check=True,
        capture_output=True,
        text=True,
    )
    return int(done.stdout)


def check(quick: bool = False) -> tuple[str, bool]:
    """What was found in words, and whether times, ratio and memory hold."""
    found = {n: measure(n, max(1, r // (3 if quick else 1))) for n, r in
             ((174, 60), (2040, 6), (5044, 2))}  # fmt: skip
    memory = {s: peak_memory(5044, s) for s in (True, False)}
    words, good = [], max(memory.values()) <= MEMORY
    for n, f in found.items():
        words.append(
            f"{n} panels: {f['half']:.4f} s (both halves solved {f['both']:.4f}; LU alone of the "
            f"full matrix {f['lu']:.4f}: {f['half'] / f['lu']:.2f} and {f['both'] / f['lu']:.2f} "
            "times)"
        )
        good = good and f["half"] <= MUST[n]
    ratio = max(found[AT]["half"], found[AT]["both"]) / found[AT]["lu"]
    growth = [found[b]["half"] / found[a]["half"] for a, b in ((174, 2040), (2040, 5044))]
    words.append(
        f"from 174 to 2040 panels (11.7 times) {growth[0]:.0f} times as long, to 5044 (2.5 times) "
        f"{growth[1]:.1f}"
    )
    words.append(
        f"largest process {memory[True] / 1e6:.0f} MB, both halves {memory[False] / 1e6:.0f} MB"
    )
    words.append("one thread, whole call")
    return "; ".join(words), good and ratio <= TIMES_LU


def bench_row(rounds: int = 6) -> dict[str, Any]:
    """The row of `make bench`: 2040 panels, beside the LU alone of the same run."""
    f = measure(AT, rounds)
    return {
        "name": f"vortex_lattice_{AT}",
        "ours_s": f["half"],
        "ours_both_halves_s": f["both"],
        "peer": "LU alone of the full matrix",
        "peer_s": f["lu"],
        "ratio": f["lu"] / f["half"],
        "allocations": None,
    }


if __name__ == "__main__":
    text, passed = check("quick" in sys.argv)
    print(text, passed)
    print(json.dumps(bench_row(2)))
