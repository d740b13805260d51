"""The stage: maneuvers of flights in, reconstructed motion out, by any of the methods."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.special import gammaincinv

from alula.aircraft import Aircraft
from alula.base.arrays import Array
from alula.base.messages import Message, note, warn
from alula.base.project import ReconstructSpec
from alula.core import core
from alula.flight import Flight, Maneuver, Motion
from alula.reconstruct.compare import compare_duplicates
from alula.reconstruct.kalman import RUNS, solve_filter
from alula.reconstruct.maximum_likelihood import solve_ml
from alula.reconstruct.problem import Problem, make_problem
from alula.reconstruct.recorded import recorded_motion
from alula.reconstruct.result import Constant, Reconstruction, Segment, SensorFit
from alula.reconstruct.skew import time_skews
from alula.reconstruct.solution import Solution
from alula.reconstruct.transfer import Transfer

Method = Callable[[Problem, ReconstructSpec], Solution]


def _filter(name: str) -> Method:
    return lambda problem, _: solve_filter(problem, name)


# One method: one file, one entry here; its name in words stands in alula.base.filters. The Kalman
# filters are registered where they run.
METHODS: Mapping[str, Method] = {
    **{name: _filter(name) for name in RUNS},
    "ml": lambda problem, spec: solve_ml(problem, spec.initial_state == "estimate"),
}
OBSERVED = 0.5  # share of the prior's standard deviation that the data must take away
LATE = 0.5  # of a sample interval: a delay that is worth a word


def reconstruct(
    flights: Mapping[str, Flight],
    maneuvers: Sequence[Maneuver],
    aircraft: Aircraft,
    spec: ReconstructSpec,
    progress: Callable[[str], None] = lambda _: None,
    loaded: Mapping[str, Aircraft] | None = None,
) -> Reconstruction:
    """Reconstruct all maneuvers. flights: by log id. progress: is told what is being done.
    loaded: by log id, where the aircraft was otherwise loaded than `aircraft` says.

    Raises BadInput for problems that cannot be solved; what the data leave open is marked in the
    constants (`observable`) and said in the messages.
    """
    if spec.filter == "none":
        return _as_recorded(flights, maneuvers, aircraft, spec, loaded or {})
    groups: dict[str, list[Maneuver]] = {}
    for m in maneuvers:
        groups.setdefault({"all": "", "log": m.log, "maneuver": m.id}[spec.share], []).append(m)
    segments: list[Segment] = []
    constants: list[Constant] = []
    covariances: list[Array] = []
    messages: list[Message] = []
    status, converged, nis, readings = "", True, 0.0, 0
    for group, members in groups.items():
        ids = [m.id for m in members]
        more = f" and {len(ids) - 3} more" if len(ids) > 3 else ""
        progress(f"reconstructing {', '.join(ids[:3])}{more}")
        problem = make_problem(dict(flights), members, aircraft, spec)
        solution = METHODS[spec.filter](problem, spec)
        suffix = f"[{group}]" if len(groups) > 1 else ""
        found, said = _constants(problem, solution, suffix)
        constants += found
        covariances.append(solution.covariance)
        messages += [*problem.messages, *solution.messages, *said]
        messages += _skews(problem, solution, f", {group}" if len(groups) > 1 else "")
        nis, readings = nis + solution.nis, readings + solution.readings
        status, converged = solution.status, converged and solution.converged
        for k, maneuver in enumerate(members):
            flight, own = flights[maneuver.log], (loaded or {}).get(maneuver.log, aircraft)
            segments.append(_segment(problem, solution, k, flight, own, spec, messages))
            messages += compare_duplicates(flights[maneuver.log], maneuver)
    order = {m.id: i for i, m in enumerate(maneuvers)}
    count = max(readings, 1)
    low, high = (2.0 * float(gammaincinv(count / 2.0, x)) / count for x in (0.025, 0.975))
    return Reconstruction(
        method=spec.filter,
        segments=tuple(sorted(segments, key=lambda s: order[s.maneuver.id])),
        constants=tuple(constants),
        constants_cov=_block_diagonal(covariances),
        nis_mean=nis / count,
        nis_interval=(low, high),
        status=status,
        converged=converged,
        messages=tuple(dict.fromkeys(messages)),
    )


def _as_recorded(
    flights: Mapping[str, Flight],
    maneuvers: Sequence[Maneuver],
    aircraft: Aircraft,
    spec: ReconstructSpec,
    loaded: Mapping[str, Aircraft],
) -> Reconstruction:
    segments, messages = [], []
    for maneuver in maneuvers:
        own = loaded.get(maneuver.log, aircraft)
        motion, said = recorded_motion(
            flights[maneuver.log], maneuver, own, spec.smoothing_window_s
        )
        messages += said
        nothing = np.zeros((len(motion.t), 0))
        segments.append(Segment(maneuver, motion, (), nothing, nothing, (), {}))
    return Reconstruction(
        "none", tuple(segments), (), np.zeros((0, 0)), float("nan"), (float("nan"), float("nan")),
        "motion as recorded; nothing was reconstructed", True, tuple(dict.fromkeys(messages)),
    )  # fmt: skip


def _constants(
    problem: Problem, solution: Solution, suffix: str
) -> tuple[list[Constant], list[Message]]:
    out, messages = [], []
    for i, unknown in enumerate(problem.unknowns):
        observable = bool(solution.informed[i] > OBSERVED)
        out.append(
            Constant(
                unknown.name + suffix,
                float(solution.constants[i]),
                float(np.sqrt(solution.covariance[i, i])),
                unknown.unit,
                observable,
            )
        )
        if not observable:
            messages.append(
                warn(
                    "not_observable",
                    where=f"unknown {unknown.name}{suffix}",
                    expected="motion and sensors that tell its value",
                    found=f"its standard deviation fell only from {unknown.prior:.3g} to "
                    f"{np.sqrt(solution.covariance[i, i]):.3g} {unknown.unit}",
                    do='Add a sensor or a maneuver that shows it, or set state = "off".',
                )
            )
    return out, messages


def _skews(problem: Problem, solution: Solution, where: str) -> list[Message]:
    """A warning for each delay that matters, a note for every other one. where: ', maneuver'."""
    out = []
    dt = float(np.median(np.diff(problem.records[0].t)))
    for skew in time_skews(problem, solution):
        if skew.significant and abs(skew.delay_s) > LATE * dt:
            out.append(
                warn(
                    "time_skew",
                    where=f"channel {skew.channel}{where}",
                    expected="stamps in step with the inertial sensor's",
                    found=f"{abs(skew.delay_s):.3f} s {'late' if skew.delay_s > 0 else 'early'}, "
                    f"standard error {skew.se:.3f} s",
                    do=f"If the recorder explains it, add delay_s = {skew.delay_s:.3f} to the "
                    "channel.",
                )
            )
        else:
            out.append(
                note(
                    "time_skew",
                    where=f"channel {skew.channel}{where}",
                    expected="stamps in step with the inertial sensor's",
                    found=f"{abs(skew.delay_s):.4f} s {'late' if skew.delay_s > 0 else 'early'}, "
                    f"standard error {skew.se:.4f} s",
                    do="Nothing: within three standard errors of none, or under half a sample.",
                )
            )
    return out


def _segment(
    problem: Problem,
    solution: Solution,
    k: int,
    flight: Flight,
    aircraft: Aircraft,
    spec: ReconstructSpec,
    messages: list[Message],
) -> Segment:
    record, found = problem.records[k], solution.records[k]
    transfer = Transfer(
        problem, record, flight, aircraft, spec.smoothing_window_s, spec.vibration_filter_hz
    )
    motion = transfer.motion(found.states)
    messages.append(_differentiated(transfer, motion))
    if transfer.rho is None:
        messages.append(
            note(
                "standard_atmosphere",
                where=f"maneuver {record.maneuver.id}",
                expected="a channel 'rho'",
                found="none; the standard atmosphere's density at h is taken",
                do="Map rho where temperature and pressure were recorded.",
            )
        )
    return Segment(
        maneuver=record.maneuver,
        motion=motion,
        state_names=problem.names,
        states=found.states[record.base],
        states_se=found.states_se[record.base],
        sensors=tuple(_sensor(problem, solution, k, i) for i in range(len(problem.sensors))),
        mismatch=_mismatch(problem, solution, k),
        perturbed=tuple(transfer.motion(found.states + shift) for shift in found.doubt),
    )


def _differentiated(transfer: Transfer, motion: Motion) -> Message:
    """Window and error of the angular accelerations, in words."""
    errors = ", ".join(
        f"{name} {transfer.cubic.derivative_se(getattr(motion, rate)):.2g}"
        for name, rate in (("pdot", "p"), ("qdot", "q"), ("rdot", "r"))
    )
    return note(
        "differentiated",
        where=f"maneuver {motion.maneuver.id}",
        expected="angular accelerations",
        found=f"rates; local cubics over {transfer.cubic.window_s:.3g} s differentiate them with "
        f"standard errors {errors} rad/s2",
        do="Nothing: all that stands beside them in a moment equation passes the same filter.",
    )


def _sensor(problem: Problem, solution: Solution, k: int, i: int) -> SensorFit:
    record, found = problem.records[k], solution.records[k]
    sensor, readings = problem.sensors[i], record.readings[:, i]
    use = np.isfinite(readings)
    innovation, deviation = found.innovation[use, i], found.deviation[use, i]
    residual = _wrapped(sensor.kind, readings[use] - found.fitted[use, i])
    test = innovation / deviation if np.isfinite(innovation).any() else residual
    return SensorFit(
        name=sensor.channel,
        unit=sensor.unit,
        t=record.t[use],
        measured=readings[use],
        fitted=readings[use] - residual,  # an attitude a turn away is the same attitude
        innovation=innovation,
        innovation_se=deviation,
        sigma=float(solution.sigma[i]),
        whiteness=_lag_one(test),
    )


def _wrapped(kind: str, angle: Array) -> Array:
    if kind not in ("phi", "psi"):
        return angle
    return np.asarray(angle - 2.0 * np.pi * np.round(angle / (2.0 * np.pi)))


def _lag_one(x: Array) -> float:
    x = x[np.isfinite(x)] - np.mean(x[np.isfinite(x)]) if np.isfinite(x).any() else x
    power = float(x @ x) if len(x) > 2 else 0.0
    return float(x[1:] @ x[:-1]) / power if power > 0.0 else float("nan")


def _mismatch(problem: Problem, solution: Solution, k: int) -> dict[str, float]:
    """Rms of measurement minus open-loop kinematics, by sensor, SI."""
    record, found = problem.records[k], solution.records[k]
    loop = core.path_open_loop(
        problem.model(), record.t, record.inputs, np.ascontiguousarray(found.start),
        problem.held[k], jacobian=False,
    )  # fmt: skip
    out = {}
    for i, sensor in enumerate(problem.sensors):
        difference = _wrapped(sensor.kind, record.readings[:, i] - loop["readings"][:, i])
        good = difference[np.isfinite(difference)]
        if len(good):
            out[sensor.channel] = float(np.sqrt(np.mean(good**2)))
    return out


def _block_diagonal(blocks: Sequence[Array]) -> Array:
    size = sum(len(b) for b in blocks)
    out, at = np.zeros((size, size)), 0
    for b in blocks:
        out[at : at + len(b), at : at + len(b)] = b
        at += len(b)
    return out
