"""DHC-2 in turbulence (Jategaonkar 2006): equation error, filter error and output error against the
exact truth.

Columns 12 to 19 of the record are a simulated lateral motion with process noise in roll and yaw
rate and none in the measurements. Equation error on them as they are must give the truth; filter
error must give it back when white measurement noise is added, with intervals that hold and the
process noise's intensity; output error, which knows of no turbulence, stands beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from alula.base.arrays import Array
from alula.identify.linear.filter_error import identify_filter_error
from alula.identify.linear.model import LinearModel, linear_model, process_covariance, sample
from alula.identify.linear.output_error import identify_linear_output_error
from alula.identify.linear.record import LinearRecord, linear_record
from alula.identify.regression.least_squares import least_squares
from verification.places import DATA

OUTPUTS = ("pdot", "rdot", "ay", "p", "r")
INPUTS = ("da", "dr", "v")
TRUTH = {
    "Lp": -5.820, "Lr": 1.782, "Lda": -16.434, "Ldr": 0.4435, "Lv": -0.0969, "L0": 0.0683,
    "Np": -0.6649, "Nr": -0.7119, "Nda": -0.4287, "Ndr": -2.8243, "Nv": 0.0084, "N0": -0.0912,
    "Yp": -0.2784, "Yr": 1.4099, "Yda": -0.4471, "Ydr": 2.6571, "Yv": -0.1799, "Y0": 0.0365,
}  # fmt: skip
DIGITS = 1e-4  # one unit of the last digit printed; Lp, Lr, Lda have one digit less
# Standard deviations a draw adds: rate gyros of 0.1 deg/s, angular accelerations of 1.1 and 0.6
# deg/s2, lateral acceleration of 2 mg.
NOISE = {"pdot": 0.02, "rdot": 0.01, "ay": 0.02, "p": 0.002, "r": 0.002}


def model() -> LinearModel:
    """The lateral equations with sideslip velocity measured, as the data were made."""
    row = {
        name: " + ".join(f"{a}{x}*{x}" for x in ("p", "r", *INPUTS)) + f" + {a}0"
        for name, a in (("p", "L"), ("r", "N"), ("ay", "Y"))
    }
    outputs = {"pdot": "", "rdot": "", "ay": row.pop("ay"), "p": "", "r": ""}
    return linear_model(row, outputs, INPUTS)


def channels(path: Path) -> dict[str, Array]:
    """The motion with process noise: columns 12 to 19, and time from zero."""
    table = np.loadtxt(path)
    names = (*OUTPUTS, *INPUTS)
    found = {name: table[:, 11 + i] for i, name in enumerate(names)}
    found["t"] = table[:, 0] - table[0, 0]
    return found


def equation_error(found: dict[str, Array]) -> dict[str, float]:
    """The three equations by least squares with constants, on the record as it is."""
    x = np.column_stack([found[n] for n in ("p", "r", *INPUTS)] + [np.ones(len(found["t"]))])
    names = ("p", "r", *INPUTS, "0")
    return {
        f"{letter}{n}": float(value)
        for letter, output in (("L", "pdot"), ("N", "rdot"), ("Y", "ay"))
        for n, value in zip(names, least_squares(x, found[output]).value, strict=True)
    }


def intensity(found: dict[str, Array]) -> dict[str, float]:
    """Process noise the record itself has: the true model's errors from step to step."""
    known = model()
    m = known.at(np.array([TRUTH[p] for p in known.parameters]))
    dt = float(np.mean(np.diff(found["t"])))
    step = sample(m, dt)
    x = np.column_stack([found["p"], found["r"]])
    w = np.column_stack([*(found[n] for n in INPUTS), np.ones(len(x))])
    e = x[1:] - x[:-1] @ step.phi.T - w[:-1] @ step.now.T - w[1:] @ step.next.T
    unit = np.array([np.diag(process_covariance(m.A, np.diag(row), dt)) for row in np.eye(2)])
    squares = np.linalg.solve(unit.T, np.mean(e**2, axis=0))
    return {"F_p": float(squares[0] ** 0.5), "F_r": float(squares[1] ** 0.5)}


