"""What every command has in common: options, exit codes, the JSON envelope, progress, errors."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TextIO

import typer

from alula.base.messages import BadInput, Message, refuse

if TYPE_CHECKING:
    from alula.flight import SourceFile
    from alula.report import ReportInput

# Control characters, escapes that are no color, and marks that turn the direction of writing.
_STEERING = re.compile(
    r"\x1b(?!\[[\d;]*m)|[\x00-\x08\x0b-\x1a\x1c-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]"
)

Kind = Literal["", "report", "model", "json", "picture", "plot", "calibration", "three_view"]
Status = Literal["ok", "not_identifiable", "check_failed", "bad_input"]
OWN_FAULT = 70  # sysexits: internal software error
EXIT: Mapping[Status, int] = {"ok": 0, "not_identifiable": 1, "check_failed": 1, "bad_input": 2}

ProjectArgument = Annotated[Path, typer.Argument(metavar="PROJECT", help="The project file.")]
ReportOption = Annotated[
    Path | None, typer.Option(metavar="FILE", help="Write the HTML report there.")
]
JsonOption = Annotated[
    str, typer.Option("--json", metavar="FILE|-", help="Write the result as JSON; - is stdout.")
]
SeedOption = Annotated[
    int | None, typer.Option("--seed", metavar="N", help="Seed of anything random.")
]
ThreadsOption = Annotated[
    int,
    typer.Option(
        "--threads", metavar="N", min=0, help="Threads of linear algebra; 0: the library chooses."
    ),
]
QuietOption = Annotated[
    bool, typer.Option("--quiet", help="No progress and no notes; warnings stay.")
]


@dataclass
class Command:
    """One run of one command: collects what the envelope holds and ends with the right code."""

    name: str  # of the schema: 'identification'
    json: str = ""
    seed: int | None = None
    threads: int = 1  # the matrices are small: more threads cost time
    quiet: bool = False
    status: Status = "ok"
    messages: Sequence[Message] = ()
    inputs: Sequence[SourceFile] = ()
    result: Mapping[str, Any] = field(default_factory=dict)
    timing: Mapping[str, float] = field(default_factory=dict)
    _start: float = field(default_factory=time.perf_counter)

    @property
    def talks(self) -> bool:
        """Whether stdout is for people."""
        return self.json != "-"

    def progress(self, text: str) -> None:
        """One line on stderr about what is being done."""
        if not self.quiet:
            _out(f"… {text}\n", sys.stderr)

    def say(self, text: str) -> None:
        """Text for people, on stdout; nothing where stdout is JSON."""
        if self.talks:
            _out(text + "\n", sys.stdout)

    def written(self, **files: Path | None) -> None:
        """Say where each file that was asked for stands now."""
        for kind, path in files.items():
            if path is not None:
                self.say(f"\n{kind}: {path}")

    def write_report(self, path: Path, report_of: Callable[[str, int | None], ReportInput]) -> None:
        """Write the page of what `report_of` makes of date and seed."""
        from alula.base.files import write_whole
        from alula.report import render

        self.progress("writing the report")
        date = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
        write_whole(path, render(report_of(date, self.seed)))

    @contextmanager
    def run(self) -> Iterator[None]:
        """The command's body. Bad input ends in messages and code 2, never in a traceback."""
        if self.threads:
            for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
                os.environ[name] = str(self.threads)
        try:
            self._json_can_be_written()
            yield
        except BadInput as error:
            self.status, self.messages = "bad_input", error.messages
            self.result = {}
        except typer.Exit:
            raise
        except Exception:
            # Alula's own mistake, not the user's; told apart from 'not identifiable' by its code.
            _out(
                traceback.format_exc() + "This is a mistake in Alula; please report it with the "
                "lines above. No file was left half written.\n",
                sys.stderr,
            )
            raise typer.Exit(OWN_FAULT) from None
        self._finish()

    def _json_can_be_written(self) -> None:
        if not self.json or not self.talks:
            return
        path, self.json = self.json, ""  # no envelope to where it must not go
        writable(Path(path), "json")
        self.json = path

    def _finish(self) -> None:
        for message in self.messages:
            if message.level != "info" or self.status == "bad_input":
                _out(f"{message.level}: {message}\n", sys.stderr)
        if self.json:
            try:
                self._write(json.dumps(self._envelope(), indent=1, allow_nan=False) + "\n")
            except BadInput as error:
                _out(f"error: {error}\n", sys.stderr)
                raise typer.Exit(2) from None
        raise typer.Exit(EXIT[self.status])

    def _write(self, text: str) -> None:
        if self.talks:
            from alula.base.files import write_whole

            write_whole(Path(self.json), text)
        else:
            _out(text, sys.stdout)

    def _envelope(self) -> dict[str, Any]:
        from alula.base.provenance import provenance

        lost: list[str] = []
        result = finite(self.result, "result", lost)
        messages = [m.as_dict() for m in self.messages]
        if lost:
            messages.append(
                Message(
                    "non_finite",
                    "info",
                    ", ".join(lost[:20]) + (" ..." if len(lost) > 20 else ""),
                    "numbers",
                    f"{len(lost)} that are not finite",
                    "They are null in this file: there is no value to give.",
                ).as_dict()
            )
        return {
            "schema": f"alula.{self.name}/1",
            "status": self.status,
            "messages": messages,
            "inputs": [
                {
                    "path": f.path,
                    "sha256": f.sha256,
                    "bytes": f.bytes,
                    "decoded": f.decoded,
                    "skipped": f.skipped,
                    "unknown": f.unknown,
                }
                for f in self.inputs
            ],
            "result": result,
            "provenance": provenance(self.seed),
            "timing_s": {
                **{k: round(v, 4) for k, v in self.timing.items()},
                "total": round(time.perf_counter() - self._start, 4),
            },
        }


