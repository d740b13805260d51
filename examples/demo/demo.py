"""The main job on a flight campaign that the project flies itself: `make demo`.

`alula fly` flies campaign.toml, with sensor errors, and writes logs and truth; `alula identify`
takes the logs and sets what it finds beside the truth.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def alula(*words: object) -> int:
    """Run the command; its exit code."""
    return subprocess.run([sys.executable, "-m", "alula", *map(str, words)], check=False).returncode


def main() -> int:
    """Fly, identify, report; the exit code is that of the command that ended it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=Path("build/demo"))
    parser.add_argument("--seed", type=int, default=2)
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    campaign = args.folder / "campaign"
    code = alula("fly", HERE / "campaign.toml", "--out", campaign, "--seed", args.seed)
    if code:
        return code
    print(flush=True)
    return alula(
        "identify",
        campaign / "campaign.toml",
        "--truth",
        campaign / "truth.json",
        "--report",
        args.folder / "report.html",
        "--seed",
        args.seed,
    )


if __name__ == "__main__":
    sys.exit(main())
