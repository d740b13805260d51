"""Random problems that the data cannot solve, beside others that they can, by output error.

Random are the derivatives (within 30 % of the SportStar's), airspeed, inputs and noise. What is
asked: a verdict every time, and no value that is wrong by more than four of its own standard errors
and reads 'ok'. Of some thousand values one may lie that far off by chance: how many are expected
to, and what becomes of such a problem with other noise, is printed beside it.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from math import erfc, sqrt

import numpy as np

from alula.base.messages import BadInput
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_error import identify_output_error
from alula.simulate.inputs import Signal, Steps, Sum
from verification.estimation.noisy_flights import LATERAL, LONGITUDINAL, flown, measured, sportstar

KINDS = (
    "collinear controls", "no excitation", "unobservable", "wrong sign", "saturated sensor",
)  # fmt: skip
PITCH = {"CD": "1 + alpha", "CL": "1 + alpha + qhat + de", "Cm": "1 + alpha + qhat + de"}
ROLL = {
    "CY": "beta + phat + rhat + dr",
    "Cl": "beta + phat + rhat + da + dr",
    "Cn": "beta + phat + rhat + da + dr",
}
WRONG = 4.0  # standard errors
AGAIN = 100  # other noises, with which a problem that came out wrong is repeated
DEG = np.pi / 180.0


@dataclass(frozen=True)
class Problem:
    """One maneuver, its formulas, the truth by name; a term that the aircraft lacks is zero."""

    kind: str
    aspect: str
    maneuver: MeasuredManeuver
    formulas: dict[str, str]
    truth: dict[str, float]


@dataclass(frozen=True)
class Judged:
    """What became of one problem. off: of parameters that read 'ok', by how many of their own
    standard errors they are off, by name.
    """

    kind: str
    verdicts: tuple[str, ...]
    off: dict[str, float]
    status: str

    @property
    def wrong(self) -> tuple[str, ...]:
        """Parameters that read 'ok' and are not."""
        return tuple(name for name, off in self.off.items() if not abs(off) <= WRONG)


def problem(seed: int, kind: str | None, noise: int = 0) -> Problem:
    """The problem of a seed; kind None: a well-posed one. noise: another number, other noise."""
    random = np.random.default_rng([seed, 0 if kind is None else 1 + KINDS.index(kind)])
    base = sportstar().model.params
    names = [n for n in base if not n.endswith("_0") and "(" not in n]
    aircraft = sportstar({n: base[n] * random.uniform(0.7, 1.3) for n in names})
    lateral = kind == "collinear controls" or bool(random.random() < 0.5)
    aspect = "lateral" if lateral else "longitudinal"
    signals = _signals(random, kind, lateral)
    flight = flown(
        aircraft, "m", signals, V=random.uniform(32.0, 48.0), seconds=16.0, rate=25.0,
        aspect=aspect, substeps=4,
    )  # fmt: skip
    outputs = LATERAL if lateral else LONGITUDINAL
    maneuver = measured(aircraft, flight, outputs, int(random.integers(2**31)) + noise)
    formulas = dict(ROLL if lateral else PITCH)
    if kind == "unobservable":
        formulas["Cn" if lateral else "Cm"] += random.choice([" + df", " + df^2"])
        n = len(maneuver.t)
        maneuver = replace(maneuver, controls={**maneuver.controls, "df": np.full(n, 0.2)})
        if lateral:
            formulas["Cn"] = "1 + " + formulas["Cn"]
    if kind == "wrong sign":
        name = str(random.choice(["da", "dr"])) if lateral else "de"
        turned = {**maneuver.controls, name: -maneuver.controls[name]}
        maneuver = replace(maneuver, controls=turned)
    if kind == "saturated sensor":
        name = str(random.choice(["p", "r", "beta"] if lateral else ["q", "alpha"]))
        reading = maneuver.outputs[name]
        level, part = float(np.median(reading)), random.uniform(0.4, 0.8)
        low, high = (level + part * (end - level) for end in (reading.min(), reading.max()))
        clipped = {**maneuver.outputs, name: np.clip(reading, low, high)}
        maneuver = replace(maneuver, outputs=clipped)
    return Problem(str(kind), aspect, maneuver, formulas, dict(aircraft.model.params))


def _signals(random: np.random.Generator, kind: str | None, lateral: bool) -> dict[str, Signal]:
    size = 0.0 if kind == "no excitation" and not lateral else random.uniform(0.8, 1.2)
    if not lateral:
        widths, levels = (1.2, 0.8, 0.4, 0.4), (1.0, -1.0, 1.0, -1.0)
        return {
            "de": Sum((
                Steps(-2.0 * DEG * size, 1.0, widths, levels, 0.1),
                Steps(2.0 * DEG * size, 6.0, (0.4, 0.4), (1.0, -1.0), 0.1),
            ))
        }  # fmt: skip
    rudder = Sum((
        Steps(6.0 * DEG * size, 1.0, (0.8, 0.8), (1.0, -1.0), 0.1),
        Steps(5.0 * DEG * size, 9.0, (0.5, 0.5), (-1.0, 1.0), 0.1),
    ))  # fmt: skip
    aileron = Sum((
        Steps(5.0 * DEG * size, 4.5, (0.6, 1.2, 0.6), (1.0, -1.0, 1.0), 0.1),
        Steps(5.0 * DEG * size, 12.0, (0.5, 0.5), (-1.0, 1.0), 0.1),
    ))  # fmt: skip
    if kind == "collinear controls":
        factor = random.uniform(0.3, 1.0)
        return {"da": aileron, "dr": Scaled(aileron, factor)}
    if kind == "no excitation":
        return {"da": aileron} if random.random() < 0.5 else {"dr": rudder}
    return {"da": aileron, "dr": rudder}


@dataclass(frozen=True)
class Scaled:
    """A signal times a factor."""

    signal: Signal
    factor: float

    def value(self, t: np.ndarray) -> np.ndarray:
        """Values (n,) at times t (n,), s."""
        return self.factor * self.signal.value(t)


def judged(p: Problem) -> Judged:
    """The estimator's verdicts beside the truth."""
    lateral = p.aspect == "lateral"
    try:
        found = identify_output_error(
            [p.maneuver],
            p.formulas,
            states="lateral" if lateral else "longitudinal",
            outputs=LATERAL if lateral else LONGITUDINAL,
            truth=p.truth,
        )
    except BadInput as bad:
        return Judged(p.kind, (), {}, f"refused: {bad}")
    off = {
        q.name: (q.value - p.truth.get(q.name, 0.0)) / q.se
        for q in found.parameters
        if "(0)" not in q.name and q.verdict == "ok"
    }
    verdicts = tuple(q.verdict for q in found.parameters)
    return Judged(p.kind, verdicts, off, found.status)


