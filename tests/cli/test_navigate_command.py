"""`alula navigate` as a user calls it, on a flight that the truth is known of."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from alula.simulate.virtual_loading import toml_text
from cli.command import Ran, alula
from simulate.virtual import doublet, plan_tree

SENSORS = {
    **{n: {"sigma": 0.03, "bias_sigma": 0.03} for n in ("ax", "ay", "az")},
    **{n: {"sigma": 0.05, "bias_sigma": 0.05, "unit": "deg/s"} for n in ("p", "q", "r")},
    **{n: {"sigma": 0.1} for n in ("v_north", "v_east", "v_down")},
    "V": {"sigma": 0.2},
    "alpha": {"sigma": 0.1, "unit": "deg"},
    "beta": {"sigma": 0.1, "unit": "deg"},
    "h": {"sigma": 0.3},
}


@pytest.fixture(scope="module")
def flown(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a virtual flight of one maneuver in wind."""
    folder = tmp_path_factory.mktemp("navigate")
    plan = folder / "plan.toml"
    plan.write_text(
        toml_text(
            plan_tree(
                duration=20.0, rate=100.0, wind=[4.0, -3.0, 0.0], sensors=SENSORS,
                maneuvers=[{"id": "roll", "inputs": [doublet("da", 4.0), doublet("dr", 2.0)]}],
            )
        )
    )  # fmt: skip
    assert alula("fly", plan, "--out", folder / "out", "--quiet", "--seed", 3).code == 0
    return folder / "out"


def navigated(flown: Path, *words: object) -> Ran:
    return alula("navigate", flown / "campaign.toml", *words)


def test_attitude_agrees_with_the_truth(flown: Path) -> None:
    ran = navigated(flown, "--json", "-")
    assert ran.code == 0, ran.err
    assert ran.envelope["schema"] == "alula.navigation/1"
    (log,) = ran.envelope["result"]["logs"]
    (file,) = (flown / "truth").glob("*.parquet")
    truth = pd.read_parquet(file).iloc[-1]
    last = log["last"]
    for i, name in enumerate(("phi", "theta", "psi")):
        off = last["attitude_deg"][i] - np.degrees(truth[name])
        # four of its standard errors; the first heading is the recorded one, within 0.1 rad
        assert abs((off + 180.0) % 360.0 - 180.0) < 4.0 * last["attitude_se_deg"][i]
        assert last["attitude_se_deg"][i] < 3.0
    for found, true, se in zip(last["wind"], (4.0, -3.0, 0.0), last["wind_se"], strict=True):
        assert abs(found - true) < 4.0 * se
    sensors = {s["kind"]: s for s in log["sensors"]}
    assert set(sensors) == {"velocity", "height", "V", "alpha", "beta"}
    assert sensors["velocity"]["nis"] == pytest.approx(1.0, abs=0.15)  # 2001 of 3: se 0.02
    assert log["attitude_difference_deg"]["phi"] < 1.0


def test_report(flown: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    ran = navigated(flown, "--report", page)
    assert ran.code == 0
    assert "estimate minus recorded" in ran.out
    text = page.read_text()
    assert "Navigation: attitude and wind" in text
    assert "Innovations of velocity" in text


def test_a_wrong_sign_is_named(flown: Path, tmp_path: Path) -> None:
    project = flown / "wrong.toml"
    text = (flown / "campaign.toml").read_text()
    turned = text.replace("v_north = {from", "v_north = {sign = -1, from", 1)
    assert turned != text
    project.write_text(turned)
    ran = alula("navigate", project, "--json", "-")
    assert ran.code == 1
    assert ran.envelope["status"] == "check_failed"
    # straight ahead a wind of twice the airspeed would explain it
    assert ran.messages("sensor_refused") or ran.messages("implausible_wind")


def test_bad_input(flown: Path) -> None:
    ran = navigated(flown, "--log", "nothing", "--json", "-")
    assert ran.code == 2
    assert ran.messages("unknown_log")
    ran = navigated(flown, "--filter", "pair", "--json", "-")
    assert ran.code == 2
    assert ran.messages("missing_field")


def without(flown: Path, *channels: str) -> Path:
    """The project with channels not mapped."""
    lines = (flown / "campaign.toml").read_text().splitlines()
    kept = [line for line in lines if not line.startswith(tuple(f"{c} = {{from" for c in channels))]
    assert len(kept) == len(lines) - len(channels)
    project = flown / f"without_{'_'.join(channels)}.toml"
    project.write_text("\n".join(kept))
    return project


def test_without_satellites_it_says_what_to_doubt(flown: Path) -> None:
    ran = alula("navigate", without(flown, "v_north", "v_east", "v_down"), "--json", "-")
    (said,) = ran.messages("no_satellites")
    assert said["level"] == "warning"
    assert "v_north" in said["expected"]


def test_an_airspeed_that_is_never_usable_is_no_success(flown: Path) -> None:
    text = (flown / "campaign.toml").read_text()
    row = next(line for line in text.splitlines() if line.startswith("V = {from"))
    project = flown / "slow.toml"
    project.write_text(text.replace(row, 'V = {constant = 0.0, unit = "m/s"}'))
    ran = alula("navigate", project, "--json", "-")
    assert ran.code == 1, ran.err
    (said,) = ran.messages("sensor_not_usable")
    assert "V" in said["where"]


def test_only_the_logs_asked_for_are_in_the_report(flown: Path, tmp_path: Path) -> None:
    text = (flown / "campaign.toml").read_text()
    block = text[text.index("[[logs]]") :].split("\n\n")[0]
    id = block.split('id = "')[1].split('"')[0]
    project = flown / "two.toml"
    other = block.replace(f'id = "{id}"', 'id = "second_log"')
    project.write_text(text.replace(block, f"{block}\n\n{other}", 1))
    page = tmp_path / "page.html"
    for words, there in (((), True), (("--log", id), False)):
        assert alula("navigate", project, *words, "--report", page).code == 0
        assert ("second_log" in page.read_text()) is there


def test_a_log_that_is_not_asked_for_is_not_read(flown: Path) -> None:
    text = (flown / "campaign.toml").read_text()
    block = text[text.index("[[logs]]") :].split("\n\n")[0]
    id = block.split('id = "')[1].split('"')[0]
    lost = '[[logs]]\nid = "lost"\npath = "nowhere.csv"'
    project = flown / "lost.toml"
    project.write_text(text.replace(block, f"{lost}\n\n{block}", 1))
    assert alula("navigate", project, "--json", "-").code == 2
    ran = alula("navigate", project, "--log", id, "--json", "-")
    assert ran.code == 0, ran.err
    assert [log["log"] for log in ran.envelope["result"]["logs"]] == [id]
    assert len(ran.envelope["inputs"]) == 1
