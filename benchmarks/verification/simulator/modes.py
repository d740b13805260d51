"""Modes of the SportStar and the X8: roots of the full linear model, names under reordering."""

from __future__ import annotations

import numpy as np

from alula.aircraft import load_aircraft
from alula.model import load_model
from alula.simulate import Condition, LinearModel, Mode, airframe_of, linearize, modes_of, trim
from alula.simulate.airframe import core_model
from verification.places import ROOT

AIRCRAFT = ROOT / "aircraft"
CASES = {"sportstar": (45.0, 1000.0), "x8": (18.0, 500.0)}


def modes(quick: bool) -> tuple[str, bool]:
    """Largest distance of a root to the full model's eigenvalues; shuffled orders and units."""
    said, good = [], True
    trials = 20 if quick else 200
    for name, (V, h) in CASES.items():
        aircraft = load_aircraft(AIRCRAFT / f"{name}.toml")
        assert aircraft.aero is not None
        model = load_model(aircraft.aero)
        frame = airframe_of(aircraft, engines="modeled", actuators=True)
        steady = trim(frame, model, Condition(V, h), limits=aircraft.control_limits)
        full = linearize(core_model(frame, model), steady.state, steady.inputs)
        found = modes_of(full.motion(), V)
        roots = [z for m in found for z in {m.eigenvalue, m.eigenvalue.conjugate()}]
        # heading and place: three more, at zero, on which nothing depends
        wanted = np.linalg.eigvals(full.A)
        far = max(float(np.min(np.abs(wanted - z))) for z in roots)
        complete = len(roots) + 3 == len(wanted)
        kept = sum(_same(found, _shuffled(full.motion(), seed), V) for seed in range(trials))
        names = ", ".join(m.words for m in found)
        said.append(f"{name}: {names}; {far:.0e} 1/s, names kept in {kept} of {trials} orders")
        good = good and complete and far < 1e-6 and kept == trials
    return "; ".join(said), good


def _same(found: tuple[Mode, ...], shuffled: LinearModel, V: float) -> bool:
    roots = {m.name: m.eigenvalue for m in found}
    again = modes_of(shuffled, V)
    return set(roots) == {m.name for m in again} and all(
        abs(m.eigenvalue - roots[m.name]) <= 1e-6 * (1.0 + abs(m.eigenvalue)) for m in again
    )


def _shuffled(part: LinearModel, seed: int) -> LinearModel:
    """Other order of the states, other units."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(part.states))
    unit = 10.0 ** random.uniform(-2.0, 2.0, len(part.states))
    A = (part.A * unit / unit[:, None])[np.ix_(order, order)]
    n = len(order)
    states = tuple(part.states[i] for i in order)
    return LinearModel(states, (), (), A, np.zeros((n, 0)), np.zeros((0, n)), np.zeros((0, 0)))
