"""Tests import their helpers from this folder, and what `make verify` runs from benchmarks/."""

import os
import sys
from pathlib import Path

# One thread of linear algebra: the matrices are small, and tests may run side by side.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "benchmarks")]

import verification.places  # noqa: E402, F401  sets ALULA_DATA, which examples/real asks for
