"""Accelerometer, gyro, magnetometer: truth comes back within its errors; bad input is refused."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from alula.base.messages import BadInput
from alula.navigate.calibration import (
    Turn,
    Turns,
    calibrate_accelerometer,
    calibrate_gyro,
    calibrate_magnetometer,
    current_field,
    turns_of,
)
from alula.navigate.calibration.accelerometer import nearest_directions
from alula.navigate.calibration.magnetometer import level_field
from alula.navigate.calibration.procrustes import rotation_between

G = 9.81
CUBE = np.array(list(np.ndindex(3, 3, 3)), dtype=float) - 1.0
CUBE = CUBE[(np.abs(CUBE).sum(1) > 0) & (np.abs(CUBE).sum(1) < 3)]  # 6 faces and 12 edges
CUBE /= np.linalg.norm(CUBE, axis=1)[:, None]
FACES = CUBE[np.abs(CUBE).max(axis=1) > 0.9]
# 25 draws of a 95 % interval: 19 or fewer inside has probability 0.001 for one parameter, but the
# parameters of a draw are related and there are a dozen; on their mean 0.88 is a safe bound.
SEEDS, COVERED = 25, 0.88


def truth_of(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return np.eye(3) + 0.02 * rng.standard_normal((3, 3)), 0.1 * rng.standard_normal(3)


def positions(seed: int, directions: np.ndarray, by_hand: float, noise: float) -> np.ndarray:
    """Readings at rest: directions off by `by_hand` rad, readings by `noise` m/s2."""
    rng = np.random.default_rng(seed)
    C, offset = truth_of()
    turned = Rotation.from_rotvec(by_hand * rng.standard_normal((len(directions), 3)))
    f = G * turned.apply(directions)
    return f @ np.linalg.inv(C).T + offset + noise * rng.standard_normal(f.shape)


def coverage(found: list, truth: np.ndarray) -> float:
    return float(
        np.mean([[p.ci95[0] < v < p.ci95[1] for p, v in zip(c.parameters, truth, strict=True)]
                 for c in found])
    )  # fmt: skip


def test_accelerometer_without_noise_is_exact() -> None:
    C, offset = truth_of()
    found = calibrate_accelerometer(positions(0, CUBE, 0.0, 0.0), G, CUBE)
    # the fit ends where steps of 1e-14 no longer help; differences by 1e-6 steps lose nothing here
    np.testing.assert_allclose(found.matrix, C, atol=1e-9)
    np.testing.assert_allclose(found.offset, offset, atol=1e-9)
    assert found.after.largest < 1e-10 < found.before.largest


@pytest.mark.parametrize("directions", [CUBE, FACES], ids=["18 positions", "6 faces"])
def test_accelerometer_truth_inside_intervals(directions: np.ndarray) -> None:
    """Positions set by hand to 0.6 deg, noise of 0.5 mg."""
    C, offset = truth_of()
    found = [
        calibrate_accelerometer(positions(s, directions, 0.01, 0.005), G, directions)
        for s in range(SEEDS)
    ]
    assert coverage(found, np.concatenate([C.ravel(), offset])) > COVERED
    assert all(c.determined for c in found)


def test_directions_by_hand_do_not_bend_the_lengths() -> None:
    """Lengths alone and lengths with directions give the same lengths."""
    f = positions(1, CUBE, 0.02, 0.005)
    alone, both = calibrate_accelerometer(f, G), calibrate_accelerometer(f, G, CUBE)
    assert both.after.rms == pytest.approx(alone.after.rms, rel=1e-6)
    assert "no_alignment" in {m.code for m in alone.messages}
    assert np.allclose(alone.matrix, alone.matrix.T)


def test_nearest_directions_and_what_is_unclear() -> None:
    f = positions(2, CUBE, 0.01, 0.0)
    np.testing.assert_allclose(nearest_directions(f, "faces_and_edges", ""), CUBE, atol=1e-12)
    with pytest.raises(BadInput, match="direction_not_clear"):
        calibrate_accelerometer(f, G, "faces")  # edges are 45 deg away


def test_too_few_and_useless_positions_are_refused() -> None:
    f = positions(0, CUBE, 0.0, 0.0)
    with pytest.raises(BadInput, match="too_few_positions"):
        calibrate_accelerometer(f[:9], G)
    with pytest.raises(BadInput, match="too_few_positions"):
        calibrate_accelerometer(f[:5], G, CUBE[:5])
    with pytest.raises(BadInput, match="no_usable_samples"):
        calibrate_accelerometer(np.full((18, 3), np.nan), G)
    with pytest.raises(BadInput, match="no_usable_samples"):
        calibrate_accelerometer(np.full((18, 3), 1e300), G)
    for dead in (np.zeros((18, 3)), np.ones((18, 3))):
        with pytest.raises(BadInput, match="dead_sensor"):
            calibrate_accelerometer(dead, G, CUBE)
    with pytest.raises(BadInput, match="bad_directions"):
        calibrate_accelerometer(f, G, CUBE[:4])
    with pytest.raises(BadInput, match="bad_directions"):
        calibrate_accelerometer(f, G, 0.0 * CUBE)


def test_not_an_ellipsoid() -> None:
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-1, 1, (2, 40))
    saddle = np.column_stack([x, y, x**2 - y**2])  # lies on a hyperbolic paraboloid
    with pytest.raises(BadInput, match="not_an_ellipsoid"):
        calibrate_accelerometer(saddle, G)


def test_one_nan_and_a_saturated_position_are_left_out() -> None:
    f = positions(0, CUBE, 0.0, 0.001)
    f[3, 1], f[5, 0] = np.nan, 20.0
    found = calibrate_accelerometer(f, G, CUBE, limit=19.6)
    assert len(found.raw) == 16
    assert {m.code for m in found.messages} >= {"not_finite", "saturated_sensor"}
    np.testing.assert_allclose(found.matrix, truth_of()[0], atol=0.005)


def test_coplanar_positions_are_not_identifiable() -> None:
    """Turned about x only: what belongs to x cannot be told, and is said."""
    angle = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    ring = np.column_stack([0.0 * angle, np.sin(angle), np.cos(angle)])
    f = positions(4, ring, 0.0, 0.002)
    alone = calibrate_accelerometer(f, G)
    assert not alone.determined
    assert "coplanar_positions" in {m.code for m in alone.messages}
    both = calibrate_accelerometer(f, G, ring)
    lost = {p.name for p in both.parameters if p.verdict == "not_identifiable"}
    assert {"C_xx", "C_yx", "C_zx"} <= lost
    assert not {"C_yy", "C_zz", "C_yz", "C_zy"} & lost
    assert all(np.isnan(p.value) for p in both.parameters if p.name in lost)
    assert both["C_xx"].tied_to


AXES = np.vstack([CUBE, -CUBE[:6]])  # 24 turns
OMEGA_0, COUPLING = np.array([0.07, -0.05, 0.004]), np.diag([1.1e-3, 9e-4, 1.2e-3])


def turned(seed: int, by_hand: float, noise: float, rests: int = 6) -> Turns:
    """Turns by 180 deg in about 2 s, and rests of 10 s, with noise of their integrals."""
    rng = np.random.default_rng(seed)
    C = truth_of()[0]
    n = len(AXES)
    axis = np.vstack([AXES, np.tile([1.0, 0.0, 0.0], (rests, 1))])
    angle = np.concatenate([np.full(n, np.pi), np.zeros(rests)])
    time = np.concatenate([rng.uniform(1.0, 4.0, n), np.full(rests, 10.0)])
    pull = rng.standard_normal((n + rests, 3))
    force = G * pull / np.linalg.norm(pull, axis=1)[:, None] * time[:, None]
    true = Rotation.from_rotvec(by_hand * rng.standard_normal((n + rests, 3))).apply(
        angle[:, None] * axis
    )
    rate = (true + force @ COUPLING.T) @ np.linalg.inv(C).T + np.outer(time, OMEGA_0)
    rate += noise * rng.standard_normal(rate.shape)
    return Turns(rate, force, time, angle, axis)


def test_gyro_without_noise_is_exact() -> None:
    found = calibrate_gyro(turned(0, 0.0, 0.0))
    np.testing.assert_allclose(found.matrix, truth_of()[0], atol=1e-9)
    np.testing.assert_allclose(found.offset, OMEGA_0, atol=1e-9)
    np.testing.assert_allclose(found.g_sensitivity, COUPLING, atol=1e-9)
    assert found.after.largest < 1e-9 < found.before.largest


def test_gyro_truth_inside_intervals() -> None:
    """Axes by hand to 1 deg, integrals to 0.1 deg."""
    truth = np.concatenate([truth_of()[0].ravel(), OMEGA_0, np.diag(COUPLING)])
    found = [calibrate_gyro(turned(s, 0.018, 0.002)) for s in range(SEEDS)]
    assert coverage(found, truth) > COVERED


def test_gyro_without_axes_keeps_lengths_and_says_so() -> None:
    t = turned(0, 0.018, 0.0)
    found = calibrate_gyro(Turns(t.rate, t.force, t.time, t.angle, None), "none")
    # what the true coupling of 1e-3 s/m adds in turns of up to 4 s: 0.04 rad of 3.14
    assert found.after.largest < 0.02 < found.before.largest
    assert "no_alignment" in {m.code for m in found.messages}


def test_gyro_turns_about_one_plane_are_not_identifiable() -> None:
    t = turned(0, 0.0, 0.001)
    flat = np.abs(t.axis[:, 2]) < 1e-6
    assert t.axis is not None
    part = Turns(t.rate[flat], t.force[flat], t.time[flat], t.angle[flat], t.axis[flat])
    found = calibrate_gyro(part)
    lost = {p.name for p in found.parameters if p.verdict == "not_identifiable"}
    # C_xz, C_yz are told, weakly: the specific force reaches raw z, and a diagonal G cannot take
    # its part in x and y. C_zz and G_z do the same.
    assert "C_zz" in lost
    assert not {"C_xx", "C_yy", "C_xy", "C_yx"} & lost
    plain = calibrate_gyro(
        Turns(*(v[flat] for v in (t.rate, 0 * t.force, t.time, t.angle, t.axis))), "none"
    )
    assert {"C_xz", "C_yz", "C_zz"} <= {
        p.name for p in plain.parameters if p.verdict == "not_identifiable"
    }
    assert "coplanar_axes" in {m.code for m in found.messages}


def test_bad_turns_are_refused() -> None:
    t = turned(0, 0.0, 0.0)
    two = Turns(t.rate[:2], t.force[:2], t.time[:2], t.angle[:2], None)
    with pytest.raises(BadInput, match="too_few_turns"):
        calibrate_gyro(two)
    with pytest.raises(BadInput, match="dead_sensor"):
        calibrate_gyro(Turns(0.0 * t.rate, t.force, t.time, t.angle, t.axis))
    rate = t.rate.copy()
    rate[4, 2] = np.nan
    with pytest.raises(BadInput, match=r"turn 5.*not_finite"):
        calibrate_gyro(Turns(rate, t.force, t.time, t.angle, t.axis))


def test_turns_are_integrated_and_checked() -> None:
    """Half a turn with a smooth start and stop about a slanted axis, sampled at 100 Hz."""
    t = np.arange(0.0, 6.0, 0.01)
    pulse = np.where((t > 2) & (t < 4), 1.0 - np.cos(np.pi * (t - 2)), 0.0) * np.pi / 2
    axis = np.array([0.6, 0.0, 0.8])
    rate = pulse[:, None] * axis
    found, said = turns_of(t, rate, None, [Turn(1.0, 5.0, np.pi, (0.6, 0.0, 0.8)), Turn(0.0, 1.0)])
    # the trapezoid rule is exact to 1e-6 for a smooth pulse
    np.testing.assert_allclose(found.rate[0], np.pi * axis, atol=1e-5)
    np.testing.assert_allclose(found.rate[1], 0.0, atol=1e-12)
    assert said == []
    swung = rate.copy()
    swung[:, 1] = 0.8 * pulse * np.sin(6.0 * t)
    assert [m.code for m in turns_of(t, swung, None, [Turn(1.0, 5.0, np.pi)])[1]] == [
        "axis_wandered"
    ]
    holed = rate.copy()
    holed[300, 0] = np.nan
    with pytest.raises(BadInput, match="not_finite"):
        turns_of(t, holed, None, [Turn(1.0, 5.0, np.pi)])
    with pytest.raises(BadInput, match="bad_window"):
        turns_of(t, rate, None, [Turn(5.0, 9.0, np.pi)])
    clipped = np.clip(rate + 1e-4 * np.random.default_rng(0).standard_normal(rate.shape), -2, 2)
    with pytest.raises(BadInput, match="saturated_sensor"):
        turns_of(t, clipped, None, [Turn(1.0, 5.0, np.pi)])


FIELD = np.array([21e-6, 1.5e-6, 44e-6])
HARD = np.array([-100e-6, -70e-6, 30e-6])
TURNED_IN = Rotation.from_rotvec([0.02, -0.03, 0.05]).as_matrix()
SOFT = np.array([[1.05, 0.01, -0.02], [0.01, 1.08, 0.0], [-0.02, 0.0, 0.97]])


def tumbled(seed: int, n: int = 1500, noise: float = 0.5e-6) -> tuple[np.ndarray, np.ndarray]:
    """Readings in attitudes all over the sphere, and level ones to the four winds."""
    rng = np.random.default_rng(seed)
    C = TURNED_IN @ SOFT
    B = Rotation.random(n, random_state=seed).apply(FIELD)
    level = np.array([level_field(FIELD, h) for h in WINDS])
    out = [v @ np.linalg.inv(C).T + HARD for v in (B, level)]
    scale = (noise, 0.2 * noise)
    out = [v + s * rng.standard_normal(v.shape) for v, s in zip(out, scale, strict=True)]
    return out[0], out[1]


WINDS = [0.0, np.pi / 2, np.pi, 3 * np.pi / 2]


def test_magnetometer_truth_inside_intervals() -> None:
    truth = np.concatenate([(TURNED_IN @ SOFT).ravel(), HARD])
    found = []
    for seed in range(SEEDS):
        B, level = tumbled(seed)
        found.append(calibrate_magnetometer(B, FIELD, level, WINDS))
    assert coverage(found, truth) > COVERED
    assert all(c.determined for c in found)


def test_noise_does_not_shrink_the_matrix() -> None:
    """3 % noise: least squares of |B| would scale by 1 - 2 s2/|B|2 = 0.998."""
    scale = [
        np.linalg.det(calibrate_magnetometer(tumbled(s, 3000, 1.5e-6)[0], FIELD).matrix)
        for s in range(12)
    ]
    mean, error = np.mean(scale), np.std(scale) / np.sqrt(len(scale))
    true = np.linalg.det(SOFT)
    # second-order bias that is left: s2/|B|2 = 1e-3, of three axes
    assert abs(mean / true - 1.0) < 3.0 * error + 1.5e-3


def test_plane_recording_is_not_identifiable() -> None:
    level = np.array([level_field(FIELD, h) for h in np.linspace(0.0, 6.28, 300)]) + HARD
    found = calibrate_magnetometer(
        level + 1e-8 * np.random.default_rng(0).random(level.shape), FIELD
    )
    assert not found.determined
    assert "coplanar_readings" in {m.code for m in found.messages}


def test_bad_magnetometer_input_is_refused() -> None:
    B, level = tumbled(0, 200)
    with pytest.raises(BadInput, match="too_few_readings"):
        calibrate_magnetometer(B[:20], FIELD)
    with pytest.raises(BadInput, match="bad_field"):
        calibrate_magnetometer(B, 0.0)
    with pytest.raises(BadInput, match="bad_level_readings"):
        calibrate_magnetometer(B, 48e-6, level, WINDS)
    with pytest.raises(BadInput, match="mirrored_axes"):
        calibrate_magnetometer(B * [1, -1, 1], FIELD, level * [1, -1, 1], WINDS)


def test_saturated_readings_are_left_out() -> None:
    B, _ = tumbled(0, 3000)
    clipped = np.maximum(B, -135e-6)
    found = calibrate_magnetometer(clipped, FIELD)
    assert "saturated_sensor" in {m.code for m in found.messages}
    assert np.all(
        np.abs(found.offset - HARD) < 5.0 * np.array([found[f"offset_{a}"].se for a in "xyz"])
    )


def test_rotation_of_parallel_references_is_refused() -> None:
    with pytest.raises(BadInput, match="parallel_references"):
        rotation_between(np.outer([1.0, 2.0, -1.0], FIELD), np.eye(3))


def test_current_field_by_regression_within_standings() -> None:
    """Fields of four headings, three currents each: the slope comes back, not the headings."""
    slope = np.array([8e-9, 1.3e-8, -2.3e-8])
    amperes = np.tile([0.0, 30.0, 65.0], 4)
    standing = np.repeat(np.arange(4), 3)
    field = np.array([level_field(FIELD, h) for h in WINDS])[standing]
    field = field + np.outer(amperes, slope)
    found = current_field(field, amperes, standing)
    np.testing.assert_allclose(found.value, slope, rtol=1e-9)
    assert found.after < 1e-12 < found.before
    with pytest.raises(BadInput, match="current_does_not_vary"):
        current_field(field, np.full(12, 10.0), standing)
