"""The demo's logs: deterministic, and identifiable by what its maneuvers excite."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pandas as pd
import pytest

from alula.aircraft import load_aircraft
from alula.base.project import load_project
from alula.model import load_model, regressors

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def demo() -> ModuleType:
    path = ROOT / "examples" / "demo" / "make_logs.py"
    spec = importlib.util.spec_from_file_location("make_logs", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["make_logs"] = module  # where dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def test_same_seed_same_bytes(demo: ModuleType, tmp_path: Path) -> None:
    a, b = demo.simulate_demo(7, tmp_path / "a"), demo.simulate_demo(7, tmp_path / "b")
    c = demo.simulate_demo(8, tmp_path / "c")
    for one, two, other in zip(a.logs, b.logs, c.logs, strict=True):
        assert one.read_bytes() == two.read_bytes()
        assert one.read_bytes() != other.read_bytes()
    assert a.truth.read_bytes() == b.truth.read_bytes()


def test_project_names_what_the_logs_hold(demo: ModuleType, tmp_path: Path) -> None:
    files = demo.simulate_demo(1, tmp_path)
    project = load_project(files.project)
    truth = json.loads(files.truth.read_text())
    for path, log in zip(files.logs, project.logs, strict=True):
        assert path == log.path
        columns = set(pd.read_csv(path, nrows=2).columns)
        assert {s for c in project.channels_of(log).values() for s in c.sources} == columns
    names = {
        name
        for coefficient, formula in project.identify.models.items()
        for name in regressors(coefficient, formula, _ones())[0]
    }
    # Lateral constants are identified though their truth is zero and so not in the model.
    assert names - set(truth["parameters"]) == {"CY_0", "Cl_0", "Cn_0"}
    # The drag rise beyond 0.2 rad is zero wherever the demo flies.
    assert set(truth["parameters"]) - names == {"CD_(alpha-0.2)+2"}
    assert set(project.reconstruct.unknowns) <= set(truth["constants"])


def _ones() -> dict[str, np.ndarray]:
    names = ("V", "alpha", "beta", "phat", "qhat", "rhat", "de", "da", "dr", "df", "dt", "mach")
    return {name: np.ones(2) for name in names}


def test_sensors_err_by_what_is_stated(demo: ModuleType, tmp_path: Path) -> None:
    files = demo.simulate_demo(3, tmp_path)
    constants = json.loads(files.truth.read_text())["constants"]
    aircraft = load_aircraft(ROOT / "aircraft" / "sportstar.toml")
    model = load_model(ROOT / "aircraft" / "sportstar_aero.toml")
    flights = demo.fly_demo(aircraft, model)
    for path in files.logs:
        log = pd.read_csv(path)
        for name, truth in demo.sensed(flights[path.stem], aircraft).items():
            unit, si = demo.UNITS[name]
            error = log[f"{name}_{unit}"].to_numpy() * si - truth
            expected = constants.get(f"b_{name}", 0.0) + constants.get(f"k_{name}", 0.0) * truth
            noise, n = (error - expected) / demo.NOISE[name], len(truth)
            assert abs(noise.mean()) < 5 / np.sqrt(n), name  # five sigma
            assert abs(noise.std() - 1.0) < 5 / np.sqrt(2 * n), name


def test_maneuvers_stay_in_the_envelope(demo: ModuleType) -> None:
    aircraft = load_aircraft(ROOT / "aircraft" / "sportstar.toml")
    model = load_model(ROOT / "aircraft" / "sportstar_aero.toml")
    for flight in demo.fly_demo(aircraft, model).values():
        m = flight.motion
        assert aircraft.envelope.V is not None
        assert aircraft.envelope.V[0] < m.V.min() < m.V.max() < aircraft.envelope.V[1]
        assert -4.0 * 9.81 < m.az.min() < m.az.max() < 0.0  # light aircraft's load factor, no push
        for name in ("alpha", "beta"):
            low, high = model.validity[name]
            assert low <= getattr(m, name).min() <= getattr(m, name).max() <= high, name
