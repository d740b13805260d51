"""A report's input made of plausible arrays: damped oscillations, biases, colored residuals.

Nothing here is estimated; the numbers only look like those of a flight.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from alula.base.arrays import Array, frozen
from alula.base.messages import note, warn
from alula.flight import Maneuver, Motion, SourceFile
from alula.identify.result import Fit, Identification, Parameter, Series, Tie
from alula.logs.card import ChannelCard, LogCard, ManeuverCard
from alula.reconstruct.result import Constant, Reconstruction, Segment, SensorFit
from alula.report import ReportInput

MANEUVERS = (
    Maneuver("elevator", "Elv1", "3211", 0.0, 25.0, "longitudinal", {"flaps": "0"}),
    Maneuver("aileron", "Ail1", "bank to bank", 30.0, 55.0, "lateral", {"flaps": "0"}),
    Maneuver("rudder", "Rud1", "doublet", 60.0, 85.0, "lateral", {"flaps": "0"}, held_out=True),
)
STATES = ("u", "v", "w", "phi", "theta", "psi", "h")
SENSORS = (
    ("V", "m/s", 0.3), ("alpha", "rad", 2e-3), ("beta", "rad", 2e-3), ("phi", "rad", 3e-3),
    ("theta", "rad", 2e-3), ("psi", "rad", 4e-3), ("h", "m", 1.0), ("v_north", "m/s", 0.1),
    ("v_east", "m/s", 0.1), ("v_down", "m/s", 0.1),
)  # fmt: skip


def oscillation(t: Array, start: float, period: float, damping: float, size: float) -> Array:
    """A damped oscillation that starts 2 s after `start`."""
    x = np.clip(t - start - 2.0, 0.0, None)
    return np.asarray(size * np.exp(-damping * x) * np.sin(2 * np.pi * x / period))


def motion(maneuver: Maneuver, rate: float) -> Motion:
    t = maneuver.start + np.arange(round((maneuver.end - maneuver.start) * rate) + 1) / rate
    n, s = len(t), maneuver.start
    lateral = 1.0 if maneuver.aspect == "lateral" else 0.05
    q = oscillation(t, s, 4.0, 0.5, 0.08 * (1.05 - lateral))
    p = oscillation(t, s, 5.0, 0.2, 0.2 * lateral)
    r = oscillation(t, s, 5.0, 0.2, 0.05 * lateral)
    theta = 0.06 + np.cumsum(q) / rate
    phi = np.cumsum(p) / rate
    de = -0.02 + 0.03 * (1.05 - lateral) * np.sign(np.sin(t - s)) * (t - s < 8)
    da = 0.05 * lateral * np.sign(np.sin(0.8 * (t - s))) * (t - s < 10)
    columns: dict[str, Array] = {
        "V": 102.0 - 60.0 * (theta - 0.06), "alpha": 0.06 + 0.7 * q, "beta": 0.3 * r, "p": p,
        "q": q, "r": r, "pdot": np.gradient(p) * rate, "qdot": np.gradient(q) * rate,
        "rdot": np.gradient(r) * rate, "ax": 0.6 + 9.8 * (theta - 0.06), "ay": -8.0 * r,
        "az": -9.81 - 90.0 * q, "phi": phi, "theta": theta, "psi": 1.2 + np.cumsum(r) / rate,
        "h": 4800.0 + 100.0 * np.cumsum(theta - 0.06) / rate, "rho": np.full(n, 0.75),
    }  # fmt: skip
    return Motion(
        maneuver,
        frozen(t),
        **{k: frozen(v) for k, v in columns.items()},
        controls={"de": frozen(de), "da": frozen(da), "dr": frozen(0.2 * da)},
        thrust=frozen(np.full(n, 21000.0)),
    )


def segment(maneuver: Maneuver, rate: float, seed: int) -> Segment:
    random = np.random.default_rng(seed)
    m = motion(maneuver, rate)
    n = len(m.t)
    u, v, w = m.V * np.cos(m.alpha), m.V * np.sin(m.beta), m.V * np.sin(m.alpha)
    states = np.column_stack([u, v, w, m.phi, m.theta, m.psi, m.h])
    settle = 1.0 + 3.0 * np.exp(-(m.t - m.t[0]))
    se = settle[:, None] * np.array([0.05, 0.05, 0.06, 1e-3, 1e-3, 2e-3, 0.2])
    sensors = []
    for name, unit, sigma in SENSORS:
        truth = np.asarray(getattr(m, name, oscillation(m.t, maneuver.start, 9.0, 0.1, 4.0)))
        measured = truth + sigma * random.standard_normal(n)
        band = 1.1 * sigma * settle
        innovation = 0.9 * band * random.standard_normal(n)
        if name == "v_north":  # a hole in the log
            measured[n // 3 : n // 3 + n // 20] = np.nan
            innovation[n // 3 : n // 3 + n // 20] = np.nan
        whiteness = float(np.corrcoef(np.nan_to_num(innovation)[1:],
                                      np.nan_to_num(innovation)[:-1])[0, 1])  # fmt: skip
        sensors.append(SensorFit(name, unit, m.t, frozen(measured), frozen(truth),
                                 frozen(innovation), frozen(band), sigma, whiteness))  # fmt: skip
    mismatch = {"V": 0.21, "alpha": 0.0021, "theta": 0.0019}
    return Segment(maneuver, m, STATES, frozen(states), frozen(se), tuple(sensors), mismatch)


def reconstruction(rate: float) -> Reconstruction:
    constants = (
        Constant("b_ax", 0.0312, 0.0011, "m/s2", True),
        Constant("b_ay", -0.0087, 0.0009, "m/s2", True),
        Constant("b_az", 0.104, 0.0042, "m/s2", True),
        Constant("b_p", 1.21e-4, 3.4e-5, "rad/s", True),
        Constant("b_q", -6.1e-5, 2.2e-5, "rad/s", True),
        Constant("b_r", 3.0e-6, 2.9e-5, "rad/s", True),
        Constant("k_alpha", 0.031, 0.0042, "1", True),
        Constant("b_alpha", -0.0043, 0.00031, "rad", True),
        Constant("k_beta", 0.0, 0.2, "1", False),
    )
    return Reconstruction(
        "ukf",
        tuple(segment(m, rate, k) for k, m in enumerate(MANEUVERS)),
        constants,
        frozen(np.diag([c.se**2 for c in constants])),
        1.04,
        (0.97, 1.06),
        "The smoother's states agree with the kinematics integrated open loop.",
        True,
        (warn("not_observable", where="k_beta", expected="sideslip that changes",
              found="0.3 deg rms", do="Fly a rudder doublet, or fix k_beta in the project."),),
    )  # fmt: skip


MODELS = {
    "CZ": ("1 + alpha + qhat + de", (-0.32, -5.1, -9.4, -0.42)),
    "Cm": ("1 + alpha + alphadot + qhat + de", (0.08, -0.95, np.nan, np.nan, -1.32)),
    "CY": ("1 + beta + rhat + dr", (0.001, -0.82, 0.31, 0.011)),
    "Cl": ("1 + beta + phat + rhat + da + dr", (0.0, -0.092, -0.48, 0.14, -0.11, 0.012)),
}


def identification(rec: Reconstruction, truth: bool) -> Identification:
    random = np.random.default_rng(7)
    parameters: list[Parameter] = []
    series: list[Series] = []
    fits: dict[str, Fit] = {}
    blocks: list[Array] = []
    for name, (formula, values) in MODELS.items():
        wanted = "longitudinal" if name in ("CZ", "Cm") else "lateral"
        lateral = wanted == "lateral"
        names = [f"{name}_{'0' if term == '1' else term}" for term in formula.split(" + ")]
        root = random.standard_normal((len(names), len(names) + 2))
        scale = np.array([0.02 * abs(v) + 1e-3 if np.isfinite(v) else np.nan for v in values])
        c = root @ root.T
        c /= np.sqrt(np.outer(np.diag(c), np.diag(c)))
        blocks.append(c * np.outer(scale, scale))
        for label, value, se in zip(names, values, scale, strict=True):
            lost = not np.isfinite(value)
            weak = not lost and abs(value) < 2 * se
            ties = (Tie(f"{name}_qhat", 1.0), Tie(f"{name}_alphadot", 2.1)) if lost else ()
            parameters.append(
                Parameter(label, name, float(value), float(se / 3), float(se),
                          (float(value - 1.96 * se), float(value + 1.96 * se)),
                          "not_identifiable" if lost else "weak" if weak else "ok", ties,
                          "1" if label.endswith("_0") else "1/rad", 1e4 if lost else 2.3,
                          float(value + 0.8 * se) if truth and not lost else None)
            )  # fmt: skip
        held = 0
        for s in rec.segments:
            if s.maneuver.aspect != wanted:
                continue
            m = s.motion
            model = 0.2 * m.p + 0.9 * m.r if lateral else -5.1 * m.alpha - 0.4 * m.controls["de"]
            colored = np.convolve(random.standard_normal(len(m.t)), np.ones(9) / 9, "same")
            measured = model + 0.05 * np.std(model) * colored
            held += len(m.t) * s.maneuver.held_out
            series.append(Series(name, s.maneuver.id, m.t, frozen(measured), frozen(model),
                                 s.maneuver.held_out))  # fmt: skip
        fits[name] = Fit(name, formula, 0.9931, 0.031, 626, held, 0.981 if held else np.nan, 0.31)
    n = sum(len(b) for b in blocks)
    covariance, at = np.zeros((n, n)), 0
    for b in blocks:
        covariance[at : at + len(b), at : at + len(b)] = b
        at += len(b)
    return Identification("equation error", tuple(parameters), fits, tuple(series),
                          frozen(covariance), "Cm_q and Cm_alphadot cannot be told apart; fly a "
                          "maneuver in which pitch rate and angle of attack differ.")  # fmt: skip


def card(m: Maneuver, rate: float, digit: int) -> LogCard:
    """The card of a log that holds one maneuver."""

    def channel(name: str, unit: str, low: float, high: float) -> ChannelCard:
        return ChannelCard(
            name, unit, f"column '{name.upper()}', converted to {unit}", round(25 * rate) + 1,
            3 if name == "h" else 0, rate, m.start, m.end,
            ((m.start + 8.0, m.start + 9.2),) if name == "v_north" else (),
            low, (low + high) / 2, high, np.nan if name == "V" else (high - low) / 200,
        )  # fmt: skip

    channels = (
        channel("ax", "m/s2", -0.4, 1.9), channel("az", "m/s2", -14.1, -3.2),
        channel("q", "rad/s", -0.08, 0.09), channel("alpha", "rad", 0.01, 0.11),
        channel("V", "m/s", 96.2, 104.1), channel("h", "m", 4788.0, 4826.0),
        channel("v_north", "m/s", -4.0, 4.0), channel("de", "rad", -0.05, 0.02),
    )  # fmt: skip
    entry = {"V": 102.1, "alpha": 0.0611, "h": 4800.0}
    file = SourceFile(f"{m.log}.mat", f"{digit:x}" * 64, 381_204, 358_000, 23_204, 0)
    maneuver = ManeuverCard(m.id, m.log, m.kind, m.aspect, m.held_out, m.configuration, m.start,
                            m.end, round(25 * rate) + 1, (), entry)  # fmt: skip
    return LogCard(m.log, (file,), channels, (maneuver,), ())


def example(rate: float = 25.0, *, truth: bool = False, **changes: Any) -> ReportInput:
    """Three maneuvers of 25 s at `rate` Hz; `changes` replace fields of the input."""
    rec = reconstruction(rate)
    fields: dict[str, Any] = {
        "name": "Example jet, three maneuvers",
        "path": "projects/example/project.toml",
        "date": "2024-05-17",
        "aircraft": {"Aircraft": "Example jet", "Wing area": "64.0 m²", "Span": "21.5 m",
                     "Mean chord": "3.16 m", "Mass": "17 400 kg (assumed)", "Ixx": "215 000 kg m²"},
        "cards": tuple(card(m, rate, k) for k, m in enumerate(MANEUVERS, 10)),
        "maneuvers": MANEUVERS,
        "reconstruction": rec,
        "identification": identification(rec, truth),
        "messages": (
            warn("gap", where="log Ail1, channel v_north, 38.3 s", expected="a sample each 0.04 s",
                 found="1.2 s without a sample", do="Nothing: the filter bridges it."),
            note("converted", where="log Elv1, channel alpha", expected="rad", found="deg",
                 do="Multiplied by pi/180."),
        ),
        "provenance": {"alula": "0.1.0", "commit": "31d0f1c", "isa": "x86-64-v3", "seed": 1,
                       "project sha256": "3f" * 32,
                       "versions": {"numpy": "2.1.0", "scipy": "1.14.0"}},
    }  # fmt: skip
    return ReportInput(**(fields | changes))
