"""Lookup table of a five-hole probe for the flight computer, with the error it makes.

The table is over the start of the inverse (core/include/alula/airdata/probe_table.hpp): what it
holds is nearly what it is asked for, and a small one does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from alula.airdata.probe import FiveHoleProbe, ProbeFlow, _rows, counted
from alula.base.arrays import Array, frozen
from alula.base.messages import refuse
from alula.core import core

SIZES = (9, 17, 33, 65, 129, 257)


@dataclass(frozen=True)
class ProbeTable:
    """data: (n, n, 3) float: v/u, w/u and q over the start's q. half: end of both axes.

    error_alpha, error_beta (rad), error_q (relative): largest found between the nodes on a grid
    four times as fine, over the probe's whole domain.
    """

    probe: FiveHoleProbe
    data: NDArray[np.float32]
    half: float
    error_alpha: float
    error_beta: float
    error_q: float

    @property
    def bytes(self) -> int:
        """Of flash."""
        return int(self.data.nbytes)

    def flow(self, pressures: ArrayLike) -> ProbeFlow:
        """Flow of pressure differences (n, 3) by the table, in the flight computer's float."""
        return _lookup(self.probe, self.data, self.half, _rows(pressures))

    def header(self, name: str = "probe_table") -> str:
        """C++ header with the table, for alula::airdata::probe_lookup."""
        n = len(self.data)
        A, B, K = self.probe.start()
        numbers = [f"{_float(float(x))}," for x in self.data.ravel()]
        rows = ["    " + " ".join(numbers[k : k + 6]) for k in range(0, len(numbers), 6)]
        return "\n".join(
            [
                "#pragma once",
                f"// Five-hole probe, {n} x {n} nodes, {self.bytes} bytes. Largest error of the",
                f"// table within {np.degrees(self.probe.domain):.4g} deg: alpha "
                f"{np.degrees(self.error_alpha):.2g} deg, beta "
                f"{np.degrees(self.error_beta):.2g} deg, q {100 * self.error_q:.2g} %.",
                '#include "alula/airdata/probe_table.hpp"',
                "",
                f"inline constexpr float {name}_data[{self.data.size}] = {{",
                *rows,
                "};",
                f"inline constexpr alula::airdata::ProbeTable<float> {name}{{",
                f"    {name}_data, {n}, {_float(self.half)}, {_float(A)}, {_float(B)}, "
                f"{_float(K)}, {_float(self.probe.least)}, {_float(self.probe.domain)}}};",
                "",
            ]
        )


def probe_table(probe: FiveHoleProbe, error: float = 1.7e-4) -> ProbeTable:
    """The smallest table whose largest error of alpha and beta stays below `error`, rad.

    The default is 0.01 deg. Raises BadInput where 257 x 257 nodes do not do.
    """
    # The start at the border of the domain; a margin of one cell is added below.
    edge = np.linspace(-probe.domain, probe.domain, 201)
    far = np.full_like(edge, probe.domain)
    border = [(edge, far), (edge, -far), (far, edge), (-far, edge)]
    a, b = (np.concatenate([side[k] for side in border]) for k in (0, 1))
    reach = float(np.max(np.abs(probe.starts(probe.pressures(1000.0, a, b))[:, :2])))
    table = None
    for n in SIZES:
        table = _made(probe, n, reach * (1.0 + 2.0 / (n - 3)))
        if max(table.error_alpha, table.error_beta) <= error:
            return table
    assert table is not None
    raise refuse(
        "probe_table_error",
        where="lookup table of the five-hole probe",
        expected=f"an error below {np.degrees(error):.3g} deg",
        found=f"{np.degrees(max(table.error_alpha, table.error_beta)):.3g} deg with {SIZES[-1]} "
        "nodes a side",
        do="Allow a larger error, or use the inverse itself.",
    )


def _made(probe: FiveHoleProbe, n: int, half: float) -> ProbeTable:
    axis = np.linspace(-half, half, n)
    Y, Z = (x.ravel() for x in np.meshgrid(axis, axis, indexing="ij"))
    wide = FiveHoleProbe(probe.side, probe.port_angle, probe.center, 1.4, probe.least)
    # Pressures that start there: those of the two-term probe, for which the start is exact.
    A, B, K = probe.start()
    x2 = 1.0 / (1.0 + Y**2 + Z**2)
    p = 1000.0 * np.column_stack([2 * A * x2 + B - A, K * x2 * Z, K * x2 * Y])
    found = wide.flow(p)
    data = np.column_stack(
        [np.tan(found.beta) / np.cos(found.alpha), np.tan(found.alpha), found.q / 1000.0]
    )
    table = data.reshape(n, n, 3).astype(np.float32)
    fine = np.linspace(-probe.domain, probe.domain, min(4 * n + 1, 401))
    a, b = (x.ravel() for x in np.meshgrid(fine, fine, indexing="ij"))
    looked = _lookup(probe, table, half, probe.pressures(1000.0, a, b), margin=1.02)
    off = [np.abs(looked.alpha - a), np.abs(looked.beta - b), np.abs(looked.q / 1000.0 - 1.0)]
    worst = [float(np.max(x)) if np.isfinite(x).all() else float("inf") for x in off]
    return ProbeTable(probe, table, half, *worst)


def _lookup(
    probe: FiveHoleProbe, data: NDArray[np.float32], half: float, p: Array, margin: float = 1.0
) -> ProbeFlow:
    out, status = np.empty((len(p), 3)), np.empty(len(p), dtype=np.int32)
    core.probe_lookup(
        data, half, np.array(probe.start()), probe.least, margin * probe.domain, p, out, status
    )
    q, alpha, beta = (frozen(column) for column in out.T)
    messages = counted(status, "five-hole probe, by table")
    return ProbeFlow(q, alpha, beta, np.zeros(len(p)), status, messages)


def _float(value: float) -> str:
    """A float literal that reads back the same."""
    text = f"{np.float32(value):.9g}"
    if text in ("nan", "-nan"):
        return '__builtin_nanf("")'
    return text + ("f" if any(c in text for c in ".e") else ".0f")
