"""`alula compare`: results and models as columns, judged on what none of them saw."""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from alula.campaign.compare import run_comparison
from alula.cli.compare_output import text_of
from cli.command import SmallProject, alula, assert_refused, small_project


@dataclass
class Results:
    """A project with one maneuver held out; equation and output error of the other, as files."""

    project: SmallProject
    ee: Path
    oe: Path
    model: Path


@pytest.fixture(scope="module")
def made(demo_files: Path, tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("compare")
    project = small_project(demo_files, folder / "project")
    project.edit("end = 20.0", "end = 11.0")
    project.add_maneuver("later", 11.5, 20.0, "held_out = true")
    out = Results(project, folder / "ee.json", folder / "oe.json", folder / "model.toml")
    ran = alula("identify", project.path, "--json", out.ee, "--model", out.model, "--quiet")
    assert ran.code == 0, ran.err
    ran = alula("identify", project.path, "--method", "oe", "--json", out.oe, "--quiet")
    assert ran.code == 0, ran.err
    return out


def compared(*words: object) -> dict[str, Any]:
    ran = alula("compare", *words, "--json", "-")
    assert ran.code == 0, ran.err
    assert ran.envelope["schema"] == "alula.comparison/1"
    result = ran.envelope["result"]
    assert isinstance(result, dict)
    return result


def test_methods_side_by_side(made: Results) -> None:
    result = compared(made.ee, made.oe)
    assert [c["method"] for c in result["columns"]] == ["equation error", "output error"]
    assert [c["name"] for c in result["columns"]] == ["ee", "oe"]
    sources = [json.loads(p.read_text())["result"]["parameters"] for p in (made.ee, made.oe)]
    by_name = [{p["name"]: p for p in every} for every in sources]
    for row in result["parameters"]:
        if row["entries"][0] is None:
            assert "(0)[" in row["name"]  # only output error has initial states
            continue
        first, second = row["entries"]
        a, b = by_name[0][row["name"]], by_name[1][row["name"]]
        assert (first["value"], second["value"]) == (a["value"], b["value"])
        assert first["ratio"] == 1.0
        assert first["sigmas"] == 0.0
        assert second["ratio"] == pytest.approx(b["value"] / a["value"])
        assert second["sigmas"] == pytest.approx(
            (b["value"] - a["value"]) / math.hypot(a["se"], b["se"])
        )
        assert abs(second["sigmas"]) < 4.0  # the same flight: they agree
    assert result["judged"] == {}


def test_screen_has_every_shared_parameter(made: Results) -> None:
    ran = alula("compare", made.ee, made.oe)
    assert ran.code == 0
    for name in ("CD_alpha", "CL_q", "Cm_de", "initial states"):
        assert name in ran.out
    assert "q(0)[" not in ran.out


@pytest.mark.parametrize("width", [80, 100, 160])
def test_many_sources_fit_the_width(made: Results, width: int) -> None:
    """Blocks of columns, each against the first; every number stands there whatever the width."""
    found = run_comparison([made.ee, made.oe, made.model, made.ee, made.model])
    lines = text_of(found, width).splitlines()
    assert max(map(len, lines)) <= width
    head = [line for line in lines if line.startswith("parameter")]
    assert all("value (1)" in line for line in head)
    assert [n for line in head for n in re.findall(r"value \((\d)\)", line) if n != "1"] == [
        "2", "3", "4", "5",
    ]  # fmt: skip
    for row in found.rows:
        if row.differences[0] is None:
            assert "(0)[" in row.name  # output error's alone
            continue
        mine = [line for line in lines if line.split(" ")[0] == row.name.split(" ")[0]]
        assert len(mine) >= len(head)
    # 95 % intervals need 97 letters beside the first column
    assert any("is left out" in line for line in lines) is (width < 97)


def test_baseline_is_judged_on_the_same_maneuvers(made: Results, tmp_path: Path) -> None:
    """van den Hoek's Table 8: an older model beside the identified one, on what neither saw."""
    text = made.model.read_text()
    value = next(line for line in text.splitlines() if line.startswith('"Cm_alpha" = '))
    old = tmp_path / "old.toml"
    old.write_text(text.replace(value, '"Cm_alpha" = -0.6'))  # 40 % too stable
    result = compared(made.ee, made.model, old, "--project", made.project.path)
    assert [m["id"] for m in result["maneuvers"]] == ["later"]
    assert [m["seen_by_estimate"] for m in result["maneuvers"]] == [["no", "no", "no"]]
    assert set(result["judged"]) == {"CD", "CL", "Cm"}
    fit = json.loads(made.ee.read_text())["result"]["fit"]
    for name, row in result["judged"].items():
        ours, file, _ = row["entries"]
        assert row["n"] == fit[name]["n_held_out"]
        assert ours["r2"] == pytest.approx(fit[name]["r2_held_out"], abs=1e-9)  # as identify says
        assert file["r2"] == pytest.approx(ours["r2"], abs=1e-9)  # the same model, from its file
    cm = result["judged"]["Cm"]["entries"]
    assert cm[2]["r2"] < cm[0]["r2"] - 0.01
    assert cm[2]["rrmse"] > 1.5 * cm[0]["rrmse"]
    assert result["judged"]["CL"]["entries"][2] == result["judged"]["CL"]["entries"][1]


def test_output_error_is_judged_by_its_formulas(made: Results) -> None:
    result = compared(made.ee, made.oe, "--project", made.project.path)
    for row in result["judged"].values():
        ours, other = row["entries"]
        assert other["r2"] == pytest.approx(ours["r2"], abs=0.02)  # two estimates of one flight


def test_terms_that_were_not_estimated_count_in_the_judgment(made: Results, tmp_path: Path) -> None:
    """Fixed where output error found it, a derivative changes nothing; tied, hardly anything."""
    found = {p["name"]: p["value"] for p in json.loads(made.oe.read_text())["result"]["parameters"]}
    folder = tmp_path / "held"
    folder.mkdir()
    for file in made.project.folder.iterdir():
        (folder / file.name).write_bytes(file.read_bytes())
    project = folder / made.project.path.name
    factor = found["CL_de"] / found["Cm_de"]
    project.write_text(
        made.project.path.read_text()
        + f"[identify.options]\nfixed = {{Cm_q = {found['Cm_q']!r}}}\n"
        + f'tied = {{CL_de = "{factor!r}*Cm_de"}}\n'
    )
    held = tmp_path / "held.json"
    ran = alula("identify", project, "--method", "oe", "--json", held, "--quiet")
    assert ran.code == 0, ran.err
    written = json.loads(held.read_text())["result"]
    assert written["fixed"] == {"Cm_q": found["Cm_q"]}
    assert written["tied"]["CL_de"]["name"] == "Cm_de"
    judged = compared(made.oe, held, "--project", made.project.path)["judged"]
    for coefficient in ("CL", "Cm"):
        ours, other = judged[coefficient]["entries"]
        # the same estimate but for two freedoms; without its term Cm would be far off
        assert other["r2"] == pytest.approx(ours["r2"], abs=1e-4)


def test_maneuvers_that_a_result_learned_from_are_named(made: Results, tmp_path: Path) -> None:
    project = tmp_path / "demo.toml"
    for file in made.project.folder.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    project.write_text(made.project.path.read_text().replace("held_out = true", ""))
    ran = alula("compare", made.ee, made.model, "--project", project, "--json", "-")
    assert ran.code == 0
    assert ran.messages("no_held_out_maneuver")
    assert ran.messages("seen_by_estimate")
    seen = {m["id"]: m["seen_by_estimate"] for m in ran.envelope["result"]["maneuvers"]}
    assert seen == {"longitudinal": ["yes", "yes"], "later": ["no", "no"]}


def changed(made: Results, path: Path, name: str, **values: Any) -> Path:
    tree = json.loads(made.ee.read_text())
    for p in tree["result"]["parameters"]:
        if p["name"] == name:
            p.update(values)
    path.write_text(json.dumps(tree))
    return path


def test_limit_ends_in_one(made: Results, tmp_path: Path) -> None:
    off = changed(made, tmp_path / "off.json", "Cm_q", value=-30.0)
    assert alula("compare", made.ee, off).code == 0
    ran = alula("compare", made.ee, off, "--limit", "5", "--json", "-")
    assert ran.code == 1
    assert ran.envelope["status"] == "check_failed"
    assert "Cm_q" in ran.messages("results_differ")[0]["found"]
    assert alula("compare", made.ee, made.ee, "--limit", "0.001").code == 0


def test_what_is_not_identifiable_ends_in_one(made: Results, tmp_path: Path) -> None:
    lost = changed(
        made, tmp_path / "lost.json", "Cm_q", value=None, se=None, verdict="not_identifiable"
    )
    ran = alula("compare", made.ee, lost, "--json", "-")
    assert ran.code == 1
    assert ran.envelope["status"] == "not_identifiable"
    (row,) = [r for r in ran.envelope["result"]["parameters"] if r["name"] == "Cm_q"]
    assert row["entries"][1]["value"] is None
    assert row["entries"][1]["sigmas"] is None


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("{", "not_a_result"),
        ("{}", "not_a_result"),
        ('{"schema": "alula.check/1"}', "not_a_result"),
        (
            '{"schema": "alula.identification/1", "status": "bad_input", "result": {}}',
            "not_a_result",
        ),
        ('{"schema": "alula.identification/1", "result": []}', "not_a_result"),
        (
            '{"schema": "alula.identification/1", "result": {"method": "ee", "status": "",'
            ' "parameters": [{"name": "Cm_q", "value": "many"}]}}',
            "not_a_result",
        ),
        ("{" + '"a":[' * 100_000, "not_a_result"),
        ("not = [a model", None),
        ("\x00\x01\x02", None),
        ("", None),
    ],
)
def test_other_files_are_refused(
    made: Results, tmp_path: Path, text: str, code: str | None
) -> None:
    path = tmp_path / "odd.json"
    path.write_text(text)
    ran = alula("compare", made.ee, path, "--json", "-")
    if code is None:  # read as a model: its own message
        assert ran.code == 2
        assert "Traceback" not in ran.err
        assert ran.envelope["status"] == "bad_input"
    else:
        assert_refused(ran, code, "odd.json")


def test_missing_file_and_single_file_are_refused(made: Results, tmp_path: Path) -> None:
    assert_refused(alula("compare", made.ee, tmp_path / "none", "--json", "-"), "unreadable_file")
    assert_refused(alula("compare", made.ee, tmp_path, "--json", "-"), "unreadable_file")
    assert_refused(alula("compare", made.ee, "--json", "-"), "too_few_results")


def test_names_that_repeat_are_told_apart(made: Results, tmp_path: Path) -> None:
    (tmp_path / "ee.json").write_bytes(made.ee.read_bytes())
    names = [c["name"] for c in compared(made.ee, tmp_path / "ee.json", made.ee)["columns"]]
    assert len(set(names)) == 3
