"""A virtual campaign of 124 maneuvers through the command: seconds, and bytes by threads.

Two centers of gravity, 31 airspeeds, an elevator and a lateral maneuver at each; 20 s at 100 Hz,
21 sensors with errors, piston engine, wind; CSV, Parquet and truth of each.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from verification.places import ROOT


def plan_text(rate: float = 100.0) -> str:
    """The plan of 124 maneuvers."""
    sensors = (ROOT / "examples" / "demo" / "campaign.toml").read_text()
    sensors = sensors[sensors.index("[sensors]") : sensors.index("[identify]")]
    return f"""schema = "alula.plan/1"
name = "124 maneuvers"
aircraft = "{ROOT / "aircraft" / "sportstar.toml"}"
rate = {rate}
duration = 20.0
wind = [4.0, -3.0, 0.0]
[[loadings]]
id = "cg30"
[[loadings]]
id = "cg32"
cg_shift = [-0.025, 0.0, 0.0]
[[conditions]]
V = {[26.0 + 0.9 * k for k in range(31)]}
h = 915.0
[[maneuvers]]
id = "elevator"
inputs = [{{control = "de", kind = "3211", amplitude_deg = -1.5, width = 0.4, ramp = 0.2}}]
[[maneuvers]]
id = "lateral"
inputs = [
  {{control = "da", kind = "bank_to_bank", amplitude_deg = 4.0, width = 0.6, ramp = 0.2}},
  {{control = "dr", kind = "doublet", amplitude_deg = 2.0, start = 9.0, width = 0.8, ramp = 0.2}},
]
{sensors}"""


def fly(plan: Path, out: Path, threads: int) -> tuple[int, float]:
    """Exit code and seconds of the command, start of Python included."""
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "alula", "fly", str(plan), "--out", str(out), "--threads",
         str(threads), "--seed", "7", "--quiet"],
        capture_output=True,
    )  # fmt: skip
    return done.returncode, time.perf_counter() - begin


def digest(folder: Path) -> str:
    """One hash of all files, names and bytes."""
    whole = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        whole.update(str(path.relative_to(folder)).encode() + b"\0" + path.read_bytes())
    return whole.hexdigest()


def virtual_campaign(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds: flown and written in 10 s, same seed, same bytes."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        plan = root / "plan.toml"
        plan.write_text(plan_text())
        runs = [fly(plan, root / f"run{k}", threads) for k, threads in enumerate((2, 2, 1))]
        codes = [code for code, _ in runs]
        flown = len(list((root / "run0" / "logs").glob("*.csv")))
        size = sum(p.stat().st_size for p in (root / "run0").rglob("*") if p.is_file()) / 1e6
        same = len({digest(root / f"run{k}") for k in range(3)}) == 1
    best = min(seconds for _, seconds in runs[:2])
    got = (
        f"{flown} maneuvers of 20 s at 100 Hz, {size:.0f} MB: {best:.1f} s with 2 threads, "
        f"{runs[2][1]:.1f} s with one; bytes {'the same' if same else 'differ'} in three runs"
    )
    return got, codes == [0, 0, 0] and flown == 124 and best < 10.0 and same
