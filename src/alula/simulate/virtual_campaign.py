"""A virtual flight test flown and written: logs, truth, and the project that identifies from them.

Maneuvers are flown side by side in threads, since the core works without Python's lock. Their
random numbers belong to their names, so that the same seed gives the same bytes whatever the
number of threads.
"""

from __future__ import annotations

import io
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.base.messages import BadInput, Message, refuse
from alula.model import AeroModel, load_model, model_text
from alula.simulate.trim import Trim
from alula.simulate.virtual_flight import (
    Flown,
    channels_of,
    constants_of,
    fly_maneuver,
    logged,
    sense,
    trimmed,
)
from alula.simulate.virtual_loading import MODEL, Loading, loadings_of
from alula.simulate.virtual_maneuvers import Condition, VirtualManeuver, maneuvers_of
from alula.simulate.virtual_plan import Plan
from alula.simulate.virtual_project import PROJECT, project_text

TRUTH = "truth.json"
Progress = Callable[[str], None]


@dataclass(frozen=True)
class WrittenFile:
    """One file of the campaign: its name in the folder, size and SHA-256."""

    name: str
    bytes: int
    sha256: str


@dataclass(frozen=True)
class Written:
    """What became of one maneuver. files: log as CSV and Parquet, and the truth."""

    plan: VirtualManeuver
    samples: int
    trim: Trim
    files: tuple[WrittenFile, ...]


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
    progress: Progress = lambda _: None,
) -> Campaign:
    """Fly a plan and write it to `folder`, whole or not at all.

    seed: instead of the plan's. threads: maneuvers side by side; 0: as many as there are
    processors. A maneuver that does not trim or that diverges is left out and named in `failed`.
    Raises BadInput where nothing can be flown, or the folder holds something else.
    """
    begin = time.perf_counter()
    _check_folder(folder)
    seed = plan.seed if seed is None else seed
    loadings = loadings_of(plan)
    model = load_model(_model_path(plan))
    asked = maneuvers_of(plan)
    channels = channels_of(plan, loadings)
    constants = constants_of(plan, seed)
    workers = threads or os.cpu_count() or 1
    with _new_folder(folder) as new, ThreadPoolExecutor(workers) as pool:
        for name in ("logs", "truth"):
            (new / name).mkdir()
        progress(f"trimming {len({(m.loading, m.condition) for m in asked})} conditions")
        trims = _trims(plan, loadings, model, asked, pool)
        trimmed_at = time.perf_counter()
        progress(f"flying {len(asked)} maneuvers")

        def one(item: VirtualManeuver) -> Written | tuple[Message, ...]:
            trim = trims[item.loading, item.condition]
            if isinstance(trim, tuple):
                return trim
            loading = loadings[item.loading]
            try:
                flight = fly_maneuver(plan, item, loading, model, trim)
            except BadInput as error:
                return error.messages
            sensed = sense(plan, flight, loading, channels, constants, seed)
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
            _save(new / loading.file, loading.text.encode())
        _save(new / MODEL, model_text(model).encode())
        wind = dict(zip(("wind_n", "wind_e", "wind_d"), plan.wind, strict=True))
        truth = {"parameters": model.params, "constants": {**constants, **wind}}
        _save(new / TRUTH, (json.dumps(truth, indent=1) + "\n").encode())
        text = project_text(plan, model, loadings, [w.plan for w in written], channels)
        _save(new / PROJECT, text.encode())
    end = time.perf_counter()
    seconds = {
        "trim": trimmed_at - begin, "fly_and_write": flown_at - trimmed_at, "rest": end - flown_at,
    }  # fmt: skip
    return Campaign(
        folder, folder / PROJECT, written, failed, constants, seconds,
        tuple(dict.fromkeys(m for x in loadings.values() for m in x.aircraft.messages)),
    )  # fmt: skip


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
            return trimmed(loadings[pair[0]], model, pair[1], np.array(plan.wind))
        except BadInput as error:
            return error.messages

    return dict(zip(wanted, pool.map(trim, wanted), strict=True))


