"""Sources of one angle side by side: silence, age, vote, agreement; covariance of the filter's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.airdata.angles import LIMIT, WHITE, angle_source, compare_angles, on_grid, stuck_held
from alula.airdata.asse_lift import lift_angle, lift_angle_sigma
from alula.model import Reference, aero_model
from alula.navigate import navigate_joint
from alula.navigate.result import rotations
from navigate.recordings import sensors, turning

DEG = np.pi / 180.0
T = np.arange(0.0, 40.0, 0.02)
TRUTH = 4.0 * DEG + 2.0 * DEG * np.sin(0.8 * T)


def noisy(sigma_deg: float, seed: int, bias_deg: float = 0.0) -> np.ndarray:
    random = np.random.default_rng(seed)
    return TRUTH + bias_deg * DEG + sigma_deg * DEG * random.standard_normal(len(T))


def test_what_is_not_known_well_enough_is_not_reported_and_ages() -> None:
    sigma = np.where(T < 10.0, 1.0 * DEG, 1.01 * LIMIT)
    found = angle_source(T, TRUTH, sigma, "made")
    assert found.reported[T < 10.0].all()
    assert not found.reported[T >= 10.0].any()
    assert found.age[-1] == pytest.approx(T[-1] - 9.98)  # since the last sample before 10 s
    assert np.isnan(angle_source(T, TRUTH, LIMIT * 2.0, "made").age).all()  # never


def test_slow_sensor_stays_slow_and_silent_one_silent() -> None:
    own = np.arange(0.0, 20.0, 0.1)
    found = on_grid(T, own, 3.0 * own)
    there = np.isfinite(found)
    assert there.sum() == len(own)
    assert found[there] == pytest.approx(3.0 * T[there])  # straight between samples is exact
    assert not there[T > 20.0].any()
    assert np.isnan(on_grid(T, own, np.full(len(own), np.nan))).all()
    assert np.isnan(on_grid(T, own[:1], own[:1])).all()


def test_agreement_counts_what_was_stated() -> None:
    """Errors as large as stated: normalized rms 1, within four standard errors of 2000 samples."""
    sources = {
        "vane": angle_source(T, noisy(0.3, 1), 0.3 * DEG, "", recorded=True),
        "model": angle_source(T, noisy(0.5, 2, 1.0), np.hypot(0.5, 1.0) * DEG, ""),
    }
    found = compare_angles("alpha", T, sources, {"ASSE": "no phi"})
    model = found.agreement["model"]
    assert model.against == "vane"
    assert model.n == len(T)
    assert model.bias / DEG == pytest.approx(1.0, abs=4.0 * np.hypot(0.3, 0.5) / len(T) ** 0.5)
    assert model.normalized == pytest.approx(1.0, abs=0.1)
    assert found.agreement["vane"].against == "voted"
    row = found.as_dict()
    assert row["absent"] == [{"name": "ASSE", "reason": "no phi"}]
    assert "not there: no phi" in found.summary()
    assert sources["vane"].white == pytest.approx(0.3 * DEG, rel=0.1)  # its noise, found by itself


@pytest.mark.parametrize(
    ("reason", "spoil"),
    [
        ("stuck", lambda x, at: np.where(at > T, x, x[at > T][-1])),
        ("dead", lambda x, at: np.where(at > T, x, np.nan)),
        ("biased", lambda x, at: np.where(at > T, x, x + 4.0 * DEG)),
    ],
)
def test_fault_of_the_vane_is_named(reason: str, spoil) -> None:
    vane = spoil(noisy(0.2, 3), 20.0)
    sources = {
        "vane": angle_source(T, vane, 0.3 * DEG, "", recorded=True),
        "filter": angle_source(T, noisy(0.1, 4), 0.4 * DEG, ""),
        "model": angle_source(T, noisy(0.2, 5), 0.3 * DEG, ""),
    }
    found = compare_angles("alpha", T, sources, {})
    assert [(n.source, n.reason) for n in found.named] == [("vane", reason)]
    assert 20.0 <= found.named[0].t < 22.0  # as the monitor promises
    assert found.voted is not None
    late = T > 25.0
    assert np.abs(found.voted.angle - TRUTH)[late].max() < 1.0 * DEG


def test_stuck_reading_stays_equal_when_it_is_carried() -> None:
    raw = np.where((T > 5.0) & (T < 8.0), TRUTH[250], noisy(0.2, 9))
    raw[::2] = np.nan  # 25 Hz
    carried = raw + 0.01 * np.sin(5.0 * T)
    found = stuck_held(raw, carried)
    inside = (T > 5.05) & (T < 7.95) & np.isfinite(raw)
    assert len(set(found[inside])) == 1
    outside = (T < 5.0) & np.isfinite(raw)
    assert (found[outside] == carried[outside]).all()
    assert np.isnan(stuck_held(np.full(4, np.nan), np.full(4, np.nan))).all()


def test_silence_of_what_is_computed_is_no_fault() -> None:
    """ASSE falls silent in trim and is heard again; a vane that does is named."""
    silent = np.where((T > 10.0) & (T < 20.0), np.nan, noisy(0.2, 6))
    computed = {
        "vane": angle_source(T, noisy(0.2, 7), 0.3 * DEG, "", recorded=True),
        "ASSE": angle_source(T, silent, 0.5 * DEG, ""),
    }
    found = compare_angles("alpha", T, computed, {})
    assert found.named == ()
    assert found.voted is not None
    assert (found.voted.used[T > 30.0] == 2).all()
    swapped = {"vane": replace(computed["ASSE"], recorded=True), "ASSE": computed["vane"]}
    assert compare_angles("alpha", T, swapped, {}).named[0].reason == "dead"


def test_nothing_observable_gives_no_vote() -> None:
    sources = {"ASSE": angle_source(T, TRUTH, np.full(len(T), 1.0), "")}
    found = compare_angles("beta", T, sources, {})
    assert found.voted is None
    assert found.agreement["ASSE"].n == 0
    assert found.as_dict()["voted"] is None
    assert "never" in found.summary()
    assert angle_source(T, np.full(len(T), np.nan), 0.1, "").white == WHITE


def test_covariance_of_the_filters_air_data() -> None:
    """Against air data of states moved by each error: central differences of `air` itself."""
    motion = turning(20.0, wind=(5.0, -8.0, 0.0))
    found = navigate_joint(motion.inertial, sensors(motion), every=200)
    size, columns = 1e-6, []
    for name, k in [(n, k) for n in ("turn", "velocity", "wind", "gust") for k in range(3)]:
        sides = []
        for sign in (1.0, -1.0):
            step = sign * size * np.eye(3)[k]
            air = found.velocity - found.wind
            R = rotations(found.q)
            if name == "turn":  # R_true = (I - [turn x]) R
                v = np.einsum("nij,nj->ni", R, air)
                v = v - np.cross(step, v)
            else:
                v = np.einsum("nij,nj->ni", R, air + step * (1.0 if name == "velocity" else -1.0))
            plane = np.hypot(v[:, 0], v[:, 2])
            angles = np.arctan2(v[:, 2], v[:, 0]), np.arctan2(v[:, 1], plane)
            sides.append(np.column_stack([np.hypot(plane, v[:, 1]), *angles]))
        columns.append((sides[0] - sides[1]) / (2.0 * size))
    J = np.stack(columns, axis=2)
    index = np.concatenate([np.arange(22)[found.states[n]] for n in
                            ("turn", "velocity", "wind", "gust")])  # fmt: skip
    expected = J @ found.covariance[:, index[:, None], index] @ J.transpose(0, 2, 1)
    # the differences' own error, 1e-6 squared over 1e-6, and rounding
    assert found.air_covariance() == pytest.approx(expected, rel=1e-4, abs=1e-10)


def test_sigma_of_the_lift_angle_is_its_scatter() -> None:
    """Load factor, pressure and parameters drawn from what is stated: 400 draws."""
    covariance = np.diag([0.01**2, 0.05**2])
    model = aero_model(
        "line", {"CZ": "1 + alpha"}, {"CZ_0": -0.3, "CZ_alpha": -5.0}, Reference(10.0, 8.0, 1.2),
        covariance=covariance,
    )  # fmt: skip
    alpha, mass, rho, V = 0.08, 500.0, 1.1, 45.0
    pressure_area = 0.5 * rho * V**2 * 10.0
    fz = (-0.3 - 5.0 * alpha) * pressure_area / mass
    random, n = np.random.default_rng(8), 400

    def given(f: float, speed: float) -> dict:
        one = np.ones(1)
        return {"mass": mass, "f": np.array([[0.0, 0.0, f]]), "V": speed * one, "rho": rho * one,
                "variables": {}}  # fmt: skip

    stated = lift_angle_sigma(model, np.array([alpha]), **given(fz, V), load=0.2, pressure=0.02)
    found = []
    for _ in range(n):
        drawn = replace(model, values=random.multivariate_normal(model.values, covariance))
        speed = V * (1.0 + 0.01 * random.standard_normal())  # 2 % of the pressure
        found.append(lift_angle(drawn, **given(fz + 0.2 * random.standard_normal(), speed))[0])
    # a scatter of 400 draws is known to 3.5 %
    assert np.std(found) == pytest.approx(stated[0], rel=0.12)