def again(seed: int, kind: str | None, name: str, off: float) -> str:
    """The same problem with other noise: an error of the method comes back, chance does not."""
    every = [judged(problem(seed, kind, 1 + i)).off.get(name) for i in range(AGAIN)]
    z = np.array([x for x in every if x is not None])
    words = f"{name} of seed {seed} ({kind or 'well-posed'}), {off:+.2f} standard errors off"
    if len(z) < 2:
        return f"{words}; with {AGAIN} other noises it does not read ok"
    return (
        f"{words}; with {AGAIN} other noises mean {z.mean():+.2f}, deviation {z.std(ddof=1):.2f}, "
        f"{int(np.sum(np.abs(z) > WRONG))} beyond {WRONG:g}"
    )


def ill_posed(quick: bool) -> tuple[str, bool]:
    """What was found, and whether it holds."""
    runs = 20 if quick else 200
    bad = [judged(problem(seed, KINDS[seed % len(KINDS)])) for seed in range(runs)]
    good = [judged(problem(seed, None)) for seed in range(runs)]
    said = all(j.verdicts for j in bad)
    wrong = Counter(j.kind for j in bad if j.wrong)
    lost = sum(1 for j in bad if "not_identifiable" in j.verdicts)
    verdicts = [v for j in good for v in j.verdicts]
    ok = sum(v == "ok" for v in verdicts) / len(verdicts)
    refused = sum(1 for j in good if not j.verdicts or j.status.startswith("failed"))
    wrong_good = [j.wrong for j in good if j.wrong]
    checked = sum(len(j.off) for j in (*bad, *good))
    repeated = [
        again(seed, None if which is good else j.kind, name, j.off[name])
        for which in (bad, good)
        for seed, j in enumerate(which)
        for name in j.wrong
    ]
    got = (
        f"{runs} ill-posed: {sum(1 for j in bad if j.verdicts)} with a verdict, {lost} with "
        f"something not identifiable, with a wrong value that reads ok: {dict(wrong) or 'none'}; "
        f"{runs} well-posed: {ok:.1%} of {len(verdicts)} parameters ok, {refused} refused or "
        f"failed, {len(wrong_good)} with a wrong value; of {checked} "
        f"values that read ok {checked * erfc(WRONG / sqrt(2.0)):.2f} are expected that far off by "
        "chance" + "".join(f"; {words}" for words in repeated)
    )
    return got, said and not wrong and ok >= 0.95 and not refused and not wrong_good
