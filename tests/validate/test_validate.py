"""The model that flew the flight flies it again; another one does not, and it is seen."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.validate import Validation, validate
from validate.flights import aileron, as_case, changed, elevator, rudder, truth


def codes(result: Validation) -> list[str]:
    return [m.code for m in result.messages]


@pytest.fixture(scope="module")
def cases():
    return elevator(), aileron(), rudder()


def test_the_truth_matches_itself(cases) -> None:
    result = validate(truth(), cases, draws=0)
    for one in result.flown:
        assert one.horizon == pytest.approx(one.asked)
        for c in one.channels.values():
            if c.recorded and c.in_axis:
                # same integrator, same step, same inputs: the start goes through its Euler angles
                assert c.quality.rms < 1e-9 * max(1.0, np.abs(c.measured).max()), c.name
    assert {e.verdict for e in result.evidence} == {"pass"}
    assert not result.failed
    assert "outside_validity" not in codes(result)
    assert [e.entry for e in result.evidence] == [
        "2.c.10", "2.c.10", "2.d.2", "2.d.7", "2.d.7", "2.d.7", "2.d.6",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("factors", "entry"),
    [
        ({"Cm_de": 1.5}, "2.c.10"),
        ({"Cl_da": 1.4}, "2.d.2"),
        ({"Cn_beta": 2.5}, "2.d.7"),
        ({"Cn_r": 0.3}, "2.d.7"),
    ],
)
def test_a_wrong_derivative_fails_its_own_requirement(cases, factors, entry) -> None:
    result = validate(changed(truth(), **factors), cases, draws=0)
    failed = {e.entry for e in result.evidence if e.verdict == "fail"}
    assert entry in failed
    assert result.failed
    assert ("2.c.10" in failed) == ("Cm_de" in factors)  # the other axis stays as it is


def test_model_without_some_coefficients_takes_them_as_recorded(cases) -> None:
    """Every coefficient as recorded: the flight closes with its own forces and moments."""
    model = truth()
    lateral = [k for k, (c, _) in enumerate(model.terms) if c in ("CY", "Cl", "Cn")]
    longitudinal = [k for k in range(len(model.terms)) if k not in lateral]
    for case, keep, axis in ((cases[0], lateral, "V"), (cases[1], longitudinal, "p")):
        part = replace(
            model,
            terms=tuple(model.terms[k] for k in keep),
            values=model.values[keep],
            covariance=None,
        )
        result = validate(part, [case], draws=0)
        (one,) = result.flown
        assert len(one.as_recorded) == 3
        assert "coefficient_as_recorded" in codes(result)
        channel = one.channels[axis]
        assert channel.as_recorded
        assert not channel.counts
        # lines between samples at 50 Hz instead of the model itself: h^2/8 of the curvature
        assert channel.quality.r2 > 0.999
        assert {e.verdict for e in result.evidence} == {"not_judged"}
        assert all("as recorded" in e.reason for e in result.evidence)


def test_diverging_flight_is_told_with_its_time_and_shown_until_then(cases) -> None:
    result = validate(changed(truth(), Cm_alpha=-6.0, Cm_q=0.1), cases, draws=0)
    one = result.flown[0]
    assert one.diverged_at is not None
    assert 100.0 < one.diverged_at < 112.0
    assert one.t[-1] < one.diverged_at
    assert len(one.channels["alpha"].model) == len(one.t)
    assert np.abs(one.channels["alpha"].model).max() <= np.radians(45.0)
    assert f"{one.diverged_at:.5g} s" in next(
        m.found for m in result.messages if m.code == "model_flight_diverged"
    )
    rows = [e for e in result.evidence if e.maneuver == "elevator"]
    assert {e.verdict for e in rows} == {"fail"}
    assert all("diverged" in e.reason for e in rows)


def test_horizon(cases) -> None:
    (one,) = validate(truth(), cases[:1], draws=0, horizon=4.0).flown
    assert one.horizon == pytest.approx(4.0)
    assert one.asked == pytest.approx(4.0)
    with pytest.raises(BadInput, match="bad_option"):
        validate(truth(), cases[:1], horizon=0.0)


def test_outside_validity_is_said_once_with_the_value(cases) -> None:
    narrow = replace(truth(), validity={"alpha": (0.0, 0.01), "da": (-0.01, 0.01), "mach": (0, 1)})
    result = validate(narrow, cases, draws=0)
    (message,) = [m for m in result.messages if m.code == "outside_validity"]
    alpha = result.flown[0].channels["alpha"].model
    farthest = alpha[np.argmax(np.maximum(-alpha, alpha - 0.01))]
    assert f"alpha {np.degrees(farthest):.3g} deg (range 0 deg to 0.573 deg" in message.found
    assert "da" in message.found
    assert set(result.flown[0].outside) == {"alpha"}


def test_band_is_the_parameters_error_and_repeats_with_its_seed(cases) -> None:
    model = truth()
    k = model.names.index("Cm_de")
    covariance = np.zeros((len(model.values),) * 2)
    covariance[k, k] = (0.01 * model.values[k]) ** 2
    known = replace(model, covariance=covariance)
    first, second = (validate(known, cases[:1], seed=3).flown[0] for _ in range(2))
    band = first.channels["q"].model_se
    assert band is not None
    np.testing.assert_array_equal(band, second.channels["q"].model_se)
    other = validate(known, cases[:1], seed=4).flown[0].channels["q"].model_se
    assert not np.array_equal(band, other)
    # one parameter: the band is the change that one standard deviation makes, to 1/sqrt(2 * 40)
    high = validate(changed(model, Cm_de=1.01), cases[:1], draws=0).flown[0].channels["q"].model
    change = np.abs(high - first.channels["q"].model)
    inside = change > 0.2 * change.max()
    np.testing.assert_allclose(band[inside] / change[inside], 1.0, atol=0.4)  # 3 of 11 %
    assert first.draws == 40
    without = validate(known, cases[:1], draws=0).flown[0]
    assert without.channels["q"].model_se is None


def test_parameter_sets_that_do_not_fly_are_counted(cases) -> None:
    model = truth()
    k = model.names.index("Cm_alpha")
    covariance = np.zeros((len(model.values),) * 2)
    covariance[k, k] = (8.0 * model.values[k]) ** 2
    result = validate(replace(model, covariance=covariance), cases[:1])
    assert result.flown[0].draws < 40
    assert "draws_diverged" in codes(result)


@pytest.mark.parametrize("trim", ["entry", "whole"])
def test_trim_offsets_take_a_wrong_constant_out_and_say_so(cases, trim) -> None:
    wrong = changed(truth(), Cm_0=1.1, CL_0=1.02)
    plain = validate(wrong, cases[:1], draws=0).flown[0]
    result = validate(wrong, cases[:1], draws=0, trim=trim)
    (one,) = result.flown
    model = truth()
    value = model.params["Cm_0"]
    assert one.offsets["Cm"] == pytest.approx(-0.1 * value, rel=1e-6)
    assert one.channels["theta"].quality.rms < 1e-6
    assert plain.channels["theta"].quality.rms > 1e-2
    assert plain.offsets == {}
    (message,) = [m for m in result.messages if m.code == "trim_offset"]
    assert "Cm" in message.found


def test_trimmed_sets_are_trimmed_each(cases) -> None:
    """A constant's error is taken out by the offset: it leaves no band."""
    model = truth()
    k = model.names.index("Cm_0")
    covariance = np.zeros((len(model.values),) * 2)
    covariance[k, k] = (0.05 * model.values[k]) ** 2
    known = replace(model, covariance=covariance)
    free = validate(known, cases[:1]).flown[0].channels["theta"].model_se
    held = validate(known, cases[:1], trim="entry").flown[0].channels["theta"].model_se
    assert free is not None
    assert held is not None
    assert held.max() < 1e-6 * free.max()


