"""The zero-order scheme and the exact affine form on Lerro's maneuvers, without noise.

Zero order: 2, 3 and 4 equations at neighboring steps of 0.1 ms, solved every 1 ms from the last
valid angles. Exact form: 20 airspeeds 0.1 s apart, rates and accelerations every 0.1 ms; it is
taken where its own covariance, for airspeeds to 0.01 mm/s, reads under 0.2 deg.
"""

from __future__ import annotations

import numpy as np

from alula.airdata.asse import AsseSettings, estimate_window
from alula.airdata.asse_zero_order import zero_order, zero_order_error
from alula.base.arrays import Array
from verification.airdata.asse_flights import DEG, Flown, flown

EXACT = AsseSettings(
    sigma_V=1e-5, sigma_tilt=1e-7, sigma_a=1e-7, sigma_w=1e-9, density_a=0.0, density_w=0.0,
    limit=0.2 * DEG, block=0.0,
)  # fmt: skip


def zero_order_figures(flight: Flown, equations: int) -> dict[str, tuple[float, float]]:
    """By angle: share of the maneuver over the threshold, largest error there, deg."""
    offsets = tuple(range(1, equations))
    found = zero_order(
        flight.record(),
        float(flight.alpha[0]),
        float(flight.beta[0]),
        offsets=offsets,
        every=10,
        equation_error=1e-9,
    )
    solved = flight.between(flight.t) & (np.arange(len(flight.t)) % 10 == 0)
    out = {}
    for name, x, truth, observable in (
        ("alpha", found.alpha, flight.alpha, found.observable_alpha),
        ("beta", found.beta, flight.beta, found.observable_beta),
    ):
        taken = solved & observable
        error = float(np.max(np.abs(x - truth)[taken])) / DEG if taken.any() else np.inf
        out[name] = (float(taken.sum() / solved.sum()), error)
    return out


def error_measures(flight: Flown) -> tuple[float, float]:
    """Largest of Eq. (25), two and four equations, where the denominator is over 5 %."""
    ca, cb = np.cos(flight.alpha), np.cos(flight.beta)
    sa, sb = np.sin(flight.alpha), np.sin(flight.beta)
    v = flight.V[:, None] * np.stack([ca * cb, sb, sa * cb], axis=1)
    record = flight.record()
    a = record.f + record.gravity
    out = []
    for back in (1, 3):
        ratio, denominator = zero_order_error(flight.t, v, flight.w, a, back)
        size = np.where(flight.between(flight.t), np.abs(denominator), 0.0)
        out.append(float(np.max(np.abs(ratio[size > 0.05 * np.nanmax(size)]))))
    return out[0], out[1]


def exact_figures(flight: Flown) -> dict[str, tuple[float, float]]:
    """By angle: share of the maneuver reported, largest error there, deg."""
    found = estimate_window(flight.record(1, 1000), EXACT, every=100)
    solved = flight.between(flight.t) & (np.arange(len(flight.t)) % 100 == 0)
    out = {}
    for name, x, truth, taken in (
        ("alpha", found.alpha, flight.alpha, found.observable_alpha & solved),
        ("beta", found.beta, flight.beta, found.observable_beta & solved),
    ):
        error: Array = np.abs(x - truth)[taken] / DEG
        out[name] = (float(taken.sum() / solved.sum()), float(error.max(initial=0.0)))
    return out


def asse_noise_free(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds."""
    words, holds = [], True
    for kind in ("stall", "sweep"):
        flight = flown(kind)
        for equations in (2, 4) if quick else (2, 3, 4):
            by_angle = zero_order_figures(flight, equations)
            said = []
            for name, (share, error) in by_angle.items():
                said.append(f"{name} {error:.2f} deg on {share:.0%}")
                holds &= error < 0.6
                holds &= share >= 0.5 or name != flight.excited
            words.append(f"{kind}, {equations} equations: {', '.join(said)}")
        two, four = error_measures(flight)
        holds &= two <= 0.5 * four
        words.append(f"Eq. (25) {two:.2%} and {four:.2%} (his at most 2 % and 6 %)")
        exact = exact_figures(flight)
        said = []
        for name, (share, error) in exact.items():
            said.append(f"{name} {error:.4f} deg on {share:.0%}")
            holds &= error < 0.05
            holds &= share >= 0.5 or name != flight.excited
        words.append(f"exact form {', '.join(said)}")
    return "; ".join(words), bool(holds)
