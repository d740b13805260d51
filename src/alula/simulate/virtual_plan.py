"""The plan of a virtual flight test, `alula.plan/1`: aircraft, loadings, conditions, maneuvers,
sensors, air. The layout is explained in docs/plan_file.md.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from alula.base.file_schema import Identifier, Quantity, ReadFile, Strict
from alula.base.messages import BadInput
from alula.base.project_messages import check_units, expand_paths, read_toml, validated
from alula.model.formula_problems import formula_problems

Positive = Annotated[float, Field(gt=0.0, le=1e6)]
NotNegative = Annotated[float, Field(ge=0.0, le=1e6)]
Number = Annotated[float, Field(ge=-1e6, le=1e6)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]
Window = Annotated[list[NotNegative], Field(min_length=2, max_length=2)]
Surface = Literal["de", "da", "dr", "df"]
Aspect = Literal["longitudinal", "lateral", "both"]
Some = Literal["all"] | Annotated[list[str], Field(min_length=1)]
InputKind = Literal[
    "pulse", "doublet", "3211", "steps", "bank_to_bank", "sweep", "multisine"
]  # fmt: skip

SENSED = (
    "ax", "ay", "az", "p", "q", "r", "phi", "theta", "psi", "V", "alpha", "beta", "h",
    "v_north", "v_east", "v_down", "de", "da", "dr", "df", "dt", "thrust", "fuel_used",
)  # fmt: skip


class LoadingSpec(Strict):
    """One state of mass: the aircraft file, changed."""

    id: Identifier
    aircraft: Path | None = Field(
        default=None, strict=False, description="another aircraft file; default the plan's"
    )
    cg_shift: Vector | None = Field(
        default=None, description="of the center of gravity, m, body axes; inertia stays"
    )
    fuel_used: NotNegative = Field(default=0.0, description="kg, burned before the maneuvers")
    set: dict[str, float | str | bool | list[float]] = Field(
        default={}, description="values of the aircraft file by dotted key, lists by name"
    )


class ConditionSpec(Strict):
    """Steady flights from which maneuvers begin: every V at every h."""

    id: Identifier | None = None
    V: Positive | Annotated[list[Positive], Field(min_length=1)] = Field(description="m/s, true")
    h: Number | Annotated[list[Number], Field(min_length=1)] = Field(description="m")
    gamma_deg: Number = Field(default=0.0, description="climb angle against the air, deg")
    psi_deg: Number = Field(default=0.0, description="heading, deg")
    df_deg: Number = Field(default=0.0, description="flap, deg")
    loadings: Some = "all"


class InputSpec(Strict):
    """One control's input on top of its trim position."""

    control: Surface
    kind: InputKind
    amplitude_deg: Number = Field(description="deg; the first step's direction")
    start: NotNegative = Field(default=1.0, description="s")
    width: Positive | None = Field(default=None, description="s, of a step; 3-2-1-1: of the unit")
    hold: NotNegative = Field(default=0.0, description="s at each bank angle of bank_to_bank")
    ramp: NotNegative = Field(default=0.0, description="s, of each change of level")
    widths: list[Positive] | None = Field(default=None, description="s, of 'steps'")
    levels: list[Number] | None = Field(default=None, description="times amplitude, of 'steps'")
    duration: Positive | None = Field(default=None, description="s, of a sweep or a multisine")
    band_hz: Window | None = Field(default=None, description="first and last frequency, Hz")
    logarithmic: bool = Field(default=True, description="of a sweep")
    fade: NotNegative = Field(default=0.0, description="s, of a sweep")

    @model_validator(mode="after")
    def _complete(self) -> InputSpec:
        needed: dict[str, tuple[str, ...]] = {
            "steps": ("widths", "levels"),
            "sweep": ("duration", "band_hz"),
            "multisine": ("duration", "band_hz"),
        }
        missing = [k for k in needed.get(self.kind, ("width",)) if getattr(self, k) is None]
        if missing:
            raise ValueError(f"{' and '.join(missing)} for kind '{self.kind}'|none")
        if self.kind == "steps" and len(self.widths or []) != len(self.levels or []):
            raise ValueError(
                f"as many levels as widths|{len(self.levels or [])} and {len(self.widths or [])}"
            )
        if self.band_hz is not None and min(self.band_hz) <= 0.0:
            raise ValueError(f"frequencies above zero|{self.band_hz}")
        if self.kind == "multisine" and self.band_hz and self.band_hz[0] > self.band_hz[1]:
            raise ValueError(f"band_hz as [lowest, highest]|{self.band_hz}")
        if self.duration is not None and 2.0 * self.fade > self.duration:
            raise ValueError(f"two fades within the duration|fade {self.fade:g} s")
        return self


class ManeuverPlan(Strict):
    """A maneuver, flown from every condition named."""

    id: Identifier
    inputs: list[InputSpec] = Field(default_factory=list)
    aspect: Aspect | None = Field(default=None, description="default: by the controls moved")
    conditions: Some = "all"
    duration: Positive | None = Field(default=None, description="s; default the plan's")
    repeats: Annotated[int, Field(ge=1, le=1000)] = 1
    controls: Literal["fixed", "free"] = Field(
        default="fixed", description="after the input: held, or floating by [float]"
    )
    reference_V: Positive | None = Field(
        default=None, description="m/s; widths are for this airspeed, longer at a lower one"
    )
    amplitude_exponent: Number = Field(
        default=0.0, description="amplitude goes with (reference_V / V) to this power"
    )
    held_out: bool = False

    @model_validator(mode="after")
    def _multisines_agree(self) -> ManeuverPlan:
        sines = [i for i in self.inputs if i.kind == "multisine"]
        if len({(i.start, i.duration, *(i.band_hz or [])) for i in sines}) > 1:
            raise ValueError("one start, duration and band_hz for multisines flown at once|several")
        if len({i.control for i in sines}) < len(sines):
            raise ValueError("one multisine for each control|several for one")
        return self


