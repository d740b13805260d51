"""State equations: derivatives from kinematics, and a linear system found again."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from alula.base.local_cubic import LocalCubic
from alula.base.messages import BadInput
from alula.flight import Maneuver, Motion
from alula.identify.equation_error.state_space import identify_state_space, state_derivatives

G = 9.80665


def flown(t: np.ndarray) -> Motion:
    """A made motion: V, alpha, beta and attitude as functions of time, and from them what
    gyroscopes and accelerometers sense, by differencing attitude and velocity over the Earth.
    """

    def states(t):
        V = 50.0 + 4.0 * np.sin(0.9 * t)
        alpha = 0.1 + 0.05 * np.sin(2.0 * t + 1.0)
        beta = 0.08 * np.sin(1.5 * t)
        phi, theta, psi = 0.6 * np.sin(1.1 * t), 0.2 * np.sin(0.7 * t + 2.0), 0.3 * t
        return V, alpha, beta, phi, theta, psi

    def attitude(t):
        _, _, _, phi, theta, psi = states(t)
        return Rotation.from_euler("ZYX", np.column_stack([psi, theta, phi]))

    def velocity(t):
        V, alpha, beta, *_ = states(t)
        return attitude(t).apply(
            V[:, None]
            * np.column_stack(
                [np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)]
            )
        )

    step = 1e-4
    acceleration = (velocity(t + step) - velocity(t - step)) / (2 * step)
    force = attitude(t).inv().apply(acceleration - [0.0, 0.0, G])
    rates = (attitude(t - step).inv() * attitude(t + step)).as_rotvec() / (2 * step)
    V, alpha, beta, phi, theta, psi = states(t)
    none = np.zeros_like(t)
    return Motion(
        Maneuver("m", "log", "", 0.0, 1.0), t, V, alpha, beta, *rates.T, none, none, none,
        *force.T, phi, theta, psi, none, none + 1.0,
    )  # fmt: skip


def test_derivatives_are_those_of_the_states():
    t = np.linspace(0.0, 10.0, 500)
    got = state_derivatives(flown(t))
    early, late = flown(t - 1e-4), flown(t + 1e-4)
    for name in ("V", "alpha", "beta", "phi", "theta"):
        slope = (getattr(late, name) - getattr(early, name)) / 2e-4
        assert got[name] == pytest.approx(slope, abs=1e-5)  # differencing: 1e-8 / 1e-4 x 50 m/s


def lateral(noise: float = 0.0, seed: int = 0) -> tuple[Motion, np.ndarray, np.ndarray]:
    """A Dutch roll with roll subsidence, p' and r' as a linear system says; other rows unused."""
    a = np.array(
        [[-0.2, 0.05, -1.0, 0.15], [-9.0, -5.0, 1.5, 0.0], [4.0, -0.3, -0.6, 0.0], [0, 1.0, 0, 0]]
    )
    b = np.array([[0.0, 0.03], [-12.0, 0.8], [-0.4, -3.0], [0.0, 0.0]])
    t = np.arange(1500) * 0.02
    da = 0.1 * ((t > 1) & (t < 2)) - 0.1 * ((t > 2) & (t < 3))
    dr = 0.1 * ((t > 12) & (t < 13)) - 0.1 * ((t > 13) & (t < 14))
    u = np.column_stack([da, dr])
    ramp = np.zeros((8, 8))  # exact for inputs that go straight from sample to sample
    ramp[:4, :4], ramp[:4, 4:6], ramp[4:6, 6:] = a, b, np.eye(2) / 0.02
    whole = expm(ramp * 0.02)[:4]
    x = np.zeros((len(t), 4))
    for i in range(len(t) - 1):
        x[i + 1] = whole @ np.concatenate([x[i], u[i], u[i + 1] - u[i]])
    rng = np.random.default_rng(seed)
    rate = x @ a.T + u @ b.T + noise * rng.standard_normal((len(t), 4))
    none = np.zeros_like(t)
    motion = Motion(
        Maneuver("m", "log", "", 0.0, 30.0), t, none + 50.0, none, x[:, 0], x[:, 1], none,
        x[:, 2], rate[:, 1], none, rate[:, 2], none, none, none - G, x[:, 3], none, none,
        none, none + 1.0, {"da": da, "dr": dr},
    )  # fmt: skip
    return motion, a, b


def test_linear_system_is_found_again():
    motion, a, b = lateral()
    got = identify_state_space([motion], "lateral")
    for row in (1, 2):  # roll and yaw acceleration
        assert got.A[row] == pytest.approx(a[row], abs=1e-9)  # no noise: rounding only
        assert got.B[row] == pytest.approx(b[row], abs=1e-9)
    assert got.states == ("beta", "p", "r", "phi")
    assert {p.name for p in got.parameters} >= {"A_p_beta", "B_r_dr"}
    by_name = {p.name: p for p in got.parameters}
    assert by_name["A_p_p"].unit == "1/s"
    assert by_name["A_p_beta"].unit == "1/s2"


def test_error_bars_hold_the_truth():
    """Noise on the accelerations; 4.5 standard errors is passed once in 1e5 for a normal error."""
    for seed in range(5):
        motion, a, b = lateral(0.02, seed)
        got = identify_state_space([motion, motion], "lateral")
        for row in (1, 2):
            assert np.all(np.abs(got.A[row] - a[row]) < 4.5 * got.A_se[row])
            assert np.all(np.abs(got.B[row] - b[row]) < 4.5 * got.B_se[row])
            assert np.all(got.B_se[row] < 0.05)


def test_control_that_stands_still_is_not_identifiable():
    motion, _, _ = lateral(0.02)
    still = replace(motion, controls={"da": motion.controls["da"], "dr": np.zeros(len(motion.t))})
    got = identify_state_space([still], "lateral")
    assert np.isnan(got.B[1, 1])
    assert np.isfinite(got.B[1, 0])
    assert "not_identifiable" in [m.code for m in got.messages]


def test_held_out_motion_is_left_aside():
    motion, _, _ = lateral(0.02)
    wrong = replace(motion, maneuver=replace(motion.maneuver, id="unseen", held_out=True),
                    pdot=-motion.pdot)  # fmt: skip
    alone, both = (identify_state_space(m, "lateral") for m in ([motion], [motion, wrong]))
    assert np.array_equal(alone.A, both.A)
    assert [m.where for m in both.messages if m.code == "held_out"] == ["unseen"]
    with pytest.raises(BadInput, match="no_maneuver"):
        identify_state_space([wrong], "lateral")


def test_summary_has_every_entry_with_its_verdict():
    motion, _, _ = lateral(0.02)
    got = identify_state_space([motion], "lateral")
    lines = got.summary().splitlines()
    for p in got.parameters:
        (line,) = [x for x in lines if x.split()[:1] == [p.name]]
        assert float(line.split()[1]) == pytest.approx(p.value, rel=1e-4)
        assert line.endswith(p.verdict.replace("_", " "))


def test_missing_control_and_no_motion_are_refused():
    motion, _, _ = lateral()
    with pytest.raises(BadInput, match="missing_control"):
        identify_state_space([motion], "longitudinal")
    with pytest.raises(BadInput, match="missing_control"):
        identify_state_space([motion], "lateral", inputs=("da", "de"))
    with pytest.raises(BadInput, match="no_maneuver"):
        identify_state_space([], "lateral")


def test_smoothed_accelerations_do_not_shrink_the_matrices():
    """Angular accelerations differenced over a window: the rest must pass the same filter."""
    motion, a, _ = lateral()
    cubic = LocalCubic(motion.t, 0.4)
    smoothed = replace(motion, pdot=cubic.derivative(motion.p), rdot=cubic.derivative(motion.r))
    told = identify_state_space([replace(smoothed, window_s=cubic.window_s)], "lateral")
    untold = identify_state_space([smoothed], "lateral")
    assert abs(untold.A[1, 1] - a[1, 1]) > 0.05 * abs(a[1, 1])  # control: it would matter
    # the filter's trapezoid against a roll time constant of ten samples
    assert told.A[1, 1] == pytest.approx(a[1, 1], rel=0.01)
    assert told.A[2, 0] == pytest.approx(a[2, 0], rel=0.01)
