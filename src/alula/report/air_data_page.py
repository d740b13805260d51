"""The report of the air data, calibration and angles: one page, no script, nothing from outside."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from alula.airdata.angles import Compared, Kind
from alula.airdata.inflight_result import InFlightCalibration, Parameter
from alula.base.messages import Message
from alula.report.angle_picture import ANGLES_STYLE
from alula.report.angles_section import angles_section
from alula.report.html import Html, join, table, tag
from alula.report.numbers import MISSING, interval, number, plus_minus
from alula.report.pictures import interval_picture, mark
from alula.report.plain_page import END, SKIP, plain_page

MEANING = {
    "k_V": "airspeed scale", "k_alpha": "upwash at the alpha vane", "b_alpha": "alpha vane, bias",
    "k_beta": "sidewash at the beta vane", "b_beta": "beta vane, bias",
    "static_error": "static port less air, per dynamic pressure",
    "wind_north": "wind toward north", "wind_east": "wind toward east",
    "wind_down": "wind downward", "b_phi": "bank, bias", "b_theta": "pitch attitude, bias",
    "b_psi": "heading, bias", "gps_delay": "GPS, delay", "h_offset": "height, offset",
    "h_scale": "height, scale",
}  # fmt: skip
_MARKS = {"ok": ("good", "ok"), "weak": ("caution", "weak"),
          "not_identifiable": ("bad", "not identifiable")}  # fmt: skip


def air_data_page(
    name: str,
    found: Mapping[str, InFlightCalibration],
    angles: Mapping[str, Mapping[Kind, Compared]] | None = None,
    refused: Mapping[str, Message] | None = None,
) -> str:
    """The page as HTML, a section for each log; the same input gives the same text.

    found: calibrations; angles: comparisons of the flow angles; refused: why there is no
    calibration; by log.
    """
    angles, refused = angles or {}, refused or {}
    body = tag(
        "body",
        SKIP,
        tag(
            "main",
            tag("p", "Alula · air data", class_="kicker"),
            tag("h1", name),
            *(
                tag(
                    "section",
                    tag("h2", f"Log {id}"),
                    air_data(found[id]) if id in found else _not_calibrated(refused.get(id)),
                    angles_section(angles[id]) if id in angles else "",
                    class_="chapter",
                )
                for id in dict.fromkeys([*found, *angles])
            ),
            END,
            id="report",
        ),
    )
    return plain_page(f"{name} · air data", body, ANGLES_STYLE if angles else "")


def air_data(found: InFlightCalibration) -> Html:
    """Parameters with intervals and verdicts, and what was noticed."""
    said = (
        "The flight tells airspeed errors and wind apart."
        if found.rich
        else "The flight does not tell airspeed errors and wind apart: fly turns."
    )
    rows = [
        [
            tag("code", p.name),
            MEANING.get(p.name, ""),
            MISSING if p.verdict == "not_identifiable" else plus_minus(_shown(p, p.value), _se(p)),
            {"rad": "°", "1": "–"}.get(p.unit, p.unit),
            MISSING
            if p.verdict == "not_identifiable"
            else interval(*(_shown(p, x) for x in p.ci95)),
            "" if p.verdict == "not_identifiable" else interval_picture(p.value, *p.ci95, None),
            join([mark(*_MARKS[p.verdict]), _ties(p)]),
        ]
        for p in found.parameters
    ]
    rms = ", ".join(
        f"{n} {number(_of(n) * float(np.sqrt(np.nanmean(found.resid[:, j] ** 2))), 2)}"
        f"{'°' if n in ('alpha', 'beta', 'beta_flank') else ' m' if n == 'h' else ' m/s'}"
        for j, n in enumerate(found.outputs)
    )
    return join(
        [
            tag("p", mark("good" if found.rich else "bad", "rich" if found.rich else "not rich"),
                f" {said} 1 − |mean direction of flight| is {number(found.spread, 2)}."),
            table(
                "reading = (1 + k) truth + b",
                ["Parameter", "Meaning", "Value ± se", "Unit", "95 % interval", "Zero and interval",
                 "Verdict"],
                rows,
                numeric=[2, 4],
                class_="dense whole",
            ),
            tag("p", f"Residuals, gusts included, rms: {rms}; {found.used} samples.",
                class_="note"),
            *(tag("p", str(m), class_="note") for m in found.messages),
        ]
    )  # fmt: skip


def _not_calibrated(why: Message | None) -> Html:
    words = "" if why is None else f" Expected {why.expected}; found {why.found}. {why.do}"
    return tag("p", mark("caution", "not calibrated"), words)


def _of(output: str) -> float:
    return float(np.degrees(1.0)) if output in ("alpha", "beta", "beta_flank") else 1.0


def _shown(p: Parameter, value: float) -> float:
    return float(np.degrees(value)) if p.unit == "rad" else value


def _se(p: Parameter) -> float:
    return _shown(p, p.se)


def _ties(p: Parameter) -> str:
    return " tied to " + ", ".join(n for n, _ in p.tied_to) if p.tied_to else ""
