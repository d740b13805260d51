"""Lookup tables of strip theory: their error, the simulator with them, the flight computer's."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from alula.aircraft import Aircraft, load_aircraft
from alula.base.messages import BadInput
from alula.model import VARIABLES, AeroModel, evaluate_in_core
from alula.predict.strip_model import COEFFICIENTS, StripModel, strip_model
from alula.predict.strip_tables import Grid, strip_tables, table_grid
from alula.predict.table_error import FLIGHT, table_errors
from alula.predict.tables import table_header, write_table_header
from alula.simulate.airframe import airframe_of, core_model
from alula.simulate.plant import further_states, plant_inputs, plant_outputs, plant_rates

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / "aircraft" / "armhawk.toml"


@pytest.fixture(scope="module")
def aircraft() -> Aircraft:
    return load_aircraft(FILE)


@pytest.fixture(scope="module")
def strips(aircraft: Aircraft) -> StripModel:
    return strip_model(aircraft, downwash=0.48)


@pytest.fixture(scope="module")
def grid() -> Grid:
    return table_grid(4.0)


@pytest.fixture(scope="module")
def tables(strips: StripModel, grid: Grid, aircraft: Aircraft) -> AeroModel:
    return strip_tables(strips, grid, aircraft.reference_point)


def test_at_the_breakpoints_the_tables_are_exact(
    strips: StripModel, grid: Grid, tables: AeroModel
) -> None:
    rng = np.random.default_rng(2)
    n = 50

    def pick(name: str) -> np.ndarray:
        return rng.choice(grid[name], n)

    zero = {v: np.zeros(n) for v in FLIGHT}
    cases = [("alpha", "beta", "wash"), ("alpha", "de", "wash"), ("beta", "dr", "wash")]
    kept = [COEFFICIENTS, ("CD", "CL", "Cm"), ("CY", "Cl", "Cn")]
    for axes, names in zip(cases, kept, strict=True):
        at = {**zero, **{a: pick(a) for a in axes}}
        made, true = evaluate_in_core(tables, at), strips.evaluate(at)
        for c in names:
            np.testing.assert_allclose(made[c], true[c], atol=1e-12, err_msg=f"{c} {axes}")


def test_finer_tables_are_nearer(
    strips: StripModel, grid: Grid, tables: AeroModel, aircraft: Aircraft
) -> None:
    fine = table_grid(2.0)
    nearer = strip_tables(strips, fine, aircraft.reference_point)
    coarse_error = table_errors(strips, tables, grid, points=500)
    fine_error = table_errors(strips, nearer, fine, points=500)
    for c in ("CL", "CD", "Cm"):
        # Linear interpolation: a quarter where the curve is smooth, less where it has the stall.
        assert fine_error[0].rms[c] < 0.75 * coarse_error[0].rms[c]
    flight = fine_error[2]
    for c in COEFFICIENTS:
        assert flight.rms[c] < 0.06 * flight.size[c]  # of the coefficient's own size
    assert "in flight" in flight.text


def test_the_plant_flies_with_the_slipstream_of_its_propeller(
    aircraft: Aircraft, tables: AeroModel
) -> None:
    frame = airframe_of(aircraft, engines="modeled")
    plant = core_model(frame, tables)
    assert "omega" in further_states(plant)
    x = np.zeros(plant.state_count)
    V, alpha, omega = 15.0, 0.1, 600.0
    x[3] = 1.0
    x[7:10] = V * np.cos(alpha), 0.0, V * np.sin(alpha)
    place = 13 + further_states(plant).index("omega")
    x[place] = omega
    u = np.zeros(len(plant_inputs(plant)))
    _, y = plant_rates(plant, x, u)
    out = dict(zip(plant_outputs(plant), y, strict=True))
    D, rho = 0.508, out["rho"]
    u0 = V * np.cos(alpha)
    wash = (np.sqrt(u0**2 + 2.0 * out["thrust"] / (rho * np.pi * 0.25 * D**2)) - u0) / V
    assert 0.5 < wash < 2.0
    at = {v: np.zeros(1) for v in FLIGHT} | {"alpha": np.array([alpha]), "wash": np.array([wash])}
    expected = evaluate_in_core(tables, at)
    found = [out[k] for k in ("C_0", "C_1", "C_2", "Cl", "Cm", "Cn")]
    np.testing.assert_allclose(found, [expected[c][0] for c in COEFFICIENTS], rtol=1e-9)
    assert out["Cl"] > 0.0 > out["Cn"]
    x[place] = 0.0  # a propeller that stands blows nothing
    calm = plant_rates(plant, x, u)[1]
    still = evaluate_in_core(tables, {**at, "wash": np.zeros(1)})
    np.testing.assert_allclose(calm[14], still["Cl"][0], atol=1e-12)


def test_a_resolution_out_of_reason_is_refused() -> None:
    with pytest.raises(BadInput, match="resolution"):
        table_grid(0.1)


def test_exporters_that_know_no_slipstream_say_so(tables: AeroModel) -> None:
    with pytest.raises(BadInput, match=r"DAVE-ML.*'wash'"):
        tables.check_without_wash("DAVE-ML")


def test_a_header_needs_a_name(tables: AeroModel) -> None:
    with pytest.raises(BadInput, match="ARM-Hawk"):
        table_header(tables, "ARM-Hawk")


@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler: install g++")
def test_the_flight_computers_header_gives_the_same(
    tables: AeroModel, strips: StripModel, grid: Grid, tmp_path: Path
) -> None:
    errors = table_errors(strips, tables, grid, points=200)
    size = write_table_header(tmp_path / "hawk.hpp", tables, "hawk", errors)
    values = sum(t.values.size for t in tables.tables.values())
    assert 4 * values < size < 4 * values + 8000  # the breakpoints beside
    n = 20
    rng = np.random.default_rng(4)
    at = {v: np.float32(rng.uniform(*FLIGHT[v], n)).astype(float) for v in FLIGHT}
    rows = np.zeros((n, 1 + len(VARIABLES)))
    rows[:, 0] = 1.0
    for name, x in at.items():
        rows[:, 1 + VARIABLES.index(name)] = x
    points = ", ".join("{" + ", ".join(f"{v:.9g}" for v in row) + "}" for row in rows)
    (tmp_path / "main.cpp").write_text(
        f"""#include <cstdio>
#include "hawk.hpp"
int main() {{
  const double points[{n}][{1 + len(VARIABLES)}] = {{{points}}};
  for (const auto& point : points) {{
    float slots[alula::kMaxSlots];
    for (int i = 0; i < alula::kVariables; ++i) slots[i] = static_cast<float>(point[i]);
    alula::fill_slots(hawk::table, slots, hawk::lookups);
    for (float c : alula::coefficients(hawk::table, hawk::values, slots)) std::printf("%.9g ", c);
    std::printf("\\n");
  }}
}}
"""
    )
    include = ROOT / "core" / "include"
    command = ["g++", "-std=c++20", "-O0", f"-I{include}", "main.cpp", "-o", "main"]
    subprocess.run(command, cwd=tmp_path, check=True, timeout=300)
    text = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    found = np.array([line.split() for line in text.splitlines()], dtype=float)
    true = evaluate_in_core(tables, at)
    for j, c in enumerate(COEFFICIENTS):
        # Single precision: 1e-7 of coefficients up to 10, thirty of them added.
        np.testing.assert_allclose(found[:, j], true[c], atol=2e-5, err_msg=c)
