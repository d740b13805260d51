"""Sources of one flow angle beside one another on common times, their vote, and how far they agree.

A source is a recorded channel or something computed (ASSE, joint filter, lift model). Each gives a
standard deviation; above LIMIT a value is not reported: it reads not observable, with the age of
the last one that was. What is reported votes (`monitor`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from alula.airdata.monitor import MonitorSettings, Named, Source, Voted, monitor
from alula.base.arrays import Array, frozen

Kind = Literal["alpha", "beta"]
LIMIT = float(np.radians(2.5))  # standard deviation above which an angle is not observable
WHITE = float(np.radians(0.1))  # least noise of a reading: resolution and what lies between rates
READMIT = 5.0  # s of good behavior after which a source votes again
STUCK = 25  # equal readings in a row of a recorded channel
_SILENT = ("dead",)  # no fault of what is computed: it was not observable


@dataclass(frozen=True)
class AngleSource:
    """values, sigma (n,) rad at the common times, NaN where there is none.

    reported (n,): known well enough. age (n,): s since the last reported value, NaN: never.
    observed (n,): reported, or last so within three of its own intervals: a slow source is seen
    between its readings, too. how: where it comes from, in words. recorded: a channel, whose
    silence is a fault. votes: False for what is only shown beside.
    """

    values: Array
    sigma: Array
    reported: NDArray[np.bool_]
    age: Array
    observed: NDArray[np.bool_]
    how: str
    recorded: bool = False
    votes: bool = True

    @property
    def white(self) -> float:
        """Noise of one reading, rad, by third differences; their median forgives a bad stretch."""
        x = self.values[self.reported]
        if len(x) < 8:
            return WHITE
        steps = np.abs(x[3:] - 3.0 * x[2:-1] + 3.0 * x[1:-2] - x[:-3])
        steps = steps[steps > 0.0]  # of a stuck one
        if not len(steps):
            return WHITE
        return max(WHITE, float(np.median(steps)) / float(0.6745 * np.sqrt(20.0)))

    @property
    def slow(self) -> float:
        """Standard deviation of errors that last, rad: what is stated, root mean square."""
        stated = self.sigma[self.reported]
        return float(np.sqrt(np.mean(stated**2))) if len(stated) else LIMIT


@dataclass(frozen=True)
class Agreement:
    """How one source agrees with another, `against`, where both report; rad, NaN without any.

    n: samples compared. rms, bias: of the difference. normalized: rms of the difference over the
    root of both variances, 1 where the standard deviations are as stated.
    """

    against: str
    n: int
    rms: float
    bias: float
    normalized: float


@dataclass(frozen=True)
class Compared:
    """All of one angle. sources, agreement: by name. absent: why a source is not there.

    voted: None where nothing votes. named: sources taken out, when and why.
    """

    kind: Kind
    t: Array
    sources: Mapping[str, AngleSource]
    absent: Mapping[str, str]
    voted: Voted | None
    named: tuple[Named, ...]
    agreement: Mapping[str, Agreement]

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it; angles in deg."""
        deg = float(np.degrees(1.0))
        rows = []
        for name, s in self.sources.items():
            a = self.agreement[name]
            rows.append({
                "name": name, "how": s.how, "votes": s.votes,
                "samples": int(np.isfinite(s.values).sum()),
                "observed": float(np.mean(s.observed)),
                "sigma_deg": deg * _mean(s.sigma[s.reported]),
                "age_at_end_s": float(s.age[-1]),
                "against": a.against, "compared": a.n, "rms_deg": deg * a.rms,
                "bias_deg": deg * a.bias, "normalized_rms": a.normalized,
            })  # fmt: skip
        v = self.voted
        return {
            "start": float(self.t[0]), "end": float(self.t[-1]), "samples": len(self.t),
            "sources": rows,
            "absent": [{"name": n, "reason": why} for n, why in self.absent.items()],
            "voted": None if v is None else {
                "observed": float(np.mean(np.isfinite(v.angle))),
                "sigma_deg": deg * _mean(v.sigma[np.isfinite(v.sigma)]),
                "split": float(np.mean(v.split)),
            },
            "failures": [{"source": n.source, "t": n.t, "reason": n.reason} for n in self.named],
        }  # fmt: skip

    def summary(self) -> str:
        """As a table; angles in deg."""
        found = self.as_dict()
        lines = [
            f"{self.kind:<18}{'samples':>8}{'observed':>10}{'sigma':>8}  {'against':<12}{'rms':>7}"
            f"{'bias':>7}{'rms/sigma':>11}"
        ]
        for r in found["sources"]:
            lines.append(
                f"{r['name']:<18}{r['samples']:>8}{_share(r['observed']):>10}{_word(r['sigma_deg']):>8}"
                f"  {r['against']:<12}{_word(r['rms_deg']):>7}{_word(r['bias_deg']):>7}"
                f"{_word(r['normalized_rms']):>11}" + ("" if r["votes"] else "  no vote")
            )
        vote = found["voted"]
        if vote is not None:
            lines.append(
                f"{'voted':<26}{_share(vote['observed']):>10}{_word(vote['sigma_deg']):>8}"
            )
        lines += [f"{r['name']:<18}not there: {r['reason']}" for r in found["absent"]]
        lines += [f"  {r['source']} {r['reason']} at {r['t']:.6g} s" for r in found["failures"]]
        return "\n".join(lines)