def draw(found: dict[str, Array], seed: int) -> LinearRecord:
    """The record with one draw of white measurement noise."""
    rng = np.random.default_rng(seed)
    noisy = dict(found)
    for name, size in NOISE.items():
        noisy[name] = found[name] + size * rng.standard_normal(len(found["t"]))
    return linear_record("turbulence", found["t"], noisy, model())


@dataclass(frozen=True)
class Drawn:
    """Over all draws: share of intervals that hold the truth, pooled over the derivatives and
    constants; mean error of each, and over the mean of its own standard error; mean of the noises
    found; failed searches. All draws share one turbulence.
    """

    coverage: float
    bias: dict[str, float]
    relative: dict[str, float]
    noises: dict[str, float]
    failed: int


def monte_carlo(found: dict[str, Array], seeds: Sequence[int], method: str) -> Drawn:
    """Filter error ('fe') or output error ('oe') on every draw."""
    values, errors, inside, noises, failed = [], [], [], [], 0
    for seed in seeds:
        record = draw(found, seed)
        identify = identify_filter_error if method == "fe" else identify_linear_output_error
        result = identify(model(), [record], truth=TRUTH)  # type: ignore[operator]
        if not result.series:
            failed += 1
            continue
        mine = [result[name] for name in TRUTH]
        values.append([p.value for p in mine])
        errors.append([p.se for p in mine])
        inside.append([p.ci95[0] <= TRUTH[p.name] <= p.ci95[1] for p in mine])
        noises.append({p.name: p.value for p in result.parameters if p.name.startswith("F_")})
    bias = np.mean(values, axis=0) - np.array(list(TRUTH.values()))
    own = np.mean(errors, axis=0)
    return Drawn(
        float(np.mean(inside)),
        dict(zip(TRUTH, bias.tolist(), strict=True)),
        dict(zip(TRUTH, (bias / own).tolist(), strict=True)),
        {n: float(np.mean([d[n] for d in noises])) for n in (noises[0] if noises else {})},
        failed,
    )


def f(quick: bool) -> tuple[str, bool]:
    """The row 'DHC-2, columns 12 to 19'. quick: 10 draws instead of 100."""
    path = DATA / "dhc2" / "y13aus_da1.asc"
    if not path.exists():
        return f"flight data not found: {path.name}", False
    found = channels(path)
    exact = equation_error(found)
    off = max(
        abs(exact[n] - v) / (10.0 * DIGITS if n in ("Lp", "Lr", "Lda") else DIGITS)
        for n, v in TRUTH.items()
    )
    true = intensity(found)
    seeds = range(10 if quick else 100)
    filtered, plain = (monte_carlo(found, seeds, way) for way in ("fe", "oe"))
    ratio = {n: filtered.noises[n] / true[n] for n in true}
    worst = sorted(TRUTH, key=lambda n: -abs(plain.bias[n] / TRUTH[n]))[:3]
    got = (
        f"equation error off by {off:.2f} of the last digit at most; filter error, "
        f"{len(seeds)} draws (noise pdot 0.02, rdot 0.01 rad/s2, ay 0.02 m/s2, p and r 0.002 "
        f"rad/s): coverage {filtered.coverage:.1%}, largest bias "
        f"{max(map(abs, filtered.relative.values())):.2f} se, process noise "
        + ", ".join(f"{n} {filtered.noises[n]:.3f} ({r:.2f} of true)" for n, r in ratio.items())
        + f" per sqrt(s), {filtered.failed} failed; output error on the same draws: coverage "
        f"{plain.coverage:.1%}, {plain.failed} failed, largest biases "
        + ", ".join(
            f"{n} {plain.bias[n] / abs(TRUTH[n]):+.0%} ({plain.relative[n]:+.1f} se)" for n in worst
        )
    )
    holds = (
        off <= 1.0
        and 0.91 <= filtered.coverage <= 0.98
        and all(abs(r - 1.0) <= 0.2 for r in ratio.values())
        and filtered.failed == 0
    )
    return got, holds