def _out(text: str, stream: TextIO) -> None:
    """Text to stdout or stderr, with '?' for what its encoding lacks (a file's name may be any)
    and for what would steer the terminal, colors aside (a log's names may be any too).

    A reader who has seen enough (`| head`) ends the text, not the command.
    """
    text = _STEERING.sub("?", text)
    encoding = stream.encoding or "utf-8"
    try:
        stream.write(text.encode(encoding, "replace").decode(encoding))
        stream.flush()
    except BrokenPipeError:
        # What is still in the buffer would complain once more when Python closes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def finite(value: Any, where: str, lost: list[str]) -> Any:
    """The value with every number that is not finite replaced by None; its place goes to `lost`."""
    if isinstance(value, Mapping):
        return {str(k): finite(v, f"{where}.{k}", lost) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(v, f"{where}[{i}]", lost) for i, v in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        lost.append(where)
        return None
    return value


def writable(path: Path | None, kind: Kind = "") -> None:
    """Raise BadInput at once if a file could not be written there after the work is done.

    path: None where none was asked for. kind: of what Alula writes. A file that is there already
    is replaced only if it is of that kind: a slip in the options must not cost a log.
    """
    if path is None:
        return
    folder = path.absolute().parent
    expected, do = "", "Choose another path; nothing was done yet."
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        expected = "a file name in a folder that exists and can be written to"
        found = f"no {'permission to write to ' if folder.is_dir() else ''}folder {folder}"
    elif path.is_dir():
        expected, found = "the name of a file", "a folder"
    elif path.exists() and not path.is_file():
        expected, found = "the name of a file", "a device"
        do = "Choose another path; --json - writes to stdout."
    elif path.exists() and kind and not _is_own(path, kind):
        expected, found = f"a free name, or a {kind} of Alula's to replace", "another kind of file"
    if expected:
        raise refuse("output_not_writable", where=str(path), expected=expected, found=found, do=do)


def _is_own(path: Path, kind: str) -> bool:
    marks = {
        "report": b'content="Alula"', "model": b"alula.model/", "json": b'"schema": "alula.',
        "picture": b'class="splane"', "plot": b"Alula",
        "calibration": b"alula.imu_calibration/", "three_view": b'class="threeview"',
    }  # fmt: skip
    try:
        with path.open("rb") as file:
            head = file.read(2048)
    except OSError:
        return False
    return not head or marks[kind] in head
