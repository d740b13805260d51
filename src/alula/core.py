"""The compiled core, built for the processor that runs it.

A wheel has the same bindings twice: `_core` for any processor, `_core_v3` for x86-64-v3 (AVX2,
FMA), and `ALULA_ISA=baseline` chooses the first; results agree to 1e-10 between them and to the
last bit within one of them. A build for the machine it is made on has `_core` alone, with the
instructions of that machine. What never flies (the vortex lattice) is in `_core` alone, here as
`host`.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from alula import _core

if TYPE_CHECKING:
    core = _core
else:
    core = _core
    if os.environ.get("ALULA_ISA", "") == "baseline":
        if _core.instruction_set() != "baseline":
            raise ImportError(
                f"ALULA_ISA=baseline: this build has {_core.instruction_set()} alone. Build with "
                "both instruction sets: make build INSTRUCTION_SETS=all"
            )
    elif _core.instruction_set() == "baseline" and _core.has_x86_64_v3():
        try:
            from alula import _core_v3 as core
        except ImportError:  # not built: another architecture, or for this machine alone
            core = _core

host = _core
ISA = core.instruction_set()
# The modules that are built and that this processor runs, by instruction set.
MODULES = {module.instruction_set(): module for module in (_core, core)}
