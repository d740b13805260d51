"""`alula propeller`: table, JSON, picture, exit codes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.predict.propeller_momentum import momentum_propeller
from cli.command import alula, assert_refused
from predict.propellers import PARAMETERS, blades, toml

MOMENTUM = {"c_l_alpha": 5.2, "alpha_max_deg": 14.32, "c_d_alpha": 1.1, "pitch": 0.3}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "p.toml"
    path.write_text(toml(momentum=MOMENTUM))
    return path


def with_test(path: Path, J: np.ndarray) -> None:
    curve = momentum_propeller(blades(), J, PARAMETERS)
    columns = {"J": J, "CT": curve.CT, "CP": curve.CP}
    lines = [f"{name} = {[float(x) for x in values]}" for name, values in columns.items()]
    path.write_text(toml() + "[test]\n" + "\n".join(lines) + "\n")


def test_both_models_in_table_and_json(file: Path) -> None:
    ran = alula("propeller", file, "--rpm", 5000, "--json", "-")
    assert ran.code == 0, ran.err
    result = ran.envelope["result"]
    assert ran.envelope["schema"] == "alula.propeller/1"
    assert [m["name"] for m in result["models"]] == ["momentum disk", "blade elements"]
    for model in result["models"]:
        assert model["J"][0] == 0.0
        assert model["J"][-1] < model["windmill_J"]
        assert all(np.diff(model["CT"]) < 0.0)
        assert len(model["eta"]) == len(model["CP"]) == len(model["J"])
    text = alula("propeller", file, "--J", "0,0.3", "--rpm", 5000).out
    assert "blade elements" in text
    assert f"{result['models'][0]['CT'][0]:.5f}" in text


def test_a_test_is_fitted_and_drawn(file: Path, tmp_path: Path) -> None:
    with_test(file, np.linspace(0.0, 0.5, 15))
    for name in ("a.png", "a.svg"):
        picture = tmp_path / name
        ran = alula("propeller", file, "--rpm", 5000, "--json", "-", "--plot", picture)
        assert ran.code == 0, ran.err
        assert picture.stat().st_size > 5000
    (fit,) = ran.envelope["result"]["fits"]
    values = {p["name"]: p for p in fit["parameters"]}
    assert values["pitch"]["value"] == pytest.approx(0.3, rel=1e-3)
    assert all(p["verdict"] == "ok" for p in values.values())
    # a picture of its own is replaced, another file is not
    assert alula("propeller", file, "--rpm", 5000, "--plot", picture).code == 0
    log = tmp_path / "log.png"
    log.write_text("t,V\n" * 900)
    ran = alula("propeller", file, "--plot", log, "--json", "-")
    assert_refused(ran, "output_not_writable", "another kind of file")
    assert log.read_text().startswith("t,V")


def test_a_test_at_rest_ends_with_one(file: Path) -> None:
    with_test(file, np.zeros(3))
    ran = alula("propeller", file, "--rpm", 5000, "--json", "-")
    assert ran.code == 1
    assert ran.envelope["status"] == "not_identifiable"
    (fit,) = ran.envelope["result"]["fits"]
    lost = [p for p in fit["parameters"] if p["verdict"] == "not_identifiable"]
    assert lost
    assert all(p["se"] is None for p in lost)
    assert [m["name"] for m in ran.envelope["result"]["models"]] == ["blade elements"]


@pytest.mark.parametrize("J", ["-0.1", "0.1,2", "0.1,9"])
def test_reverse_and_windmill_give_no_number(file: Path, J: str) -> None:
    ran = alula("propeller", file, f"--J={J}", "--rpm", 5000, "--json", "-")
    assert_refused(ran, "outside_propeller_model")


def test_bad_words_are_refused(file: Path, tmp_path: Path) -> None:
    assert_refused(alula("propeller", file, "--J", "a", "--json", "-"), "bad_advance_ratio")
    for words, code in (
        (("--plot", tmp_path / "a.jpg"), "picture_format"),
        (("--diameter", 1.0), "bad_option"),
        (("--rpm", -5), "outside_propeller_model"),
        (("--fit-below", 0.1, "--test", tmp_path / "none.txt"), "file_not_readable"),
    ):
        assert_refused(alula("propeller", file, *words, "--json", "-"), code)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"r": [0.04, 0.127, 0.08, 0.18, 0.23, 0.254]}, "increasing"),
        ({"chord": [0.026, 0.0, 0.04, 0.034, 0.023, 0.01]}, "station 2"),
        ({"polar": {"c_l_alpha": float("nan")}}, "finite"),
    ],
)
def test_blades_that_are_none_are_refused(tmp_path: Path, change, word) -> None:
    path = tmp_path / "p.toml"
    path.write_text(toml(**change))
    assert_refused(alula("propeller", path, "--json", "-"), "bad_value", word)


def test_an_assumed_polar_is_said(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_text(toml(polar=None))
    ran = alula("propeller", path, "--json", "-")
    assert ran.code == 0
    assert ran.messages("assumed_polar")
    assert ran.messages("assumed_rpm")


def test_the_page(file: Path, tmp_path: Path) -> None:
    with_test(file, np.linspace(0.0, 0.5, 15))
    page = tmp_path / "page.html"
    ran = alula("propeller", file, "--rpm", 5000, "--fit-below", 0.4, "--report", page)
    assert ran.code == 0, ran.err
    assert f"Report: {page}" in ran.out
    text = page.read_text()
    assert "Fitted to the test" in text
    assert "<script" not in text
    assert text.count('class="left"') == 3 * 3  # J of 0.43, 0.46 and 0.5, in three pictures
    assert f"{PARAMETERS.c_l_alpha:g}" in text
    assert page.read_bytes() == alula_page(file, tmp_path).read_bytes()


def alula_page(file: Path, folder: Path) -> Path:
    """The same page once more."""
    page = folder / "again.html"
    words = ("--rpm", 5000, "--fit-below", 0.4, "--report", page)
    assert alula("propeller", file, *words).code == 0
    return page


def test_beyond_thrust_there_is_no_efficiency(file: Path) -> None:
    out = alula("propeller", file, "--rpm", 5000).out
    rows = [line.split() for line in out.splitlines() if len(line.split()) == 4]
    braking = [row for row in rows if row[1].startswith("-")]
    assert braking
    assert all(row[3] == "-" for row in braking)
