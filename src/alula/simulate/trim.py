"""Trim: the attitude, controls and power that hold a flight condition.

One set of equations for all conditions: the rates of the flight states that must vanish or have a
given value, the path, coordination, and the rate of every further state (rotor, separation point,
actuator), solved for as many unknowns by bounded least squares with the exact Jacobian of
`linearize`, then by Newton steps. Body rates are unknowns and the rates of the Euler angles
equations, so that the same lines serve a flat and a turning Earth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import degrees, isfinite

from alula.aircraft import Envelope
from alula.base.arrays import Array, frozen
from alula.base.messages import Message, refuse, warn
from alula.model import AeroModel
from alula.simulate.airframe import GRAVITY, Airframe, core_model
from alula.simulate.condition import Condition, check_envelope
from alula.simulate.coordinates import plant_state
from alula.simulate.plant import further_states, plant_outputs
from alula.simulate.trim_failure import failure
from alula.simulate.trim_solver import TOLERANCE, Problem
from alula.simulate.wind import Wind


@dataclass(frozen=True)
class Trim:
    """A trimmed flight. Angles rad, rates rad/s, thrust N, throttle 0 to 1.

    state: (13 + k,) of the core. controls: de da dr df dt by name; with thrust they are the inputs.
    residual: largest rate left, m/s2 or rad/s2. gamma: climb angle against the air. further: the
    plant's further states by name. free: the unknowns that were solved for.
    """

    state: Array
    controls: dict[str, float]
    alpha: float
    theta: float
    thrust: float
    residual: float
    condition: Condition
    beta: float = 0.0
    phi: float = 0.0
    gamma: float = 0.0
    p: float = 0.0
    q: float = 0.0
    r: float = 0.0
    turn_rate: float = 0.0
    load_factor: float = 1.0  # normal: -az over standard gravity
    further: Mapping[str, float] = field(default_factory=dict)
    free: tuple[str, ...] = ()
    messages: tuple[Message, ...] = ()

    @property
    def inputs(self) -> dict[str, float]:
        """All inputs by name, as `fly` and `linearize` take them."""
        return {**self.controls, "thrust": self.thrust}


def trim(
    airframe: Airframe,
    model: AeroModel,
    condition: Condition,
    *,
    limits: Mapping[str, tuple[float, float]] | None = None,
    controls: Mapping[str, float] | None = None,
    envelope: Envelope | None = None,
    in_spite: bool = False,
    wind: Array | Wind | None = None,
    gravity: float = GRAVITY,
) -> Trim:
    """Trim an aircraft in a condition.

    limits: (lowest, highest) of unknowns by name, rad, N, 0 to 1; default 30 deg for controls, 20
    deg for alpha and beta. controls: inputs held, such as df; one that is held is no unknown.
    envelope: V, h, n and alpha must lie in it; in_spite: it is a warning if they do not. Straight
    flight keeps its wings level; a turn has no lateral specific force; without a rudder neither is
    asked for. Raises BadInput naming the force or moment that cannot be balanced and the control at
    its stop.
    """
    said = check_envelope(condition, envelope, not in_spite) if envelope else ()
    plant = core_model(airframe, model, wind, gravity)
    earth = airframe.earth
    bounds = dict(limits or {})
    if envelope is not None and envelope.alpha is not None and not in_spite:
        bounds.setdefault("alpha", envelope.alpha)
    held = dict(controls or {})
    for name, position in held.items():
        if not isfinite(position):
            raise refuse(
                "bad_control",
                where=f"trim, {condition.words}: {name}",
                expected="a finite number",
                found=f"{position:g}",
                do="Give the position at which it is held.",
            )
    problem = Problem(plant, condition, airframe, bounds, held, earth)
    found = problem.solve()
    if found.residual > TOLERANCE:
        raise failure(condition, airframe, found, problem.solve, TOLERANCE)
    value = dict(zip(problem.names, found.values.tolist(), strict=True))
    outputs = dict(zip(plant_outputs(plant), found.outputs.tolist(), strict=True))
    further = {name: value[name] for name in further_states(plant)}
    state = plant_state(found.values[: problem.n], problem.wind, earth)
    result = Trim(
        state=frozen(state),
        controls={n: value[problem.input_name(n)] for n in ("de", "da", "dr", "df", "dt")},
        alpha=value["alpha"],
        theta=value["theta"],
        thrust=value["thrust"],
        residual=found.residual,
        condition=condition,
        beta=value["beta"],
        phi=value["phi"],
        gamma=float(found.gamma),
        p=value["p"],
        q=value["q"],
        r=value["r"],
        turn_rate=float(found.rates[8]),
        load_factor=-outputs["az"] / GRAVITY,
        further=further,
        free=found.equations.free,
    )
    return replace(result, messages=(*said, *_remarks(result, model, envelope)))


def trim_level(
    airframe: Airframe,
    model: AeroModel,
    V: float,
    h: float,
    *,
    gamma: float = 0.0,
    psi: float = 0.0,
    controls: dict[str, float] | None = None,
    limits: dict[str, tuple[float, float]] | None = None,
    wind: Array | Wind | None = None,
    gravity: float = GRAVITY,
) -> Trim:
    """Trim straight flight, wings level: V m/s, height h m, climb angle gamma rad.

    See `trim`. controls: others than the elevator, held. limits: of alpha, de (rad), thrust (N).
    """
    condition = Condition(V, h, "climb" if gamma else "level", gamma=gamma, psi=psi)
    return trim(
        airframe, model, condition, limits=limits, controls=controls, wind=wind, gravity=gravity
    )


def _remarks(found: Trim, model: AeroModel, envelope: Envelope | None) -> list[Message]:
    """What the trimmed flight leaves: the model's range, the envelope's load factor and alpha."""
    where = f"trim, {found.condition.words}"
    values = {"alpha": found.alpha, "beta": found.beta, **found.controls}
    out = []
    for name, (low, high) in model.validity.items():
        value = values.get(name)
        if value is not None and not low - 1e-12 <= value <= high + 1e-12:
            out.append(
                warn(
                    "outside_validity",
                    where=where,
                    expected=f"{name} from {low:g} to {high:g}, where the model's values come from",
                    found=f"{name} = {value:.4g}"
                    + (f" rad ({degrees(value):.3g} deg)" if name != "dt" else ""),
                    do="Trust the result as far as the model can be continued.",
                )
            )
    for name, value in (("alpha", found.alpha), ("n", found.load_factor)):
        limits = getattr(envelope, name, None)
        if limits is not None and not limits[0] - 1e-9 <= value <= limits[1] + 1e-9:
            out.append(
                warn(
                    "outside_envelope",
                    where=where,
                    expected=f"{name} from {limits[0]:.4g} to {limits[1]:.4g}, the envelope",
                    found=f"{name} = {value:.4g}",
                    do="Choose a condition inside the aircraft file's envelope.",
                )
            )
    return out
