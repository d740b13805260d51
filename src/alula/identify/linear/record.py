"""What a linear model is fitted to, and which numbers are unknown in it.

Initial states belong to each maneuver; so do the constants named so (trim, sensors' biases).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from alula.base.arrays import Array, frozen
from alula.base.messages import BadInput, refuse
from alula.identify.linear.model import LinearModel

EVEN = 1e-3  # of the interval, by which a sample may be off: the model is sampled once for all


@dataclass(frozen=True)
class LinearRecord:
    """One maneuver: t (n,) s, even; inputs (n, m); outputs (n, k), NaN where there is no reading.

    Columns in the model's order.
    """

    id: str
    t: Array
    inputs: Array
    outputs: Array
    held_out: bool = False

    @property
    def dt(self) -> float:
        """Sample interval, s."""
        return float((self.t[-1] - self.t[0]) / (len(self.t) - 1))

    @property
    def drive(self) -> Array:
        """(n, m + 1): the inputs with a one behind them, as the model's matrices take them."""
        return np.column_stack([self.inputs, np.ones(len(self.t))])


def linear_record(
    id: str,
    t: Array,
    channels: Mapping[str, Array],
    model: LinearModel,
    held_out: bool = False,
) -> LinearRecord:
    """The record of one maneuver from channels (n,) by name.

    Raises BadInput where a channel is missing, inputs have gaps or time is not even.
    """
    for name in (*model.inputs, *model.outputs):
        if name not in channels or len(channels[name]) != len(t):
            found = f"{len(channels[name])} samples" if name in channels else "none"
            raise refuse(
                "missing_channel",
                where=f"maneuver {id}",
                expected=f"channel '{name}' with {len(t)} samples",
                found=found,
                do="Give every input and output of the model.",
            )
    inputs = np.column_stack([channels[n] for n in model.inputs]) if model.inputs else None
    record = LinearRecord(
        id=id,
        t=frozen(t),
        inputs=frozen(np.zeros((len(t), 0)) if inputs is None else inputs),
        outputs=frozen(np.column_stack([channels[n] for n in model.outputs])),
        held_out=held_out,
    )
    _check(record)
    return record


def _check(record: LinearRecord) -> None:
    steps = np.diff(record.t)
    if len(steps) < 2 or not (np.abs(steps - record.dt) < EVEN * record.dt).all():
        found = f"steps of {steps.min():.6g} to {steps.max():.6g} s" if len(steps) else "no step"
        raise refuse(
            "uneven_time",
            where=f"maneuver {record.id}",
            expected="three samples or more, evenly spaced",
            found=found,
            do="Put the channels on one even time base.",
        )
    if not np.isfinite(record.inputs).all():
        raise refuse(
            "not_finite",
            where=f"maneuver {record.id}, inputs",
            expected="finite inputs: they drive the model",
            found="NaN or infinity",
            do="Choose a window without gaps in the inputs.",
        )


class Named(Protocol):
    """What `Unknowns` asks of a model: the names of its states and parameters."""

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states."""
        ...

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters."""
        ...


class Unknowns:
    """Every number of a problem by name, and which are free.

    names: all; first the shared parameters, then per maneuver its own constants 'L0[id]' and
    initial states 'p(0)[id]'. free: indices into them.
    """

    def __init__(
        self,
        model: Named,
        records: Sequence[LinearRecord],
        own: Collection[str],
        fixed: Mapping[str, float],
        initial: bool,
    ) -> None:
        for name in own:
            if name not in model.parameters:
                raise _unknown("per-maneuver constant", name, model.parameters)
        several = len(records) > 1
        shared = [p for p in model.parameters if not (several and p in own)]
        names = list(shared)
        self.pick: list[
            NDArray[np.intp]
        ] = []  # per record: (j + n,) places of its parameters and states
        for r in records:
            at = {p: shared.index(p) for p in shared}
            for p in model.parameters:
                if p not in at:
                    at[p] = len(names)
                    names.append(f"{p}[{r.id}]")
            start = len(names)
            names += [f"{s}(0)[{r.id}]" for s in model.states]
            places = [at[p] for p in model.parameters]
            places += list(range(start, start + len(model.states)))
            self.pick.append(np.array(places, dtype=np.intp))
        self.names = tuple(names)
        self.base = np.zeros(len(names))
        held = np.zeros(len(names), dtype=bool)
        for name, value in fixed.items():
            here = [i for i, n in enumerate(names) if name in (n, n.split("[")[0])]
            if not here:
                raise _unknown("fixed parameter", name, self.names)
            self.base[here] = value
            held[here] = True
        if not initial:
            held |= np.array(["(0)" in n for n in names])
        self.free = np.flatnonzero(~held)
        self.j = len(model.parameters)

    @property
    def free_names(self) -> tuple[str, ...]:
        """Names of what is estimated, in the order of the search's vector."""
        return tuple(self.names[i] for i in self.free)

    def all(self, free: Array) -> Array:
        """Every number (..., all) from the free ones (..., free)."""
        out = np.broadcast_to(self.base, (*free.shape[:-1], len(self.base))).copy()
        out[..., self.free] = free
        return out

    def of(self, i: int, free: Array) -> tuple[Array, Array]:
        """Parameters (..., j) and initial states (..., n) of record i."""
        mine = self.all(free)[..., self.pick[i]]
        return mine[..., : self.j], mine[..., self.j :]

    def held(self, i: int) -> Array:
        """(j,) fixed parameters of record i; zero where they are estimated."""
        out: Array = self.base[self.pick[i][: self.j]]
        return out

    def spread(self, i: int, local: Array) -> Array:
        """Derivatives (..., j + n) by record i's own numbers as derivatives by the free ones."""
        out = np.zeros((*local.shape[:-1], len(self.names)))
        out[..., self.pick[i]] = local
        chosen: Array = out[..., self.free]
        return chosen

    def vector(self, by_name: Mapping[str, float], default: Array) -> Array:
        """(free,) values by name, a bare name standing for all maneuvers; `default` elsewhere."""
        out = default.copy()
        for name, value in by_name.items():
            here = [i for i, n in enumerate(self.free_names) if name in (n, n.split("[")[0])]
            if not here and name not in self.names:
                raise _unknown("parameter", name, self.free_names)
            out[here] = value
        return out


def _unknown(what: str, name: str, known: Sequence[str]) -> BadInput:
    return refuse(
        "unknown_parameter",
        where=what,
        expected="one of " + ", ".join(known),
        found=f"'{name}'",
        do="Use a name that stands in the model's rows.",
    )