class SensorPlan(Quantity):
    """What one sensor does wrong; numbers in `unit`, SI where none is stated."""

    use: bool = True
    sigma: NotNegative = Field(default=0.0, description="standard deviation of the white noise")
    bias: Number = 0.0
    bias_sigma: NotNegative = Field(
        default=0.0, description="standard deviation of a bias drawn once for the campaign"
    )
    scale: Number = Field(default=0.0, description="scale error, relative; of a vane its upwash")
    scale_sigma: NotNegative = Field(default=0.0, description="of one drawn for the campaign")
    step: NotNegative = Field(default=0.0, description="quantization")
    lag: NotNegative = Field(default=0.0, description="time constant, s")
    rate: Positive | None = Field(default=None, description="Hz; default the plan's")
    loss: Annotated[float, Field(ge=0.0, lt=1.0)] = Field(
        default=0.0, description="share of the samples lost"
    )
    stuck: Window | None = Field(default=None, description="start and end, s")


class PilotSpec(Strict):
    """Who holds the entry condition until the first input begins, and which axes after it."""

    hold: bool = True
    keeps: list[Literal["pitch", "roll", "yaw"]] = Field(
        default=[], description="axes that the pilot goes on holding during the maneuver"
    )


class FloatSpec(Strict):
    """Where a free surface goes by its hinge moments; both are assumed unless measured."""

    alpha: Number = Field(default=0.0, description="deflection per angle of attack (or sideslip)")
    rate: Number = Field(default=0.0, description="deflection per q, p or r, s")


class GustSpec(Strict):
    """A one-minus-cosine gust in body axes, there and back."""

    peak: Vector = Field(description="m/s, velocity of the air")
    start: NotNegative = Field(description="s")
    length: Positive = Field(description="m, from its beginning to its peak")


class TurbulenceSpec(Strict):
    """Dryden turbulence by MIL-F-8785C."""

    wind_20ft: NotNegative = Field(default=0.0, description="m/s 20 ft above ground: below 2000 ft")
    sigma: NotNegative = Field(default=0.0, description="m/s, above 1000 ft")


class Plan(ReadFile):
    """A plan as it was read; paths are absolute."""

    schema_: Literal["alula.plan/1"] = Field(alias="schema")
    name: str
    aircraft: Path = Field(strict=False)
    model: Path | None = Field(
        default=None, strict=False, description="aerodynamics; default the aircraft file's"
    )
    rate: Positive = Field(default=50.0, description="Hz, of the logs")
    step: Positive = Field(default=0.01, description="s, longest of the integration")
    duration: Positive = Field(default=20.0, description="s, of a maneuver")
    engines: Literal["modeled", "given"] = Field(
        default="modeled", description="those of the aircraft file, or a thrust that stays"
    )
    actuators: bool = Field(default=True, description="those of the aircraft file")
    seed: Annotated[int, Field(ge=0)] = 1
    loadings: list[LoadingSpec] = Field(default_factory=list)
    conditions: list[ConditionSpec] = Field(min_length=1)
    maneuvers: list[ManeuverPlan] = Field(min_length=1)
    sensors: dict[str, SensorPlan] = Field(default_factory=dict)
    wind: Vector = Field(
        default_factory=lambda: [0.0, 0.0, 0.0], description="m/s NED, the way it blows to"
    )
    gust: GustSpec | None = None
    turbulence: TurbulenceSpec | None = None
    pilot: PilotSpec = PilotSpec()
    floats: dict[Literal["de", "da", "dr"], FloatSpec] = Field(default={}, alias="float")
    identify: dict[str, str] = Field(
        default={}, description="formulas for the project; default the model's, with constants"
    )

    @model_validator(mode="after")
    def _known_sensors(self) -> Plan:
        for name in self.sensors:
            if name not in SENSED:
                raise ValueError(f"[sensors] of {', '.join(SENSED)}|'{name}'")
        for maneuver in self.maneuvers:
            if maneuver.controls == "free" and not self.floats:
                raise ValueError(f"[float.de] or another, for free controls|none, {maneuver.id}")
        for key in ("loadings", "conditions", "maneuvers"):
            ids = [x.id for x in getattr(self, key) if x.id is not None]
            twice = sorted({i for i in ids if ids.count(i) > 1})
            if twice:
                raise ValueError(f"each id once in [[{key}]]|'{twice[0]}' several times")
        known = [x.id for x in self.loadings]
        _known("loadings", known, [c.loadings for c in self.conditions])
        names = [c.id for c in self.conditions if c.id is not None]
        _known("conditions", names, [m.conditions for m in self.maneuvers])
        return self


def _known(key: str, known: list[str], asked: list[Any]) -> None:
    for name in (n for some in asked if some != "all" for n in some):
        if name not in known:
            raise ValueError(f"one of the ids of [[{key}]]: {', '.join(known) or 'none'}|'{name}'")


def load_plan(path: Path | str) -> Plan:
    """Read and check a plan; paths in it become absolute, from its folder.

    Raises BadInput with one message for everything that is wrong: file, key, expected, found.
    """
    path = Path(path)
    text, tree, sha256 = read_toml(path)
    expand_paths(tree, path, ("aircraft", "model"), "loadings", ("aircraft",))
    plan = validated(Plan, tree, path, text)
    problems = [*check_units(plan, path), *formula_problems(plan.identify, f"{path}: identify")]
    if problems:
        raise BadInput(*problems)
    plan._path, plan._sha256 = path.resolve(), sha256
    return plan
