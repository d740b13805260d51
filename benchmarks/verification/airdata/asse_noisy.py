"""Angles without vanes on Lerro's maneuvers with an IMU of Xsens MTi-G class: filter and window.

The filter is what is judged. NEES (normalized estimation error squared): of the excited angle where
it is reported, and of both angles over the whole maneuver; the errors of one run hang together, so
that 100 runs count as 100 draws and the bounds are the 99 % ones of their mean.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from alula.airdata.asse import AsseResult, estimate_filter, estimate_window
from alula.airdata.asse_zero_order import zero_order
from alula.base.arrays import Array
from verification.airdata.asse_flights import DEG, Flown, Sensed, flown, sensed

LIMIT = {"alpha": 1.5, "beta": 2.5}  # deg, of the excited angle


@dataclass
class Tally:
    """Sums over seeds; squares in rad."""

    samples: int = 0
    reported: dict[str, int] = field(default_factory=lambda: {"alpha": 0, "beta": 0})
    squares: dict[str, float] = field(default_factory=lambda: {"alpha": 0.0, "beta": 0.0})
    inside: dict[str, int] = field(default_factory=lambda: {"alpha": 0, "beta": 0})
    quiet_good: int = 0  # samples at which the other angle is inside or reads not observable
    nees_one: list[float] = field(default_factory=list)
    nees_both: list[float] = field(default_factory=list)

    def rms(self, name: str) -> float:
        """deg, over the reported samples."""
        return float(np.sqrt(self.squares[name] / max(self.reported[name], 1))) / DEG

    def add(self, flight: Flown, made: Sensed, found: AsseResult, every: int = 1) -> None:
        """One seed, estimated at every `every`th sample."""
        during = flight.between(made.t) & (np.arange(len(made.t)) % every == 0)
        self.samples += int(during.sum())
        errors = np.stack([found.alpha - made.alpha, found.beta - made.beta], axis=1)
        both: tuple[tuple[str, Array, Array, NDArray[np.bool_]], ...] = (
            ("alpha", errors[:, 0], found.sigma_alpha, found.observable_alpha),
            ("beta", errors[:, 1], found.sigma_beta, found.observable_beta),
        )
        for name, e, sigma, observable in both:
            taken = during & observable
            inside = np.abs(e) <= 1.96 * sigma
            self.reported[name] += int(taken.sum())
            self.squares[name] += float(np.sum(e[taken] ** 2))
            self.inside[name] += int((taken & inside).sum())
            if name == flight.excited:
                if taken.any():
                    self.nees_one.append(float(np.mean((e[taken] / sigma[taken]) ** 2)))
            else:
                self.quiet_good += int((during & (inside | ~observable)).sum())
        solved = during & np.isfinite(found.alpha)
        P, e = found.covariance[solved][:, 1:, 1:], errors[solved]
        self.nees_both.append(float(np.mean(np.einsum("ni,nij,nj->n", e, np.linalg.inv(P), e))))


def bounds(runs: int, freedom: int) -> tuple[float, float]:
    """99 % bounds of the mean of `runs` values of chi2 with so many degrees of freedom."""
    low, high = chi2.ppf([0.005, 0.995], runs * freedom) / runs
    return float(low), float(high)


def printed(flight: Flown, made: Sensed) -> Array:
    """Errors (n,) of the excited angle by the printed scheme with the same sensors, rad.

    Four equations 0.1 s apart; the airspeed, held between samples, by differences over 0.1 s.
    """
    r = made.record
    held = r.V.copy()
    held[1::2] = held[0::2][: len(held[1::2])]
    slope = np.full(len(held), np.nan)
    slope[5:-5] = (held[10:] - held[:-10]) / 0.1
    found = zero_order(
        type(r)(t=r.t, f=r.f, w=r.w, gravity=r.gravity, V=held),
        made.settings.first_alpha, made.settings.first_beta,
        offsets=(10, 20, 30), V_dot=slope, threshold=1e-9,
    )  # fmt: skip
    x, truth = {"alpha": (found.alpha, made.alpha), "beta": (found.beta, made.beta)}[flight.excited]
    error = np.remainder(x - truth + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(error[flight.between(made.t) & np.isfinite(error)])


def asse_noisy(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds."""
    runs, words, holds = 20 if quick else 100, [], True
    for kind in ("stall", "sweep"):
        flight = flown(kind)
        name = flight.excited
        other = "beta" if name == "alpha" else "alpha"
        by_filter, by_window = Tally(), Tally()
        squares: list[float] = []
        for seed in range(runs):
            made = sensed(flight, seed)
            by_filter.add(flight, made, estimate_filter(made.record, made.settings))
            window = estimate_window(made.record, made.settings, every=10)
            by_window.add(flight, made, window, 10)
            squares.append(float(np.mean(printed(flight, made) ** 2)))
        share = by_filter.reported[name] / by_filter.samples
        one, both = float(np.mean(by_filter.nees_one)), float(np.mean(by_filter.nees_both))
        low_1, high_1 = bounds(runs, 1)
        low_2, high_2 = bounds(runs, 2)
        quiet = by_filter.quiet_good / by_filter.samples
        holds &= by_filter.rms(name) < LIMIT[name] and share >= 0.6
        holds &= low_1 < one < high_1 and low_2 < both < high_2 and quiet >= 0.95
        words.append(
            f"{kind}, {runs} seeds: {name} rms {by_filter.rms(name):.2f} deg on {share:.0%}, NEES "
            f"{one:.2f} in {low_1:.2f} to {high_1:.2f}, of both angles {both:.2f} in {low_2:.2f} "
            f"to {high_2:.2f}; {other} inside its interval or not observable on {quiet:.1%}; "
            f"window of 20 samples: rms {by_window.rms(name):.2f} deg on "
            f"{by_window.reported[name] / by_window.samples:.0%}, NEES "
            f"{float(np.mean(by_window.nees_one)):.2f}; printed scheme: rms "
            f"{float(np.sqrt(np.mean(squares))) / DEG:.0f} deg"
        )
    return "; ".join(words), bool(holds)
