"""`alula linearize AIRCRAFT`: the linear equations of motion about a point of flight."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.condition import Asked, Loaded, at_condition, load, trim_result
from alula.cli.contract import Command, JsonOption, QuietOption, SeedOption, ThreadsOption

if TYPE_CHECKING:
    from alula.simulate import Linearization, LinearModel, Trim

_ANGLES = ("alpha", "beta", "phi", "theta", "psi", "p", "q", "r", "de", "da", "dr", "df")


@at_condition
def linearize(
    asked: Asked,
    move: Annotated[
        list[str] | None,
        typer.Option(
            "--move",
            metavar="NAME=VALUE",
            help="Leave the trimmed point: a state or input, SI, or NAME_deg; several times.",
        ),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Linearize the equations of motion about a trimmed point, or any point beside it.

    Exit 0: done. 2: bad input.
    """
    command = Command("linearization", json, seed, threads, quiet)
    with command.run():
        loaded = load(asked)
        found = loaded.trimmed()
        linear = loaded.linear(found)
        if move:
            linear = _moved(loaded, found, linear, move)
        command.inputs = loaded.files
        command.messages = [*loaded.aircraft.messages, *found.messages]
        command.result = {"trim": trim_result(found), **linearization_result(linear)}
        command.say(text_of(linear))


def linearization_result(linear: Linearization) -> dict[str, Any]:
    """The envelope's `result`: SI, rad."""
    return {
        **_matrices(linear),
        "x0": linear.x0.tolist(),
        "u0": linear.u0.tolist(),
        "f0": linear.f0.tolist(),
        "y0": linear.y0.tolist(),
        "earth": linear.earth,
        "unsteady": linear.unsteady,
        "longitudinal": _matrices(linear.longitudinal(), outputs=False),
        "lateral": _matrices(linear.lateral(), outputs=False),
    }


def _matrices(part: LinearModel, outputs: bool = True) -> dict[str, Any]:
    found = {
        "states": list(part.states),
        "inputs": list(part.inputs),
        "A": part.A.tolist(),
        "B": part.B.tolist(),
    }
    if outputs:
        more = {"outputs": list(part.outputs), "C": part.C.tolist(), "D": part.D.tolist()}
        return {**found, **more}
    return found


def _moved(loaded: Loaded, found: Trim, linear: Linearization, move: list[str]) -> Linearization:
    """The linearization where some states and inputs have other values."""
    import numpy as np

    from alula.base.messages import refuse
    from alula.simulate.coordinates import plant_state

    x, inputs = linear.x0.copy(), dict(found.inputs)
    for text in move:
        name, _, number = text.partition("=")
        plain = name.removesuffix("_deg")
        known = plain in linear.states or plain in inputs
        try:
            value = float(number)
        except ValueError:
            known = False
        if not known or (name != plain and plain not in _ANGLES) or not np.isfinite(value):
            raise refuse(
                "bad_move",
                where=f"--move {text}",
                expected="NAME=VALUE, NAME one of "
                + ", ".join(dict.fromkeys((*linear.states, *inputs)))
                + ", angles also as NAME_deg",
                found=f"'{text}'",
                do="Correct the option.",
            )
        value = radians(value) if name != plain else value
        if plain in linear.states:
            x[linear.states.index(plain)] = value
        else:
            inputs[plain] = value
    state = plant_state(x, np.zeros(3), linear.earth)
    return loaded.linear(replace(found, state=state), inputs)


def text_of(linear: Linearization) -> str:
    """What the command prints: longitudinal and lateral matrices, SI and rad."""
    lines = []
    for title, part in (("Longitudinal", linear.longitudinal()), ("Lateral", linear.lateral())):
        lines.append(f"{title} (SI, rad): rates by states | inputs")
        head = [*part.states, "|", *part.inputs]
        rows = [
            [*map(_shown, a), "|", *map(_shown, b)]
            for a, b in zip(part.A.tolist(), part.B.tolist(), strict=True)
        ]
        wide = [max(map(len, column)) for column in zip(head, *rows, strict=True)]
        label = max(map(len, part.states))
        for name, row in zip(("", *part.states), (head, *rows), strict=True):
            cells = (f"{cell:>{width}}" for cell, width in zip(row, wide, strict=True))
            lines.append(f"  {name:<{label}}  {'  '.join(cells)}")
        lines.append("")
    shown = {*linear.longitudinal().states, *linear.lateral().states}
    others = [name for name in linear.states if name not in shown]
    if others:
        lines.append(f"States beside these, held still here; --json has them: {', '.join(others)}")
    if linear.unsteady:
        rates = ", ".join(f"{n} {v:.4g}/s" for n, v in linear.unsteady.items())
        lines.append(f"Not a steady flight: {rates}")
    return "\n".join(lines).rstrip("\n")


def _shown(value: float) -> str:
    return f"{value:.5g}" if abs(value) > 1e-9 else "0"
