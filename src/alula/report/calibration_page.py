"""The report of a calibration: one page, no script, nothing from outside."""

from __future__ import annotations

from collections.abc import Sequence

from alula.navigate.calibration import AxisNoise, Calibrated, Parameter, SensorCalibration
from alula.report.calibration_pictures import STYLE, allan_picture, clouds, length_bars
from alula.report.html import Html, file_name, join, table, tag
from alula.report.numbers import number, percent, plus_minus
from alula.report.pictures import mark
from alula.report.plain_page import END, plain_page

FEW = 60  # vectors up to which each has bars of its own
LEVELS = {"ok": "good", "weak": "caution", "not_identifiable": "bad"}


def calibration_page(found: Calibrated) -> str:
    """The page as HTML; the same input gives the same text."""
    parts = [_sensor(name, sensor) for name, sensor in found.sensors.items()]
    parts += [_noise(name, axes) for name, axes in found.noise.items()]
    said = [
        tag(
            "li", tag("code", m.code), f" {m.where}: expected {m.expected}, found {m.found}. {m.do}"
        )
        for m in found.messages
    ]
    body = tag(
        "body",
        tag(
            "main",
            tag("p", "Alula · sensor calibration", class_="kicker"),
            tag("h1", found.project.name),
            *parts,
            _chapter("messages", "Messages", tag("ul", *said) if said else tag("p", "None.")),
            _chapter("files", "Files", _files(found)),
            END,
        ),
    )
    return plain_page(f"{found.project.name} · calibration", body, STYLE)


def _sensor(name: str, sensor: SensorCalibration) -> Html:
    lost = sum(p.verdict == "not_identifiable" for p in sensor.parameters)
    if lost:
        verdict = mark("bad", f"{lost} parameters are not identifiable", long=True)
    else:
        verdict = mark("good", "every parameter is determined", long=True)
    errors = table(
        "Error of the vectors' length against the reference.",
        ["", "Largest", "rms"],
        [
            ["as recorded", percent(sensor.before.largest, 3), percent(sensor.before.rms, 3)],
            ["calibrated", percent(sensor.after.largest, 3), percent(sensor.after.rms, 3)],
        ],
        numeric=(1, 2),
    )
    picture = length_bars(sensor) if len(sensor.length) <= FEW else None
    words = "Orange: as recorded. Blue: calibrated. Dashed: the reference's length."
    return _chapter(
        name,
        name.capitalize(),
        join(
            [
                tag("p", verdict),
                errors,
                tag("p", words, class_="note"),
                tag("figure", clouds(sensor)),
                tag("figure", picture) if picture is not None else None,
                _parameters(sensor.parameters, f"{name.capitalize()}: {len(sensor.raw)} vectors."),
            ]
        ),
    )


def _noise(name: str, axes: Sequence[AxisNoise]) -> Html:
    parameters = [p for axis in axes for p in axis.parameters]
    return _chapter(
        f"noise-{name}",
        f"Noise of the {name}",
        join(
            [
                tag("figure", allan_picture(axes, name)),
                _parameters(parameters, "White noise, bias instability and random walk."),
            ]
        ),
    )


def _parameters(parameters: Sequence[Parameter], caption: str) -> Html:
    rows = [
        [
            tag("code", p.name),
            plus_minus(p.value, p.se),
            f"{number(p.ci95[0])} … {number(p.ci95[1])}",
            p.unit,
            mark(LEVELS[p.verdict], p.verdict.replace("_", " ")),
            ", ".join(n for n, _ in p.tied_to),
        ]
        for p in parameters
    ]
    head = ["Parameter", "Value ± standard error", "95 % interval", "Unit", "Verdict", "Tied to"]
    return table(caption, head, rows, numeric=(1, 2))


def _files(found: Calibrated) -> Html:
    rows = [
        [file_name(f.path), f.bytes, f.decoded, f.skipped, f.unknown, tag("code", f.sha256[:16])]
        for f in found.files
    ]
    head = ["File", "Bytes", "Decoded", "Skipped", "Unknown", "SHA-256"]
    return table("Every byte accounted for.", head, rows, numeric=range(1, 5))


def _chapter(key: str, title: str, content: Html) -> Html:
    return tag("section", tag("h2", title), content, id=key, class_="chapter")
