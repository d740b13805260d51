"""Several identifications of different parameters as one result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from alula.base.arrays import frozen
from alula.identify.result import Identification


def merged(results: Sequence[Identification]) -> Identification:
    """All parameters, fits and series in turn; parameters of different results do not correlate.

    Each coefficient or output must stand in one result only. One that failed makes the whole
    `status` say so.
    """
    if len(results) == 1:
        return results[0]
    sizes = [len(r.parameters) for r in results]
    ends = np.cumsum(sizes)
    covariance = np.zeros((ends[-1], ends[-1]))
    for r, size, end in zip(results, sizes, ends, strict=True):
        covariance[end - size : end, end - size : end] = r.covariance
    first = results[0]
    return replace(
        first,
        parameters=tuple(p for r in results for p in r.parameters),
        fits={k: v for r in results for k, v in r.fits.items()},
        series=tuple(s for r in results for s in r.series),
        covariance=frozen(covariance),
        status="; ".join(dict.fromkeys(_status(r) for r in results)),
        messages=tuple(dict.fromkeys(m for r in results for m in r.messages)),
        labels={k: v for r in results for k, v in r.labels.items()},
        formulas={k: v for r in results for k, v in r.formulas.items()},
        fixed={k: v for r in results for k, v in r.fixed.items()},
        tied={k: v for r in results for k, v in r.tied.items()},
    )


def _status(result: Identification) -> str:
    about = ", ".join(result.formulas or result.fits) or result.method
    return f"{about}: {result.status}"
