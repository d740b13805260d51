"""`alula trim AIRCRAFT`: attitude, controls and power that hold a flight condition."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

from alula.cli.condition import Asked, at_condition, load, trim_result
from alula.cli.contract import Command, JsonOption, QuietOption, SeedOption, ThreadsOption

if TYPE_CHECKING:
    from alula.simulate import Trim


@at_condition
def trim(
    asked: Asked,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Trim an aircraft: level, climb, turn, pull-up or glide.

    Exit 0: trimmed. 2: bad input, or no such flight: the force or moment that cannot be balanced
    and the control at its stop are named.
    """
    command = Command("trim", json, seed, threads, quiet)
    with command.run():
        loaded = load(asked)
        found = loaded.trimmed()
        command.inputs = loaded.files
        command.messages = [*loaded.aircraft.messages, *found.messages]
        command.result = trim_result(found)
        command.say(text_of(found))


_FURTHER = {  # of the core's states beyond the rigid body: unit, what it is
    "omega": ("rad/s", "speed of a propeller"),
    "power": ("", "power that a turbofan has reached, 0 to 1"),
    "charge": ("A s", "taken from the battery"),
    "X": ("", "attached share of the flow, 1: all"),
    "X_left": ("", "attached share of the flow on the left wing, 1: all"),
    "X_right": ("", "attached share of the flow on the right wing, 1: all"),
    "fuel_used": ("kg", "fuel burned"),
    "dt": ("", "throttle behind its actuator"),
}


def text_of(found: Trim) -> str:
    """What the commands print of a trimmed flight: degrees, SI."""
    angles = {
        "alpha": found.alpha, "beta": found.beta, "phi": found.phi, "theta": found.theta,
        "gamma": found.gamma,
    }  # fmt: skip
    lines = [f"Trimmed: {found.condition.words}"]
    lines += [f"  {name:<12}{degrees(value) + 0.0:>12.4f} deg" for name, value in angles.items()]
    if abs(found.turn_rate) > 1e-9:
        lines.append(f"  {'turn rate':<12}{degrees(found.turn_rate):>12.4f} deg/s")
    lines.append(f"  {'load factor':<12}{found.load_factor:>12.4f}")
    for name in ("de", "da", "dr", "df"):
        lines.append(f"  {name:<12}{degrees(found.controls[name]) + 0.0:>12.4f} deg")
    if "dt" in found.free or "dt_command" in found.free or found.controls["dt"]:
        lines.append(f"  {'throttle':<12}{found.controls['dt']:>12.4f}")
    if "thrust" in found.free or found.thrust:
        lines.append(f"  {'thrust':<12}{found.thrust:>12.4g} N")
    lines += [_further(name, value) for name, value in found.further.items()]
    return "\n".join(lines)


def _further(name: str, value: float) -> str:
    """A further state with its unit and meaning; 'omega_2' is the second engine's."""
    plain = name if name in _FURTHER else name.rstrip("0123456789").rstrip("_")
    if plain in ("de", "da", "dr", "df"):
        return f"  {name:<12}{degrees(value) + 0.0:>12.4f} deg  behind its actuator"
    unit, words = _FURTHER.get(plain, ("", ""))
    return f"  {name:<12}{value:>12.5g} {unit:<6}{words}".rstrip()
