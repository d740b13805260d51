"""`alula plan AIRCRAFT`: a flight test designed before fuel is spent."""

from __future__ import annotations

from enum import StrEnum
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from alula.cli.condition import AircraftArgument, Engines, EnginesOption, source_of
from alula.cli.contract import (
    Command,
    JsonOption,
    QuietOption,
    SeedOption,
    ThreadsOption,
)

if TYPE_CHECKING:
    from alula.plan import Design, Prediction


class Method(StrEnum):
    """How the flights will be identified."""

    ee = "ee"
    oe = "oe"


class Kind(StrEnum):
    """Inputs whose steps the a-priori modes give."""

    pulse = "pulse"
    doublet = "doublet"
    three = "3211"
    bank_to_bank = "bank_to_bank"


def plan(
    aircraft: AircraftArgument,
    V: Annotated[float, typer.Option("--V", metavar="M/S", help="True airspeed, m/s.")],
    h: Annotated[float, typer.Option("--h", metavar="M", help="Height, m.")],
    model: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Aerodynamic model; default the aircraft file's."),
    ] = None,
    control: Annotated[
        list[str] | None,
        typer.Option(metavar="de|da|dr", help="A maneuver with this control; several in turn."),
    ] = None,
    kind: Annotated[
        list[Kind] | None,
        typer.Option(help="Its input, one per --control; default 3211, da bank_to_bank."),
    ] = None,
    sensors: Annotated[
        Path | None,
        typer.Option(metavar="PLAN", help="Take sensors, rate and wind of this plan."),
    ] = None,
    engines: EnginesOption = Engines.modeled,
    method: Annotated[
        Method, typer.Option(help="Whose standard errors: equation error or output error.")
    ] = Method.ee,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write the plan there; `alula fly` flies it."),
    ] = None,
    json: JsonOption = "",
    seed: SeedOption = None,
    threads: ThreadsOption = 1,
    quiet: QuietOption = False,
) -> None:
    """Choose steps and amplitudes; predict standard errors.

    Exit 0: the maneuvers will tell every parameter. 1: some they will not; they are named. 2: bad
    input.
    """
    command = Command("design", json, seed, threads, quiet)
    with command.run():
        from alula.base.files import write_whole
        from alula.model import load_model
        from alula.plan import design

        if out is not None:
            _free(out)
        folder = Path() if out is None else out.absolute().parent
        aero = _model(aircraft, model)
        given = {} if sensors is None else _sensors(sensors)
        found = design(
            aircraft.absolute(),
            load_model(aero),
            aero.absolute(),
            V,
            h,
            requests=_requests(control or [], kind or []),
            engines=engines.value,
            method=method.value,
            **given,
        )
        command.inputs = [source_of(aircraft), source_of(aero)]
        command.messages = found.messages
        command.result = result_of(found)
        if any(p.verdict == "not told" for p in found.together):
            command.status = "not_identifiable"
        command.say(text_of(found))
        if out is not None:
            write_whole(out, plan_text(found, folder))
            command.say(f"\nPlan: {out}\nnext: alula fly {out}")


def _requests(controls: list[str], kinds: list[Kind]) -> list[tuple[str, str]]:
    from alula.base.messages import refuse

    if kinds and len(kinds) != len(controls):
        raise refuse(
            "usage",
            where="--kind",
            expected="one --kind for each --control, or none",
            found=f"{len(kinds)} for {len(controls)}",
            do="Give them in pairs: --control de --kind 3211 --control dr --kind doublet.",
        )
    default = {"da": "bank_to_bank", "dr": "doublet"}
    if kinds:
        return [(c, k.value) for c, k in zip(controls, kinds, strict=True)]
    return [(c, default.get(c, "3211")) for c in controls]


def _model(aircraft: Path, model: Path | None) -> Path:
    from alula.aircraft import load_aircraft
    from alula.base.messages import refuse

    if model is not None:
        return model
    default = load_aircraft(aircraft).aero
    if default is None:
        raise refuse(
            "missing_model",
            where=f"{aircraft}: aero",
            expected="an aerodynamic model",
            found="none",
            do="Name one: --model my_aero.toml.",
        )
    return Path(default)


def _sensors(path: Path) -> dict[str, Any]:
    from alula.simulate.virtual_plan import load_plan

    like = load_plan(path)
    tables = {
        name: spec.model_dump(exclude_defaults=True, exclude_none=True)
        for name, spec in like.sensors.items()
    }
    return {"sensors": tables, "rate": like.rate, "wind": like.wind}


