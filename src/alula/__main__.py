"""`python -m alula` is the command `alula`."""

from alula.cli.app import main

main()
