"""One requirement on the modes of an aircraft and what became of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt
from typing import Literal

from alula.simulate.modes import Mode

Verdict = Literal["level 1", "level 2", "level 3", "below level 3", "met", "not met", "not judged"]


@dataclass(frozen=True)
class Judgment:
    """What is asked, what the mode has, the verdict; `why` where there is none.

    value: in `unit`; None where the model does not have it. limits: what each level, or the
    paragraph, asks.
    """

    edition: str
    paragraph: str
    requirement: str
    mode: str
    value: float | None
    unit: str
    limits: str
    verdict: Verdict
    why: str = ""

    def unjudged(self, why: str) -> Judgment:
        """The same without a verdict."""
        return replace(self, verdict="not judged", why=why)


def of_family(modes: Sequence[Mode], family: str) -> list[Mode]:
    """The modes of a family, fastest first."""
    return [m for m in modes if m.family == family]


@dataclass(frozen=True)
class SecondOrder:
    """Frequency (rad/s) and damping ratio of a mode, over one where it is two stable roots."""

    name: str
    frequency: float
    damping: float


def second_order(modes: Sequence[Mode], family: str) -> SecondOrder | None:
    """An oscillation, or two aperiodic roots of one sign as s^2 + 2 zeta omega s + omega^2.

    None where the family has neither: then it has no frequency.
    """
    found = of_family(modes, family)
    if len(found) == 1 and found[0].frequency is not None and found[0].damping is not None:
        return SecondOrder(found[0].name, found[0].frequency, found[0].damping)
    if len(found) == 2:
        a, b = (m.eigenvalue.real for m in found)
        if a * b > 0.0:
            omega = sqrt(a * b)
            return SecondOrder(family, omega, -(a + b) / (2.0 * omega))
    return None


def missing(modes: Sequence[Mode], family: str) -> str:
    """Why a family cannot be judged."""
    found = of_family(modes, family)
    if not found:
        names = ", ".join(m.words for m in modes)
        return f"there is no such mode among {names}"
    return "it is aperiodic: " + ", ".join(f"{m.eigenvalue.real:.4g} 1/s" for m in found)
