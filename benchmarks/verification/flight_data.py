"""Where the flight data lies that Alula is judged by; none of it is in the repository."""

from __future__ import annotations

import os
from pathlib import Path

# Beside the checkout unless `ALULA_DATA` names another folder. Set either way: the projects of
# examples/real look there too.
DATA = Path(os.environ.setdefault("ALULA_DATA", str(Path(__file__).parents[3] / "shared" / "data")))
