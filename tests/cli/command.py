"""The command as a user calls it, and a small project to damage."""

from __future__ import annotations

import contextlib
import io
import json
import shutil
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.cli.app import main

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class Ran:
    """How a command ended and what it said."""

    code: int
    out: str
    err: str

    @property
    def envelope(self) -> dict[str, Any]:
        """All of stdout as one JSON value, without the names NaN and Infinity."""
        value = json.loads(self.out, parse_constant=_no_constant)
        assert isinstance(value, dict)
        return value

    def messages(self, code: str) -> list[dict[str, str]]:
        """The envelope's messages of that code."""
        return [m for m in self.envelope["messages"] if m["code"] == code]


def _no_constant(name: str) -> float:
    raise AssertionError(f"{name} is not JSON")


def alula(*words: object) -> Ran:
    """The installed command's entry point, in this process."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main([str(word) for word in words])
        except SystemExit as end:
            code = end.code
    assert isinstance(code, int)
    return Ran(code, out.getvalue(), err.getvalue())


def process(*words: object, **options: Any) -> Ran:
    """The command in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-m", "alula", *map(str, words)],
        capture_output=True,
        text=True,
        check=False,
        **options,
    )
    return Ran(done.returncode, done.stdout, done.stderr)


@dataclass
class SmallProject:
    """The demo's longitudinal maneuver: 20 s at 100 Hz, with its own copies of every file."""

    folder: Path
    header: list[str]
    table: np.ndarray[Any, Any]  # (n, columns), as in the log: degrees

    @property
    def path(self) -> Path:
        """The project file."""
        return self.folder / "demo.toml"

    @property
    def log(self) -> Path:
        """The log."""
        return self.folder / "longitudinal.csv"

    def edit(self, old: str, new: str, file: str = "demo.toml") -> None:
        """Replace text that stands exactly once in a file."""
        path = self.folder / file
        text = path.read_text()
        assert text.count(old) == 1, old
        path.write_text(text.replace(old, new))

    def column(self, name: str) -> np.ndarray[Any, Any]:
        """A view of the column of that name."""
        return self.table[:, self.header.index(name)]

    def write_log(self) -> None:
        """The header and the table as they are now."""
        rows = [",".join(f"{v:.7g}" for v in row) for row in self.table.tolist()]
        self.log.write_text("\n".join([",".join(self.header), *rows]) + "\n")

    def add_maneuver(self, id: str, start: float, end: float, more: str = "") -> None:
        """One more window of the log."""
        text = f"""
[[maneuvers]]
id = "{id}"
log = "longitudinal"
start = {start}
end = {end}
aspect = "longitudinal"
{more}
"""
        self.edit("\n[reconstruct]\n", text + "\n[reconstruct]\n")

    def identify(self, *words: object) -> Ran:
        """`alula identify` with JSON on stdout."""
        return alula("identify", self.path, "--json", "-", *words)

    def check(self) -> Ran:
        """`alula check` with JSON on stdout."""
        return alula("check", self.path, "--json", "-")

    def refused(self, code: str, *words: str) -> str:
        """Identify, which must end with 2 and that message, and write nothing; what it said."""
        before = contents(self.folder)
        ran = self.identify("--report", self.folder / "r.html", "--model", self.folder / "m.toml")
        assert_refused(ran, code, *words)
        assert contents(self.folder) == before
        return ran.err


def assert_refused(ran: Ran, code: str, *words: str) -> None:
    """Exit 2; the message says what the contract wants; JSON and text say the same."""
    said = ran.out + ran.err
    assert "Traceback" not in said
    assert ran.code == 2, said
    envelope = ran.envelope
    assert envelope["status"] == "bad_input"
    assert envelope["result"] == {}
    assert code in {m["code"] for m in envelope["messages"]}, said
    for message in envelope["messages"]:
        assert all(message[key] for key in ("where", "expected", "found", "do")), message
        assert f"[{message['code']}]" in ran.err
    for word in words:
        assert word in ran.err, said


def contents(folder: Path) -> Mapping[str, bytes]:
    """Every file below a folder, by name."""
    return {str(p): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


@pytest.fixture(scope="session")
def demo_files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The demo's files, made once; tests work on copies."""
    folder = tmp_path_factory.mktemp("demo")
    made = [sys.executable, str(ROOT / "examples" / "demo" / "make_logs.py"), str(folder), "1"]
    subprocess.run(made, check=True, capture_output=True)
    return folder


@pytest.fixture
def small(demo_files: Path, tmp_path: Path) -> SmallProject:
    """A project of one maneuver, to be damaged."""
    return small_project(demo_files, tmp_path / "project")


@pytest.fixture(scope="session")
def sound(demo_files: Path, tmp_path_factory: pytest.TempPathFactory) -> SmallProject:
    """The same, for tests that leave it as it is."""
    return small_project(demo_files, tmp_path_factory.mktemp("sound") / "project")


def small_project(demo: Path, folder: Path) -> SmallProject:
    """Copy the demo without its lateral maneuver."""
    folder.mkdir()
    for name in ("longitudinal.csv", "sportstar.toml", "truth.json"):
        shutil.copyfile(demo / name, folder / name)
    text = (demo / "demo.toml").read_text()
    text = _without(text, '[[logs]]\nid = "lateral"', "[channels]")
    text = _without(text, '[[maneuvers]]\nid = "lateral"', "[reconstruct]")
    text = text[: text.index("CY =")]
    (folder / "demo.toml").write_text(text)
    header = (folder / "longitudinal.csv").read_text().split("\n", 1)[0].split(",")
    table = np.loadtxt(folder / "longitudinal.csv", delimiter=",", skiprows=1)
    return SmallProject(folder, header, table)


def _without(text: str, start: str, end: str) -> str:
    at = text.index(start)
    return text[:at] + text[text.index(end, at) :]
