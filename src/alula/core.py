"""The compiled core, built for the processor that runs it.

The same bindings exist twice: `_core` for any processor, `_core_v3` for x86-64-v3 (AVX2, FMA).
`ALULA_ISA=baseline` chooses the first; results agree to 1e-10 between them and to the last bit
within one of them. What never flies (the vortex lattice) is in `_core` alone, here as `host`.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from alula import _core

if TYPE_CHECKING:
    core = _core
else:
    core = _core
    if os.environ.get("ALULA_ISA", "") != "baseline" and _core.has_x86_64_v3():
        try:
            from alula import _core_v3 as core
        except ImportError:  # an architecture for which it is not built
            core = _core

host = _core
ISA = "x86-64-v3" if core is not _core else "baseline"
