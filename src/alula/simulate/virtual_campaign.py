"""A virtual flight test flown and written: logs, truth, and the project that identifies from them.

Maneuvers are flown side by side in threads, since the core works without Python's lock. Their
random numbers belong to their names, so that the same seed gives the same bytes whatever the
number of threads.
"""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse
from alula.model import AeroModel, load_model, model_text
from alula.simulate.trim import Trim
from alula.simulate.virtual_flight import Flown, fly_maneuver, trimmed
from alula.simulate.virtual_folder import PROJECT, TRUTH, NewFolder, check_folder, save
from alula.simulate.virtual_loading import MODEL, Loading, loadings_of
from alula.simulate.virtual_maneuvers import Condition, VirtualManeuver, maneuvers_of
from alula.simulate.virtual_plan import Plan
from alula.simulate.virtual_project import project_text
from alula.simulate.virtual_sample import drawn
from alula.simulate.virtual_sensing import channels_of, constants_of, errors_of, logged, sense

Progress = Callable[[str], None]
_LISTED = 5  # maneuvers that a message names


@dataclass(frozen=True)
class WrittenFile:
    """One file of the campaign: its name in the folder, size and SHA-256."""

    name: str
    bytes: int
    sha256: str


@dataclass(frozen=True)
class Written:
    """What became of one maneuver. files: log as CSV and Parquet, and the truth. messages: what
    was noticed of trim and flight.
    """

    plan: VirtualManeuver
    samples: int
    trim: Trim
    files: tuple[WrittenFile, ...]
    messages: tuple[Message, ...] = ()


@dataclass(frozen=True)
class Campaign:
    """A virtual flight test as it was written.

    failed: what kept a maneuver from being flown, by its id. constants: the sensors' errors, SI.
    seconds: by step.
    """

    folder: Path
    project: Path
    maneuvers: tuple[Written, ...]
    failed: Mapping[str, tuple[Message, ...]]
    constants: Mapping[str, float]
    seconds: Mapping[str, float]
    messages: tuple[Message, ...] = ()


def fly_plan(
    plan: Plan,
    folder: Path,
    *,
    seed: int | None = None,
    threads: int = 0,
    sample: int | None = None,
    progress: Progress = lambda _: None,
) -> Campaign:
    """Fly a plan and write it to `folder`, whole or not at all.

    seed: instead of the plan's. threads: maneuvers side by side; 0: as many as there are
    processors. sample: fly the aircraft of that number drawn from its file's [uncertainty]. A
    maneuver that does not trim or that diverges is left out and named in `failed`.
    Raises BadInput where nothing can be flown, or the folder holds something else.
    """
    begin = time.perf_counter()
    check_folder(folder)
    seed = plan.seed if seed is None else seed
    loadings = loadings_of(plan)
    of_sample: dict[str, Any] = {}
    said: list[Message] = []
    if sample is not None:
        loadings, flown_aircraft, message = drawn(loadings, seed, sample)
        of_sample, said = {"aircraft": flown_aircraft}, [message]
    model = load_model(_model_path(plan))
    asked = maneuvers_of(plan)
    channels = channels_of(plan, loadings)
    constants = constants_of(plan, seed)
    errors = errors_of(plan, channels, constants)
    workers = threads or os.cpu_count() or 1
    with NewFolder(folder) as new, ThreadPoolExecutor(workers) as pool:
        for name in ("logs", "truth"):
            (new / name).mkdir()
        conditions = len({(m.loading, m.condition) for m in asked})
        progress(f"trimming {conditions} condition{'s' * (conditions != 1)}")
        trims = _trims(plan, loadings, model, asked, pool)
        trimmed_at = time.perf_counter()
        progress(f"flying {len(asked)} maneuver{'s' * (len(asked) != 1)}")

        def one(item: VirtualManeuver) -> Written | tuple[Message, ...]:
            trim = trims[item.loading, item.condition]
            if isinstance(trim, tuple):
                return trim
            loading = loadings[item.loading]
            try:
                flight = fly_maneuver(plan, item, loading, model, trim, seed)
            except BadInput as error:
                return error.messages
            sensed = sense(plan, flight, loading, errors, seed)
            return _write(Flown(item, flight, trim, sensed), new)

        found = list(pool.map(one, asked))
        written = tuple(w for w in found if isinstance(w, Written))
        failed = {
            item.maneuver.id: tuple(
                replace(m, where=f"maneuver {item.maneuver.id}, {m.where}") for m in w
            )
            for item, w in zip(asked, found, strict=True)
            if isinstance(w, tuple)
        }
        flown_at = time.perf_counter()
        if not written:
            raise BadInput(*dict.fromkeys(m for ms in failed.values() for m in ms))
        for loading in loadings.values():
            save(new / loading.file, loading.text.encode())
        save(new / MODEL, model_text(model).encode())
        wind = dict(zip(("wind_n", "wind_e", "wind_d"), plan.wind, strict=True))
        truth = {"parameters": model.params, "constants": {**constants, **wind}, **of_sample}
        save(new / TRUTH, (json.dumps(truth, indent=1) + "\n").encode())
        text = project_text(plan, model, loadings, [w.plan for w in written], channels)
        save(new / PROJECT, text.encode())
    end = time.perf_counter()
    seconds = {
        "trim": trimmed_at - begin, "fly_and_write": flown_at - trimmed_at, "rest": end - flown_at,
    }  # fmt: skip
    return Campaign(
        folder, folder / PROJECT, written, failed, constants, seconds,
        (*said, *dict.fromkeys(m for x in loadings.values() for m in x.aircraft.messages),
         *said_once(written)),
    )  # fmt: skip


