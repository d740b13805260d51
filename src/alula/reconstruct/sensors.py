"""Which channels the reconstruction can use as measurements, and what they measure."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from alula.base.messages import Message, note, refuse
from alula.base.project import SensorSpec


@dataclass(frozen=True)
class Kind:
    """A measurable quantity: its index in the core, unit, and the noise assumed if none is given.

    The default standard deviations are those of ordinary flight-test instruments (van den Hoek
    2017, Table 1, rounded up); they are named in a message wherever they are used.
    """

    quantity: int
    unit: str
    sigma: float


# Order of `Quantity` in core/include/alula/filters/path_model.hpp.
KINDS: Mapping[str, Kind] = {
    "h": Kind(0, "m", 1.0),
    "phi": Kind(1, "rad", 0.005),
    "theta": Kind(2, "rad", 0.005),
    "psi": Kind(3, "rad", 0.01),
    "V": Kind(4, "m/s", 0.3),
    "alpha": Kind(5, "rad", 0.004),
    "alpha_linear": Kind(6, "rad", 0.004),
    "beta": Kind(7, "rad", 0.004),
    "beta_flank": Kind(8, "rad", 0.004),
    "beta_linear": Kind(9, "rad", 0.004),
    "v_north": Kind(10, "m/s", 0.2),
    "v_east": Kind(11, "m/s", 0.2),
    "v_down": Kind(12, "m/s", 0.3),
    "north": Kind(13, "m", 3.0),
    "east": Kind(14, "m", 3.0),
}
AIRDATA = ("V", "alpha", "beta", "beta_flank")
GROUND = ("v_north", "v_east", "v_down", "north", "east")
FORMS = ("local", "linear")


@dataclass(frozen=True)
class Sensor:
    """One measured channel as the filter sees it."""

    channel: str  # the channel's name: 'alpha', 'alpha_2', 'h_gps'
    kind: str  # key of KINDS
    sigma: float  # SI
    reference: str  # 'zero' or 'first': what a scale error acts about

    @property
    def unit(self) -> str:
        """SI unit of its readings."""
        return KINDS[self.kind].unit


def kind_of(channel: str) -> str | None:
    """The quantity a channel measures: a second one of the same is named 'alpha_2'; else None."""
    name = re.sub(r"_\d+$", "", channel)
    name = {"h_gps": "h", "lat": "north", "lon": "east"}.get(name, name)
    return name if name in KINDS and not name.endswith("_linear") else None


def choose_sensors(
    channels: list[str], specs: Mapping[str, SensorSpec]
) -> tuple[tuple[Sensor, ...], list[Message]]:
    """The sensors among the channels, as the project wants them.

    Raises BadInput for a sensor entry that no channel answers to, or an unknown form.
    """
    sensors, messages = [], []
    for name in specs:
        if specs[name].use and (name not in channels or kind_of(name) is None):
            raise refuse(
                "unknown_sensor",
                where=f"reconstruct.sensors.{name}",
                expected="a mapped channel that measures " + ", ".join(KINDS),
                found="no such channel" if name not in channels else f"channel '{name}'",
                do="Map the channel, or take the entry out.",
            )
    for channel in channels:
        kind = kind_of(channel)
        spec = specs.get(channel, SensorSpec())
        if kind is None or not spec.use:
            continue
        if spec.form is not None and (
            spec.form not in FORMS or (spec.form == "linear" and kind not in ("alpha", "beta"))
        ):
            raise refuse(
                "unknown_form",
                where=f"reconstruct.sensors.{channel}.form",
                expected="'local', or 'linear' for alpha and beta",
                found=repr(spec.form),
                do="Take 'local' unless a publication is to be repeated.",
            )
        if spec.form == "linear":
            kind += "_linear"
        sigma = spec.sigma_si
        if sigma is None:
            sigma = KINDS[kind].sigma
            messages.append(
                note(
                    "assumed_sigma",
                    where=f"sensor {channel}",
                    expected="a standard deviation in [reconstruct.sensors]",
                    found=f"none; {sigma:g} {KINDS[kind].unit} is assumed",
                    do="State it if you know the instrument; filters weigh sensors by it.",
                )
            )
        sensors.append(Sensor(channel, kind, sigma, spec.reference))
    return tuple(sensors), messages
