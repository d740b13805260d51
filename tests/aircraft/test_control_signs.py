"""Sign codes, and whether a recorded control contradicts a real aircraft's motion."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.io

from alula.aircraft import control_sign_check, load_aircraft, sign_factor
from alula.base.arrays import Array
from alula.base.messages import BadInput
from data import data

DEG = np.pi / 180.0
HOUSE = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("control", "code", "factor"),
    [
        ("de", "+TED", 1.0),
        ("de", "+TEU", -1.0),
        ("de", "-TED", -1.0),
        ("de", "+ANU", -1.0),  # a positive reading pitches up: trailing edge up
        ("stabilizer", "+LEU", 1.0),  # leading edge up is trailing edge down
        ("dr", "+TEL", 1.0),
        ("dr", "+ANR", -1.0),  # nose right needs the trailing edge right
        ("da", "+RTED", 1.0),
        ("da", "+LTED", -1.0),
        ("da", "+RWD", -1.0),  # right wing down needs the right trailing edge up
        ("da_left", "+TED", 1.0),
        ("df", "+TED", 1.0),
        ("dt", "+AFT", -1.0),
        ("dr", " +ter ", -1.0),
    ],
)
def test_sign_codes(control: str, code: str, factor: float) -> None:
    assert sign_factor(control, code) == factor


@pytest.mark.parametrize(
    ("control", "code"), [("de", "+TEL"), ("dr", "+TED"), ("da", "+TED"), ("de", "TED"), ("de", "")]
)
def test_codes_that_say_nothing_about_the_control(control: str, code: str) -> None:
    with pytest.raises(BadInput) as error:
        sign_factor(control, code)
    assert error.value.messages[0].code == "control_sign_code"


def attas(name: str) -> dict[str, Array]:
    x = scipy.io.loadmat(data("attas", f"fAttas{name}.mat"))[f"fAttas{name}"].T * DEG
    names = {"p": 6, "q": 7, "r": 8, "alpha": 12, "beta": 13, "de": 21, "dr": 29}
    names |= {"pdot": 16, "qdot": 17, "rdot": 18}
    return {n: x[i] for n, i in names.items()} | {"da": 0.5 * (x[28] - x[27])}


@pytest.mark.parametrize(("maneuver", "moved"), [("Elv1", "de"), ("Ail1", "da"), ("Rud1", "dr")])
@pytest.mark.parametrize("accelerations", [True, False])
def test_attas_flipped_control_is_named_and_the_right_one_is_not(
    maneuver: str, moved: str, accelerations: bool
) -> None:
    motion = attas(maneuver)
    if not accelerations:
        motion = {name: x for name, x in motion.items() if not name.endswith("dot")}
    assert control_sign_check(motion, 0.04) == []
    for control in ("de", "da", "dr"):
        messages = control_sign_check(motion | {control: -motion[control]}, 0.04)
        # A control that hardly moved in this maneuver cannot be judged by it.
        assert [m.where for m in messages] == ([f"channel '{moved}'"] if control == moved else [])


def test_citation_rudder_reads_trailing_edge_right() -> None:
    """The rudder doublet of a flight without sideslip: the example's aircraft file has it right."""
    flight = np.load(data("citation_ph_lab", "flight.npz"))
    window = (flight["time"] >= 3716.0) & (flight["time"] <= 3736.0)
    names = {"p": "Ahrs1_bRollRate", "r": "Ahrs1_bYawRate", "dr": "delta_r", "da": "delta_a"}
    motion = {name: flight[key][window] * DEG for name, key in names.items()}
    (message,) = control_sign_check(motion, 0.1)
    assert message.where == "channel 'dr'"
    assert message.level == "warning"
    sign = load_aircraft(HOUSE / "aircraft/citation.toml").control_sign("dr")
    assert control_sign_check(motion | {"dr": sign * motion["dr"]}, 0.1) == []


def test_noise_contradicts_nothing() -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        walk = np.cumsum(rng.normal(size=(4, 500)), axis=1) * 0.01  # as coloured as noise can be
        motion = dict(zip(("qdot", "q", "alpha", "de"), walk, strict=True))
        if np.corrcoef(motion["qdot"], motion["de"])[0, 1] < 0.0:
            assert control_sign_check(motion, 0.02) == []


def test_constant_control_and_gaps_do_not_disturb() -> None:
    motion = attas("Elv1")
    assert control_sign_check(motion | {"de": np.full_like(motion["de"], 0.1)}, 0.04) == []
    holes = motion | {"de": np.where(np.arange(len(motion["de"])) % 7, -motion["de"], np.nan)}
    assert [m.code for m in control_sign_check(holes, 0.04)] == ["control_sign"]
    assert control_sign_check({"de": np.full(600, np.nan), "q": motion["q"][:600]}, 0.04) == []
