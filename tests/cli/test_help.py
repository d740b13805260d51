"""Help is there at once: it loads nothing heavy."""

from __future__ import annotations

import subprocess
import sys

import pytest

from cli.command import alula

COMMANDS = (
    "new", "check", "identify", "compare", "plan", "fly", "validate", "export", "trim", "linearize",
    "modes", "propeller", "schema",
)  # fmt: skip
HEAVY = ("numpy", "pandas", "scipy", "matplotlib", "pyarrow", "h5py", "alula._core", "alula.core")
PROBE = """
import sys
from alula.cli.app import main
try:
    main(sys.argv[1:])
except SystemExit as end:
    code = end.code
loaded = [name for name in {heavy} if name in sys.modules]
print("LOADED", code, *loaded, file=sys.stderr)
"""


@pytest.mark.parametrize("words", [(), *((name,) for name in COMMANDS)])
def test_help_loads_neither_numpy_nor_pandas(words: tuple[str, ...]) -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROBE.format(heavy=HEAVY), *words, "--help"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr.splitlines()[-1] == "LOADED 0"
    assert "Usage: alula" in done.stdout


def test_the_probe_sees_what_is_loaded() -> None:
    done = subprocess.run(
        [sys.executable, "-c", PROBE.format(heavy=HEAVY), "check", "none.toml"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stderr.splitlines()[-1].startswith("LOADED 2 numpy")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_takes_the_options_of_the_contract(command: str) -> None:
    ran = alula(command, "--help")
    assert ran.code == 0
    for option in ("--json", "--seed", "--threads", "--quiet"):
        assert option in ran.out


def test_help_names_every_command() -> None:
    ran = alula("--help")
    assert ran.code == 0
    for command in COMMANDS:
        assert f"\n  {command} " in ran.out
    assert "alula new LOG" in ran.out


def test_no_words_is_help_and_no_success() -> None:
    ran = alula()
    assert ran.code == 2
    assert "Usage: alula" in ran.err


def test_version() -> None:
    import alula as package

    assert alula("--version").out.split() == ["alula", package.__version__]
