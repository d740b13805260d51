"""Engines, propellers and actuators as the file states them, in SI and Alula's notation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import (
    Aircraft,
    ElectricMotor,
    PistonEngine,
    Turbofan,
    load_aircraft,
)

HEAD = """schema = "alula.aircraft/1"
name = "engines"
aero = "models/aero.toml"
[reference]
S = 10.0
b = 8.0
c = 1.25
"""
PROPELLER = """[engines.propeller]
diameter = 1.7
inertia = 0.3
sense = "{}"
J = [0.0, 0.5, 1.0]
CT = [0.12, 0.08, 0.0]
CP = [0.07, 0.06, 0.02]
"""
PISTON = (
    """[[engines]]
name = "nose"
kind = "piston"
position = [1.6, 0.0, -0.05]
"""
    + PROPELLER.format("left")
    + """[engines.piston]
reduction = 2.43
gear = "opposite"
crank_inertia = 0.05
speed_rpm = [1000.0, 5000.0, 6000.0]
torque = [60.0, 128.0, 110.0]
friction = 10.0
idle = 0.1
consumption_g_kWh = 285.0
"""
)
ELECTRIC = (
    """[[engines]]
name = "motor"
kind = "electric"
position = [-0.3, 0.0, 0.0]
"""
    + PROPELLER.format("right")
    + """[engines.electric]
k_V_rpm = 600.0
I_0 = 1.5
R_motor = 0.03
U_full = 16.8
U_empty = 13.2
capacity_Ah = 10.0
I_max = 60.0
"""
)
TURBOFAN = """[[engines]]
name = "fan"
kind = "turbofan"
position = [-2.0, 1.0, -0.5]
[engines.turbofan]
mach = [0.0, 0.5, 0.9]
height = [0.0, 10000.0]
idle = [[500.0, 200.0], [100.0, 50.0], [-100.0, -50.0]]
military = [[9000.0, 3000.0], [8000.0, 2900.0], [8500.0, 3200.0]]
lag = 1.2
angular_momentum = -150.0
consumption_kg_N_h = 0.06
"""
ACTUATORS = """[controls.de]
sign = "+TEU"
limits_deg = [-25.0, 15.0]
[actuators.de]
tau = 0.05
rate_limit_deg_s = 60.0
dead_band_deg = 0.2
[actuators.dr]
tau = 0.1
[actuators.dt]
tau = 0.5
rate_limit = 0.8
"""


def load(tmp_path: Path, text: str) -> Aircraft:
    path = tmp_path / "aircraft.toml"
    path.write_text(text)
    return load_aircraft(path)


def test_piston_engine_in_si(tmp_path: Path) -> None:
    (engine,) = load(tmp_path, HEAD + PISTON).engines
    machine = engine.machine
    assert engine.kind == "piston"
    assert engine.channel is None
    assert isinstance(machine, PistonEngine)
    assert machine.propeller.sense == -1.0
    assert machine.gear_sense == -1.0
    # 5000 revolutions per minute are 83.3 per second.
    assert machine.omega[1] == pytest.approx(2.0 * np.pi * 5000.0 / 60.0)
    # 285 g for one kW for one hour, 3.6 MJ.
    assert machine.consumption * 3.6e6 == pytest.approx(0.285)
    np.testing.assert_array_equal(machine.propeller.CT, [0.12, 0.08, 0.0])
    assert (machine.reduction, machine.friction, machine.idle) == (2.43, 10.0, 0.1)


def test_motor_constants_are_each_others_inverse(tmp_path: Path) -> None:
    """Where only k_V is stated: a volt second per radian is a newton meter per ampere."""
    (engine,) = load(tmp_path, HEAD + ELECTRIC).engines
    machine = engine.machine
    assert engine.kind == "electric"
    assert isinstance(machine, ElectricMotor)
    assert machine.k_V == pytest.approx(62.83, abs=0.01)  # 600 rpm
    assert machine.k_T * machine.k_V == pytest.approx(1.0)
    assert machine.capacity == 36000.0
    assert (machine.propeller.sense, machine.I_regen) == (1.0, 0.0)


def test_turbofan_tables_are_mach_by_height(tmp_path: Path) -> None:
    (engine,) = load(tmp_path, HEAD + TURBOFAN).engines
    machine = engine.machine
    assert engine.kind == "turbofan"
    assert isinstance(machine, Turbofan)
    assert machine.military.shape == (3, 2)
    assert machine.military[1, 0] == 8000.0
    assert machine.maximum is None
    assert machine.military_at == 1.0
    assert machine.consumption == pytest.approx(0.06 / 3600.0)
    burner = TURBOFAN + "maximum = [[15e3, 5e3], [15e3, 5e3], [16e3, 6e3]]\nmilitary_at = 0.77\n"
    machine = load(tmp_path, HEAD + burner).engines[0].machine
    assert isinstance(machine, Turbofan)
    assert machine.maximum is not None
    assert machine.military_at == 0.77


def test_given_thrust_is_shared_alike(tmp_path: Path) -> None:
    text = HEAD + "".join(
        f'[[engines]]\nname = "{n}"\nposition = [0.0, {y}, 0.0]\nchannel = "T{n}"\n'
        for n, y in (("left", -1.0), ("right", 1.0))
    )
    engines = load(tmp_path, text).engines
    assert [e.kind for e in engines] == ["given", "given"]
    assert sum(e.share for e in engines) == 1.0


def test_a_machine_may_keep_its_channel(tmp_path: Path) -> None:
    """The log's thrust serves identification, the machine simulation."""
    text = HEAD + PISTON.replace("position", 'channel = "thrust"\nposition', 1)
    aircraft = load(tmp_path, text)
    assert aircraft.engines[0].channel == "thrust"
    assert aircraft.engines[0].kind == "piston"
    assert "piston, thrust by channel 'thrust'" in aircraft.summary()["Engine nose"]
    simulated = load(tmp_path, HEAD + PISTON).summary()["Engine nose"]
    assert simulated.startswith("piston, simulated, at")