def test_uneven_times_are_resampled_and_said(cases) -> None:
    motion = cases[0].motion
    random = np.random.default_rng(1)
    t = motion.t + np.concatenate([[0.0], random.uniform(-2e-3, 2e-3, len(motion.t) - 2), [0.0]])
    arrays = {
        f.name: np.interp(t, motion.t, getattr(motion, f.name))
        for f in fields(motion)
        if isinstance(getattr(motion, f.name), np.ndarray) and f.name != "t"
    }
    shaken = replace(
        motion,
        t=t,
        **arrays,
        controls={n: np.interp(t, motion.t, u) for n, u in motion.controls.items()},
        recorded={},
    )
    result = validate(truth(), [as_case(shaken)], draws=0)
    assert "resampled" in codes(result)
    assert result.flown[0].channels["q"].quality.r2 > 0.999
    assert "resampled" not in codes(validate(truth(), cases[:1], draws=0))


def test_recorded_density_goes_before_the_standard_atmosphere(cases) -> None:
    """The same flight with its height 600 m wrong: the density tells, the height is as recorded."""
    motion = cases[0].motion
    result = validate(truth(), [as_case(replace(motion, h=motion.h + 600.0))], draws=0)
    assert "density_altitude" in codes(result)
    (one,) = result.flown
    # the height of a density is found to 1 mm
    assert one.channels["alpha"].quality.rms < 1e-7
    assert one.channels["h"].model[0] == pytest.approx(motion.h[0] + 600.0, abs=1e-6)
    with pytest.raises(BadInput, match="density"):
        validate(truth(), [as_case(replace(motion, rho=np.full(len(motion.t), 1e4)))], draws=0)


