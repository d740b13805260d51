"""JSBSim as the tests need it: skipped with a reason where absent, a failure where required."""

from __future__ import annotations

import os
from importlib.util import find_spec

import pytest


def need_jsbsim() -> None:
    """Skip, or fail with ALULA_REQUIRE_DATA, where JSBSim is not installed."""
    if find_spec("jsbsim") is None:
        reason = "JSBSim is not installed: pip install 'alula[export]'"
        if os.environ.get("ALULA_REQUIRE_DATA"):
            pytest.fail(reason)
        pytest.skip(reason)
