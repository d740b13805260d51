"""Each source of angle of attack and sideslip on one log, at the center of gravity."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from alula.airdata.angles import AngleSource, Kind, angle_source, on_grid, stuck_held
from alula.airdata.asse import AsseRecord, AsseResult, AsseSettings, estimate_filter
from alula.airdata.asse import gravity_in_body as gravity_of
from alula.airdata.asse_lift import lift_angle, lift_angle_sigma, lift_coefficient
from alula.airdata.asse_zero_order import zero_order
from alula.airdata.inflight_result import InFlightCalibration
from alula.airdata.vanes import beta_of_flank
from alula.base.arrays import Array
from alula.base.local_cubic import LocalCubic
from alula.base.messages import Message, refuse, warn
from alula.campaign.angle_board import INERTIAL, Board, carried, velocity
from alula.campaign.navigate import navigate_flight
from alula.model import AeroModel
from alula.reconstruct.transfer import controls_on, engines_on, fuel_on, standard_density

DEG = float(np.radians(1.0))
UNCALIBRATED = 1.5 * DEG  # error that lasts of a vane whose upwash and bias nobody knows
LEFT = 0.1 * DEG  # of a calibrated one, at least
OMITTED = 0.1 * DEG  # what the formula of a lift leaves out, at least
CALM = 0.2  # m/s of turbulence for ASSE where the project states none
LAG, LEAST = 0.1, 20  # s between the printed scheme's equations; airspeeds that it needs
SETTLED, FIRST = 1.2, 1.0  # the joint filter: times its usual standard deviation; s
SATELLITES = (("v_north", "v_east"), ("north", "east"), ("lat", "lon"))
OTHER_AIRCRAFT = 0.01  # relative difference of S, b or c that makes a model another aircraft's
Found = dict[Kind, AngleSource]


@dataclass(frozen=True)
class Asse:
    """ASSE over one log: record and settings, and what the filter gave, at the inertial sensor."""

    record: AsseRecord
    settings: AsseSettings
    result: AsseResult


def recorded(
    board: Board, kind: Kind, channel: str, calibration: InFlightCalibration | None
) -> AngleSource:
    """One of the log's own channels; the first corrected, if the calibration is determined."""
    raw = board.fresh(channel)
    values, how, slow = raw, "recorded, not calibrated", UNCALIBRATED
    scale, bias = f"k_{kind}", f"b_{kind}"
    if calibration is not None and channel in (kind, "beta_flank"):
        p = {x.name: x for x in calibration.parameters}
        told = {n for n in (scale, bias) if n in p and p[n].verdict != "not_identifiable"}
        if told == {scale, bias}:
            corrected = calibration.corrected({channel: values})[channel]
            spread = np.hypot(p[bias].se, p[scale].se * float(np.nanstd(values)))
            values, how, slow = corrected, "recorded, calibrated", max(LEFT, float(spread))
    at = board.t
    other: Array = np.zeros(len(at))
    side = "beta" if kind == "alpha" else "alpha"
    if side in board.flight:
        other = np.nan_to_num(board.on(side, at))
    alpha, beta = (values, other) if kind == "alpha" else (other, values)
    if channel.startswith("beta_flank"):
        beta = beta_of_flank(beta, alpha)
    arm = board.arm(channel)
    if np.any(arm):
        how += ", carried to the center of gravity"
    moved = carried(board.V_filled, alpha, beta, board.rates, -arm)[0 if kind == "alpha" else 1]
    moved = stuck_held(raw, moved)
    white = board.sigma(channel) or 0.0
    return angle_source(at, moved, float(np.hypot(slow, white)), how, recorded=True)


def asse(board: Board) -> Asse:
    """The filter that carries the affine form; airspeeds brought to the inertial sensor."""
    board.need("ASSE", *INERTIAL, "phi", "theta", "V")
    t = board.inertial_times
    f, w = board.columns(INERTIAL[:3], t), board.columns(INERTIAL[3:], t)
    speed = board.flight["V"]
    V = on_grid(t, speed.t, speed.values)
    phi, theta = board.on("phi", t), board.on("theta", t)
    gravity = gravity_of(phi, theta, board.project.reconstruct.gravity)
    settings = _settings(board, float(np.median(np.diff(t))))
    swing = np.nan_to_num(np.cross(w, board.arm("V") - board.arm("ax")))
    alpha = np.full(len(t), settings.first_alpha)
    beta = np.full(len(t), settings.first_beta)
    for _ in range(2 if np.any(swing) else 1):  # the way it flies tells which part of it counts
        there = V - np.einsum("ni,ni->n", velocity(1.0, alpha, beta), swing)
        record = AsseRecord(t=t, f=f, w=w, gravity=gravity, V=there)
        found = estimate_filter(record, settings)
        alpha = np.where(np.isfinite(found.alpha), found.alpha, alpha)
        beta = np.where(np.isfinite(found.beta), found.beta, beta)
    return Asse(record, settings, found)


