"""The project file that goes with the logs of a virtual flight test."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from alula.model import AeroModel
from alula.simulate.virtual_loading import Loading, toml_value
from alula.simulate.virtual_maneuvers import VirtualManeuver
from alula.simulate.virtual_plan import Plan
from alula.simulate.virtual_sensing import logged

INERTIAL = ("ax", "ay", "az", "p", "q", "r")
MEASURED = (
    "V", "alpha", "beta", "phi", "theta", "psi", "h", "v_north", "v_east", "v_down",
)  # fmt: skip


def project_text(
    plan: Plan,
    model: AeroModel,
    loadings: Mapping[str, Loading],
    flown: Sequence[VirtualManeuver],
    channels: Sequence[str],
) -> str:
    """A project that `alula identify` takes as it is: logs, mapping, windows, noise, formulas."""
    first = next(iter(loadings.values()))
    lines = [
        f"# {' '.join(plan.name.split())}: logs, windows and noise of a virtual flight test.",
        'schema = "alula.project/1"',
        f"name = {toml_value(plan.name)}",
        f"aircraft = {toml_value(first.file)}",
    ]
    for one in flown:
        id = one.maneuver.id
        lines += [
            "",
            "[[logs]]",
            f"id = {toml_value(id)}",
            f"path = {toml_value(f'logs/{id}.csv')}",
        ]
        if loadings[one.loading].file != first.file:
            lines.append(f"aircraft = {toml_value(loadings[one.loading].file)}")
    lines += ["", "[channels]", 't = {from = "t_s", unit = "s"}']
    formulas = formulas_of(plan, model)
    for name in channels:
        if name == "dt" and not any("dt" in f for f in formulas.values()):
            continue  # in the logs, but a throttle that rests is of no use to anything
        unit, _ = logged(name)
        lines.append(f'{name} = {{from = "{name}_{unit}", unit = "{unit}"}}')
    for one in flown:
        m = one.maneuver
        lines += [
            "",
            "[[maneuvers]]",
            f"id = {toml_value(m.id)}",
            f"log = {toml_value(m.log)}",
            f"kind = {toml_value(m.kind)}",
            f"start = {m.start!r}",
            f"end = {m.end!r}",
            f"aspect = {toml_value(m.aspect)}",
            f"configuration = {toml_value(dict(m.configuration))}",
        ]
        lines += ["held_out = true"] if m.held_out else []
    lines += ["", *_reconstruct(plan, channels), "", *_identify(plan, formulas, loadings)]
    return "\n".join(lines) + "\n"


def _reconstruct(plan: Plan, channels: Sequence[str]) -> list[str]:
    """What is known of the sensors: their noise, and how large their constant errors may be."""
    lines = ["[reconstruct]", 'filter = "ekf"', "", "[reconstruct.imu]"]
    given = {name: spec for name, spec in plan.sensors.items() if name in channels}
    for name in INERTIAL:
        if name in given and given[name].sigma > 0.0:
            lines.append(f"{name} = {{sigma = {given[name].sigma!r}{_unit(plan, name)}}}")
    lines += ["", "[reconstruct.unknowns]"]
    for name in (*INERTIAL, *MEASURED):
        spec = given.get(name)
        bias = 0.0 if spec is None else max(spec.bias_sigma, abs(spec.bias))
        scale = 0.0 if spec is None else max(spec.scale_sigma, abs(spec.scale))
        if bias:
            lines.append(f"b_{name} = {{prior = {bias!r}{_unit(plan, name)}}}")
        elif name in INERTIAL:
            lines.append(f'b_{name} = {{state = "off"}}')
        if scale:
            lines.append(f"k_{name} = {{prior = {scale!r}}}")
    blows = any(plan.wind)
    for name, speed in zip(("wind_n", "wind_e", "wind_d"), plan.wind, strict=True):
        known = name == "wind_d" and speed == 0.0  # steady wind blows level
        state = 'prior = 10.0, unit = "m/s"' if blows and not known else 'state = "off"'
        lines.append(f"{name} = {{{state}}}")
    lines += ["", "[reconstruct.sensors]"]
    for name in MEASURED:
        if name in given and given[name].sigma > 0.0:
            lines.append(f"{name} = {{sigma = {given[name].sigma!r}{_unit(plan, name)}}}")
    return lines


def _unit(plan: Plan, name: str) -> str:
    unit = plan.sensors[name].unit
    return f", unit = {toml_value(unit)}" if unit else ""


def formulas_of(plan: Plan, model: AeroModel) -> dict[str, str]:
    """The plan's formulas, or the model's own with a constant each, less flaps that never move."""
    formulas = dict(plan.identify)
    moved = any(c.df_deg for c in plan.conditions)
    for name, formula in () if formulas else model.formulas.items():
        terms = [term.strip() for term in formula.split(" + ")]
        terms = [x for x in terms if moved or not re.search(r"\bdf\b", x)]
        formula = " + ".join(terms)
        formulas[name] = formula if "1" in terms else " + ".join(["1", *terms])
    return formulas


def _identify(
    plan: Plan, formulas: Mapping[str, str], loadings: Mapping[str, Loading]
) -> list[str]:
    constant = ["common_constant = true  # one aircraft, whatever its trim"]
    engines = next(iter(loadings.values())).aircraft.engines
    if plan.engines == "modeled" and any(e.machine is not None for e in engines):
        # The shaft's torque changes with the power of each condition, and is in no coefficient.
        constant = ["common_constant = false  # the engine's torque differs from trim to trim"]
    return [
        "[identify]",
        'method = "ee"',
        "",
        "[identify.options]",
        *constant,
        "",
        "[identify.models]",
        *(f"{name} = {toml_value(formula)}" for name, formula in formulas.items()),
    ]
