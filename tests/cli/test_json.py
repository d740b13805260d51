"""The JSON contract: one envelope for every command, in success and in failure."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from pydantic import BaseModel, ConfigDict, Field

from alula.base.filters import FILTERS, FilterName
from alula.base.messages import warn
from alula.cli.contract import Command, finite
from cli.command import Ran, SmallProject, alula, process


class Strict(BaseModel):
    """A key too many is as wrong as one that is missing."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


class Said(Strict):
    code: str = Field(pattern=r"^[a-z][a-z0-9_]*$")
    level: Literal["info", "warning", "error"]
    where: str = Field(min_length=1)
    expected: str = Field(min_length=1)
    found: str = Field(min_length=1)
    do: str = Field(min_length=1)


class Input(Strict):
    path: str
    sha256: str = Field(pattern=r"^[0-9a-f]{64}$")
    bytes: int = Field(ge=0)
    decoded: int = Field(ge=0)
    skipped: int = Field(ge=0)
    unknown: int = Field(ge=0)


class Provenance(Strict):
    alula: str = Field(pattern=r"^\d+\.\d+")
    commit: str | None
    isa: str = Field(min_length=1)
    seed: int | None
    versions: dict[str, str]


class Envelope(Strict):
    schema_: str = Field(alias="schema", pattern=r"^alula\.[a-z]+/1$")
    status: Literal["ok", "not_identifiable", "check_failed", "bad_input"]
    messages: list[Said]
    inputs: list[Input]
    result: dict[str, Any]
    provenance: Provenance
    timing_s: dict[str, float]


class Tie(Strict):
    name: str
    weight: float


class Parameter(Strict):
    name: str
    coefficient: str
    value: float | None
    se_white: float | None
    se: float | None
    ci95: list[float | None] = Field(min_length=2, max_length=2)
    verdict: Literal["ok", "weak", "not_identifiable"]
    tied_to: list[Tie]
    unit: str
    vif: float | None
    truth: float = 0.0
    means: str = ""


class Fit(Strict):
    formula: str
    r2: float | None
    rrmse: float | None
    n: int = Field(ge=1)
    n_held_out: int = Field(ge=0)
    r2_held_out: float | None
    diagnostics: str | None = None


class Bias(Strict):
    name: str
    value: float
    se: float
    unit: str
    observable: bool


class Nis(Strict):
    mean: float | None
    lo: float | None
    hi: float | None


class Path_(Strict):
    method: FilterName
    status: str
    biases: list[Bias]
    nis: Nis
    mismatch: dict[str, float]
    maneuvers: dict[str, dict[str, float]]


class Parted(Strict):
    learned: list[str]
    held_out: list[str]


class Lengths(Strict):
    S: float = Field(gt=0.0)
    b: float = Field(gt=0.0)
    c: float = Field(gt=0.0)


class Factor(Strict):
    name: str
    factor: float


class Identified(Strict):
    method: str
    status: str
    uncertainty: str = Field(min_length=1)
    reference: Lengths
    reference_point: list[float] = Field(min_length=3, max_length=3)
    fixed: dict[str, float]
    tied: dict[str, Factor]
    formulas: dict[str, str]
    maneuvers: Parted
    parameters: list[Parameter]
    fit: dict[str, Fit]
    reconstruction: Path_


def checked(ran: Ran, schema: str, status: str) -> Envelope:
    """The envelope of a command that ended as it should, validated."""
    found = Envelope.model_validate(ran.envelope)
    assert found.schema_ == f"alula.{schema}/1"
    assert found.status == status
    assert ran.code == {"ok": 0, "not_identifiable": 1, "check_failed": 1, "bad_input": 2}[status]
    for file in found.inputs:
        assert file.decoded + file.skipped + file.unknown == file.bytes == size(file.path)
    assert found.timing_s["total"] > 0.0
    return found


def size(path: str) -> int:
    return Path(path).stat().st_size


@pytest.mark.parametrize("filter", FILTERS)
def test_identify(sound: SmallProject, filter: str) -> None:
    ran = sound.identify("--filter", filter, "--truth", sound.folder / "truth.json", "--seed", 3)
    found = checked(ran, "identification", ran.envelope["status"])
    assert found.status != "bad_input"
    result = Identified.model_validate(found.result)
    assert result.reconstruction.method == filter
    assert set(result.fit) == {"CD", "CL", "Cm"}
    assert {p.coefficient for p in result.parameters} == set(result.fit)
    assert all(p.truth for p in result.parameters)
    assert [Path(f.path).name for f in found.inputs] == ["longitudinal.csv"]
    assert found.provenance.seed == 3
    assert {"python", "platform", "numpy", "scipy"} <= set(found.provenance.versions)
    assert {"read", "reconstruct", "identify", "total"} == set(found.timing_s)


def test_mismatch_is_in_degrees_where_its_name_says_so(sound: SmallProject) -> None:
    """The demo's sensors have noise of 0.1 deg and 0.2 m/s; see its make_logs.py."""
    path = Identified.model_validate(sound.identify().envelope["result"]).reconstruction
    # rms of 2001 samples of white noise scatters by 1.6 %; the motion's own error is smaller
    assert path.mismatch["alpha_deg"] == pytest.approx(0.1, rel=0.1)
    assert path.mismatch["theta_deg"] == pytest.approx(0.1, rel=0.1)
    assert path.mismatch["V"] == pytest.approx(0.2, rel=0.1)
    assert path.maneuvers["longitudinal"] == pytest.approx(path.mismatch)


def test_check(sound: SmallProject) -> None:
    found = checked(sound.check(), "check", "ok")
    (card,) = found.result["logs"]
    assert card["log"] == "longitudinal"
    assert len(card["channels"]) == len(sound.header) - 1  # all but time


