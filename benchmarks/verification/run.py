"""What the rows share: projects run in process or through the command line, and pytest files."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

from verification.places import ROOT


def command(*arguments: str | Path) -> tuple[int, dict[str, Any]]:
    """Exit code and JSON envelope of `alula` with these arguments."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.json"
        done = subprocess.run(
            [sys.executable, "-m", "alula", *map(str, arguments), "--json", str(out), "--quiet"],
            capture_output=True,
            text=True,
            cwd=ROOT,
        )
        envelope = json.loads(out.read_text()) if out.exists() else {}
    if done.returncode not in (0, 1) or not envelope:
        text = (done.stderr or done.stdout).strip() or json.dumps(envelope.get("messages"))
        raise RuntimeError(f"exit {done.returncode}: {text[-300:]}")
    return done.returncode, envelope


@cache
def identified(project: str, filter: str = "") -> tuple[int, dict[str, Any]]:
    """`alula identify` on a project of examples/real, its own filter or another one."""
    options = ("--filter", filter) if filter else ()
    return command("identify", ROOT / "examples" / "real" / project, *options)


def constants(result: dict[str, Any]) -> dict[str, tuple[float, float]]:
    """Value and standard error of each constant of a result's reconstruction, by name."""
    return {b["name"]: (b["value"], b["se"]) for b in result["reconstruction"]["biases"]}


def parameters(result: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """The parameters of a result by name."""
    return {p["name"]: p for p in result["parameters"]}


def run_tests(*selection: str, slow: bool = False) -> tuple[str, bool]:
    """Runs tests of this repository, data and tools required: the summary, whether all passed."""
    done = subprocess.run(
        [
            *(sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *selection),
            *([] if slow else ["-m", "not slow"]),
        ],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env={**os.environ, "ALULA_REQUIRE_DATA": "1"},
    )
    lines = done.stdout.strip().splitlines()
    summary = re.sub(r"^=+ | =+$", "", lines[-1]) if lines else done.stderr.strip()[-200:]
    return summary, done.returncode == 0 and "skipped" not in summary


def within(found: dict[str, float], wanted: dict[str, tuple[float, float]]) -> tuple[str, bool]:
    """Each `name: (value, margin)` against what was found; the worst and whether all are inside."""
    ratios = {n: abs(found[n] - value) / margin for n, (value, margin) in wanted.items()}
    worst = max(ratios, key=lambda n: ratios[n])
    text = f"worst {worst}: {found[worst]:.5g}, {100 * ratios[worst]:.0f} % of the margin"
    return text, ratios[worst] <= 1.0
