"""The project file: what it says, and what is said about mistakes in it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest

from alula.base.messages import BadInput
from alula.base.project import Project, load_project

GOOD = """
schema = "alula.project/1"
name = "Test"
aircraft = "test.toml"
[[logs]]
id = "one"
path = "${ALULA_TEST_LOGS}/one.csv"
fill_values = [-9999]
[[logs]]
id = "two"
path = "two.npz"
[logs.channels]
alpha = {from = "aoa", unit = "rad"}
[channels]
t = {from = 1, unit = "ms"}
alpha = {from = "ALCG", unit = "deg", delay_s = 0.02}
da = {from = [29, 28], weights = [0.5, -0.5], unit = "deg"}
V = {from = "pitot", table = [[0, 0], [100, 20]], unit = "m/s", time = {from = "t2", unit = "s"}}
df = {constant = 0, unit = "deg"}
[[maneuvers]]
id = "elevator"
log = "one"
start = 0
end = 25.5
configuration = {flaps = "0"}
[reconstruct]
filter = "ukf"
[reconstruct.imu]
q = {sigma = 0.1, unit = "deg/s"}
[reconstruct.unknowns]
b_az = {state = "walk", prior = 0.02, unit = "g", walk = 1e-4}
[reconstruct.sensors]
alpha = {sigma = 0.1, unit = "deg"}
[identify.models]
Cm = "1 + alpha + qhat + de"
[identify.options]
lags = 20
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("ALULA_TEST_LOGS", "/logs")
    return tmp_path


def load(folder: Path, text: str) -> Project:
    path = folder / "project.toml"
    path.write_text(text, encoding="utf-8")
    return load_project(path)


def errors(folder: Path, text: str) -> list[tuple[str, str, str, str]]:
    """(code, key with line, expected, found) of every message; the file is named in each."""
    with pytest.raises(BadInput) as caught:
        load(folder, text)
    start = f"{folder / 'project.toml'}: "
    assert all(m.where.startswith(start[:-2]) and m.do for m in caught.value.messages)
    return [
        (m.code, m.where.removeprefix(start), m.expected, m.found) for m in caught.value.messages
    ]


def test_a_good_project(folder: Path) -> None:
    project = load(folder, GOOD)
    assert project.logs[0].path == Path("/logs/one.csv")
    assert project.logs[1].path == folder / "two.npz"
    assert project.aircraft == folder / "test.toml"
    assert project.sha256 == hashlib.sha256((folder / "project.toml").read_bytes()).hexdigest()
    assert project.path == (folder / "project.toml").resolve()
    assert project.channels_of(project.log("two"))["alpha"].sources == ("aoa",)
    assert project.channels_of(project.log("one"))["alpha"].delay_s == 0.02
    assert project.channels["da"].sources == (29, 28)
    assert project.reconstruct.imu["q"].sigma_si == pytest.approx(0.1 * 3.14159265 / 180)
    assert project.reconstruct.unknowns["b_az"].in_si(0.02) == pytest.approx(0.196133)
    assert project.maneuvers[0].on_gap == "refuse"


def test_schema_is_json_and_closed() -> None:
    schema = json.loads(json.dumps(Project.model_json_schema()))
    assert schema["additionalProperties"] is False
    assert "logs" in schema["required"]
    assert "from" in schema["$defs"]["ChannelSpec"]["properties"]


@pytest.mark.parametrize(
    ("change", "code", "where", "expected"),
    [
        (('name = "Test"', ""), "missing_key", "name", "the key 'name'"),
        (("sigma = 0.1", "sgima = 0.1"), "missing_key", "reconstruct.imu.q.sigma", "'sigma'"),
        (("fill_values", "fil_values"), "unknown_key", "logs[1].fil_values, line 8", "known"),
        (('"ukf"', '"kalman"'), "bad_value", "reconstruct.filter, line", "'ekf'"),
        (('start = 0', 'start = "0"'), "bad_value", "maneuvers[1].start", "number"),
        (("end = 25.5", "end = -1"), "bad_value", "maneuvers[1]", "'end' after 'start'"),
        (("weights = [0.5, -0.5]", "weights = [1]"), "bad_value", "channels.da", "one weight"),
        (("{constant = 0", '{from = 1, constant = 0'), "bad_value", "channels.df", "either"),
        (("[[0, 0], [100, 20]]", "[[0, 0], [0, 20]]"), "bad_value", "channels.V", "increasing"),
        (("from = 1,", "from = 0,"), "bad_value", "channels.t", "greater than or equal to 1"),
        (('unit = "ms"', 'unit = "msecs"'), "unknown_unit", "channels.t.unit", "a unit"),
        (('log = "one"', 'log = "three"'), "unknown_log", "maneuvers[1].log", "one of one, two"),
        (('id = "two"', 'id = "one"'), "duplicate_id", "logs", "each id once"),
        (("alula.project/1", "alula.project/9"), "bad_value", "schema, line 2", "project/1"),
        (("ALULA_TEST_LOGS", "ALULA_NO_SUCH"), "variable_not_set", "logs[1].path", "ALULA_NO"),
        (("time = {from = \"t2\", unit = \"s\"}", 'time = "t9"'), "unknown_time_channel",
         "channels.V.time", "t, alpha"),
        (("lags = 20", "lags = nan"), "bad_value", "identify.options.lags", "finite"),
    ],
)  # fmt: skip
def test_mistakes_are_named(
    folder: Path, change: tuple[str, str], code: str, where: str, expected: str
) -> None:
    found = errors(folder, GOOD.replace(*change))
    hits = [f for f in found if f[0] == code and where in f[1] and expected in f[2]]
    assert hits, found


def test_misspelt_keys_get_a_suggestion(folder: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load(folder, GOOD.replace("[[maneuvers]]", "[[manoeuvres]]"))
    assert any("Did you mean 'maneuvers'?" in m.do for m in caught.value.messages)


def test_all_mistakes_at_once(folder: Path) -> None:
    text = GOOD.replace('"ukf"', '"kalman"').replace("sigma = 0.1", "sigma = -1")
    assert len(errors(folder, text)) == 3  # filter, imu.q.sigma, sensors.alpha.sigma


@pytest.mark.parametrize("text", ["[[logs", "name = Test", "\udcff", "a = 1\na = 2"])
def test_not_toml(folder: Path, text: str) -> None:
    path = folder / "project.toml"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(BadInput) as caught:
        load_project(path)
    assert caught.value.messages[0].code == "not_toml"


def test_no_such_file(folder: Path) -> None:
    with pytest.raises(BadInput) as caught:
        load_project(folder / "none.toml")
    assert caught.value.messages[0].code == "file_not_readable"


def test_the_documented_example_is_a_project(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOGS", "/logs")
    text = (Path(__file__).parents[2] / "docs" / "project_file.md").read_text(encoding="utf-8")
    project = load(folder, text.split("```toml\n")[1].split("```")[0])
    assert project.maneuvers[0].id == "elevator"
