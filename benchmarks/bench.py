"""Speed of path filters, output error, recursive least squares and simulator: `make bench`.

Prints, and writes build/bench.json. The peers take turns within every round, so that a slow spell
of the machine hits all of them; a ratio counts only where the results agree (filters: the final
state with the NumPy reference to 1e-6).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # one thread each, set before NumPy loads

sys.path.insert(0, str(Path(__file__).parent))
import cases  # noqa: E402
import programs  # noqa: E402

# Each filter with the peer's whose estimate it computes. The iterated one has none: it is timed
# beside the extended filter.
FILTERS = {"ukf": "ukf", "ekf": "ekf", "srukf": "ukf", "iekf": None}
TOLERANCE = 1e-6  # of the baselines' README, relative, on the final state
ROUNDS = 12
BUILD = cases.ROOT / "build"


def modules() -> list[str]:
    """Compiled modules that this processor can run, the quickest first."""
    from alula.core import MODULES

    if "baseline" not in MODULES:
        raise SystemExit("This build is for this machine alone: make build INSTRUCTION_SETS=all")
    return [module.__name__.split(".")[-1] for module in reversed(MODULES.values())]


def allocations() -> dict[str, dict[str, Any]]:
    """What the C++ benchmark counts, by module; empty where it cannot be built."""
    from alula.core import MODULES

    try:
        return {
            module.__name__.split(".")[-1]: programs.run("path_filters", isa, 3)
            for isa, module in MODULES.items()
        }
    except (OSError, subprocess.CalledProcessError) as e:
        detail = getattr(e, "stderr", b"") or b""
        print(f"allocations are not counted: {e}\n{detail.decode()[-500:]}", file=sys.stderr)
        return {}


def _counted(counted: dict[str, dict[str, Any]], name: str) -> Any:
    """Allocations of 'ukf_core_v3' and the like; None where they were not counted."""
    short, _, module = name.partition("_")
    return counted.get(f"_{module}", {}).get(f"{short}_allocations")


def filter_rows(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """Every filter of every module against both numba filters, timed in turn."""
    c = cases.case()
    peers = cases.peers()
    runs: dict[str, Any] = {
        f"{name}{module}": cases.ours(module, name, c) for module in modules() for name in FILTERS
    }
    for name, peer in FILTERS.items():
        if peer is None:
            continue
        reference = getattr(peers, f"{peer}_numpy")(c)[0]
        for module in modules():
            apart = cases.difference(runs[f"{name}{module}"](c)[0], reference)
            if not apart <= TOLERANCE:
                raise SystemExit(
                    f"{name} of {module}: final state {apart:.1e} from {peer}_numpy, "
                    f"more than {TOLERANCE:.0e}: no ratio counts"
                )
    runs["ukf_numba"], runs["ekf_numba"] = peers.ukf_numba, peers.ekf_numba
    seconds: dict[str, list[float]] = {name: [] for name in runs}
    for name in ("ukf_numba", "ekf_numba"):
        runs[name](c)  # compiles
    for _ in range(rounds):
        for name, run in runs.items():
            begin = time.perf_counter()
            run(c)
            seconds[name].append(time.perf_counter() - begin)

    print(f"{'path filter, 6000 steps':26s} {'best s':>9s} {'median s':>9s}")
    for name, took in seconds.items():
        print(f"{name:26s} {min(took):9.4f} {statistics.median(took):9.4f}")
    counted = allocations()
    pairs = [(f"ukf{m}", "ukf_numba") for m in modules()]
    pairs += [(f"ekf{m}", p) for m in modules() for p in ("ukf_numba", "ekf_numba")]
    pairs += [(f"srukf{m}", "ukf_numba") for m in modules()]
    pairs += [(f"iekf{m}", "ekf_numba") for m in modules()]
    rows = []
    for name, peer in pairs:
        ours_s, peer_s = min(seconds[name]), min(seconds[peer])
        rows.append(
            {
                "name": name,
                "ours_s": ours_s,
                "peer": peer,
                "peer_s": peer_s,
                "ratio": peer_s / ours_s,
                "ratio_median": statistics.median(seconds[peer]) / statistics.median(seconds[name]),
                "allocations": _counted(counted, name),
            }
        )
    return rows


def output_error_rows(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """The baseline's longitudinal case against its numba program."""
    from verification.estimation import output_error_speed

    return [output_error_speed.bench_row(rounds)]


def recursive_rows(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """Recursive least squares, seconds a sample; it has no peer."""
    from verification.estimation import rls_speed

    best = rls_speed.measure(quick=rounds < ROUNDS)
    without = {"peer": None, "peer_s": None, "ratio": None, "allocations": None}
    return [{"name": f"rls, {kind}", "ours_s": s, **without} for kind, s in best.items()]


def simulation_rows(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """The simulator against JSBSim."""
    from verification.simulator import simulation_speed

    return simulation_speed.bench_rows(rounds)


def lattice_rows(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """The vortex lattice beside the factorization of its full matrix."""
    from verification.prediction import lattice_speed

    return [lattice_speed.bench_row(rounds)]


SUBJECTS: dict[str, Callable[[int], list[dict[str, Any]]]] = {
    "path filters": filter_rows,
    "output error": output_error_rows,
    "recursive least squares": recursive_rows,
    "simulator": simulation_rows,
    "vortex lattice": lattice_rows,
}
NEED_BASELINES = ("path filters", "output error")


def show(rows: list[dict[str, Any]]) -> None:
    """One line a row; '-' where there is no peer or nothing was counted."""

    def word(value: Any, form: str) -> str:
        return "-" if value is None else format(value, form)

    print(
        f"\n{'ours':36s} {'s':>10s} {'peer':20s} {'ratio':>7s} {'medians':>8s} {'allocations':>12s}"
    )
    for row in rows:
        print(
            f"{row['name']:36s} {row['ours_s']:10.3g} {word(row['peer'], 's'):20s} "
            f"{word(row['ratio'], '.2f'):>7s} {word(row.get('ratio_median'), '.2f'):>8s} "
            f"{word(row['allocations'], 'd'):>12s}"
        )


def main() -> int:
    """Run, print, write build/bench.json."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    rounds = parser.parse_args().rounds
    rows: list[dict[str, Any]] = []
    for subject, measure in SUBJECTS.items():
        if subject in NEED_BASELINES and not cases.available():
            print(
                f"no rows '{subject}': the peers are not in {cases.BASELINES} "
                "(set ALULA_BASELINES to the folder that holds path_reconstruction.py)"
            )
            continue
        try:
            rows += measure(rounds)
        except ModuleNotFoundError as e:
            print(f"no rows '{subject}': {e.name} is missing (pip install {e.name})")
    show(rows)
    BUILD.mkdir(exist_ok=True)
    (BUILD / "bench.json").write_text(json.dumps(rows, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
