"""Bad input given to the command by its options, and the command as a process of its own: exit 2,
what to do, no traceback, and nothing written.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial

import numpy as np
import pytest

from alula.model import load_model
from cli.command import SmallProject, alula, assert_refused, contents, process

# --- the command line ----------------------------------------------------------------------------


def test_unknown_maneuver(small: SmallProject) -> None:
    ran = small.identify("--maneuver", "roll")
    assert_refused(ran, "unknown_maneuver", "'roll'", "longitudinal")


@pytest.mark.parametrize(
    ("words", "found"),
    [
        (("--filter", "kf"), "'ekf'"),
        (("--method", "magic"), "'ee'"),
        (("--threads", "-1"), "-1"),
        (("--seed", "one"), "one"),
        (("--wrong",), "--wrong"),
        (("second.toml",), "second.toml"),
    ],
)
def test_options_that_are_wrong(sound: SmallProject, words: tuple[str, ...], found: str) -> None:
    assert_refused(sound.identify(*words), "usage", found)


@pytest.mark.parametrize("option", ["--report", "--model", "--json"])
@pytest.mark.parametrize("place", ["missing/out", "sportstar.toml/out", "."])
def test_output_that_cannot_be_written(small: SmallProject, option: str, place: str) -> None:
    """A folder that is missing, a file for a folder, a folder for a file: known before the work."""
    before = contents(small.folder)
    words = ["identify", small.path, option, small.folder / place]
    ran = alula(*words)
    assert ran.code == 2
    assert "[output_not_writable]" in ran.err
    assert "reading logs" not in ran.err
    assert "Traceback" not in ran.err
    assert contents(small.folder) == before


@pytest.mark.parametrize("option", ["--report", "--model", "--json"])
@pytest.mark.parametrize("target", ["longitudinal.csv", "demo.toml", "truth.json"])
def test_no_output_replaces_what_alula_did_not_write(
    small: SmallProject, option: str, target: str
) -> None:
    before = contents(small.folder)
    ran = alula("identify", small.path, option, small.folder / target)
    assert ran.code == 2
    assert "[output_not_writable]" in ran.err
    assert contents(small.folder) == before


def test_outputs_may_be_written_again(small: SmallProject) -> None:
    names = {"--report": "r.html", "--model": "m.toml", "--json": "j.json"}
    words = [word for key, name in names.items() for word in (key, small.folder / name)]
    for _ in range(2):
        ran = alula("identify", small.path, *words)
        assert ran.code == 0, ran.err


def test_pipe_or_device_is_no_file(small: SmallProject) -> None:
    """Writing by rename would put a file in its place."""
    pipe = small.folder / "pipe"
    os.mkfifo(pipe)
    ran = alula("identify", small.path, "--json", pipe)
    assert ran.code == 2
    assert "--json -" in ran.err
    assert pipe.is_fifo()


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"parameters": 3}', '{"parameters": {"Cm_0": "x"}}', "\x00"]
)
def test_truth_that_is_none(small: SmallProject, text: str) -> None:
    truth = small.folder / "t.json"
    truth.write_text(text)
    assert_refused(small.identify("--truth", truth), "bad_truth", "t.json")


def test_new_overwrites_nothing(small: SmallProject) -> None:
    before = contents(small.folder)
    ran = alula("new", small.log, "--output", small.path, "--json", "-")
    assert_refused(ran, "file_exists", "demo.toml")
    empty = small.folder / "empty.csv"
    empty.touch()
    ran = alula("new", empty, "--output", small.folder / "new.toml", "--json", "-")
    assert_refused(ran, "empty_file", "empty.csv")
    assert {k for k in contents(small.folder) if k not in before} == {str(empty)}


# --- by a process of its own ---------------------------------------------------------------------


def test_refusal_by_the_real_command(small: SmallProject) -> None:
    small.log.write_bytes(b"")
    assert_refused(process("identify", small.path, "--json", "-"), "empty_file")
    plain = process("identify", small.path)
    assert plain.code == 2
    assert plain.out == ""
    assert "Traceback" not in plain.err


def test_interrupted(small: SmallProject) -> None:
    """Ctrl-C ends with 130, no traceback and no file."""
    small.table = np.vstack([small.table] * 40)  # long enough to be interrupted
    small.column("t_s")[:] = 0.01 * np.arange(len(small.table))
    small.write_log()
    small.edit("end = 20.0", "end = 800.0")
    before = contents(small.folder)
    running = subprocess.Popen(
        [sys.executable, "-m", "alula", "identify", str(small.path), "--filter", "ml",
         "--report", str(small.folder / "r.html")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell that runs the tests in the background has made its children deaf to Ctrl-C.
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),
    )  # fmt: skip
    assert running.stderr is not None
    assert "reading logs" in running.stderr.readline()
    time.sleep(0.05)
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=120)
    assert running.returncode == 130, out + err
    assert "Traceback" not in err
    assert out == ""
    assert contents(small.folder) == before


@pytest.mark.parametrize(
    ("words", "streams"),
    [
        (("check",), "stdout"),
        (("check",), "both"),
        (("identify",), "stdout"),
        (("identify", "--json", "-"), "both"),
    ],
)
def test_reader_that_goes_away(small: SmallProject, words: tuple[str, ...], streams: str) -> None:
    """`alula ... | head`: no complaint, the command's own exit code, and its files all the same."""
    command, *more = words
    report = ["--report", str(small.folder / "r.html")] if command == "identify" else []
    with (small.folder / "stderr").open("w+") as err:
        running = subprocess.Popen(
            [sys.executable, "-m", "alula", command, str(small.path), *more, *report],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if streams == "both" else err,
        )
        assert running.stdout is not None
        running.stdout.close()
        assert running.wait(timeout=120) == 0
        err.seek(0)
        said = err.read()
    assert "Traceback" not in said
    assert "Broken pipe" not in said
    assert (small.folder / "r.html").exists() == (command == "identify")


@pytest.mark.parametrize("encoding", ["ascii", "utf-8"])
def test_file_names_of_any_bytes(small: SmallProject, encoding: str) -> None:
    """A folder named in Latin-1 on a system of UTF-8, and a terminal that knows ASCII only."""
    small.edit('name = "Demo: light', 'name = "😀 Demo: light')
    folder = small.folder.with_name(os.fsdecode(b"caf\xe9"))
    small.folder.rename(folder)
    words = {"--report": "r.html", "--model": "m.toml", "--truth": "truth.json"}
    ran = process(
        "identify",
        folder / "demo.toml",
        *(word for key, name in words.items() for word in (key, folder / name)),
        env={**os.environ, "PYTHONIOENCODING": encoding},
        errors="surrogateescape",
    )
    assert ran.code == 0, ran.err
    assert "Cm_alpha" in ran.out
    assert "caf\ufffd" in (folder / "r.html").read_text()
    assert load_model(folder / "m.toml").params
