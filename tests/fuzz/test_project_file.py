"""The project file damaged: a Project or a BadInput, never anything else."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from alula.base.messages import BadInput
from alula.base.project import Project, load_project
from alula.logs import read_all

TEXT = """schema = "alula.project/1"
name = "x"
[[logs]]
id = "a"
path = "log.csv"
[channels]
t = {from = 1, unit = "s"}
da = {from = [29, "x"], weights = [0.5, -0.5], unit = "deg"}
V = {from = "p", table = [[0, 0], [100, 20]], unit = "m/s", time = {from = 3}}
[[maneuvers]]
id = "m"
log = "a"
start = 1
end = 2.5
[reconstruct.imu]
ax = {sigma = 0.1, unit = "g"}
[identify.options]
lags = 20
"""
# Values that TOML allows and that a reader may not expect.
VALUES = (
    "1e999", "-1", "0", "nan", "inf", "true", '""', "[]", "{}", "1979-05-27", "07:32:00",
    "1" + "0" * 400, "[[[]]]", '"\\u0000"', '"~nobody/x"', '"${HOME"', '"${NO_SUCH_VARIABLE}"',
    '"' + "x" * 3000 + '"', "{from = {from = 1}}", "[1, 'a', {}]", "0x7fffffffffffffff",
)  # fmt: skip


def outcome(folder: Path, text: str) -> None:
    path = folder / "project.toml"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    try:
        project = load_project(path)
    except BadInput as error:
        if not all(m.where and m.expected and m.do for m in error.messages):
            raise  # a message without its parts
        return
    assert isinstance(project, Project)
    with pytest.raises(BadInput):  # there is no such log
        read_all(project)


@settings(
    max_examples=150,
    deadline=None,
    derandomize=True,  # the same examples in every run
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(
    st.integers(0, len(TEXT) - 1),
    st.integers(0, 30),
    st.one_of(st.sampled_from(VALUES), st.text(max_size=20)),
)
def test_damaged_text(tmp_path: Path, at: int, removed: int, put: str) -> None:
    outcome(tmp_path, TEXT[:at] + put + TEXT[at + removed :])


@pytest.mark.parametrize("value", VALUES)
def test_every_value_in_every_place(tmp_path: Path, value: str) -> None:
    lines = TEXT.splitlines()
    for i, line in enumerate(lines):
        if "=" in line:
            outcome(
                tmp_path, "\n".join([*lines[:i], f"{line.split('=')[0]}= {value}", *lines[i + 1 :]])
            )
    for key in ("from = 1,", "0.5", "100", "0.1", '"deg"', '"g"', "from = 3"):
        name = "from = " if key.startswith("from") else ""
        outcome(tmp_path, TEXT.replace(key, name + value + ("," if key[-1] == "," else ""), 1))


def test_the_whole_text_is_a_project(tmp_path: Path) -> None:
    """The positive control."""
    (tmp_path / "project.toml").write_text(TEXT)
    assert load_project(tmp_path / "project.toml").name == "x"