def test_actuators_are_in_radians_with_the_controls_limits(tmp_path: Path) -> None:
    actuators = load(tmp_path, HEAD + ACTUATORS).actuators
    de, dr, dt = actuators["de"], actuators["dr"], actuators["dt"]
    assert np.degrees([de.low, de.high]) == pytest.approx([-15.0, 25.0])  # '+TEU' turns them
    assert np.degrees([de.rate_limit, de.dead_band]) == pytest.approx([60.0, 0.2])
    assert (dr.rate_limit, dr.low, dr.high, dr.dead_band) == (np.inf, -np.inf, np.inf, 0.0)
    assert (dt.tau, dt.rate_limit) == (0.5, 0.8)


def test_the_model_is_found_from_the_files_folder(tmp_path: Path) -> None:
    assert load(tmp_path, HEAD).aero == str(tmp_path / "models" / "aero.toml")
    assert load(tmp_path, HEAD.replace('aero = "models/aero.toml"\n', "")).aero is None


def test_figures_that_make_energy_are_noticed(tmp_path: Path) -> None:
    (message,) = load(tmp_path, HEAD + PISTON.replace("0.06, 0.02]", "0.03, 0.02]")).messages
    assert message.code == "propeller_efficiency"  # J CT/CP = 0.5 * 0.08/0.03
    (message,) = load(tmp_path, HEAD + ELECTRIC + "k_T = 0.03\n").messages
    assert message.code == "motor_constants"


@pytest.mark.parametrize("word", ["mass.persons", "mass.tanks", "piston", "electric", "turbofan",
                                  "actuators"])  # fmt: skip
def test_documented_examples_load(tmp_path: Path, word: str) -> None:
    page = (Path(__file__).parents[2] / "docs" / "aircraft_file.md").read_text()
    blocks = [block.split("```")[0] for block in page.split("```toml\n")[1:]]
    (example,) = [
        b for b in blocks if f"[{word}" in b or f"[engines.{word}]" in b or f"[[{word}" in b
    ]
    empty = """[[mass.components]]
name = "empty"
mass = 300.0
position = [1.0, 0.0, 0.0]
inertia = {Ixx = 400.0, Iyy = 500.0, Izz = 800.0}
"""
    assert (
        load(tmp_path, HEAD + (empty if word.startswith("mass") else "") + example).messages == ()
    )
