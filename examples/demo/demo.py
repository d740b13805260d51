"""The main job on an example that the project makes itself: `make demo`.

Two maneuvers of a light aircraft are simulated with sensor errors, their logs written, and the
derivatives identified from the logs and set beside the truth.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from make_logs import simulate_demo


def main() -> int:
    """Simulate, identify, report; the exit code is that of `alula identify`."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=Path("build/demo"))
    parser.add_argument("--seed", type=int, default=2)
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    files = simulate_demo(args.seed, args.folder)
    report = args.folder / "report.html"
    print(f"Simulated {', '.join(str(log) for log in files.logs)}\n", flush=True)
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "alula",
            "identify",
            str(files.project),
            "--truth",
            str(files.truth),
            "--report",
            str(report),
            "--seed",
            str(args.seed),
        ],
        check=False,
    )
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
