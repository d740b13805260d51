"""Aircraft files that are wrong: each is refused with file, key, expected and found."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
import scipy.io
from hypothesis import given, settings
from hypothesis import strategies as st

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput, Message
from data import data

GOOD = """schema = "alula.aircraft/1"
name = "test"
assumed = ["mass.Ixz"]
[reference]
S = 10.0
b = 8.0
c = 1.25
[mass]
mass = 500.0
cg = [0.0, 0.0, 0.0]
Ixx = 500.0
Iyy = 600.0
Izz = 1000.0
Ixz = 30.0
[[engines]]
name = "left"
position = [2.0, -1.5, -0.5]
thrust = 1000.0
[controls.de]
sign = "+TED"
limits_deg = [-25.0, 15.0]
"""


def refusal(tmp_path: Path, text: str | bytes) -> tuple[Message, ...]:
    path = tmp_path / "aircraft.toml"
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    with pytest.raises(BadInput) as error:
        load_aircraft(path)
    for message in error.value.messages:
        assert "aircraft.toml" in message.where
        assert message.expected
        assert message.found
        assert message.do
    return error.value.messages


@pytest.mark.parametrize(
    ("old", "new", "where", "words"),
    [
        ("S = 10.0\n", "", "reference.S", "'S'"),
        ("S = 10.0", "S = -10.0", "reference.S", "-10"),
        ("S = 10.0", 'S = "10"', "reference.S", "number"),
        ("S = 10.0", "S = true", "reference.S", "number"),
        ("S = 10.0", "S = nan", "reference.S", "nan"),
        ("S = 10.0", "area = 10.0", "reference.area", "unknown_key"),
        ("[mass]", "[mas]", "mas", "mass"),
        ("cg = [0.0, 0.0, 0.0]", "cg = [0.0, 0.0]", "mass.cg", "3 items"),
        ("cg = [0.0, 0.0, 0.0]", "cg = 0.0", "mass.cg", "list"),
        ("Ixz = 30.0\n", "", "mass", "no Ixz"),
        ("Izz = 1000.0", "Izz = 0.0", "mass.Izz", "greater than 0"),
        ("thrust = 1000.0\n", "", "engines[1]", "both or neither"),
        ("thrust = 1000.0", 'thrust = 1000.0\nchannel = "T"', "engines[1]", "both or neither"),
        ("thrust = 1000.0", "thrust = 1.0\ndirection = [0, 0, 0]", "engines[1]", "all zeros"),
        ("thrust = 1000.0", "thrust = 1.0\nthrust_se = -0.1", "engines[1].thrust_se", "-0.1"),
        ("limits_deg = [-25.0, 15.0]", "limits_deg = [15.0, -25.0]", "controls.de", "lowest"),
        ("aircraft/1", "aircraft/9", "schema", "alula.aircraft/9"),
        ('sign = "+TED"', 'sign = "+DOWN"', "controls.de.sign", "+TED"),
        ('sign = "+TED"', "sign = 1", "controls.de.sign", "string"),
        ('["mass.Ixz"]', '["mass.Ixq"]', "assumed", "mass.Ixq"),
        ('["mass.Ixz"]', '["engines.middle.position"]', "assumed", "middle"),
        ("[controls.de]",
         '[[engines]]\nname = "left"\nposition = [0, 0, 0]\nthrust = 1\n[controls.de]',
         "engines", "2 times"),
        ("[[engines]]", "[mass.fuel]\nmass = 600.0\n[[engines]]", "mass.fuel.mass", "600 kg"),
        ("[[engines]]",
         '[[mass.components]]\nname = "a"\nmass = 1.0\nposition = [0, 0, 0]\n[[engines]]',
         "mass", "components and mass"),
    ],
)  # fmt: skip
def test_each_is_refused_with_its_key(
    tmp_path: Path, old: str, new: str, where: str, words: str
) -> None:
    assert old in GOOD
    messages = refusal(tmp_path, GOOD.replace(old, new, 1))
    assert any(where in m.where and words in f"{m.code} {m}" for m in messages), messages


PROPELLER = """[engines.propeller]
diameter = 1.7
inertia = 0.3
J = [0.0, 0.5, 1.0]
CT = [0.12, 0.08, 0.0]
CP = [0.07, 0.06, 0.02]
"""
PISTON = """[engines.piston]
speed_rpm = [1000.0, 5000.0]
torque = [60.0, 128.0]
"""
ELECTRIC = """[engines.electric]
k_V_rpm = 600.0
I_0 = 1.5
R_motor = 0.03
U_full = 16.8
U_empty = 13.2
capacity_Ah = 10.0
I_max = 60.0
"""
TURBOFAN = """[engines.turbofan]
mach = [0.0, 0.5]
height = [0.0, 10000.0]
idle = [[500.0, 200.0], [100.0, 50.0]]
military = [[9000.0, 3000.0], [8000.0, 2900.0]]
lag = 1.2
"""
TANK = """[[mass.tanks]]
name = "left"
shape = "box"
fuel = 40.0
density = 740.0
center = [0.2, 0.0, 0.2]
size = [0.5, 1.0, 0.12]
"""
PERSON = """[[mass.persons]]
name = "pilot"
mass = 80.0
height = 1.8
position = [0.0, -0.3, 0.0]
"""
MACHINES = {
    "piston": PROPELLER + PISTON,
    "electric": PROPELLER + ELECTRIC,
    "turbofan": TURBOFAN,
}
COMPONENT = """[[mass.components]]
name = "empty"
mass = 300.0
position = [0.0, 0.0, 0.0]
inertia = {Ixx = 400.0, Iyy = 500.0, Izz = 800.0}
"""


def engine_file(kind: str) -> str:
    """The good file with a machine for its engine."""
    return GOOD.replace("thrust = 1000.0\n", f'kind = "{kind}"\n{MACHINES[kind]}')


@pytest.mark.parametrize(
    ("kind", "old", "new", "where", "words"),
    [
        ("piston", PROPELLER, "", "engines[1]", "[engines.propeller] and [engines.piston]"),
        ("piston", 'kind = "piston"', 'kind = "steam"', "engines[1].kind", "turbofan"),
        ("piston", 'kind = "piston"', "thrust = 1.0", "engines[1]", "no machine's table"),
        ("piston", PISTON, PISTON + ELECTRIC, "engines[1]", "propeller, piston, electric"),
        ("piston", "[0.0, 0.5, 1.0]", "[0.0, 1.0, 0.5]", "engines[1].propeller", "increasing"),
        ("piston", "CT = [0.12, 0.08, 0.0]", "CT = [0.12, 0.0]", "engines[1].propeller", "2 of CT"),
        ("piston", "CT = [0.12, 0.08, 0.0]", "CT = [0.1, nan, 0.0]", "propeller.CT[2]", "nan"),
        ("piston", "inertia = 0.3", "inertia = 0.0", "propeller.inertia", "greater than 0"),
        ("piston", "speed_rpm = [1000.0, 5000.0]", f"speed_rpm = {list(map(float, range(25)))}",
         "piston.speed_rpm", "24 items"),
        ("piston", "[60.0, 128.0]", "[60.0]", "piston.torque", "2 items"),
        ("piston", "speed_rpm", "speed", "engines[1].piston", "speed_rpm"),
        ("electric", "R_motor = 0.03", "R_motor = 0.0", "engines[1].electric", "resistance"),
        ("electric", "U_empty = 13.2", "U_empty = 18.0", "engines[1].electric", "16.8 V"),
        ("electric", "capacity_Ah = 10.0", "capacity_Ah = -1.0", "capacity_Ah", "-1"),
        ("turbofan", "[100.0, 50.0]]", "[100.0]]", "turbofan", "2 items"),
        ("turbofan", "mach = [0.0, 0.5]", "mach = [0.0, 0.5, 0.8]", "turbofan", "3 rows of 2"),
        ("turbofan", "lag = 1.2", "lag = 1.2\nmilitary_at = 0.8", "turbofan", "no 'maximum'"),
        ("turbofan", "3000.0]", "inf]", "turbofan.military[1][2]", "inf"),
        ("turbofan", "lag = 1.2", "lag = 0.0", "turbofan.lag", "greater than 0"),
    ],
)  # fmt: skip
def test_machines_are_refused_with_their_key(
    tmp_path: Path, kind: str, old: str, new: str, where: str, words: str
) -> None:
    text = engine_file(kind)
    assert old in text
    messages = refusal(tmp_path, text.replace(old, new, 1))
    assert any(where in m.where and words in f"{m.code} {m}" for m in messages), messages


@pytest.mark.parametrize(
    ("addition", "where", "words"),
    [
        (TANK.replace("fuel = 40.0", "fuel = 60.0"), "tanks.left", "44.4 kg"),
        (TANK + "[mass.fuel]\nmass = 1.0\n", "mass", "'fuel' or 'tanks'"),
        (TANK.replace("size = ", "root = "), "tanks[1]", "valid dictionary"),
        (TANK.replace('"box"', '"wing"'), "tanks[1]", "root, tip for a wing"),
        (TANK.replace('"box"', '"sphere"'), "tanks[1].shape", "'cylinder'"),
        (TANK.replace("0.12]", "0.0]"), "tanks[1]", "positive length"),
        (TANK.replace("740.0", "0.74"), "tanks[1].density", "0.74"),  # kg/l
        (TANK + TANK, "mass", "'left' more than once"),
        (PERSON, "mass", "persons beside components"),
        ("[actuators.de]\ntau = 0.0\n", "actuators.de.tau", "greater than 0"),
        ("[actuators.de]\ntau = 0.1\nrate_limit = 1.0\n", "actuators.de.rate_limit", "deg"),
        ("[actuators.dt]\ntau = 0.1\ndead_band_deg = 1.0\n", "actuators.dt", "dead_band"),
        ("[actuators.flap]\ntau = 0.1\n", "actuators.flap", "'de'"),
        (TANK.replace("fuel = 40.0", "fuel = 600.0").replace("[0.5, 1.0, 0.12]", "[2.0, 2.0, 2.0]"),
         "mass.tanks", "600 kg"),
    ],
)  # fmt: skip
def test_tanks_persons_and_actuators_are_refused_with_their_key(
    tmp_path: Path, addition: str, where: str, words: str
) -> None:
    messages = refusal(tmp_path, GOOD + addition)
    assert any(where in m.where and words in f"{m.code} {m}" for m in messages), messages


def test_persons_of_the_wrong_unit(tmp_path: Path) -> None:
    totals = GOOD[GOOD.index("[mass]") : GOOD.index("[[engines]]")]
    text = GOOD.replace(totals, COMPONENT).replace('["mass.Ixz"]', "[]")
    messages = refusal(tmp_path, text + PERSON.replace("1.8", "180.0"))
    assert any("persons[1].height" in m.where and "180" in m.found for m in messages)


def test_negative_mass_of_a_component(tmp_path: Path) -> None:
    totals = GOOD[GOOD.index("[mass]") : GOOD.index("[[engines]]")]
    text = GOOD.replace(totals, COMPONENT.replace("300.0", "-300.0")).replace('["mass.Ixz"]', "[]")
    (message,) = refusal(tmp_path, text)
    assert "components[1].mass" in message.where


def test_the_good_file_is_good(tmp_path: Path) -> None:
    path = tmp_path / "aircraft.toml"
    path.write_text(GOOD)
    assert load_aircraft(path).messages == ()


def test_all_that_is_wrong_is_said_at_once(tmp_path: Path) -> None:
    text = GOOD.replace("S = 10.0", "S = -1.0").replace("mass = 500.0", 'mass = "heavy"')
    assert len(refusal(tmp_path, text)) == 2


@pytest.mark.parametrize(
    "content",
    [b"", b"\xff\xfe\x00", b"[reference", b"S = 1\nS = 2\n", b"\x00", b"S = " + b"9" * 5000],
)
def test_files_that_are_not_aircraft(tmp_path: Path, content: bytes) -> None:
    refusal(tmp_path, content)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(BadInput, match="No such file"):
        load_aircraft(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("moments", "found"),
    [
        # Ixx + Izz < Iyy
        ("Ixx = 100.0\nIyy = 600.0\nIzz = 200.0\nIxz = 0.0", "100, 200, 600"),
        # moments that add up, but not about the principal axes
        ("Ixx = 500.0\nIyy = 600.0\nIzz = 1000.0\nIxz = 400.0", "278.3, 600, 1221.7"),
        # negative about one axis
        ("Ixx = 500.0\nIyy = 600.0\nIzz = 1000.0\nIxz = 800.0", "-88.153"),
    ],
)
def test_impossible_inertia(tmp_path: Path, moments: str, found: str) -> None:
    old = "Ixx = 500.0\nIyy = 600.0\nIzz = 1000.0\nIxz = 30.0"
    (message,) = refusal(tmp_path, GOOD.replace(old, moments))
    assert message.code == "impossible_inertia"
    assert found in message.found


def test_impossible_inertia_of_a_published_aircraft(tmp_path: Path) -> None:
    """The Skywalker X8's file: principal moments 0.105, 0.170 and 2.005 kg m2."""
    x8 = scipy.io.loadmat(data("parameters", "x8_param.mat"))
    keys = {"S": "S_wing", "b": "b", "c": "c", "mass": "mass"}
    keys |= {"Ixx": "Jx", "Iyy": "Jy", "Izz": "Jz", "Ixz": "Jxz"}
    text = 'schema = "alula.aircraft/1"\nname = "X8"\n[reference]\n'
    for key, theirs in keys.items():
        text += "[mass]\ncg = [0.0, 0.0, 0.0]\n" if key == "mass" else ""
        text += f"{key} = {x8[theirs].item()}\n"
    (message,) = refusal(tmp_path, text)
    assert message.code == "impossible_inertia"
    assert "0.10" in message.found
    assert "0.1702, 2.00" in message.found


