"""What validation by flying returns: flights beside flights, evidence, a verdict in words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from alula.base.arrays import Array
from alula.base.messages import Message
from alula.flight import Maneuver
from alula.validate.quality import Quality

Seen = Literal["no", "yes", "unknown"]
Verdict = Literal["pass", "fail", "not_judged"]


@dataclass(frozen=True)
class ChannelMatch:
    """One channel, measured and flown by the model, (n,) each in SI at the flight's times.

    model_se: standard deviation by the parameters' covariance, None where that is not known.
    in_axis: whether the maneuver's aspect excites it. as_recorded: its coefficient is not in the
    model and was taken from the recording, so that a match proves nothing. recorded: False where
    the log has no such channel, and nothing to compare with.
    """

    name: str
    unit: str
    measured: Array
    model: Array
    model_se: Array | None
    quality: Quality
    in_axis: bool = True
    as_recorded: bool = False
    recorded: bool = True

    @property
    def counts(self) -> bool:
        """Whether the match says something about the model."""
        return self.in_axis and self.recorded and not self.as_recorded


@dataclass(frozen=True)
class Flown:
    """One maneuver's recorded controls through the model, from the measured initial state.

    t: (n,) s, the log's time, evenly spaced; it ends at the horizon or where the model departs.
    seen: whether the model was estimated from these samples. controls: as recorded, rad.
    asked: s, length of the maneuver or the horizon asked for. diverged_at: s, the log's time at
    which the model left every flight it could describe; None if it did not. offsets: constants
    added to coefficients, by coefficient; empty unless asked for. as_recorded: coefficients that
    the model lacks and that were taken from the recording. draws: parameter sets behind model_se.
    outside: variables beyond the model's range: (farthest value, lowest, highest), SI.
    """

    maneuver: Maneuver
    seen: Seen
    t: Array
    channels: Mapping[str, ChannelMatch]
    controls: Mapping[str, Array]
    asked: float
    diverged_at: float | None = None
    offsets: Mapping[str, float] = field(default_factory=dict)
    as_recorded: tuple[str, ...] = ()
    draws: int = 0
    outside: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)

    @property
    def horizon(self) -> float:
        """Length of the flight that is compared, s."""
        return float(self.t[-1] - self.t[0])


@dataclass(frozen=True)
class Criterion:
    """One quantity against its tolerance.

    measured, model, deviation, tolerance: in `unit`, as the regulation states it (deg, deg/s, g,
    s). For a time history measured and model are the values where the deviation is the largest
    part of its tolerance, and within_share the share of samples within. deviation_se: its
    standard error, 0 for a time history. met: None where it could not be told.
    """

    quantity: str
    unit: str
    measured: float
    model: float
    deviation: float
    tolerance: float
    met: bool | None
    deviation_se: float = 0.0
    within_share: float | None = None


@dataclass(frozen=True)
class Evidence:
    """One requirement on one maneuver. criteria are alternatives: one that is met suffices.

    entry: of the regulation's table, '2.c.10'. tolerance: in words. window: s, the log's time.
    reason: why it fails or is not judged; empty where nothing is to be said.
    """

    entry: str
    title: str
    maneuver: str
    tolerance: str
    criteria: tuple[Criterion, ...]
    verdict: Verdict
    seen: Seen
    window: tuple[float, float] | None = None
    reason: str = ""


@dataclass(frozen=True)
class Validation:
    """The result of one validation. source: where the model came from, in words."""

    model: str
    source: str
    regulation: str
    flown: tuple[Flown, ...]
    evidence: tuple[Evidence, ...]
    seed: int
    messages: tuple[Message, ...] = ()

    @property
    def failed(self) -> bool:
        """Whether a tolerance is exceeded."""
        return any(e.verdict == "fail" for e in self.evidence)

    def count(self, verdict: Verdict) -> int:
        """How many requirements have this verdict."""
        return sum(e.verdict == verdict for e in self.evidence)

    @property
    def status(self) -> str:
        """The outcome in words, with what the estimate had seen."""
        text = (
            f"{self.count('pass')} of {len(self.evidence)} requirements met, "
            f"{self.count('fail')} not met, {self.count('not_judged')} not judged"
        )
        seen = [f.maneuver.id for f in self.flown if f.seen == "yes"]
        unknown = [f.maneuver.id for f in self.flown if f.seen == "unknown"]
        if seen:
            text += f"; SEEN BY THE ESTIMATE, no validation: {', '.join(seen)}"
        if unknown:
            text += f"; not known whether the estimate saw: {', '.join(unknown)}"
        return text
