"""Where the checkout is, and the flight data that Alula is judged by; none of that is in it."""

from __future__ import annotations

import os
from pathlib import Path

ROOT = Path(__file__).parents[2]
# Beside the checkout unless `ALULA_DATA` names another folder. Set either way: the projects of
# examples/real look there too.
DATA = Path(os.environ.setdefault("ALULA_DATA", str(ROOT.parent / "shared" / "data")))