def asse_sources(board: Board, made: Asse) -> Found:
    """Angles of ASSE, with where it says that they are observable."""
    r = made.result
    rates = np.nan_to_num(made.record.w)
    alpha, beta = carried(r.V, r.alpha, r.beta, rates, -board.arm("ax"))
    out: Found = {}
    each = zip(
        ("alpha", "beta"), (alpha, beta), (r.sigma_alpha, r.sigma_beta),
        (r.observable_alpha, r.observable_beta), strict=True,
    )  # fmt: skip
    for kind, x, sigma, observable in each:
        out[kind] = angle_source(  # type: ignore[index]
            board.t, _pick(board, r.t, x), _pick(board, r.t, sigma),
            "IMU, attitude and airspeed, affine form carried by a filter",
            observable=_pick(board, r.t, observable.astype(float)) == 1.0,
        )  # fmt: skip
    return out


def zero_order_sources(board: Board, made: Asse) -> Found:
    """The printed scheme beside: four equations, shown where its existence number allows it."""
    whole = made.record
    known = np.isfinite(whole.V)
    at = np.unique(np.clip(np.searchsorted(whole.t, board.t), 0, len(whole.t) - 1))
    t = whole.t[at]
    if known.sum() < LEAST or len(t) < LEAST:
        raise refuse(
            "too_few_samples",
            where=f"log {board.flight.id}, zero-order scheme",
            expected=f"{LEAST} airspeeds or more",
            found=str(int(known.sum())),
            do="Give a longer part.",
        )
    V = np.interp(t, whole.t[known], whole.V[known])
    lag = max(1, round(LAG / float(np.median(np.diff(t)))))
    found = zero_order(
        AsseRecord(t=t, f=whole.f[at], w=whole.w[at], gravity=whole.gravity[at], V=V),
        made.settings.first_alpha,
        made.settings.first_beta,
        offsets=(lag, 2 * lag, 3 * lag),
        V_dot=LocalCubic(t, 5.0 * LAG).derivative(V),
    )
    out: Found = {}
    for kind, x, number, told in (
        ("alpha", found.alpha, found.existence_alpha, found.observable_alpha),
        ("beta", found.beta, found.existence_beta, found.observable_beta),
    ):
        sigma = 1.0 / np.maximum(number, 1e-9)
        out[kind] = angle_source(  # type: ignore[index]
            board.t, _pick(board, t, x), _pick(board, t, sigma),
            f"four equations {LAG:g} s apart, where their existence number allows it",
            observable=_pick(board, t, told.astype(float)) == 1.0, votes=False,
        )  # fmt: skip
    return out


def joint_sources(board: Board) -> tuple[Found, list[Message]]:
    """The joint filter without alpha and beta of the log: satellites, IMU, airspeed."""
    board.need("joint filter", *INERTIAL, "V")
    flight = board.flight
    if not any(board.has(*pair) for pair in SATELLITES):
        board.need("joint filter", "v_north", "v_east")
    found, said = navigate_flight(board.project, flight, board.aircraft, without=("alpha", "beta"))
    air, covariance = found.air(), found.air_covariance()
    rates = np.nan_to_num(board.columns(INERTIAL[3:], found.t)) - found.gyro_bias
    angles = carried(air[:, 0], air[:, 1], air[:, 2], rates, -board.arm("ax"))
    out: Found = {}
    for k, kind in enumerate(("alpha", "beta")):
        sigma = np.sqrt(np.maximum(covariance[:, 1 + k, 1 + k], 0.0))
        # before it has found itself, each reading moves it by steps
        settled = (sigma <= SETTLED * np.nanmedian(sigma)) & (found.t - found.t[0] >= FIRST)
        out[kind] = angle_source(  # type: ignore[index]
            board.t, _pick(board, found.t, angles[k]), _pick(board, found.t, sigma),
            "satellites, IMU and airspeed, without vanes, sideslip near zero",
            observable=_pick(board, found.t, settled.astype(float)) == 1.0,
        )  # fmt: skip
    return out, [*said, *found.messages]