def _write(flown: Flown, folder: Path) -> Written:
    """Log as CSV and Parquet, and the truth as Parquet; nothing in them tells when."""
    import pyarrow as pa
    import pyarrow.csv as csv
    import pyarrow.parquet as parquet

    motion, id = flown.flight.motion, flown.plan.maneuver.id
    columns: dict[str, Any] = {"t_s": pa.array(np.round(motion.t, 9))}
    for name, values in flown.readings.items():
        unit, si = logged(name)
        # A recorder's word has 32 bits: seven digits and a little.
        columns[f"{name}_{unit}"] = pa.array((values / si).astype(np.float32), from_pandas=True)
    table = pa.table(columns)
    text = io.BytesIO()
    text.write((",".join(table.column_names) + "\n").encode())
    csv.write_csv(table, text, csv.WriteOptions(include_header=False))
    stored = pa.BufferOutputStream()
    parquet.write_table(table, stored, compression="zstd")
    exact = pa.BufferOutputStream()
    parquet.write_table(pa.table(_truth(flown)), exact, compression="zstd")
    files = (
        (f"logs/{id}.csv", text.getvalue()),
        (f"logs/{id}.parquet", stored.getvalue().to_pybytes()),
        (f"truth/{id}.parquet", exact.getvalue().to_pybytes()),
    )
    for name, data in files:
        _save(folder / name, data)
    return Written(
        flown.plan,
        len(motion.t),
        flown.trim,
        tuple(WrittenFile(name, len(data), sha256(data).hexdigest()) for name, data in files),
    )


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


def _save(path: Path, data: bytes) -> None:
    with path.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


def _check_folder(folder: Path) -> None:
    """A folder that is there already is replaced only if it is empty or an earlier campaign."""
    found = ""
    if folder.exists() and not folder.is_dir():
        found = "a file"
    elif folder.is_dir() and any(folder.iterdir()) and not _is_campaign(folder):
        found = "a folder with other files in it"
    elif not folder.absolute().parent.is_dir():
        found = f"no folder {folder.absolute().parent}"
    elif not os.access(folder.absolute().parent, os.W_OK):
        found = f"no permission to write to {folder.absolute().parent}"
    if found:
        raise refuse(
            "output_not_writable",
            where=str(folder),
            expected="a free name, an empty folder, or an earlier campaign to replace",
            found=found,
            do="Choose another folder with --out; nothing was done yet.",
        )


def _is_campaign(folder: Path) -> bool:
    ours = {"logs", "truth", PROJECT, TRUTH, MODEL}
    names = {p.name for p in folder.iterdir()}
    return ours <= names and all(n in ours or n.endswith(".toml") for n in names)


class _new_folder:
    """A folder beside `path` that takes its place at the end, or vanishes where something fails."""

    def __init__(self, path: Path) -> None:
        self.path = path.absolute()
        self.new = Path()

    def __enter__(self) -> Path:
        try:
            self.new = Path(tempfile.mkdtemp(prefix=f".{self.path.name}.", dir=self.path.parent))
        except OSError as error:
            raise _not_writable(self.path, error) from None
        mask = os.umask(0)
        os.umask(mask)
        self.new.chmod(0o777 & ~mask)  # mkdtemp makes it private
        return self.new

    def __exit__(self, kind: type[BaseException] | None, error: object, trace: object) -> None:
        if kind is None:
            try:
                old = Path()
                if self.path.exists():
                    old = self.new.with_name(self.new.name + ".old")
                    self.path.rename(old)
                self.new.rename(self.path)
                if old != Path():
                    shutil.rmtree(old)
                return
            except OSError as problem:
                shutil.rmtree(self.new, ignore_errors=True)
                raise _not_writable(self.path, problem) from None
        shutil.rmtree(self.new, ignore_errors=True)


def _not_writable(path: Path, error: OSError) -> BadInput:
    return refuse(
        "output_not_writable",
        where=str(path),
        expected="a folder that exists and can be written to",
        found=error.strerror or str(error),
        do="Choose another folder with --out; nothing was written.",
    )
