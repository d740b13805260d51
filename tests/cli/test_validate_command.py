"""`alula validate`: envelope, exit codes, what is held out, what is written."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import Literal

import pytest
from pydantic import BaseModel, ConfigDict, Field

from alula.validate import reidentify
from cli.command import Ran, SmallProject, alula, assert_refused, contents
from cli.test_json import checked, timeless


class Strict(BaseModel):
    """A key too many is as wrong as one that is missing."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Model(Strict):
    name: str
    source: str
    sha256: str | None


class Criterion(Strict):
    quantity: str
    unit: str
    measured: float
    model: float
    deviation: float
    deviation_se: float = Field(ge=0.0)
    tolerance: float = Field(gt=0.0)
    met: bool | None
    within_share: float | None


Seen = Literal["no", "yes", "unknown"]


class Row(Strict):
    entry: str
    requirement: str
    maneuver: str
    tolerance: str
    verdict: Literal["pass", "fail", "not_judged"]
    seen_by_estimate: Seen
    window: list[float] | None
    reason: str
    criteria: list[Criterion]


class Range(Strict):
    value: float
    low: float
    high: float


class Channel(Strict):
    unit: str
    rms: float
    r2: float | None
    rrmse: float | None
    theil: float | None
    bias: float | None
    variance: float | None
    covariance: float | None
    in_axis: bool
    as_recorded: bool


class Flown(Strict):
    id: str
    kind: str
    aspect: str
    seen_by_estimate: Seen
    start: float
    horizon_s: float
    asked_s: float
    diverged_at: float | None
    offsets: dict[str, float]
    as_recorded: list[str]
    draws: int
    outside_validity: dict[str, Range]
    channels: dict[str, Channel]


class Repeated(Strict):
    name: str
    truth: float
    mean: float
    scatter: float = Field(gt=0.0)
    stated: float = Field(gt=0.0)
    inside: float = Field(ge=0.0, le=1.0)
    draws: int


class Validated(Strict):
    model: Model
    regulation: str
    status: str
    evidence: list[Row]
    maneuvers: list[Flown]
    reidentified: list[Repeated]


def project(demo: Path, folder: Path, held_out: bool = True) -> SmallProject:
    """The demo with both its logs; the second half of the longitudinal one is held out."""
    shutil.copytree(demo, folder)
    path = folder / "demo.toml"
    more = """
[[maneuvers]]
id = "second"
log = "longitudinal"
kind = "doublet"
start = 12.0
end = 20.0
aspect = "longitudinal"
"""
    text = path.read_text().replace("end = 20.0", "end = 11.9", 1)
    text = text.replace(
        "\n[reconstruct]\n", f"{more}held_out = {str(held_out).lower()}\n\n[reconstruct]\n"
    )
    path.write_text(text)
    return SmallProject(folder, [], None)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def whole(demo_files: Path, tmp_path_factory: pytest.TempPathFactory) -> SmallProject:
    return project(demo_files, tmp_path_factory.mktemp("validate") / "project")


@pytest.fixture(scope="module")
def held(whole: SmallProject) -> Ran:
    return alula("validate", whole.path, "--json", "-", "--seed", 5)


def test_envelope(held: Ran) -> None:
    found = checked(held, "validation", "ok")
    result = Validated.model_validate(found.result)
    assert found.provenance.seed == 5
    assert {"read", "reconstruct", "identify", "fly", "total"} == set(found.timing_s)
    assert result.model.sha256 is None
    assert result.model.source == "identified here from longitudinal, lateral"
    (one,) = result.maneuvers
    assert (one.id, one.seen_by_estimate, one.draws) == ("second", "no", 40)
    assert one.horizon_s == pytest.approx(8.0)
    assert {row.entry for row in result.evidence} == {"2.c.10"}
    for channel in one.channels.values():
        parts = (channel.bias, channel.variance, channel.covariance)
        assert sum(p for p in parts if p is not None) == pytest.approx(1.0, abs=1e-6)


def test_an_identified_model_of_the_demo_flies_like_the_demo(held: Ran) -> None:
    """A simulated aircraft whose structure is the model's: it predicts what it never saw."""
    result = Validated.model_validate(held.envelope["result"])
    assert {row.verdict for row in result.evidence} == {"pass"}
    channels = result.maneuvers[0].channels
    assert all((channels[n].r2 or 0.0) > 0.95 for n in ("q", "theta", "alpha", "az"))


