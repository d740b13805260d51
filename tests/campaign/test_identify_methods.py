"""Every method from one task: readings, options, and what a project asks of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.campaign.identify_task import IdentifyTask
from alula.campaign.measured import sensor_readings
from alula.campaign.methods import IDENTIFIERS, identify_by
from alula.flight import Channel, Flight, Maneuver, Motion
from alula.identify import CoefficientData, Reference
from alula.reconstruct import Segment, SensorFit

RNG = np.random.default_rng(1)
N = 400
T = np.arange(N) * 0.02
ALPHA = 0.05 + 0.02 * np.sin(2.0 * T) + 0.01 * np.sin(5.1 * T)
DE = 0.02 * np.sign(np.sin(1.3 * T))
CM = 0.01 - 1.2 * ALPHA - 1.5 * DE + 1e-4 * RNG.standard_normal(N)
DATA = CoefficientData(
    Maneuver("m", "log", "", 0.0, 8.0), T, {"Cm": CM}, {"alpha": ALPHA, "de": DE}
)


def task(options: Mapping[str, Any], **more: Any) -> IdentifyTask:
    def nothing() -> Any:
        raise AssertionError("readings are made for the methods that want them only")

    return IdentifyTask(
        data=(DATA,),
        measure=nothing,
        models={"Cm": "1 + alpha + de"},
        reference=Reference(1.0, 1.0, 1.0, np.zeros(3)),
        options=options,
        **more,
    )


@pytest.mark.parametrize("method", ["ee", "fd"])
def test_methods_of_coefficients_agree(method: str) -> None:
    found = identify_by(method, task({}, truth={"Cm_alpha": -1.2, "Cm_de": -1.5}))
    for name in ("Cm_alpha", "Cm_de"):
        p = found[name]
        assert p.truth is not None
        assert abs(p.value - p.truth) < 4.0 * p.se  # one draw
    assert found.uncertainty


def test_bootstrap_is_an_option_of_equation_error() -> None:
    found = identify_by("ee", task({"uncertainty": "bootstrap", "replicates": 200}, seed=9))
    assert found.uncertainty.startswith("block bootstrap")
    assert "seed 9" in next(m for m in found.messages if m.code == "block_bootstrap").found


def test_options_of_another_method_are_left_aside_and_said() -> None:
    found = identify_by("fd", task({"common_constant": True, "band_hz": [0.1, 3.0]}))
    (said,) = [m for m in found.messages if m.code == "option_of_another_method"]
    assert said.found == "common_constant"


@pytest.mark.parametrize(
    ("method", "options", "code"),
    [
        ("ee", {"wieghting": "equal"}, "unknown_option"),
        ("ee", {"common_constant": "yes"}, "bad_option"),
        ("ee", {"uncertainty": "jackknife"}, "bad_option"),
        ("ee", {"uncertainty": "bootstrap", "replicates": 3}, "bad_option"),
        ("ee", {"scales": [1.0]}, "bad_option"),
        ("fd", {"band_hz": [1.0]}, "bad_option"),
        ("fd", {"detrend": "cubic"}, "bad_option"),
        ("oe", {"states": "vertical"}, "bad_option"),
        ("oe", {"tied": {"Cm_de": "two Cm_alpha"}}, "bad_option"),
        ("oe", {"priors": {"Cm_de": [1.0, 0.0]}}, "bad_option"),
        ("oe", {"bounds": {"Cm_de": [1.0]}}, "bad_option"),
        ("oe", {"algorithm": "simplex"}, "bad_option"),
        ("oe", {"covariance": "banded"}, "bad_option"),
        ("oe", {"covariance": "full", "noise": {"q": 0.01}}, "bad_option"),
        ("oe", {"substeps": 1.5}, "bad_option"),
        ("oe", {"initial": "guess"}, "bad_option"),
        ("magic", {}, "unknown_method"),
    ],
)
def test_bad_options_are_refused(method: str, options: dict[str, Any], code: str) -> None:
    with pytest.raises(BadInput, match=code):
        identify_by(method, task(options))


def test_every_option_has_one_kind_in_all_methods() -> None:
    """A project's options serve several methods: a name must mean the same in each."""
    kinds: dict[str, set[str]] = {}
    for method in IDENTIFIERS.values():
        for name, kind in method.options.items():
            kinds.setdefault(name, set()).add(kind)
    assert [name for name, found in kinds.items() if len(found) > 1] == []


def motion() -> Motion:
    rest = dict.fromkeys(
        (
            "beta",
            "p",
            "q",
            "r",
            "pdot",
            "qdot",
            "rdot",
            "ax",
            "ay",
            "az",
            "phi",
            "theta",
            "psi",
            "h",
        ),
        np.zeros(N),
    )
    m = Maneuver("m", "log", "", 0.0, 8.0)
    return Motion(m, T, np.full(N, 40.0), ALPHA, **rest, rho=np.full(N, 1.2))


