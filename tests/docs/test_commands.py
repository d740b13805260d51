"""What the pages tell people to type is typed here, on a copy of the demo's logs."""

from __future__ import annotations

import contextlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path
from unittest import mock

import pytest

from cli.command import Ran, alula, process

ROOT = Path(__file__).resolve().parents[2]


def blocks(page: str, language: str) -> list[str]:
    """The fenced blocks of one language, in order."""
    found = re.findall(r"^```(\w*)\n(.*?)^```$", (ROOT / page).read_text(), re.S | re.M)
    return [block for name, block in found if name == language]


def test_readme_commands_exist() -> None:
    """`make` targets are in the Makefile; every option shown is one of its command's."""
    makefile = (ROOT / "Makefile").read_text()
    lines = [line.split("#")[0] for b in blocks("README.md", "sh") for line in b.splitlines()]
    targets = [line.split()[1] for line in lines if line.startswith("make ")]
    assert targets == ["demo", "test"]
    for target in targets:
        assert re.search(rf"^{target}:", makefile, re.M)
    commands = [line.split() for line in lines if line.startswith("alula ")]
    assert {words[1] for words in commands} == {
        "new", "check", "identify", "modes", "plan", "fly", "validate", "export",
        "predict", "compare", "calibrate", "airdata", "navigate",
    }  # fmt: skip
    for words in commands:
        said = options_of(words[1])
        assert said.issuperset(word for word in words if word.startswith("--"))


def test_readme_prediction_is_what_compare_prints() -> None:
    """The excerpt's values and ratios, to a unit in the last digit but one."""
    (shown,) = [b.splitlines() for b in blocks("README.md", "") if b.lstrip().startswith("value")]
    (command,) = [
        line.split("#")[0].split()
        for b in blocks("README.md", "sh")
        for line in b.splitlines()
        if line.startswith("alula compare")
    ]
    done = process(*command[1:], cwd=ROOT)
    assert done.code == 0, done.err
    printed = {line[:19].strip(): line[19:].split() for line in done.out.splitlines()}
    for line in shown[1:]:
        now = printed[line[:19].strip()]
        for old, new in zip(line[19:].split(), now, strict=True):
            if old[-1].isdigit():
                assert float(new) == pytest.approx(float(old), rel=0.01, abs=0.011)
            else:
                assert old == new


def test_real_projects_named_in_the_readme_load() -> None:
    from alula.base.project import load_project

    named = re.findall(r"examples/real/\w+\.toml", (ROOT / "README.md").read_text())
    assert named
    for path in named:
        load_project(ROOT / path)


def test_tutorial(tmp_path: Path) -> None:
    """Every command, every edit, in order; it ends as the page says."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    text = (ROOT / "docs/tutorial.md").read_text()
    project = tmp_path / "tutorial" / "flight.toml"
    steps = re.findall(r"^```(sh|toml|diff)\n(.*?)^```", text, re.S | re.M)
    assert {language for language, _ in steps} == {"sh", "toml", "diff"}
    for language, block in steps:
        if language == "sh":
            for line in block.splitlines():
                if not line.startswith("source "):
                    done = run(line.split(), tmp_path)
                    assert done.code == 0, done.err
        elif language == "diff":
            apply(block, project)
        elif "# confirm" in block:
            assert block.strip() in project.read_text()  # quoted from the file, not an edit
        else:
            project.write_text(project.read_text() + "\n" + block)
    result = json.loads((tmp_path / "tutorial/result.json").read_text())
    found = {p["name"]: p for p in result["result"]["parameters"]}
    for name in ("Cm_q", "Cl_p"):
        low, high = found[name]["ci95"]
        assert low < found[name]["truth"] < high
        assert f"{found[name]['truth']:g}" in text
    assert result["result"]["fit"]["Cm"]["n_held_out"] > 0
    page = (ROOT / "docs/command_line.md").read_text()
    for key in keys(result):
        assert re.search(rf"\b{key}\b", page), f"the page does not explain '{key}'"
    for name in ("report.html", "model.toml"):
        assert (tmp_path / "tutorial" / name).stat().st_size > 0


def test_flying_tutorial(tmp_path: Path) -> None:
    """Every command, every edit, in order; each ends with the code that the page says."""
    (tmp_path / "aircraft").symlink_to(ROOT / "aircraft")
    text = (ROOT / "docs/tutorial_flying.md").read_text()
    steps = re.findall(r"^```(sh|toml)\n(.*?)^```", text, re.S | re.M)
    used = []
    for language, block in steps:
        if language == "toml":
            plan = tmp_path / "plan.toml"
            plan.write_text(plan.read_text() + "\n" + block)
            continue
        for line in block.splitlines():
            if line.startswith("source "):
                continue
            words = line.split()
            used.append(words[1])
            done = run(words, tmp_path)
            # the page says that the plan will not tell one parameter, and which
            assert done.code == (1 if words[1] == "plan" else 0), done.out + done.err
            if words[1] == "plan":
                (lost,) = [x for x in done.out.splitlines() if x.endswith("not told")]
                assert f"`{lost.split()[0]}`" in text
    assert used == ["modes", "plan", "fly", "identify", "validate", "export"]
    result = json.loads((tmp_path / "result.json").read_text())
    found = {p["name"]: p for p in result["result"]["parameters"]}
    for name in ("Cm_alpha", "Cl_p"):
        low, high = found[name]["ci95"]
        assert low < found[name]["truth"] < high
        assert f"{found[name]['truth']:g}" in text
    for name in ("modes.svg", "report.html", "validation.html", "identified.dml"):
        assert (tmp_path / name).stat().st_size > 0


def test_python_page(tmp_path: Path, monkeypatch) -> None:
    """Its blocks run in order, in a folder with the demo's logs."""
    monkeypatch.setenv("MPLBACKEND", "Agg")
    done = run(["python", str(ROOT / "examples/demo/make_logs.py"), str(tmp_path), "1"], ROOT)
    assert done.code == 0, done.err
    code = blocks("docs/python.md", "python")
    assert len(code) > 5
    script = tmp_path / "page.py"
    script.write_text("\n".join(code))
    done = run(["python", "page.py"], tmp_path)
    assert done.code == 0, done.err
    assert (tmp_path / "demo.html").exists()


