"""`alula export`: what it writes, what it says, what it refuses."""

from __future__ import annotations

from pathlib import Path

import pytest

from alula.model import load_model
from cli.command import Ran, alula, process
from data import data
from export.consumer import need_jsbsim

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
MODEL = AIRCRAFT / "sportstar_aero.toml"


def export(*words: object) -> tuple[int, dict]:
    """Exit code and envelope."""
    return ended(alula("export", *words, "--json", "-"))


def ended(ran: Ran) -> tuple[int, dict]:
    """Exit code and envelope of a command that did not fall over."""
    assert "Traceback" not in ran.err
    return ran.code, ran.envelope


def test_jsbsim(tmp_path: Path) -> None:
    need_jsbsim()
    words = (MODEL, "--aircraft", AIRCRAFT / "sportstar.toml", "--to", "jsbsim", "--out", tmp_path)
    code, said = ended(process("export", *words, "--json", "-"))  # as a user starts it
    assert (code, said["status"], said["schema"]) == (0, "ok", "alula.export/1")
    (file,) = said["result"]["files"]
    assert "written by Alula" in Path(file).read_text()
    flown = {c["with"]: c["difference"] for c in said["result"]["compared"]}
    assert set(flown) == {"elevator doublet", "rudder doublet"}
    assert all(d["V"] < 0.2 and d["theta"] < 0.00175 for d in flown.values())
    assert [Path(f["path"]).name for f in said["inputs"]] == [MODEL.name, "sportstar.toml"]
    code, said = export(*words)  # its own file is replaced
    assert code == 0
    Path(file).write_text("<fdm_config name='mine'/>")
    code, said = export(*words)
    assert (code, said["messages"][0]["code"]) == (2, "output_not_writable")
    assert Path(file).read_text() == "<fdm_config name='mine'/>"


def test_daveml_out_and_in(tmp_path: Path) -> None:
    code, said = export(MODEL, "--to", "daveml", "--out", tmp_path / "m.dml")
    assert code == 0
    assert [m["code"] for m in said["messages"]] == ["stall_left_out"]
    assert max(said["result"]["compared"][0]["difference"].values()) < 1e-12
    code, said = export(tmp_path / "m.dml", "--to", "model", "--out", tmp_path / "m.toml")
    assert code == 0
    assert load_model(tmp_path / "m.toml").params == load_model(MODEL).params


def test_f16_becomes_a_model_file(tmp_path: Path) -> None:
    source = data("nesc_6dof", "models", "F16_aero.dml")
    code, said = export(source, "--to", "model", "--out", tmp_path / "f16.toml")
    assert code == 0
    assert [m["code"] for m in said["messages"]] == ["daveml_limit"]
    assert len(load_model(tmp_path / "f16.toml").tables) == 18


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><DAVEfunc>&x;</DAVEfunc>',
         "unsafe_xml"),
        ("<DAVEfunc/>", "daveml_reference"),
        ("not XML", "not_xml"),
    ],
)  # fmt: skip
def test_bad_files_end_in_a_message(tmp_path: Path, text: str, code: str) -> None:
    (tmp_path / "in.dml").write_text(text)
    found, said = export(tmp_path / "in.dml", "--to", "model", "--out", tmp_path / "out.toml")
    assert (found, said["status"], said["messages"][0]["code"]) == (2, "bad_input", code)
    assert not (tmp_path / "out.toml").exists()


def test_jsbsim_wants_the_aircraft(tmp_path: Path) -> None:
    code, said = export(MODEL, "--to", "jsbsim", "--out", tmp_path)
    assert (code, said["messages"][0]["code"]) == (2, "no_aircraft")
    assert list(tmp_path.iterdir()) == []


def test_another_file_is_not_replaced(tmp_path: Path) -> None:
    log = tmp_path / "flight.csv"
    log.write_text("t,V\n0,1\n")
    for form in ("daveml", "model"):
        code, said = export(MODEL, "--to", form, "--out", log)
        assert (code, said["messages"][0]["code"]) == (2, "output_not_writable")
    assert log.read_text() == "t,V\n0,1\n"