def test_impossible_inertia_once_the_fuel_is_gone(tmp_path: Path) -> None:
    """A heavy tank out on the wing takes more inertia along than there was."""
    fuel = "[mass.fuel]\nmass = 300.0\nposition = [0.0, 1.8, 0.0]\n[[engines]]"
    (message,) = refusal(tmp_path, GOOD.replace("[[engines]]", fuel, 1))
    assert "all fuel burned" in message.where


def test_more_fuel_burned_than_was_on_board(tmp_path: Path) -> None:
    path = tmp_path / "aircraft.toml"
    fuel = "[mass.fuel]\nmass = 50.0\n[[engines]]"
    path.write_text(GOOD.replace("[[engines]]", fuel, 1))
    with pytest.raises(BadInput, match="0 to 120 kg"):
        load_aircraft(path).mass_properties(np.array([10.0, 120.0]))


@pytest.mark.parametrize("kind", MACHINES)
def test_the_good_machines_are_good(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "aircraft.toml"
    path.write_text(engine_file(kind) + TANK)
    aircraft = load_aircraft(path)
    assert aircraft.messages == ()
    assert aircraft.engines[0].kind == kind


NUMBERS = ["0", "-1", "1e300", "1e-300", "inf", "nan", '"x"', "[]", "{}", "true", "9" * 400]


@settings(max_examples=400, deadline=None, derandomize=True)
@given(st.data())
def test_damaged_files_are_loaded_or_refused(draw: st.DataObject) -> None:
    """Numbers replaced, lines left out, doubled or cut: an aircraft or a message, nothing else."""
    fuel = "[mass.fuel]\nmass = 50.0\n[[engines]]\ndirection = [1.0, 0.0, 0.5]"
    kind = draw.draw(st.sampled_from(["given", *MACHINES]))
    if kind == "given":
        text = GOOD.replace("[[engines]]", fuel, 1)
    else:
        liquid = draw.draw(st.sampled_from(["", 'liquid = "reduced"\n']))
        text = engine_file(kind) + TANK + liquid + "[actuators.de]\ntau = 0.05\n"
    lines = text.splitlines()
    for _ in range(draw.draw(st.integers(1, 3))):
        i = draw.draw(st.integers(0, len(lines) - 1))
        kind = draw.draw(st.sampled_from(["number", "drop", "double", "cut"]))
        if kind == "number":
            new = draw.draw(st.sampled_from(NUMBERS))
            lines[i] = re.sub(r"-?\d+\.\d+", lambda _, new=new: new, lines[i], count=1)
        elif kind == "cut":
            lines[i] = lines[i][: draw.draw(st.integers(0, len(lines[i])))]
        else:
            lines[i : i + 1] = [] if kind == "drop" else [lines[i]] * 2
        if not lines:
            break
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "aircraft.toml"
        path.write_text("\n".join(lines))
        try:
            aircraft = load_aircraft(path)
        except BadInput:
            return
    if aircraft.mass is not None:
        assert np.isfinite(aircraft.mass_properties(np.zeros(1)).inertia).all()
    assert all(np.isfinite(engine.direction).all() for engine in aircraft.engines)