def angle_source(
    t: Array,
    values: Array,
    sigma: Array | float,
    how: str,
    *,
    recorded: bool = False,
    votes: bool = True,
    observable: NDArray[np.bool_] | None = None,
    limit: float = LIMIT,
) -> AngleSource:
    """A source at times t (n,): values and sigma (n,) rad; observable: where its method says so."""
    values = np.asarray(values, dtype=np.float64)
    sigma = np.where(np.isfinite(values), np.broadcast_to(sigma, values.shape), np.nan)
    with np.errstate(invalid="ignore"):
        reported = np.isfinite(values) & (sigma <= limit)
    if observable is not None:
        reported &= observable
    last = np.maximum.accumulate(np.where(reported, np.arange(len(t)), -1))
    age = np.where(last >= 0, t - t[last], np.nan)
    with np.errstate(invalid="ignore"):
        observed = age <= 3.0 * _interval(t, values) + 1e-9
    return AngleSource(
        frozen(values), frozen(sigma), reported, frozen(age), observed, how, recorded, votes
    )  # fmt: skip


def compare_angles(
    kind: Kind, t: Array, sources: Mapping[str, AngleSource], absent: Mapping[str, str]
) -> Compared:
    """Vote over the sources at times t (n,), and compare each with the recorded channel.

    The recorded one, and all where there is none, are compared with the vote; with the recorded
    one only while it has a vote.
    """
    voting = {n: s for n, s in sources.items() if s.votes and s.reported.any()}
    voted: Voted | None = None
    named: tuple[Named, ...] = ()
    if voting:
        interval = max((_interval(t, s.values) for s in voting.values() if s.recorded), default=0.0)
        voted = monitor(
            t,
            {n: np.where(s.reported, s.values, np.nan) for n, s in voting.items()},
            {n: Source(s.white, s.slow, STUCK if s.recorded else 0) for n, s in voting.items()},
            MonitorSettings(dead_after=max(0.5, 3.0 * interval), readmit=READMIT),
        )
        named = tuple(
            n for n in voted.named if sources[n.source].recorded or n.reason not in _SILENT
        )
    recorded = next((n for n, s in voting.items() if s.recorded), None)
    agreement = {}
    for name, source in sources.items():
        if recorded is not None and voted is not None and name != recorded:
            other, healthy = sources[recorded], voted.health[:, voted.names.index(recorded)] == 0
            there, value, sigma = other.reported & healthy, other.values, other.sigma
            against = recorded
        elif voted is not None:
            # a vote of its own only would agree with itself
            alone = (voted.used < 2) & (source.reported & source.votes)
            there, value, sigma = np.isfinite(voted.angle) & ~alone, voted.angle, voted.sigma
            against = "voted"
        else:
            continue
        agreement[name] = _agreement(against, source, there, value, sigma)
    for name in sources:
        agreement.setdefault(name, Agreement("", 0, np.nan, np.nan, np.nan))
    return Compared(kind, frozen(t), dict(sources), dict(absent), voted, named, agreement)


def on_grid(t: Array, own: Array, values: Array) -> Array:
    """values (m,) at times own (m,) brought to t (n,): straight between samples, at the times next
    to a sample only, NaN at all others. So a slow sensor stays slow, a silent one silent.
    """
    good = np.isfinite(values) & np.isfinite(own)
    own, values = own[good], values[good]
    if len(own) < 2 or len(t) < 2:
        return np.full(len(t), np.nan)
    next_ = np.clip(np.searchsorted(t, own), 1, len(t) - 1)
    nearest = next_ - (own - t[next_ - 1] < t[next_] - own)
    near = np.abs(t[nearest] - own) <= 0.51 * float(np.median(np.diff(t)))
    fresh = np.zeros(len(t), dtype=np.bool_)
    fresh[nearest[near]] = True
    return np.where(fresh, np.interp(t, own, values), np.nan)


def stuck_held(raw: Array, values: Array) -> Array:
    """values (n,), made from readings raw (n,), as constant as these where they stick: the monitor
    then sees what a lever arm or a correction would hide. NaN are no readings.
    """
    at = np.flatnonzero(np.isfinite(raw))
    if not len(at):
        return values
    first = np.concatenate([[True], np.diff(raw[at]) != 0.0])
    run = np.cumsum(first) - 1
    long = np.bincount(run)[run] > STUCK
    out = np.array(values)
    out[at[long]] = values[at[np.flatnonzero(first)[run[long]]]]
    return out


def _agreement(
    against: str, source: AngleSource, there: NDArray[np.bool_], value: Array, sigma: Array
) -> Agreement:
    both = source.reported & there
    if not both.any():
        return Agreement(against, 0, np.nan, np.nan, np.nan)
    off = source.values[both] - value[both]
    spread = np.sqrt(source.sigma[both] ** 2 + sigma[both] ** 2)
    return Agreement(
        against, int(both.sum()), float(np.sqrt(np.mean(off**2))), float(np.mean(off)),
        float(np.sqrt(np.mean((off / spread) ** 2))),
    )  # fmt: skip


def _interval(t: Array, values: Array) -> float:
    """Median time between readings, s."""
    at = t[np.isfinite(values)]
    return float(np.median(np.diff(at))) if len(at) > 1 else 0.0


def _mean(x: Array) -> float:
    return float(np.mean(x)) if len(x) else float("nan")


def _word(x: float) -> str:
    return f"{x:.2f}" if np.isfinite(x) else "-"


def _share(x: float) -> str:
    return "never" if x == 0.0 else f"{100.0 * x:.0f} %" if x >= 0.01 else f"{100.0 * x:.2g} %"
