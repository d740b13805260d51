"""The flight data that tests are judged by; skipped where absent, unless data are required."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from verification.places import DATA as ROOT


def data(*parts: str) -> Path:
    """The path of a data file; skips the test where it is absent, unless data are required."""
    path = ROOT.joinpath(*parts)
    if not path.exists():
        reason = f"flight data not found: {path.name} (set ALULA_DATA to the folder that holds it)"
        if os.environ.get("ALULA_REQUIRE_DATA"):
            pytest.fail(reason)
        pytest.skip(reason)
    return path
