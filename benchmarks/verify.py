"""Runs every row of every 'What must hold' table: `make verify`.

Writes build/verify.json and docs/verification.md. A row that is not built yet, or that fails with
an exception, is there and does not hold. Exit 1 where a row that is built does not hold.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import platform
import sys
import time
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

sys.path.insert(0, str(Path(__file__).parent))
from verification.registry import ROWS, TOPICS, Row  # noqa: E402

ROOT = Path(__file__).parents[1]
for _topic in ("main_job", "simulator", "estimation", "prediction", "airdata"):
    importlib.import_module(f"verification.{_topic}.rows")
importlib.import_module("verification.later")


def run(row: Row, quick: bool) -> dict[str, Any]:
    """What one row gave; an exception's text where it ended in one."""
    begin = time.perf_counter()
    try:
        got, holds = row.check(quick)
    except (Exception, SystemExit) as e:
        got, holds = f"{type(e).__name__}: {e}", False
    return {
        "topic": row.topic,
        "row": row.row,
        "must": row.must,
        "got": got,
        "pass": bool(holds),
        "seconds": round(time.perf_counter() - begin, 2),
    }


def machine() -> str:
    """Processor, number of cores and interpreter, as the figures depend on them."""
    name = platform.processor() or platform.machine()
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                name = line.split(":", 1)[1].strip()
                break
    except OSError:
        pass
    return f"{name}, {os.cpu_count()} cores, Python {platform.python_version()}"


def page(results: list[dict[str, Any]]) -> str:
    """docs/verification.md."""

    def cell(text: str) -> str:
        return " ".join(str(text).split()).replace("|", "\\|")

    lines = [
        "# What holds",
        "Written by `make verify`; do not edit.",
        "",
        f"{datetime.now(UTC):%Y-%m-%d}, {machine()}.",
    ]
    for topic in TOPICS:
        rows = [r for r in results if r["topic"] == topic]
        if not rows:
            continue
        held = sum(r["pass"] for r in rows)
        lines += ["", f"## {topic}: {held} of {len(rows)}", ""]
        lines += ["| case | must give | found | holds | s |", "| --- | --- | --- | --- | --- |"]
        lines += [
            f"| {cell(r['row'])} | {cell(r['must'])} | {cell(r['got'])} | "
            f"{'yes' if r['pass'] else '**no**'} | {r['seconds']} |"
            for r in rows
        ]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--topic", choices=TOPICS, help="only this one; the page is left alone")
    parser.add_argument("--row", help="only rows whose name has this text; likewise")
    parser.add_argument("--quick", action="store_true", help="reduced; likewise")
    parser.add_argument(
        "--update", action="store_true", help="keep the last result of the other rows, and the page"
    )
    args = parser.parse_args()
    chosen = [
        r
        for r in ROWS
        if args.topic in (None, r.topic) and (args.row or "").lower() in r.row.lower()
    ]
    results = []
    for row in sorted(chosen, key=lambda r: TOPICS.index(r.topic)):
        result = run(row, args.quick)
        results.append(result)
        print(f"{'yes' if result['pass'] else 'NO ':4s} {row.topic}: {row.row}: {result['got']}")
    out = ROOT / "build"
    out.mkdir(exist_ok=True)
    written = out / "verify.json"
    shown = results
    if args.update and not args.quick and written.exists():
        done = {(r["topic"], r["row"]): r for r in [*json.loads(written.read_text()), *results]}
        known = sorted(ROWS, key=lambda r: TOPICS.index(r.topic))
        shown = [done[r.topic, r.row] for r in known if (r.topic, r.row) in done]
    # A part of the rows, or a quick look, never takes the place of all.
    whole = len(shown) == len(ROWS)
    if not args.quick and (whole or args.update):
        written.write_text(json.dumps(shown, indent=1) + "\n")
    if not args.quick and whole:
        (ROOT / "docs" / "verification.md").write_text(page(shown))
    return int(any(not r["pass"] and not r["got"].startswith("not built yet") for r in results))


if __name__ == "__main__":
    raise SystemExit(main())
