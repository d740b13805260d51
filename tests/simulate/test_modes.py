"""Modes: the eigenvalues of the full linear model, under names that no reordering changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import load_aircraft
from alula.base.messages import BadInput
from alula.model import load_model
from alula.simulate import Condition, LinearModel, airframe_of, linearize, modes_of, trim
from alula.simulate.airframe import core_model
from alula.simulate.modes import Mode, family_of
from simulate.light_aircraft import airframe, light

AIRCRAFT = Path(__file__).parents[2] / "aircraft"
RIGID = {"short_period", "phugoid", "dutch_roll", "roll", "spiral", "altitude"}


def linear(states: tuple[str, ...], A: np.ndarray) -> LinearModel:
    n = len(states)
    none = np.zeros((n, 0))
    return LinearModel(states, (), (), A, none, none.T, np.zeros((0, 0)))


def of_light(**changed: float) -> dict[str, Mode]:
    model = light(**changed)
    steady = trim(airframe(), model, Condition(45.0, 1000.0))
    full = linearize(core_model(airframe(), model), steady.state, steady.inputs)
    return {m.name: m for m in modes_of(full.motion(), 45.0)}


def shuffled(part: LinearModel, random: np.random.Generator) -> LinearModel:
    """Other order, other units."""
    order = random.permutation(len(part.states))
    unit = 10.0 ** random.uniform(-2, 2, len(part.states))
    A = (part.A * unit / unit[:, None])[np.ix_(order, order)]
    return linear(tuple(part.states[i] for i in order), A)


def roots_of(modes: tuple[Mode, ...]) -> np.ndarray:
    """All eigenvalues, twins too, sorted."""
    both = [(m.eigenvalue, m.eigenvalue.conjugate()) for m in modes]
    found = [z for a, b in both for z in ((a, b) if a.imag else (a,))]
    return np.array(sorted(found, key=lambda z: (round(z.real, 6), z.imag)))


READY = {"sportstar": (45.0, 1000.0), "x8": (18.0, 500.0)}


@pytest.mark.parametrize("engines", ["given", "modeled"])
@pytest.mark.parametrize("name", READY)
def test_ready_aircraft(name: str, engines: str) -> None:
    """Every root is an eigenvalue of the full model and each name stays, 20 orders and units."""
    aircraft = load_aircraft(AIRCRAFT / f"{name}.toml")
    assert aircraft.aero is not None
    model = load_model(aircraft.aero)
    frame = airframe_of(aircraft, engines=engines, actuators=True)
    V, h = READY[name]
    steady = trim(frame, model, Condition(V, h), limits=aircraft.control_limits)
    full = linearize(core_model(frame, model), steady.state, steady.inputs)
    found = modes_of(full, V)
    eigenvalues = np.array(
        sorted(np.linalg.eigvals(full.A), key=lambda z: (round(z.real, 6), z.imag))
    )
    # roots at zero are defective (place follows speed): they move by the root of rounding
    np.testing.assert_allclose(roots_of(found), eigenvalues, atol=1e-6)
    motion = modes_of(full.motion(), V)
    names = {m.name: m.eigenvalue for m in motion}
    assert set(names) >= RIGID
    random = np.random.default_rng(1)
    for _ in range(20):
        again = modes_of(shuffled(full.motion(), random), V)
        assert [m.name for m in again] == [m.name for m in motion]
        for m in again:
            # A stall's two states and two actuators have all but equal roots, whose eigenvectors
            # are ill determined; nothing else is.
            assert m.eigenvalue == pytest.approx(names[m.name], rel=1e-6, abs=1e-9)
    # the longitudinal modes live in longitudinal states
    by_name = {m.name: m for m in motion}
    assert by_name["short_period"].participation["alpha"] > 0.3
    assert by_name["phugoid"].participation["V"] > 0.3
    assert by_name["dutch_roll"].participation["beta"] > 0.3
    assert by_name["roll"].participation["p"] > 0.5
    assert by_name["spiral"].participation["phi"] > 0.5


def test_further_states_have_their_own_modes() -> None:
    aircraft = load_aircraft(AIRCRAFT / "sportstar.toml")
    model = load_model(AIRCRAFT / "sportstar_aero.toml")
    frame = airframe_of(aircraft, engines="modeled")
    steady = trim(frame, model, Condition(45.0, 1000.0), limits=aircraft.control_limits)
    full = linearize(core_model(frame, model), steady.state, steady.inputs)
    families = [m.family for m in modes_of(full.motion(), 45.0)]
    assert families.count("rotor") == 1
    assert families.count("stall") == sum(n.startswith("X") for n in full.states)


def test_textbook_transport() -> None:
    """Boeing 747 at Mach 0.8, 40 000 ft: matrices and roots as published by Etkin and Reid,
    Dynamics of Flight, 3rd ed., sections 6.2 and 6.7; ft/s, rad.
    """
    lon = np.array([
        [-0.006868, 0.01395, 0.0, -32.2],
        [-0.09055, -0.3151, 773.98, 0.0],
        [0.0001187, -0.001026, -0.4285, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ])  # fmt: skip
    short, slow = modes_of(linear(("V", "alpha", "q", "theta"), lon))  # w in the place of alpha
    assert (short.name, slow.name) == ("short_period", "phugoid")
    # printed with five digits
    assert short.eigenvalue == pytest.approx(-0.3719 + 0.8875j, abs=2e-4)
    assert slow.eigenvalue == pytest.approx(-0.003289 + 0.06723j, abs=2e-5)
    lat = np.array([
        [-0.0558, 0.0, -774.0, 32.2],
        [-0.003865, -0.4342, 0.4136, 0.0],
        [0.001086, -0.006112, -0.1458, 0.0],
        [0.0, 1.0, 0.0, 0.0],
    ])  # fmt: skip
    found = {m.name: m for m in modes_of(linear(("beta", "p", "r", "phi"), lat))}  # v for beta
    assert set(found) == {"dutch_roll", "roll", "spiral"}
    assert found["spiral"].eigenvalue == pytest.approx(-0.0072973, abs=2e-5)
    assert found["roll"].eigenvalue == pytest.approx(-0.56248, abs=2e-4)
    assert found["dutch_roll"].eigenvalue == pytest.approx(-0.033011 + 0.94655j, abs=2e-4)


def test_numbers_of_an_oscillation() -> None:
    m = Mode("phugoid", "phugoid", -0.1 + 0.7j)
    assert m.frequency == pytest.approx(np.hypot(0.1, 0.7))
    assert m.damping == pytest.approx(0.1 / np.hypot(0.1, 0.7))
    assert m.period == pytest.approx(2 * np.pi / 0.7)
    assert np.exp(-0.1 * m.time_to_half) == pytest.approx(0.5)
    assert m.time_to_double is None
    assert m.time_constant is None
    assert np.exp(-0.1 * m.period * m.cycles_to_tenth) == pytest.approx(0.1)
    growing = Mode("phugoid", "phugoid", 0.1 + 0.7j)
    assert np.exp(0.1 * growing.time_to_double) == pytest.approx(2.0)
    assert growing.time_to_half is None
    assert growing.damping < 0.0
    assert not growing.stable


def test_numbers_of_a_root() -> None:
    m = Mode("roll", "roll", complex(-4.0))
    assert (m.form, m.frequency, m.period, m.damping) == ("aperiodic", None, None, None)
    assert m.time_constant == 0.25
    resting = Mode("altitude", "altitude", 0j)
    assert resting.time_to_half is resting.time_to_double is resting.time_constant is None


def test_short_period_that_fell_apart() -> None:
    """Two roots in alpha and q: s^2 + 5 s + 4, beside an ordinary phugoid."""
    A = np.zeros((4, 4))
    A[:2, :2] = [[-2.0, 1.0], [2.0, -3.0]]  # alpha, q
    A[2:, 2:] = [[-0.02, -9.8], [0.005, 0.0]]  # V, theta
    found = modes_of(linear(("alpha", "q", "V", "theta"), A))
    assert [m.name for m in found] == ["short_period_1", "short_period_2", "phugoid"]
    assert [m.family for m in found[:2]] == ["short_period"] * 2
    assert [m.eigenvalue.real for m in found[:2]] == pytest.approx([-4.0, -1.0])
    assert found[0].words == "short period, 1"


def test_phugoid_that_fell_apart() -> None:
    A = np.zeros((4, 4))
    A[:2, :2] = [[-1.0, 1.0], [-9.0, -2.0]]
    A[2:, 2:] = [[-0.02, 0.1], [0.005, 0.03]]  # one root grows: tuck
    names = [m.name for m in modes_of(linear(("alpha", "q", "V", "theta"), A))]
    assert names == ["short_period", "phugoid_1", "phugoid_2"] or names == [
        "short_period", "phugoid_2", "phugoid_1",
    ]  # fmt: skip


def test_statically_unstable_aircraft_has_a_divergence() -> None:
    found = of_light(Cm_alpha=1.2)
    growing = [m for m in found.values() if m.eigenvalue.real > 1e-6 and m.form == "aperiodic"]
    growing = [m for m in growing if m.name != "spiral"]
    assert len(growing) == 1
    assert growing[0].family in ("short_period", "phugoid")
    assert {"dutch_roll", "roll", "spiral"} <= set(found)


def test_roll_and_spiral_become_one_oscillation() -> None:
    """Roll and spiral coupled as a lateral phugoid, beside a Dutch roll."""
    A = np.zeros((4, 4))
    A[:2, :2] = [[-0.3, -1.0], [6.0, -0.4]]  # beta, r
    A[2:, 2:] = [[-0.5, -0.2], [1.0, 0.0]]  # p, phi: s^2 + 0.5 s + 0.2
    found = {m.name: m for m in modes_of(linear(("beta", "r", "p", "phi"), A))}
    assert set(found) == {"dutch_roll", "roll_spiral"}
    assert found["roll_spiral"].frequency == pytest.approx(np.sqrt(0.2))
    assert found["roll_spiral"].words == "roll-spiral oscillation"


def test_directional_divergence_is_a_dutch_roll_that_fell_apart() -> None:
    A = np.zeros((4, 4))
    A[:2, :2] = [[-0.3, -1.0], [-2.0, -0.4]]  # Cn_beta < 0
    A[2, 2], A[3, 2], A[3, 3] = -5.0, 1.0, 0.01
    found = {m.name: m for m in modes_of(linear(("beta", "r", "p", "phi"), A))}
    assert set(found) == {"dutch_roll_1", "dutch_roll_2", "roll", "spiral"}
    assert max(m.eigenvalue.real for n, m in found.items() if "dutch" in n) > 0.5


def test_short_period_and_phugoid_merged() -> None:
    """A pair that lives in alpha and theta, with roots of q and V left over."""
    A = np.zeros((4, 4))
    A[0, 1], A[1, 0], A[0, 0] = 1.0, -1.0, -0.1  # alpha and theta swing together
    A[2, 2], A[3, 3] = -3.0, -0.05
    found = [m.name for m in modes_of(linear(("alpha", "theta", "q", "V"), A))]
    assert sorted(found) == ["phugoid", "short_period", "third_oscillation"]


def test_a_turn_keeps_its_names() -> None:
    """In a steady turn longitudinal and lateral motion are coupled; modes go on from level ones."""
    model, frame = light(), airframe()
    for bank in (0.0, 0.2, 0.5, 0.8):
        condition = Condition(45.0, 1000.0, "turn", bank=bank) if bank else Condition(45.0, 1000.0)
        steady = trim(frame, model, condition)
        full = linearize(core_model(frame, model), steady.state, steady.inputs)
        names = {m.name for m in modes_of(full.motion(), 45.0)}
        assert {"short_period", "dutch_roll", "roll", "phugoid"} <= names


def test_families_of_states() -> None:
    assert family_of("omega_2") == "rotor"
    assert family_of("X_left") == "stall"
    assert family_of("de") == "actuator_de"
    assert family_of("something") == "something"


def test_what_is_not_finite_is_refused() -> None:
    with pytest.raises(BadInput, match="not_finite"):
        modes_of(linear(("alpha", "q"), np.array([[np.nan, 1.0], [0.0, 1.0]])))
