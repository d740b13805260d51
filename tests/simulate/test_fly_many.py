"""Several flights at once: each is the flight that `fly` gives, whatever the others do."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.base.messages import BadInput
from alula.model import AeroModel, load_model, lookup_table
from alula.simulate import (
    Airframe,
    SimulatedFlight,
    airframe_of,
    fly,
    fly_many,
    initial_state,
)
from alula.simulate.pilot import Pilot
from alula.simulate.wind import Turbulence, Wind

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
T = np.arange(0.0, 8.0, 0.1)
# Flights side by side take other exponentials and arctangents, right to 5e-16; 1e-10 leaves room
# for what eight seconds of a light aircraft make of it.
CLOSE: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-10}


@pytest.fixture(scope="module")
def model() -> AeroModel:
    return load_model(AIRCRAFT / "sportstar_aero.toml")


@pytest.fixture(scope="module")
def airframe() -> Airframe:
    return airframe_of(
        load_aircraft(AIRCRAFT / "sportstar.toml"), engines="modeled", actuators=True, burn=True
    )


def starts(k: int) -> Array:
    return np.stack(
        [
            initial_state(40.0 + 3.0 * i, 0.05, 0.05, 700.0 + 50.0 * i, beta=0.01 * i)
            for i in range(k)
        ]
    )


def elevators(k: int) -> Array:
    return -0.06 + 0.02 * np.sin(2.0 * T + np.arange(k)[:, None])


def same(a: SimulatedFlight, b: SimulatedFlight) -> None:
    np.testing.assert_allclose(a.plant_states, b.plant_states, **CLOSE)
    np.testing.assert_allclose(a.motion.alpha, b.motion.alpha, **CLOSE)
    np.testing.assert_allclose(a.motion.ax, b.motion.ax, **CLOSE)
    np.testing.assert_allclose(a.velocity, b.velocity, **CLOSE)
    np.testing.assert_allclose(a.engine_force, b.engine_force, **CLOSE)
    np.testing.assert_array_equal(a.inputs, b.inputs)
    assert [m.code for m in a.messages] == [m.code for m in b.messages]


# Below, at and above the number of lanes, and no multiple of it.
@pytest.mark.parametrize("k", [1, 3, 4, 6])
@pytest.mark.parametrize("hold", [False, True])
def test_each_is_the_flight_alone(airframe: Airframe, model: AeroModel, k: int, hold: bool) -> None:
    x0, de = starts(k), elevators(k)
    wind = np.stack([[3.0 + i, -2.0, 0.1 * i] for i in range(k)])
    gusts = np.zeros((k, len(T), 6))
    gusts[:, 30:, 2] = np.arange(k)[:, None]
    common: dict[str, Any] = {"dt": 0.6, "da": 0.01 * np.sin(T)}
    options: dict[str, Any] = {"substeps": 10, "hold": hold}
    flights = fly_many(
        airframe, model, x0, T, {**common, "de": de}, wind=wind, gusts=gusts, **options
    )
    assert len(flights) == k
    for i, flight in enumerate(flights):
        alone = fly(
            airframe, model, x0[i], T, {**common, "de": de[i]}, wind=wind[i], gusts=gusts[i],
            **options,
        )  # fmt: skip
        same(alone, flight)
        assert flight.motion.maneuver.id == f"flight_{i}"
    assert k == 1 or np.abs(flights[0].motion.q - flights[1].motion.q).max() > 1e-3


def test_everything_common_is_given_once(airframe: Airframe, model: AeroModel) -> None:
    wind = Wind(np.array([5.0, 0.0, 0.0]), reference_height=300.0, logarithmic=True, ground=500.0)
    gusts = np.zeros((len(T), 6))
    gusts[20:, 0] = 2.0
    controls: dict[str, Any] = {"dt": 0.6, "de": elevators(1)[0]}
    options: dict[str, Any] = {"wind": wind, "gusts": gusts, "substeps": 10, "check": True}
    flights = fly_many(airframe, model, starts(5), T, controls, **options)
    for x, flight in zip(starts(5), flights, strict=True):
        same(fly(airframe, model, x, T, controls, **options), flight)


def test_a_table_and_the_turning_earth(airframe: Airframe, model: AeroModel) -> None:
    from alula.model import aero_model

    alpha = np.radians(np.linspace(-10.0, 20.0, 13))
    table = lookup_table({"alpha": alpha}, 0.5 * alpha**2, "cubic")
    formulas = model.formulas
    formulas["CD"] = formulas["CD"] + " + extra(alpha)"
    with_table = aero_model(
        model.name, formulas, {**model.params, "CD_extra": 1.0}, model.reference,
        axes=model.axes, reference_point=model.reference_point, tables={"extra": table},
    )  # fmt: skip
    over = replace(airframe, earth="wgs84")
    x0 = np.stack(
        [
            initial_state(45.0, 0.05, 0.05, h, earth="wgs84", latitude=0.8, longitude=0.2)
            for h in (500.0, 900.0, 12000.0)
        ]
    )
    options: dict[str, Any] = {"substeps": 10}
    controls = {"dt": 0.6, "de": -0.06}
    flights = fly_many(over, with_table, x0, T, controls, **options)
    for x, flight in zip(x0, flights, strict=True):
        alone = fly(over, with_table, x, T, controls, **options)
        # Places are of the size of the Earth: rounding there is 1e-9 m.
        np.testing.assert_allclose(alone.plant_states, flight.plant_states, rtol=1e-10, atol=1e-9)


def test_turbulence_pilots_and_mixed_profiles(airframe: Airframe, model: AeroModel) -> None:
    x0 = starts(3)
    controls = {"dt": 0.6, "de": -0.06}
    air = [Turbulence(W20=5.0, sigma=1.0, seed=i) for i in range(2)]
    pilot = Pilot({("da", "phi"): -0.3}, {"phi": 0.1})
    winds = [
        Wind(),
        Wind(np.array([4.0, 0.0, 0.0]), reference_height=6.0, logarithmic=True),
        Wind(),
    ]
    options: dict[str, Any] = {"substeps": 5}
    flights = fly_many(
        airframe, model, x0, T, controls, wind=winds, turbulence=[*air, None], pilot=pilot,
        **options,
    )  # fmt: skip
    for i, flight in enumerate(flights):
        alone = fly(
            airframe, model, x0[i], T, controls, wind=winds[i], pilot=pilot,
            turbulence=[*air, None][i], **options,
        )  # fmt: skip
        np.testing.assert_array_equal(alone.plant_states, flight.plant_states)


def test_a_flight_does_not_depend_on_the_others(airframe: Airframe, model: AeroModel) -> None:
    x0 = starts(7)
    options: dict[str, Any] = {"substeps": 10}
    controls = {"dt": 0.6, "de": elevators(7)}
    flights = fly_many(airframe, model, x0, T, controls, **options)
    again = fly_many(airframe, model, x0, T, controls, **options)
    wild = x0.copy()
    wild[[0, 2, 5], 10] = 1e180  # rad/s: no number after a step
    cut = fly_many(airframe, model, wild, T, controls, diverged="cut", **options)
    order = [6, 1, 4]
    some = fly_many(
        airframe, model, x0[order], T, {**controls, "de": elevators(7)[order]}, **options
    )
    for i in range(7):
        assert flights[i].plant_states.tobytes() == again[i].plant_states.tobytes()
        if i in (0, 2, 5):
            assert 1 <= len(cut[i].motion.t) < len(T)
            assert len(cut[i].plant_states) == len(cut[i].motion.t)
            assert "diverged" in [m.code for m in cut[i].messages]
            assert f"flight {i}" in next(m.where for m in cut[i].messages if m.code == "diverged")
        else:
            assert flights[i].plant_states.tobytes() == cut[i].plant_states.tobytes()
    for i, flight in zip(order, some, strict=True):
        assert flights[i].plant_states.tobytes() == flight.plant_states.tobytes()
    with pytest.raises(BadInput, match="diverged") as caught:
        fly_many(airframe, model, wild, T, controls, **options)
    assert "flight 0" in caught.value.messages[0].where


@pytest.mark.parametrize(
    ("changed", "code"),
    [
        ({"x0": np.zeros(13)}, "initial_state"),
        ({"x0": np.zeros((0, 13))}, "initial_state"),
        ({"x0": np.zeros((3, 12))}, "initial_state"),
        ({"controls": {"de": np.zeros((2, len(T)))}}, "bad_control"),
        ({"controls": {"de": np.full((3, len(T)), np.nan)}}, "bad_control"),
        ({"controls": {"dx": np.zeros((3, len(T)))}}, "unknown_control"),
        ({"wind": np.zeros((2, 3))}, "bad_wind"),
        ({"wind": np.zeros((3, 2))}, "bad_wind"),
        ({"wind": [Wind(), np.zeros(3)]}, "bad_wind"),
        ({"gusts": np.zeros((2, len(T), 6))}, "bad_gust"),
        ({"gusts": np.zeros((3, len(T), 5))}, "bad_gust"),
        ({"turbulence": [Turbulence()]}, "bad_turbulence"),
        ({"maneuvers": []}, "bad_maneuvers"),
        ({"t": T**2}, "uneven_time"),
    ],
)
def test_refusals(airframe: Airframe, model: AeroModel, changed: dict[str, Any], code: str) -> None:
    given: dict[str, Any] = {"x0": starts(3), "t": T, "controls": {"de": -0.06}, **changed}
    with pytest.raises(BadInput) as caught:
        fly_many(airframe, model, given.pop("x0"), given.pop("t"), given.pop("controls"), **given)
    assert caught.value.messages[0].code == code