@pytest.mark.parametrize(
    "command",
    [
        "new",
        "check",
        "identify",
        "compare",
        "plan",
        "fly",
        "validate",
        "navigate",
        "calibrate",
        "export",
        "trim",
        "linearize",
        "modes",
        "schema",
    ],
)
def test_every_option_is_on_the_page(command: str) -> None:
    page = (ROOT / "docs/command_line.md").read_text()
    options = options_of(command) - {"--help", "--output"}
    assert options
    for option in options:
        assert f"`{option}" in page


BY_NAME = (
    "mismatch",
    "formulas",
    "maneuvers",
    "versions",
    "timing_s",
)  # whose keys name sensors and the like


def keys(value: object) -> set[str]:
    """The names of all fields of an envelope."""
    if isinstance(value, list):
        return {key for item in value for key in keys(item)}
    if not isinstance(value, dict):
        return set()
    out = set()
    for name, inner in value.items():
        out.add(name)
        if name == "fit":  # by coefficient
            out |= keys(list(inner.values()))
        elif name not in BY_NAME:
            out |= keys(inner)
    return out


def apply(block: str, file: Path) -> None:
    """A page's edit: each '-' line begins one line of the file, which becomes the '+' line."""
    lines = block.splitlines()
    for old, new in zip(lines[::2], lines[1::2], strict=True):
        assert (old[:2], new[:2]) == ("- ", "+ ")
        text = file.read_text().splitlines()
        (where,) = [i for i, line in enumerate(text) if line.startswith(old[2:])]
        text[where] = new[2:]
        file.write_text("\n".join(text) + "\n")


def options_of(command: str) -> set[str]:
    """What `alula COMMAND --help` names, from the entry point in this process."""
    said = alula(command, "--help")
    assert said.code == 0
    return set(re.findall(r"--[A-Za-z][A-Za-z-]*", said.out))


def run(words: list[str], folder: Path) -> Ran:
    """One command in a folder, by this Python's environment: `python` by a process of its own,
    `alula` by its entry point in this one. The demo and `compare` of the README start it for real.
    """
    wide = {"COLUMNS": "200", "NO_COLOR": "1"}
    if words[0] == "alula":
        with contextlib.chdir(folder), mock.patch.dict(os.environ, wide):
            return alula(*words[1:])
    assert words[0] == "python"
    return started([sys.executable, *words[1:]], folder, wide)


def started(words: list[str], folder: Path, more: dict[str, str]) -> Ran:
    done = subprocess.run(
        words,
        cwd=folder,
        env={**os.environ, **more},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return Ran(done.returncode, done.stdout, done.stderr)