@pytest.mark.parametrize("kind", ["project", "aircraft", "calibration"])
def test_schema(kind: str) -> None:
    found = checked(alula("schema", kind, "--json", "-"), "schema", "ok")
    assert found.result["type"] == "object"
    assert json.loads(alula("schema", kind).out) == found.result


def test_new(sound: SmallProject, tmp_path: Path) -> None:
    made = tmp_path / "made.toml"
    found = checked(alula("new", sound.log, "-o", made, "--json", "-"), "new", "ok")
    assert found.result == {"project": str(made)}
    assert made.exists()


@pytest.mark.parametrize("command", ["check", "identify", "new"])
def test_failure(command: str, tmp_path: Path) -> None:
    schema = {"identify": "identification"}.get(command, command)
    found = checked(alula(command, tmp_path / "none", "--json", "-"), schema, "bad_input")
    assert found.result == {}
    assert "error" in {m.level for m in found.messages}


@pytest.mark.parametrize(
    "words", [["identify"], ["nonsense"], ["check", "a", "b"], ["identify", "--filter", "kf", "a"]]
)
def test_command_line_that_cannot_be_read(words: list[str]) -> None:
    for asked in (["--json", "-"], ["--json=-"]):
        found = checked(alula(*words, *asked), "usage", "bad_input")
        assert found.messages[0].found


def test_stdout_of_the_real_command_is_json_alone(sound: SmallProject) -> None:
    """Progress, warnings and libraries speak on stderr; the parser sees all of stdout."""
    words = ("--json", "-", "--report", sound.folder / "r.html", "--threads", 1)
    ran = process("identify", sound.path, *words)
    (sound.folder / "r.html").unlink()
    assert Identified.model_validate(checked(ran, "identification", "ok").result)
    assert "reading logs" in ran.err
    failed = process("identify", sound.folder, "--json", "-")
    checked(failed, "identification", "bad_input")


def test_file_holds_what_stdout_would(sound: SmallProject, tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    ran = alula("identify", sound.path, "--json", path)
    assert ran.code == 0
    assert "Identification by equation error" in ran.out  # text is for people then
    assert timeless(json.loads(path.read_text())) == timeless(sound.identify().envelope)
    assert [p.name for p in tmp_path.iterdir()] == ["out.json"]  # no temporary file is left


def test_file_of_a_failure(sound: SmallProject, tmp_path: Path) -> None:
    path = tmp_path / "out.json"
    ran = alula("identify", tmp_path / "none.toml", "--json", path)
    assert ran.code == 2
    assert json.loads(path.read_text())["status"] == "bad_input"


def test_same_input_and_seed_same_result(sound: SmallProject) -> None:
    first, second = (timeless(sound.identify("--seed", 7).envelope) for _ in range(2))
    assert first == second


def timeless(envelope: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in envelope.items() if key != "timing_s"}


def test_threads_do_not_change_the_result(sound: SmallProject) -> None:
    one = process("identify", sound.path, "--json", "-", "--threads", 1)
    two = process("identify", sound.path, "--json", "-", "--threads", 2)
    assert one.code == two.code == 0
    values = [[p["value"] for p in ran.envelope["result"]["parameters"]] for ran in (one, two)]
    np.testing.assert_allclose(*values, rtol=1e-9)  # sums of 2001 samples in another order


def test_quiet_has_no_progress_and_no_notes(small: SmallProject) -> None:
    loud = alula("check", small.path)
    assert "reading logs" in loud.err
    assert "note:" in loud.out
    quiet = alula("check", small.path, "--quiet")
    assert quiet.code == 0
    assert quiet.err == ""
    assert "note:" not in quiet.out
    assert "longitudinal.csv" in quiet.out
    small.column("dr_deg")[:] = 0.0
    small.write_log()
    ran = alula("check", small.path, "--quiet")
    assert ran.err.count("[constant_channel]") == 1  # a warning is no note
    assert "[constant_channel]" not in ran.out  # and is said once
    small.log.unlink()
    assert "[file_not_readable]" in alula("check", small.path, "--quiet").err


def test_numbers_that_are_none(small: SmallProject) -> None:
    """What is not finite is null, and a message says where."""
    small.column("de_deg")[:] = 1.5
    small.write_log()
    ran = small.identify()
    found = checked(ran, "identification", "not_identifiable")
    result = Identified.model_validate(found.result)
    lost = next(p for p in result.parameters if p.name == "Cm_de")
    assert lost.value is None
    assert lost.ci95 == [None, None]
    (message,) = ran.messages("non_finite")
    assert "result.parameters[" in message["where"]
    assert message["level"] == "info"


def test_finite_names_each_place() -> None:
    lost: list[str] = []
    value = {"a": [1.0, math.nan, {"b": -math.inf}], "c": (np.float64(np.inf), 2), "d": "nan"}
    assert finite(value, "result", lost) == {
        "a": [1.0, None, {"b": None}],
        "c": [None, 2],
        "d": "nan",
    }
    assert lost == ["result.a[1]", "result.a[2].b", "result.c[0]"]


def test_statuses_and_exit_codes(capsys: pytest.CaptureFixture[str]) -> None:
    import typer

    said = warn("code", where="here", expected="this", found="that", do="Mend it.")
    for status, code in (("ok", 0), ("not_identifiable", 1), ("check_failed", 1)):
        command = Command("check", "-", messages=(said,))
        with pytest.raises(typer.Exit) as end, command.run():
            command.status = status  # type: ignore[assignment]
        assert end.value.exit_code == code
        out, err = capsys.readouterr()
        assert json.loads(out)["status"] == status
        assert err == "warning: here: expected this, found that. Mend it. [code]\n"
