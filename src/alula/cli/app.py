"""`alula`: one command per file; each takes --json, --seed, --threads and --quiet."""

from __future__ import annotations

import typer

from alula.cli.check import check
from alula.cli.identify import identify
from alula.cli.new import new
from alula.cli.schema import schema

app = typer.Typer(
    name="alula",
    help="Turns flight logs into flight models you can trust.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for command in (new, check, identify, schema):
    app.command()(command)


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


def main() -> None:
    """Entry point of the installed command."""
    app()
