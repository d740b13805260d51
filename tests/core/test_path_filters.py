"""The filters of the core against NumPy references, and the two instruction sets against each
other, on the first seconds of the shared path reconstruction case."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
import cases
from alula.core import MODULES as BUILT

MODULES = [module.__name__.split(".")[-1] for module in BUILT.values()]


@pytest.fixture(scope="module")
def case():
    if not cases.available():
        reason = f"no baselines in {cases.BASELINES} (set ALULA_BASELINES to their folder)"
        if os.environ.get("ALULA_REQUIRE_DATA"):
            pytest.fail(reason)
        pytest.skip(reason)
    whole = cases.case()
    return {k: v[:400] if np.shape(v)[:1] == (6000,) else v for k, v in whole.items()}


# The square-root filter is the unscented one, computed otherwise.
PEER = {"ukf": "ukf", "srukf": "ukf", "ekf": "ekf"}


@pytest.mark.parametrize("module", MODULES)
@pytest.mark.parametrize("name", PEER)
def test_final_state_is_that_of_numpy(case, module, name):
    """The tolerance of the case's contract; the references use other factorizations."""
    reference = getattr(cases.peers(), f"{PEER[name]}_numpy")(case)
    final, history = cases.ours(module, name, case)(case)
    assert cases.difference(final, reference[0]) < 1e-6
    assert cases.difference(history[200], reference[1][200]) < 1e-6


@pytest.mark.skipif(len(MODULES) < 2, reason="built for one instruction set alone")
@pytest.mark.parametrize("name", ["ukf", "ekf", "srukf", "iekf"])
def test_instruction_sets_agree(case, name):
    """To 1e-10, as promised: fused products round differently, nothing else differs."""
    a, b = (cases.ours(m, name, case)(case)[1] for m in MODULES)
    scale = np.maximum(np.abs(a), 1e-3)
    assert np.max(np.abs(a - b) / scale) < 1e-10


@pytest.mark.parametrize("module", MODULES)
@pytest.mark.parametrize("name", ["ukf", "srukf", "iekf"])
def test_same_input_same_bytes(case, module, name):
    run = cases.ours(module, name, case)
    assert run(case)[1].tobytes() == run(case)[1].tobytes()
