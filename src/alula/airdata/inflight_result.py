"""What a calibration of air data in flight gives: errors with intervals and verdicts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, refuse

Verdict = Literal["ok", "weak", "not_identifiable"]
SOUGHT = ("k_V", "k_alpha", "b_alpha", "k_beta", "b_beta", "static_error")
WIND = ("wind_north", "wind_east", "wind_down")


@dataclass(frozen=True)
class Parameter:
    """One parameter. value: NaN where the flight does not determine it."""

    name: str
    value: float
    se_white: float
    se: float
    ci95: tuple[float, float]
    unit: str
    verdict: Verdict
    tied_to: tuple[tuple[str, float], ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """As the envelope's `result.parameters[]` carries it."""
        return {
            "name": self.name, "value": self.value, "se_white": self.se_white, "se": self.se,
            "ci95": list(self.ci95), "verdict": self.verdict,
            "tied_to": [{"name": n, "weight": w} for n, w in self.tied_to], "unit": self.unit,
        }  # fmt: skip


@dataclass(frozen=True)
class InFlightCalibration:
    """Errors of the air data: reading = (1 + k) truth + b, port pressure = p + static_error q.

    parameters: sought ones, wind, and what was known before (attitude biases, GPS delay), each
    with interval and verdict. covariance: of them, in their order. spread: 1 - |mean direction|,
    0 for a straight flight. resid: (n, m) reading less foretold one, by `outputs`. used: samples.
    gps_delay: s, that was found and removed beforehand; None where it is a parameter.
    """

    parameters: tuple[Parameter, ...]
    covariance: Array
    spread: float
    t: Array
    outputs: tuple[str, ...]
    resid: Array
    used: int
    iterations: int
    gps_delay: float | None = None
    messages: tuple[Message, ...] = ()

    def __getitem__(self, name: str) -> Parameter:
        """The parameter of that name; raises BadInput naming those there are."""
        for p in self.parameters:
            if p.name == name:
                return p
        raise refuse(
            "unknown_parameter",
            where="in-flight calibration",
            expected=", ".join(p.name for p in self.parameters),
            found=f"'{name}'",
            do="Name one of these.",
        )

    @property
    def rich(self) -> bool:
        """Whether the flight told airspeed error and wind apart."""
        return self["k_V"].verdict != "not_identifiable"

    @property
    def determined(self) -> bool:
        """Whether every sought parameter is."""
        return all(
            p.verdict != "not_identifiable" for p in self.parameters if p.name in (*SOUGHT, *WIND)
        )

    def corrected(self, readings: Mapping[str, Array]) -> dict[str, Array]:
        """Readings 'V', 'alpha', 'beta' or 'beta_flank' without their errors.

        Raises BadInput where the flight did not determine what is needed.
        """
        out = {}
        for name, values in readings.items():
            kind = "beta" if name == "beta_flank" else name
            scale, bias = (
                self[n].value if any(p.name == n for p in self.parameters) else 0.0
                for n in (f"k_{kind}", f"b_{kind}")
            )
            if not np.isfinite(scale + bias):
                raise refuse(
                    "flight_not_rich",
                    where=f"in-flight calibration, {name}",
                    expected="a flight that determines its errors",
                    found=f"headings spread {self.spread:.2g}; "
                    f"se {', '.join(f'{p.name} {p.se:.2g}' for p in self.parameters[:5])}",
                    do="Fly turns, and maneuvers in pitch and yaw.",
                )
            out[name] = (np.asarray(values) - bias) / (1.0 + scale)
        return out

    def as_dict(self) -> dict[str, Any]:
        """As the envelope carries it."""
        return {
            "parameters": [p.as_dict() for p in self.parameters],
            "rich": self.rich,
            "heading_spread": self.spread,
            "samples": self.used,
            "outputs": list(self.outputs),
            "resid_rms": {
                n: float(np.sqrt(np.nanmean(self.resid[:, j] ** 2)))
                for j, n in enumerate(self.outputs)
            },
            "iterations": self.iterations,
            "gps_delay": self.gps_delay,
        }

    def summary(self) -> str:
        """The parameters as text; angles in deg."""
        lines = [f"{'parameter':<14}{'value':>11}{'se':>10}   95 % interval          verdict"]
        for p in self.parameters:
            k, unit = (np.degrees(1.0), "deg") if p.unit == "rad" else (1.0, p.unit)
            low, high = (k * x for x in p.ci95)
            lines.append(
                f"{p.name:<14}{k * p.value:>11.4g}{k * p.se:>10.2g}   {low:>9.4g} to {high:<9.4g}"
                f"  {p.verdict.replace('_', ' ')}"
                + (f"  [{unit}]" if unit != "1" else "")
                + (", tied to " + ", ".join(n for n, _ in p.tied_to) if p.tied_to else "")
            )
        return "\n".join(lines)
