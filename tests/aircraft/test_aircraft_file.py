"""The aircraft file: frames, sensors, engines, signs, limits."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, aircraft_schema, load_aircraft
from alula.base.messages import BadInput

HEAD = """schema = "alula.aircraft/1"
name = "test"
assumed = ["mass.Ixz", "engines.left.position"]
"""
BODY = """
[reference]
S = 10.0
b = 8.0
c = 1.25
[mass]
mass = 500.0
cg = [0.1, 0.0, -0.2]
Ixx = 500.0
Iyy = 600.0
Izz = 1000.0
Ixz = 30.0
Ixy = 4.0
[sensors.imu]
position = [0.5, 0.1, 0.2]
[sensors.alpha]
position = [3.0, -1.0, 0.0]
[[engines]]
name = "left"
position = [2.0, -1.5, -0.5]
channel = "thrust_left"
tilt_deg = 2.0
toe_deg = 3.0
thrust_se = 0.05
[[engines]]
name = "right"
position = [2.0, 1.5, -0.5]
direction = [2.0, 0.0, 0.0]
thrust = 1234.0
[controls.de]
sign = "+TEU"
limits_deg = [-25.0, 15.0]
[controls.dt]
sign = "+FWD"
limits = [0.0, 1.0]
[envelope]
V = [30.0, 70.0]
alpha_deg = [-5.0, 12.0]
"""


def load(tmp_path: Path, text: str) -> Aircraft:
    path = tmp_path / "aircraft.toml"
    path.write_text(text)
    return load_aircraft(path)


@pytest.fixture
def aircraft(tmp_path: Path) -> Aircraft:
    return load(tmp_path, HEAD + BODY)


def test_sensors_by_channel_group_and_default(aircraft: Aircraft) -> None:
    np.testing.assert_array_equal(aircraft.sensor_position("az"), [0.5, 0.1, 0.2])
    np.testing.assert_array_equal(aircraft.sensor_position("q"), [0.5, 0.1, 0.2])
    np.testing.assert_array_equal(aircraft.sensor_position("alpha"), [3.0, -1.0, 0.0])
    np.testing.assert_array_equal(aircraft.sensor_position("beta"), [0.1, 0.0, -0.2])  # the CG


def test_engines_have_a_unit_line_of_action(aircraft: Aircraft) -> None:
    left, right = aircraft.engines
    # 2 deg up and 3 deg to the right of the nose: up is -z.
    assert np.degrees(np.arcsin(-left.direction[2])) == pytest.approx(2.0)
    assert np.degrees(np.arctan2(left.direction[1], left.direction[0])) == pytest.approx(3.0)
    assert np.linalg.norm(left.direction) == pytest.approx(1.0)
    np.testing.assert_array_equal(right.direction, [1.0, 0.0, 0.0])
    assert (left.channel, left.thrust, left.thrust_se) == ("thrust_left", None, 0.05)
    assert (right.channel, right.thrust) == (None, 1234.0)


def test_limits_turn_with_the_sign(aircraft: Aircraft) -> None:
    """25 deg down to 15 deg up in a log that counts up as positive: -15 to 25 in Alula's."""
    assert aircraft.control_sign("de") == -1.0
    assert np.degrees(aircraft.control_limits["de"]) == pytest.approx([-15.0, 25.0])
    assert aircraft.control_limits["dt"] == (0.0, 1.0)
    assert aircraft.control_sign("dr") == 1.0
    assert aircraft.envelope.alpha == pytest.approx(np.radians([-5.0, 12.0]))
    assert aircraft.envelope.h is None


def test_design_frame_is_turned_into_body_axes(tmp_path: Path, aircraft: Aircraft) -> None:
    """Negating x and z of every vector, and Ixy, describes the same aircraft as before."""
    text = HEAD + '[datum]\nname = "nose"\nframe = "design"\n' + BODY
    for body, design in (
        ("cg = [0.1, 0.0, -0.2]", "cg = [-0.1, 0.0, 0.2]"),
        ("[0.5, 0.1, 0.2]", "[-0.5, 0.1, -0.2]"),
        ("[3.0, -1.0, 0.0]", "[-3.0, -1.0, 0.0]"),
        ("[2.0, -1.5, -0.5]", "[-2.0, -1.5, 0.5]"),
        ("[2.0, 1.5, -0.5]", "[-2.0, 1.5, 0.5]"),
        ("direction = [2.0, 0.0, 0.0]", "direction = [-2.0, 0.0, 0.0]"),
        ("Ixy = 4.0", "Ixy = -4.0"),
    ):
        assert body in text
        text = text.replace(body, design)
    other = load(tmp_path, text)
    assert other.datum == "nose"
    for channel in ("ax", "alpha", "beta"):
        np.testing.assert_array_equal(
            other.sensor_position(channel), aircraft.sensor_position(channel)
        )
    for a, b in zip(other.engines, aircraft.engines, strict=True):
        np.testing.assert_allclose(a.position, b.position)
        np.testing.assert_allclose(a.direction, b.direction)
    assert other.mass is not None
    assert aircraft.mass is not None
    np.testing.assert_array_equal(other.mass.inertia, aircraft.mass.inertia)
    np.testing.assert_array_equal(other.mass.cg, aircraft.mass.cg)


def test_moment_reference_is_the_center_of_gravity_or_the_point_stated(
    tmp_path: Path, aircraft: Aircraft
) -> None:
    np.testing.assert_array_equal(aircraft.reference_point, [0.1, 0.0, -0.2])
    stated = load(tmp_path, HEAD + BODY.replace("c = 1.25", "c = 1.25\npoint = [0.3, 0.0, 0.0]"))
    np.testing.assert_array_equal(stated.reference_point, [0.3, 0.0, 0.0])


def test_mass_may_be_left_out_until_it_is_needed(tmp_path: Path) -> None:
    bare = load(
        tmp_path, 'schema = "alula.aircraft/1"\nname = "x"\n[reference]\nS = 10\nb = 8\nc = 1.25\n'
    )
    np.testing.assert_array_equal(bare.sensor_position("alpha"), np.zeros(3))
    with pytest.raises(BadInput, match=r"no \[mass\]"):
        bare.mass_properties(np.zeros(3))


def test_half_span_for_span_is_noticed(tmp_path: Path) -> None:
    (message,) = load(tmp_path, HEAD + BODY.replace("b = 8.0", "b = 4.0")).messages
    assert message.code == "reference_geometry"


def test_misspelled_sensor_is_noticed(tmp_path: Path) -> None:
    text = HEAD + BODY.replace("[sensors.alpha]", "[sensors.alhpa]")
    (message,) = load(tmp_path, text).messages
    assert message.code == "unknown_sensor"


def test_summary_names_what_is_assumed(aircraft: Aircraft) -> None:
    summary = aircraft.summary()
    assert summary["Assumed, not measured"] == "mass.Ixz, engines.left.position"
    assert summary["Ixx, Iyy, Izz, Ixz"] == "500, 600, 1000, 30 kg m²"


def test_the_schema_is_json_and_knows_the_tables() -> None:
    schema = json.loads(json.dumps(aircraft_schema()))
    assert {"schema", "reference", "mass", "engines"} <= set(schema["properties"])
    assert schema["additionalProperties"] is False
