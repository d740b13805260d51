"""Flight conditions that can be trimmed: level, climb, steady turn, pull-up, glide."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, atan, cos, degrees
from typing import Literal

import numpy as np

from alula.aircraft import Envelope
from alula.base.messages import BadInput, Message, refuse, warn

Kind = Literal["level", "climb", "turn", "pull_up", "glide"]
KINDS: tuple[Kind, ...] = ("level", "climb", "turn", "pull_up", "glide")
GRAVITY = 9.80665  # m/s2, standard: load factors and first guesses


@dataclass(frozen=True)
class Condition:
    """A flight condition: V m/s (airspeed), h m, angles rad, turn rate rad/s, load factor 1.

    gamma: climb angle against the air, of 'climb', 'turn' and 'pull_up'; found by 'glide'. psi:
    heading. One of bank, load_factor, turn_rate describes a 'turn' (right where positive; a load
    factor turns right); load_factor a 'pull_up'. power: of a 'glide', throttle (0 to 1) or given
    thrust (N). place: north, east (m) or, on WGS-84, latitude, longitude (rad).
    """

    V: float
    h: float
    kind: Kind = "level"
    gamma: float = 0.0
    psi: float = 0.0
    bank: float | None = None
    load_factor: float | None = None
    turn_rate: float | None = None
    power: float = 0.0
    place: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        numbers = (self.V, self.h, self.gamma, self.psi, self.bank, self.load_factor,
                   self.turn_rate, self.power, *self.place)  # fmt: skip
        if not all(x is None or np.isfinite(x) for x in numbers) or not self.V > 0.0:
            raise _refused("a positive airspeed and finite numbers", self.words)
        given = [n for n in ("bank", "load_factor", "turn_rate") if getattr(self, n) is not None]
        wanted = {"turn": 1, "pull_up": 1}.get(self.kind, 0)
        if len(given) != wanted or (self.kind == "pull_up" and given != ["load_factor"]):
            expected = {
                "turn": "one of bank, load factor and turn rate",
                "pull_up": "a load factor",
            }.get(self.kind, "neither bank nor load factor nor turn rate")
            raise _refused(f"{expected} for '{self.kind}'", ", ".join(given) or "none")
        if self.gamma != 0.0 and self.kind in ("level", "glide"):
            raise _refused(f"no climb angle for '{self.kind}'", f"{degrees(self.gamma):g} deg")
        if abs(self.gamma) >= np.pi / 2.0 or abs(self.bank or 0.0) >= np.pi / 2.0:
            raise _refused("climb and bank angles under 90 deg", self.words)
        if self.kind == "turn" and self.load_factor is not None and not self.load_factor > 1.0:
            raise _refused("a load factor over 1 for a turn", f"{self.load_factor:g}")

    @property
    def words(self) -> str:
        """The condition as a message names it."""
        text = f"{self.kind.replace('_', '-')} at V = {self.V:g} m/s, h = {self.h:g} m"
        if self.gamma:
            text += f", gamma = {degrees(self.gamma):.4g} deg"
        if self.bank is not None:
            text += f", bank {degrees(self.bank):.4g} deg"
        if self.load_factor is not None:
            text += f", n = {self.load_factor:g}"
        if self.turn_rate is not None:
            text += f", {degrees(self.turn_rate):.4g} deg/s"
        return text

    @property
    def bank_guess(self) -> float:
        """Bank of a coordinated turn, rad."""
        if self.kind != "turn":
            return 0.0
        if self.bank is not None:
            return self.bank
        if self.load_factor is not None:
            return acos(min(1.0, cos(self.gamma) / self.load_factor))
        return atan(self.V * cos(self.gamma) * (self.turn_rate or 0.0) / GRAVITY)

    @property
    def load_factor_guess(self) -> float:
        """Normal load factor, about what it comes to."""
        if self.load_factor is not None:
            return self.load_factor
        return cos(self.gamma) / cos(self.bank_guess)


def check_envelope(condition: Condition, envelope: Envelope, refused: bool) -> tuple[Message, ...]:
    """What of a condition lies outside of the aircraft's envelope.

    refused: raise BadInput for it; otherwise it is returned as warnings.
    """
    values = {"V": condition.V, "h": condition.h, "n": condition.load_factor_guess}
    units = {"V": " m/s", "h": " m", "n": ""}
    messages = []
    for name, value in values.items():
        limits = getattr(envelope, name)
        # a turn given by its bank comes to its load factor only about
        if limits is None or limits[0] - 1e-6 <= value <= limits[1] + 1e-6:
            continue
        messages.append(
            warn(
                "outside_envelope",
                where=f"trim, {condition.words}",
                expected=f"{name} from {limits[0]:g} to {limits[1]:g}{units[name]}, the aircraft "
                "file's envelope",
                found=f"{name} = {value:.5g}{units[name]}",
                do="Choose a condition inside, or ask for it with --anyway (in_spite=True).",
            )
        )
    if messages and refused:
        raise BadInput(*(Message(m.code, "error", m.where, m.expected, m.found, m.do)
                         for m in messages))  # fmt: skip
    return tuple(messages)


def _refused(expected: str, found: str) -> BadInput:
    return refuse(
        "bad_condition",
        where="flight condition",
        expected=expected,
        found=found,
        do="Describe the flight so that it is determined, and no more than that.",
    )