def said_once(written: Sequence[Written]) -> Iterator[Message]:
    """What was noticed in flight, once for all maneuvers of which it is true, with each value."""
    same: dict[tuple[str, str], list[tuple[str, Message]]] = {}
    for w in written:
        for m in w.messages:
            same.setdefault((m.code, m.where), []).append((w.plan.maneuver.id, m))
    for found in same.values():
        first = found[0][1]
        values = [f"{id}: {m.found}" for id, m in found]
        more = f"; and in {len(values) - _LISTED} more" if len(values) > _LISTED else ""
        yield replace(first, found="; ".join(values[:_LISTED]) + more)


def _model_path(plan: Plan) -> Path:
    if plan.model is not None:
        return plan.model
    default = load_aircraft(plan.aircraft).aero
    if default is None:
        raise refuse(
            "missing_model",
            where=f"{plan.path}: model",
            expected="an aerodynamic model, here or as 'aero' of the aircraft file",
            found="neither",
            do='Add model = "my_aero.toml".',
        )
    return Path(default)


def _trims(
    plan: Plan,
    loadings: Mapping[str, Loading],
    model: AeroModel,
    asked: tuple[VirtualManeuver, ...],
    pool: ThreadPoolExecutor,
) -> dict[tuple[str, Condition], Trim | tuple[Message, ...]]:
    """The trim of every condition at every loading, or what kept it from being one."""
    wanted = list(dict.fromkeys((m.loading, m.condition) for m in asked))

    def trim(pair: tuple[str, Condition]) -> Trim | tuple[Message, ...]:
        try:
            return trimmed(plan, loadings[pair[0]], model, pair[1])
        except BadInput as error:
            return error.messages

    return dict(zip(wanted, pool.map(trim, wanted), strict=True))


def _write(flown: Flown, folder: Path) -> Written:
    """Log as CSV and Parquet, and the truth as Parquet; nothing in them tells when."""
    import pyarrow as pa
    import pyarrow.csv as csv
    import pyarrow.parquet as parquet

    motion, id = flown.flight.motion, flown.plan.maneuver.id
    columns: dict[str, Any] = {"t_s": _column(np.round(motion.t, 9))}
    for name, values in flown.readings.items():
        unit, si = logged(name)
        # A recorder's word has 32 bits: seven digits and a little.
        columns[f"{name}_{unit}"] = _column((values / si).astype(np.float32))
    table = pa.table(columns)
    text = io.BytesIO()
    text.write((",".join(table.column_names) + "\n").encode())
    csv.write_csv(table, text, csv.WriteOptions(include_header=False))
    stored = pa.BufferOutputStream()
    # Noise has no word twice: a dictionary would only cost time.
    how: dict[str, Any] = {"compression": "zstd", "use_dictionary": False}
    parquet.write_table(table, stored, **how)
    exact = pa.BufferOutputStream()
    truth = {name: _column(values) for name, values in _truth(flown).items()}
    parquet.write_table(pa.table(truth), exact, **how)
    files = (
        (f"logs/{id}.csv", text.getvalue()),
        (f"logs/{id}.parquet", stored.getvalue().to_pybytes()),
        (f"truth/{id}.parquet", exact.getvalue().to_pybytes()),
    )
    for name, data in files:
        save(folder / name, data)
    return Written(
        flown.plan,
        len(motion.t),
        flown.trim,
        tuple(WrittenFile(name, len(data), sha256(data).hexdigest()) for name, data in files),
        tuple(dict.fromkeys((*flown.trim.messages, *flown.flight.messages))),
    )


def _column(values: Array | NDArray[np.float32]) -> Any:
    """An Arrow array over the same memory, NaN as null; pa.array would load pandas first."""
    import pyarrow as pa

    known = ~np.isnan(values)
    bits = None if known.all() else pa.py_buffer(np.packbits(known, bitorder="little"))
    kind = pa.float32() if values.dtype == np.float32 else pa.float64()
    data = pa.py_buffer(np.ascontiguousarray(values))
    return pa.Array.from_buffers(kind, len(values), [bits, data])


def _truth(flown: Flown) -> dict[str, Array]:
    """Everything that the simulation knows, SI and radians, at the center of gravity."""
    flight, motion = flown.flight, flown.flight.motion
    names = (
        "t", "V", "alpha", "beta", "p", "q", "r", "pdot", "qdot", "rdot", "ax", "ay", "az",
        "phi", "theta", "psi", "h", "rho",
    )  # fmt: skip
    out: dict[str, Array] = {name: getattr(motion, name) for name in names}
    out |= dict(zip(("north", "east", "down"), flight.position.T, strict=True))
    out |= dict(zip(("v_north", "v_east", "v_down"), flight.velocity.T, strict=True))
    out["mach"] = flight.mach
    out |= dict(motion.controls) | dict(motion.recorded)
    if motion.thrust is not None:
        out["thrust"] = motion.thrust
    out |= dict(getattr(flight, "states", {}))
    return {name: np.ascontiguousarray(values) for name, values in out.items()}
