"""What trim, linearize and modes have in common: an aircraft, its model, a flight condition."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import MISSING, dataclass, fields
from enum import StrEnum
from functools import wraps
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_type_hints

import typer

if TYPE_CHECKING:
    from alula.aircraft import Aircraft
    from alula.flight import SourceFile
    from alula.model import AeroModel
    from alula.simulate import Airframe, Condition, Linearization, Trim


class Kind(StrEnum):
    """What is trimmed."""

    level = "level"
    climb = "climb"
    turn = "turn"
    pull_up = "pull-up"
    glide = "glide"


class Engines(StrEnum):
    """What makes the thrust."""

    modeled = "modeled"
    given = "given"


AircraftArgument = Annotated[Path, typer.Argument(metavar="AIRCRAFT", help="The aircraft file.")]
ModelOption = Annotated[
    Path | None,
    typer.Option("--model", metavar="FILE", help="The model; default: what AIRCRAFT names."),
]
SpeedOption = Annotated[float, typer.Option("--V", metavar="M/S", help="True airspeed.")]
HeightOption = Annotated[float, typer.Option("--h", metavar="M", help="Height.")]
KindOption = Annotated[Kind, typer.Option("--kind", help="What is flown.")]
GammaOption = Annotated[float, typer.Option("--gamma-deg", metavar="DEG", help="Climb angle.")]
BankOption = Annotated[
    float | None, typer.Option("--bank-deg", metavar="DEG", help="Of a turn; right is positive.")
]
LoadOption = Annotated[
    float | None, typer.Option("--n", metavar="N", help="Load factor of a turn or pull-up.")
]
RateOption = Annotated[
    float | None, typer.Option("--turn-rate-deg", metavar="DEG/S", help="Of a turn.")
]
PowerOption = Annotated[
    float, typer.Option("--power", metavar="P", help="Of a glide: throttle 0 to 1, or thrust in N.")
]
FlapsOption = Annotated[float, typer.Option("--flaps-deg", metavar="DEG", help="Flaps.")]
FuelOption = Annotated[float, typer.Option("--fuel-used", metavar="KG", help="Fuel burned.")]
EnginesOption = Annotated[
    Engines,
    typer.Option(help="modeled: the file's engines, by throttle; given: thrust in N is found."),
]
ActuatorsOption = Annotated[
    bool, typer.Option("--actuators", help="With the actuators of the aircraft file.")
]
AnywayOption = Annotated[
    bool, typer.Option("--anyway", help="Also outside the aircraft file's envelope; it is said.")
]


@dataclass(frozen=True)
class Asked:
    """One command's aircraft and condition: its fields are the command line's options."""

    aircraft: AircraftArgument
    V: SpeedOption
    h: HeightOption
    model: ModelOption = None
    kind: KindOption = Kind.level
    gamma_deg: GammaOption = 0.0
    bank_deg: BankOption = None
    n: LoadOption = None
    turn_rate_deg: RateOption = None
    power: PowerOption = 0.0
    flaps_deg: FlapsOption = 0.0
    fuel_used: FuelOption = 0.0
    engines: EnginesOption = Engines.modeled
    actuators: ActuatorsOption = False
    anyway: AnywayOption = False


def at_condition(command: Callable[..., None]) -> Callable[..., None]:
    """A command whose first parameter is an `Asked`, with that one's options in its place."""
    hints = get_type_hints(Asked, include_extras=True)
    place = inspect.Parameter.KEYWORD_ONLY
    first = [
        inspect.Parameter(
            f.name,
            place,
            default=inspect.Parameter.empty if f.default is MISSING else f.default,
            annotation=hints[f.name],
        )
        for f in fields(Asked)
    ]
    own = inspect.signature(command, eval_str=True)
    rest = [p.replace(kind=place) for p in list(own.parameters.values())[1:]]

    @wraps(command)
    def run(**given: Any) -> None:
        command(Asked(**{p.name: given.pop(p.name) for p in first}), **given)

    run.__signature__ = own.replace(parameters=[*first, *rest])  # type: ignore[attr-defined]
    run.__annotations__ = {p.name: p.annotation for p in (*first, *rest)}
    return run


@dataclass(frozen=True)
class Loaded:
    """The same as values of the stages."""

    aircraft: Aircraft
    airframe: Airframe
    model: AeroModel
    condition: Condition
    files: Sequence[SourceFile]
    flaps: float
    anyway: bool

    def trimmed(self) -> Trim:
        """The condition trimmed within the aircraft's control limits and envelope."""
        from alula.simulate import trim

        return trim(
            self.airframe,
            self.model,
            self.condition,
            limits=self.aircraft.control_limits,
            controls={"df": self.flaps},
            envelope=self.aircraft.envelope,
            in_spite=self.anyway,
        )

    def linear(self, found: Trim, inputs: dict[str, float] | None = None) -> Linearization:
        """Linearized where it is trimmed, or under other inputs."""
        from alula.simulate import linearize
        from alula.simulate.airframe import core_model

        return linearize(
            core_model(self.airframe, self.model),
            found.state,
            found.inputs if inputs is None else inputs,
            earth=self.airframe.earth,
        )


def load(asked: Asked) -> Loaded:
    """Read the files; raises BadInput where there is no model or the condition is not one."""
    from alula.aircraft import load_aircraft
    from alula.base.messages import refuse
    from alula.model import load_model
    from alula.simulate import Condition, airframe_of

    aircraft = load_aircraft(asked.aircraft)
    named = aircraft.aero
    path = asked.model or (None if named is None else Path(named))
    if path is None:
        raise refuse(
            "no_model",
            where=str(asked.aircraft),
            expected='an aerodynamic model: --model FILE, or aero = "FILE" in the aircraft file',
            found="neither",
            do="Name the model's file.",
        )
    model = load_model(path)
    condition = Condition(
        V=asked.V,
        h=asked.h,
        kind=asked.kind.name,  # type: ignore[arg-type]
        gamma=radians(asked.gamma_deg),
        bank=None if asked.bank_deg is None else radians(asked.bank_deg),
        load_factor=asked.n,
        turn_rate=None if asked.turn_rate_deg is None else radians(asked.turn_rate_deg),
        power=asked.power,
    )
    return Loaded(
        aircraft,
        airframe_of(
            aircraft, asked.fuel_used, engines=asked.engines.value, actuators=asked.actuators
        ),
        model,
        condition,
        [source_of(asked.aircraft), source_of(path)],
        radians(asked.flaps_deg),
        asked.anyway,
    )


def trim_result(found: Trim) -> dict[str, Any]:
    """A trimmed flight as JSON carries it: SI, rad."""
    c = found.condition
    return {
        "kind": c.kind,
        "V": c.V,
        "h": c.h,
        "alpha": found.alpha,
        "beta": found.beta,
        "phi": found.phi,
        "theta": found.theta,
        "psi": c.psi,
        "gamma": found.gamma,
        "p": found.p,
        "q": found.q,
        "r": found.r,
        "turn_rate": found.turn_rate,
        "load_factor": found.load_factor,
        "controls": found.inputs,
        "further": dict(found.further),
        "free": list(found.free),
        "residual": found.residual,
    }


def source_of(path: Path) -> SourceFile:
    """A file that was read whole, for the envelope."""
    from alula.base.files import sha256
    from alula.flight import SourceFile

    size = path.stat().st_size
    return SourceFile(str(path), sha256(path), size, size, 0, 0)
