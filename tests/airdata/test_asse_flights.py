"""Angles without vanes on the simulator's stall and sideslip sweep, and the lift model beside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.airdata.asse import AsseRecord, AsseSettings, estimate_filter, gravity_in_body
from alula.airdata.asse_lift import lift_angle
from alula.base.arrays import Array
from alula.base.messages import BadInput
from alula.model import AeroModel, Reference, aero_model, load_model
from alula.simulate import Condition, SimulatedFlight, airframe_of, fly, trim
from alula.simulate.inputs import Steps
from verification.airdata.asse_noise_free import asse_noise_free
from verification.airdata.asse_noisy import asse_noisy

AIRCRAFT = Path(__file__).parents[2] / "aircraft" / "sportstar.toml"
DEG = np.pi / 180.0


@pytest.fixture(scope="module")
def dive_and_pull() -> tuple[SimulatedFlight, AeroModel, float]:
    """A dive and a pull short of the stall, at 100 Hz; the model and the mass."""
    frame = airframe_of(load_aircraft(AIRCRAFT))
    model = replace(load_model(AIRCRAFT.with_name("sportstar_aero.toml")), stall=None)
    start = trim(frame, model, Condition(36.0, 1500.0))
    t = np.arange(1001) / 100.0
    controls: dict[str, Array | float] = {**start.inputs}
    elevator = Steps(2.0 * DEG, 1.0, (2.0, 2.0), (1.0, -1.0), 0.5)
    controls["de"] = start.controls["de"] + elevator.value(t)
    return fly(frame, model, start.state, t, controls, substeps=5), model, frame.mass


def record(flight: SimulatedFlight) -> AsseRecord:
    """Without noise."""
    m = flight.motion
    return AsseRecord(
        t=m.t, f=np.stack([m.ax, m.ay, m.az], axis=1), w=np.stack([m.p, m.q, m.r], axis=1),
        gravity=gravity_in_body(m.phi, m.theta), V=m.V,
    )  # fmt: skip


def test_filter_before_in_and_after_a_maneuver(
    dive_and_pull: tuple[SimulatedFlight, AeroModel, float],
) -> None:
    """Not observable in trim, found by the maneuver, carried on after it; inside its interval."""
    flight, _, _ = dive_and_pull
    m = flight.motion
    found = estimate_filter(record(flight), AsseSettings(first_alpha=float(m.alpha[0]) + 0.08))
    assert not found.observable_alpha[m.t < 1.0].any()
    assert found.observable_alpha[m.t > 5.0].all()
    assert not found.observable_beta.any()  # nothing lateral happened
    error = np.abs(found.alpha - m.alpha)
    # exact sensors, so that errors are below those allowed for
    assert (error < 2.0 * found.sigma_alpha)[m.t > 0.5].all()
    assert error[m.t > 5.0].max() < 0.5 * DEG


def test_lift_model_gives_the_angle_it_flew(
    dive_and_pull: tuple[SimulatedFlight, AeroModel, float],
) -> None:
    """The simulator's own model and load factor: its own alpha; and the filter takes it."""
    flight, model, mass = dive_and_pull
    m = flight.motion
    variables = {
        "qhat": m.q * model.reference.c / (2.0 * m.V), "de": m.controls["de"], "beta": m.beta
    }  # fmt: skip
    given = record(flight)
    found = lift_angle(
        model, mass=mass, f=given.f, V=m.V, rho=m.rho, variables=variables,
        engine_force=flight.engine_force,
    )  # fmt: skip
    inside = (m.alpha > -0.06) & (m.alpha < 0.19)
    assert inside.sum() > 900
    # Newton's last step; the recorded coefficients are those flown
    assert found[inside] == pytest.approx(m.alpha[inside], abs=1e-6)
    assert np.isnan(found[~inside]).all()
    settings = AsseSettings(first_alpha=float(m.alpha[0]) + 0.08)
    aided = estimate_filter(given, settings, alpha=found, alpha_sigma=0.5 * DEG)
    early = (m.t > 0.1) & (m.t < 1.0)
    assert aided.observable_alpha[early].all()  # the maneuver is no longer needed


def test_model_without_lift_is_refused() -> None:
    """Nothing can be solved for."""
    model = aero_model(
        "bare", {"Cm": "1 + alpha"}, {"Cm_0": 0.1, "Cm_alpha": -1.0}, Reference(10.0, 8.0, 1.2)
    )
    one = np.ones(3)
    with pytest.raises(BadInput, match="lift"):
        lift_angle(model, mass=1.0, f=np.ones((3, 3)), V=one, rho=one, variables={})


def test_stall_and_sweep_without_noise() -> None:
    """Zero order over its threshold, its error measure, the exact form: the row itself."""
    words, holds = asse_noise_free(quick=True)
    assert holds, words


def test_stall_and_sweep_with_noise() -> None:
    """The row itself with 20 seeds."""
    words, holds = asse_noisy(quick=True)
    assert holds, words