def test_the_model_file_gives_the_same_and_knows_what_it_saw(
    whole: SmallProject, held: Ran, tmp_path: Path
) -> None:
    file = tmp_path / "model.toml"
    assert alula("identify", whole.path, "--model", file, "--quiet").code == 0
    ran = alula("validate", whole.path, "--model", file, "--json", "-", "--seed", 5)
    found = Validated.model_validate(checked(ran, "validation", "ok").result)
    assert found.model.source == str(file)
    assert found.model.sha256 is not None
    assert found.maneuvers[0].seen_by_estimate == "no"
    first = Validated.model_validate(held.envelope["result"])
    # the reconstruction shares its constants among fewer maneuvers here: not to the last digit
    assert found.maneuvers[0].channels["q"].r2 == pytest.approx(
        first.maneuvers[0].channels["q"].r2, abs=0.02
    )
    words = ("--model", file, "--maneuver", "lateral", "--json", "-")
    seen = alula("validate", whole.path, *words)
    assert {m["seen_by_estimate"] for m in seen.envelope["result"]["maneuvers"]} == {"yes"}
    assert "SEEN BY THE ESTIMATE" in seen.envelope["result"]["status"]
    (said,) = seen.messages("seen_by_the_estimate")
    assert said["level"] == "warning"


def test_the_truth_flies_what_was_recorded_in_wind_with_noise_and_biases(demo_files: Path) -> None:
    """Logs, reconstruction and flight in one: the model that made the demo's logs, flown anew."""
    file = Path(__file__).parents[2] / "aircraft" / "sportstar_aero.toml"
    words = ("--model", file, "--json", "-", "--draws", 0)
    ran = alula("validate", demo_files / "demo.toml", *words)
    found = Validated.model_validate(checked(ran, "validation", "ok").result)
    assert {m.seen_by_estimate for m in found.maneuvers} == {"unknown"}
    assert ran.messages("origin_unknown")
    longitudinal, lateral = found.maneuvers
    # sensor noise of 0.1 deg and 0.2 m/s, smoothed, on motions of some degrees and 10 m/s
    for flown, names in ((longitudinal, ("V", "alpha", "q", "theta", "h")),
                         (lateral, ("beta", "p", "r", "phi"))):  # fmt: skip
        assert min(flown.channels[n].r2 or 0.0 for n in names) > 0.995
    assert {row.verdict for row in found.evidence} == {"pass"}


def test_maneuver_holds_out(demo_files: Path, tmp_path: Path) -> None:
    small = project(demo_files, tmp_path / "p", held_out=False)
    words = ("--json", "-", "--draws", 0)
    named = alula("validate", small.path, "--maneuver", "second", *words)
    result = Validated.model_validate(named.envelope["result"])
    assert [m.id for m in result.maneuvers] == ["second"]
    assert result.maneuvers[0].seen_by_estimate == "no"
    assert "second" not in result.model.source
    none = Validated.model_validate(alula("validate", small.path, *words).envelope["result"])
    assert {m.seen_by_estimate for m in none.maneuvers} == {"yes"}
    assert len(none.maneuvers) == 3
    assert_refused(alula("validate", small.path, "--maneuver", "x", *words), "unknown_maneuver")


def test_a_model_that_does_not_fly_like_it_ends_with_one(
    whole: SmallProject, tmp_path: Path
) -> None:
    file = tmp_path / "model.toml"
    assert alula("identify", whole.path, "--model", file, "--quiet").code == 0
    lines = [
        '"Cm_de" = -4.0' if line.startswith('"Cm_de"') else line
        for line in file.read_text().splitlines()
    ]
    file.write_text("\n".join(lines))
    ran = alula("validate", whole.path, "--model", file, "--json", "-")
    found = Validated.model_validate(checked(ran, "validation", "check_failed").result)
    assert ran.code == 1
    assert "fail" in {row.verdict for row in found.evidence}


