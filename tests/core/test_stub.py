"""The committed description of the compiled core is the one that its build gives."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

STUB = Path(__file__).parents[2] / "src" / "alula" / "_core.pyi"


def test_stub_is_what_the_build_gives(tmp_path: Path) -> None:
    pytest.importorskip("nanobind", reason="nanobind, which writes the stub, is not installed")
    fresh = tmp_path / "_core.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "alula._core", "-o", fresh]
    subprocess.run(command, check=True)
    assert fresh.read_text() == STUB.read_text(), "run `make stubs` and commit src/alula/_core.pyi"