def _free(path: Path) -> None:
    """A plan is written under a free name, or over another plan."""
    from alula.base.messages import refuse
    from alula.cli.contract import writable

    writable(path)
    if path.exists() and b"alula.plan/" not in path.read_bytes()[:4096]:
        raise refuse(
            "output_not_writable",
            where=str(path),
            expected="a free name, or a plan to replace",
            found="another kind of file",
            do="Choose another path; nothing was done yet.",
        )


def plan_text(found: Design, folder: Path) -> str:
    """The plan as TOML; paths from `folder`, where it will stand."""
    import os

    from alula.simulate.virtual_loading import toml_text

    tree = dict(found.tree)
    for key in ("aircraft", "model"):
        tree[key] = os.path.relpath(tree[key], folder.resolve())
    head = [
        "# Designed by `alula plan`: steps by the modes below, amplitudes by flying the a-priori",
        "# model inside the limits of the aircraft file and of the model's validity.",
    ]
    for m in found.maneuvers:
        head += [
            f"# {m.id}: {i.control} {i.kind}, {mode_words(i.timing.mode)} "
            f"{i.timing.frequency:.3g} rad/s, {degrees(i.amplitude):.2f} deg, bounded by {i.bound}"
            for i in m.inputs
        ]
    return "\n".join(head) + "\n" + toml_text(tree)


def result_of(found: Design) -> dict[str, Any]:
    """The envelope's `result`. Angles in degrees where the name says so, else SI."""
    return {
        "method": found.method,
        "trim": {
            "alpha_deg": degrees(found.trim.alpha),
            "de_deg": degrees(found.trim.controls["de"]),
            "thrust": found.trim.thrust,
        },
        "modes": [
            {"name": m.name, "real": m.eigenvalue.real, "imag": m.eigenvalue.imag}
            for m in found.modes
        ],
        "maneuvers": [
            {
                "id": m.id,
                "inputs": [
                    {
                        "control": i.control,
                        "kind": i.kind,
                        "amplitude_deg": degrees(i.amplitude),
                        "bounded_by": i.bound,
                        "width_s": i.timing.width,
                        "mode": i.timing.mode,
                        "frequency": i.timing.frequency,
                    }
                    for i in m.inputs
                ],
                "reached": {
                    (f"{k}_deg" if k in ("alpha", "beta", "phi") else k): [
                        degrees(v) if k in ("alpha", "beta", "phi") else v for v in pair
                    ]
                    for k, pair in m.reached.items()
                },
                "parameters": [_prediction(p) for p in m.predictions],
            }
            for m in found.maneuvers
        ],
        "parameters": [_prediction(p) for p in found.together],
    }


_EXPECTED = {
    "ee": "equation error with the sensors' white noise; constant errors found, model right",
    "oe": "output error, Cramer-Rao bounds with the sensors' white noise; initial states estimated "
    "along, constant errors found, air calm, model right",
}


def _prediction(p: Prediction) -> dict[str, Any]:
    return {
        "name": p.name,
        "coefficient": p.coefficient,
        "value": p.value,
        "se": p.se,
        "verdict": p.verdict.replace(" ", "_"),
        "tied_to": list(p.tied_to),
    }


def text_of(found: Design) -> str:
    """What the command prints."""
    lines = []
    for m in found.maneuvers:
        lines.append(f"Maneuver {m.id}")
        for i in m.inputs:
            lines.append(
                f"  {i.control} {i.kind:<13}{degrees(i.amplitude):>8.2f} deg "
                f"(bounded by {i.bound}), step {i.timing.width:.2f} s for the "
                f"{mode_words(i.timing.mode)}, {i.timing.frequency:.2f} rad/s"
            )
        low, high = m.reached["n"]
        a, b = (degrees(x) for x in m.reached["alpha"])
        slow, fast = m.reached["V"]
        lines.append(
            f"  reaches n {low:.2f} to {high:.2f}, alpha {a:.1f} to {b:.1f} deg, "
            f"V {slow:.1f} to {fast:.1f} m/s"
        )
    lines += ["", f"{'parameter':<22}{'a priori':>11}{'expected se':>13}{'of value':>10}  verdict"]
    for p in found.together:
        share = f"{100 * p.se / abs(p.value):.1f} %" if p.value and p.se < float("inf") else "-"
        tied = f": not apart from {', '.join(p.tied_to)}" if p.tied_to else ""
        se = f"{p.se:.2g}" if p.se < float("inf") else "-"
        lines.append(f"{p.name:<22}{p.value:>11.5g}{se:>13}{share:>10}  {p.verdict}{tied}")
    lines.append(f"expected se: {_EXPECTED[found.method]}")
    return "\n".join(lines)


def mode_words(name: str) -> str:
    """'Dutch roll', 'short period'."""
    return name.replace("_", " ").replace("dutch", "Dutch")