def test_text_names_channels_requirements_and_outcome(whole: SmallProject, tmp_path: Path) -> None:
    report = tmp_path / "r.html"
    ran = alula("validate", whole.path, "--report", report, "--trim", "entry", "--horizon", 6)
    assert ran.code in (0, 1)
    for words in (
        "Theil U",
        "2.c.10",
        "14 CFR Part 60",
        "requirements met",
        "6 s flown",
        str(report),
    ):
        assert words in ran.out
    assert 'id="flown-1"' in report.read_text()


def test_bad_input_writes_nothing(whole: SmallProject, tmp_path: Path) -> None:
    before = contents(whole.folder)
    report = tmp_path / "r.html"
    for words, code in (
        (("--model", tmp_path / "none.toml"), "file_not_readable"),
        (("--horizon", "-1"), "bad_option"),
        (
            ("--model", Path(__file__).parents[2] / "aircraft" / "citation2_aero.toml"),
            "other_reference",
        ),
    ):
        ran = alula("validate", whole.path, "--json", "-", "--report", report, *words)
        assert_refused(ran, code)
        assert not report.exists()
    assert contents(whole.folder) == before


def test_same_seed_same_result(whole: SmallProject, held: Ran) -> None:
    again = alula("validate", whole.path, "--json", "-", "--seed", 5)
    assert timeless(again.envelope) == timeless(held.envelope)


def test_flights_of_the_model_are_identified_again(whole: SmallProject, tmp_path: Path) -> None:
    report = tmp_path / "report.html"
    ran = alula(
        "validate", whole.path, "--reidentify", 10, "--draws", 0, "--json", "-", "--report", report
    )
    found = Validated.model_validate(checked(ran, "validation", "ok").result).reidentified
    assert {r.name for r in found} >= {"CL_alpha", "Cm_alpha", "Cm_q", "Cm_de"}
    assert {r.draws for r in found} == {10}
    assert "Identified again" in report.read_text()
    assert_refused(
        alula("validate", whole.path, "--reidentify", 3, "--json", "-"), "bad_option", "10"
    )


@pytest.mark.parametrize(("method", "every", "draws"), [("oe", 1, 10), ("fe", 10, 3)])
def test_readings_of_flights_of_the_model_are_identified_again(
    small: SmallProject,
    monkeypatch: pytest.MonkeyPatch,
    method: str,
    every: int,
    draws: int,
) -> None:
    """Lift and pitch from 8 s of readings; filter error, which is slow, at 10 Hz and only thrice.

    A method that did not see the drawn readings would have no scatter, one that saw others a bias.
    """
    monkeypatch.setattr(sys.modules[reidentify.__module__], "FEWEST", draws)
    small.edit('method = "ee"', f'method = "{method}"')
    small.edit('CD = "1 + alpha"\n', "")
    small.edit("end = 20.0", "end = 8.0")
    small.table = small.table[::every]
    small.write_log()
    with (small.folder / "demo.toml").open("a") as file:
        file.write('\n[identify.options]\nstates = ["q"]\noutputs = ["q", "az"]\n')
        file.write("fixed = {F_q = 1e-3}\n" if method == "fe" else "")  # half the steps
    ran = alula("validate", small.path, "--reidentify", draws, "--draws", 0, "--json", "-")
    found = Validated.model_validate(checked(ran, "validation", "ok").result).reidentified
    assert {r.name for r in found} == {
        f"{c}_{x}" for c in ("CL", "Cm") for x in ("0", "alpha", "q", "de")
    }
    assert not ran.messages("draws_diverged")
    for r in found:
        assert r.draws == draws
        # 3 draws know a mean to 0.6 standard errors and their deviation to 0.07 to 2.6 of it
        assert abs(r.mean - r.truth) < 2.0 * r.stated, r.name
        assert 0.05 * r.stated < r.scatter < 3.0 * r.stated, r.name


def test_a_long_name_of_a_maneuver_stands_apart_from_its_verdict(small: SmallProject) -> None:
    small.edit('id = "longitudinal"\nlog =', 'id = "elevator_at_45_m_s"\nlog =')
    file = Path(__file__).parents[2] / "aircraft" / "sportstar_aero.toml"
    ran = alula("validate", small.path, "--model", file, "--draws", 0)
    rows = [x.split() for x in ran.out.splitlines() if x.startswith("  2.")]
    assert rows
    assert all(row[1] == "elevator_at_45_m_s" for row in rows)
