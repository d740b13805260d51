"""`alula`: one command per file; each takes --json, --seed, --threads and --quiet."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NoReturn

import typer

from alula.base.messages import refuse
from alula.cli.airdata import airdata
from alula.cli.calibrate import calibrate
from alula.cli.check import check
from alula.cli.compare import compare
from alula.cli.contract import Command
from alula.cli.export import export
from alula.cli.fly import fly
from alula.cli.identify import identify
from alula.cli.linearize import linearize
from alula.cli.modes import modes
from alula.cli.navigate import navigate
from alula.cli.new import new
from alula.cli.plan import plan
from alula.cli.predict import predict
from alula.cli.propeller import propeller
from alula.cli.schema import schema
from alula.cli.trim import trim
from alula.cli.validate import validate

app = typer.Typer(
    name="alula",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
COMMANDS = (
    new,
    check,
    calibrate,
    airdata,
    identify,
    compare,
    predict,
    plan,
    fly,
    trim,
    linearize,
    modes,
    validate,
    navigate,
    propeller,
    export,
    schema,
)
for command in COMMANDS:
    app.command()(command)


# Not exported under its own name; typer brings its own click.
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]


def _version(wanted: bool) -> None:
    if wanted:
        from alula import __version__

        typer.echo(f"alula {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and stop."
    ),
) -> None:
    """Turns flight logs into flight models you can trust.

    Begin with `alula new LOG`, look with `alula check PROJECT`, then `alula identify PROJECT`.
    """


INTERRUPTED = 130  # by Ctrl-C, as shells count it


@cache
def _group() -> Callable[..., Any]:
    """The commands with their options, which `app()` would read from the functions at each call."""
    return typer.main.get_command(app)


def main(arguments: Sequence[str] | None = None) -> NoReturn:
    """Entry point of the installed command; arguments: instead of sys.argv's."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        code = _group()(words, prog_name="alula", standalone_mode=False) or 0
        if code == INTERRUPTED:
            typer.echo("interrupted; no file was left half written", err=True)
    except _UsageError as error:
        if not words:  # what it carries is the help
            typer.echo(str(error), err=True)
            sys.exit(2)
        code = _usage(words, error)
    sys.exit(code)


def _usage(words: Sequence[str], error: Exception) -> int:
    """A command line that cannot be read ends as other bad input does, envelope and all."""
    json = ""
    for word, following in zip(words, [*words[1:], ""], strict=True):
        if word == "--json" or word.startswith("--json="):
            json = word.partition("=")[2] or following
    said = getattr(error, "format_message", error.__str__)()
    try:
        with Command("usage", json).run():
            raise refuse(
                "usage",
                where="alula " + " ".join(words),
                expected="a command with its arguments and options",
                found=said.replace("Value error, ", "").rstrip("."),
                do="alula --help and alula COMMAND --help list them.",
            )
    except typer.Exit as end:
        return end.exit_code