def lift_source(board: Board, model: AeroModel) -> tuple[AngleSource, list[Message]]:
    """Angle of attack at which the model's lift is the measured one."""
    what = f"lift model '{model.name}'"
    coefficient = lift_coefficient(model)
    board.need(what, *INERTIAL, "V")
    flight, aircraft, t = board.flight, board.aircraft, board.t
    if aircraft is None or aircraft.mass is None:
        raise refuse(
            "missing_mass",
            where=f"log {flight.id}, {what}",
            expected="an aircraft file with [mass]: lift is load factor times weight",
            found="none" if aircraft is None else f"{aircraft.path} without [mass]",
            do="State the mass in the aircraft file.",
        )
    said = _other_aircraft(board, model)
    w = board.columns(INERTIAL[3:], t)
    arm = -board.arm("ax")
    cubic = LocalCubic(t)
    turning = np.column_stack([cubic.derivative(np.nan_to_num(x)) for x in w.T])
    f = board.columns(INERTIAL[:3], t) + np.cross(turning, arm) + np.cross(w, np.cross(w, arm))
    V = board.V
    if "rho" in flight:
        rho = board.on("rho", t)
    else:
        board.need(what + ", density", "h")
        rho = standard_density(board.on("h", t))
    fuel = fuel_on(flight, t)
    mass = aircraft.mass_properties(np.zeros(len(t)) if fuel is None else fuel).mass
    b, c = model.reference.b, model.reference.c
    known = {"phat": b * w[:, 0], "qhat": c * w[:, 1], "rhat": b * w[:, 2]}
    variables = {n: x / (2.0 * V) for n, x in known.items()}
    variables |= {n: board.on(n, t) for n in ("beta", "mach") if n in flight}
    variables |= controls_on(flight, aircraft, t)
    needed = {
        v for name, term in model.terms if name == coefficient for x in term.factors
        for v in x.variables
    } - {"alpha", "V"}  # fmt: skip
    board.need(what, *sorted(needed - set(variables)))
    thrust = engines_on(flight, aircraft, t)
    engines = [e for e in aircraft.engines if e.name in thrust]
    pull = sum((np.outer(thrust[e.name], e.direction) for e in engines), np.zeros((len(t), 3)))
    given = {
        "mass": mass, "f": f, "V": V, "rho": rho, "variables": variables,
        "engine_force": np.asarray(pull),
    }  # fmt: skip
    alpha = lift_angle(model, **given)  # type: ignore[arg-type]
    with np.errstate(invalid="ignore"):
        sigma = np.hypot(OMITTED, lift_angle_sigma(model, alpha, **given))  # type: ignore[arg-type]
    how = f"load factor by {coefficient} of '{model.name}'"
    if coefficient == "CL" and len(engines) < len(aircraft.engines):
        how += ", thrust not known"
    return angle_source(t, alpha, sigma, how), said


def _settings(board: Board, step: float) -> AsseSettings:
    """The defaults, with the noise the project states and air of some turbulence."""
    spec = board.project.navigate
    gust = spec.gust if "gust" in spec.model_fields_set else CALM
    usual = float(np.nanmedian(board.V))
    kept = AsseSettings(density_wind=gust * float(np.sqrt(2.0 * usual / spec.gust_length)))
    V = board.sigma("V")
    tilt = max((board.sigma(n) or 0.0 for n in ("phi", "theta")), default=0.0)
    noise = {n: s.sigma_si * float(np.sqrt(step)) for n, s in board.project.reconstruct.imu.items()}
    density_a = max((noise.get(n, 0.0) for n in ("ax", "ay", "az")), default=0.0)
    density_w = max((noise.get(n, 0.0) for n in ("p", "q", "r")), default=0.0)
    return replace(
        kept,
        sigma_V=V or kept.sigma_V,
        sigma_tilt=max(tilt, kept.sigma_tilt),
        density_a=density_a or kept.density_a,
        density_w=density_w or kept.density_w,
        longest_gap=max(kept.longest_gap, 2.5 * step),
    )


def _other_aircraft(board: Board, model: AeroModel) -> list[Message]:
    aircraft = board.aircraft
    assert aircraft is not None
    pairs = {n: (getattr(model.reference, n), getattr(aircraft, n)) for n in ("S", "b", "c")}
    apart = {n: p for n, p in pairs.items() if abs(p[0] / p[1] - 1.0) > OTHER_AIRCRAFT}
    if not apart:
        return []
    return [
        warn(
            "other_reference",
            where=f"log {board.flight.id}, lift model '{model.name}'",
            expected=f"the reference of {aircraft.name}: "
            + ", ".join(f"{n} {p[1]:.4g}" for n, p in apart.items()),
            found=", ".join(f"{n} {p[0]:.4g}" for n, p in apart.items()),
            do="Give the model of this aircraft; its angle is shown all the same.",
        )
    ]


def _pick(board: Board, own: Array, values: Array) -> Array:
    """values at the common times; where these are among its own, as they are."""
    at = np.clip(np.searchsorted(own, board.t), 0, max(len(own) - 1, 0))
    if len(own) and np.array_equal(own[at], board.t):
        return np.asarray(values[at])
    return on_grid(board.t, own, values)