def test_seen_maneuvers_are_labeled(cases) -> None:
    seen, unknown = replace(cases[0], seen="yes"), replace(cases[1], seen="unknown")
    result = validate(truth(), [seen, unknown], draws=0)
    assert {"seen_by_the_estimate", "origin_unknown"} <= set(codes(result))
    assert "SEEN BY THE ESTIMATE, no validation: elevator" in result.status
    assert "not known whether the estimate saw: aileron" in result.status
    assert {e.seen for e in result.evidence if e.maneuver == "elevator"} == {"yes"}
    assert "SEEN" not in validate(truth(), cases[:1], draws=0).status


def test_forces_that_do_not_close_are_said(cases) -> None:
    motion = cases[0].motion
    body = {n: np.zeros(len(motion.t)) for n in ("CX", "CY", "CZ")}
    result = validate(truth(), [replace(cases[0], coefficients=body)], draws=0)
    (message,) = [m for m in result.messages if m.code == "forces_do_not_close"]
    assert message.found.startswith(f"{motion.az.mean():+.3g} m/s2 missing in z")


def test_what_cannot_be_flown_is_refused(cases) -> None:
    with pytest.raises(BadInput, match="no_maneuver"):
        validate(truth(), [])
    without = replace(cases[0].motion, controls={})
    with pytest.raises(BadInput, match="missing_control"):
        validate(truth(), [replace(cases[0], motion=without)])
    lift = replace(truth(), terms=truth().terms[:2], values=truth().values[:2], covariance=None)
    with pytest.raises(BadInput, match="coefficient_not_modeled") as caught:
        validate(lift, [replace(cases[0], coefficients={})])
    assert "CL" in caught.value.messages[0].found


def test_channels_that_were_not_recorded_are_not_compared(cases) -> None:
    result = validate(truth(), [replace(cases[0], missing=("theta", "q"))], draws=0)
    (one,) = result.flown
    assert not one.channels["theta"].recorded
    assert [e.verdict for e in result.evidence] == ["not_judged", "pass"]
    assert result.evidence[0].reason == "channel not recorded"