def fitted(name: str, t: np.ndarray, measured: np.ndarray, model: np.ndarray, sigma: float):
    nan = np.full(len(t), np.nan)
    return SensorFit(name, "rad", t, measured, model, nan, nan, sigma, 0.0)


def segment(*sensors: SensorFit) -> Segment:
    none = np.zeros((N, 1))
    return Segment(DATA.maneuver, motion(), ("h",), none, none, sensors, {})


EMPTY = Flight("log", {})


def test_readings_lose_bias_upwash_and_lever_arm_but_not_their_noise() -> None:
    noise = 0.002 * RNG.standard_normal(N)
    upwash, bias, arm = 0.15, 0.01, 0.004 * np.cos(T)  # arm: the angle's difference at the vane
    at_vane = (1.0 + upwash) * (ALPHA + arm) + bias
    found, _ = sensor_readings(
        segment(fitted("alpha", T, at_vane + noise, at_vane, 0.002)), EMPTY, lambda _: 1.0 + upwash
    )
    assert found["alpha"] == pytest.approx(ALPHA + noise / 1.15, abs=1e-12)
    assert list(found) == ["alpha"]  # what was not measured is no output


def test_slower_sensors_speak_at_their_own_stamps() -> None:
    t = T[::10][:-1] + 0.004  # between the stamps
    true = np.interp(t, T, ALPHA)
    found, _ = sensor_readings(
        segment(fitted("alpha", t, true + 0.003, true, 1.0)), EMPTY, lambda _: 1
    )
    heard = np.isfinite(found["alpha"])
    assert heard.sum() == len(t)
    assert found["alpha"][heard] == pytest.approx(ALPHA[heard] + 0.003, abs=1e-12)


def test_the_better_of_two_sensors_is_compared_and_said() -> None:
    worse = fitted("alpha", T, ALPHA + 1.0, ALPHA, 0.01)
    better = fitted("alpha_2", T, ALPHA + 0.001, ALPHA, 0.002)
    found, said = sensor_readings(segment(worse, better), EMPTY, lambda _: 1.0)
    assert found["alpha"] == pytest.approx(ALPHA + 0.001, abs=1e-12)
    assert [m.code for m in said] == ["sensor_not_compared"]


def test_flank_angle_becomes_sideslip() -> None:
    beta, alpha = 0.1, 0.2
    flank = np.arctan(np.tan(beta) / np.cos(alpha))
    off = 1e-4
    seg = segment(fitted("beta_flank", T, np.full(N, flank + off), np.full(N, flank), 0.01))
    seg = replace(seg, motion=replace(seg.motion, alpha=np.full(N, alpha), beta=np.full(N, beta)))
    found, _ = sensor_readings(seg, EMPTY, lambda _: 1.0)
    exact = np.arctan(np.tan(flank + off) * np.cos(alpha))
    assert found["beta"] == pytest.approx(np.full(N, exact), abs=1e-8)  # second order in 1e-4


def test_without_reconstruction_the_channels_are_the_readings() -> None:
    slow = T[::4]
    values = ALPHA[::4]
    flight = Flight("log", {"alpha": Channel("alpha", slow, values, "rad", "")})
    m = replace(motion(), alpha=np.interp(T, slow, values))
    none = np.zeros((N, 0))
    found, _ = sensor_readings(
        Segment(DATA.maneuver, m, (), none, none, (), {}), flight, lambda _: 1
    )
    heard = np.isfinite(found["alpha"])
    assert heard.sum() == len(slow)  # interpolated samples are no readings
    assert found["alpha"][heard] == pytest.approx(values, abs=1e-15)


def test_the_stall_takes_its_own_formulas_and_says_which_are_left() -> None:
    """What of the stall holds is in tests/identify; here: the way from a project's options."""
    alpha = 0.2 + 0.15 * np.sin(0.8 * T)
    X = 0.5 * (1.0 - np.tanh(20.0 * (alpha - 0.25)))
    CL = (0.3 + 4.5 * alpha) * (0.5 * (1.0 + np.sqrt(X))) ** 2 + 1e-3 * RNG.standard_normal(N)
    stall = replace(DATA, coefficients={"CL": CL, "CY": CL}, variables={"alpha": alpha})
    given = replace(
        task({"fixed": {"tau1": 1e-3, "tau2": 0.0}}),
        data=(stall,),
        models={"CL": "1 + alpha", "CY": "1 + alpha"},
    )
    found = identify_by("stall", given)
    assert found["alpha_star"].value == pytest.approx(0.25, abs=0.01)  # 1 ms of lag is none
    assert found.fixed == {"tau1": 1e-3, "tau2": 0.0}
    assert [m.found for m in found.messages if m.code == "model_not_served"] == ["CY"]
