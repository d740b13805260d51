"""The ARM-Hawk's lookup tables: time to build, error, time of a lookup; and of a term table."""

from __future__ import annotations

import time

import numpy as np

from alula.aircraft import load_aircraft
from alula.base.arrays import Array
from alula.model import VARIABLES, AeroModel, Reference, aero_model, to_table
from alula.predict.strip_model import StripModel, strip_model
from alula.predict.strip_tables import strip_tables, table_grid
from alula.predict.table_error import FLIGHT, table_errors
from verification.prediction.armhawk_aircraft import DOWNWASH, FILE

BUILT, LOOKUP, TERMS = 60.0, 2.0, 0.5  # s; microseconds
_STEP = 1e-3


def armhawk_tables(quick: bool) -> tuple[str, bool]:
    """The row: what was found, and whether it is as it must be."""
    aircraft = load_aircraft(FILE)
    strips = strip_model(aircraft, downwash=DOWNWASH)
    resolution = 2.0 if quick else 1.0
    begin = time.process_time()
    grid = table_grid(resolution)
    tables = strip_tables(strips, grid, aircraft.reference_point)
    built = time.process_time() - begin
    errors = table_errors(strips, tables, grid, points=1000 if quick else 4000)
    lookup = evaluation_time(tables, quick)
    terms = term_model(strips)
    plain = evaluation_time(terms, quick)
    numbers = sum(t.values.size for t in tables.tables.values())
    flight = errors[2]
    text = (
        f"resolution {resolution:g} deg: {len(tables.tables)} tables, {numbers} values, built in "
        f"{built:.2f} s; one lookup of six coefficients {lookup:.2f} us; term table of "
        f"{len(terms.terms)} terms {plain:.2f} us; " + "; ".join(e.text for e in errors)
    )
    close = all(flight.rms[c] < 0.05 * flight.size[c] for c in flight.rms)
    return text, built < BUILT and lookup < LOOKUP and plain < TERMS and close


def evaluation_time(model: AeroModel, quick: bool) -> float:
    """Microseconds of one evaluation, six coefficients: least CPU time of several runs over random
    points of flight, one after the other as they come.
    """
    n = 2000 if quick else 5000
    rng = np.random.default_rng(3)
    rows = np.zeros((n, 1 + len(VARIABLES)))
    rows[:, 0] = 1.0
    for name, (low, high) in FLIGHT.items():
        rows[:, 1 + VARIABLES.index(name)] = rng.uniform(low, high, n)
    out = np.empty((n, 6))
    table = to_table(model)
    least = np.inf
    for _ in range(20):
        begin = time.process_time()
        table.evaluate(model.values, rows, out)
        least = min(least, time.process_time() - begin)
    return float(1e6 * least / n)


def term_model(strips: StripModel) -> AeroModel:
    """Strip theory's derivatives at 4 deg as a model of terms, with those that wash changes."""
    at = {"alpha": np.radians(4.0)}
    text = {
        "CD": "1 + alpha + alpha^2 + wash",
        "CY": "beta + phat + rhat + dr + dr*wash",
        "CL": "1 + alpha + qhat + de + df + alpha*wash + de*wash",
        "Cl": "wash + beta + phat + rhat + da + dr",
        "Cm": "1 + alpha + qhat + de + df + alpha*wash + de*wash",
        "Cn": "wash + beta + phat + rhat + da + dr + dr*wash",
    }
    values: dict[str, float] = {}
    for c, formula in text.items():
        for term in formula.split(" + "):
            factors = term.replace("^2", "").split("*")
            name = f"{c}_{_label(term)}"
            values[name] = 0.0 if term == "1" else _slope(strips, at, c, factors)
    values["CL_0"] = float(strips.evaluate({"alpha": np.zeros(1)})["CL"][0])
    values["Cm_0"] = float(strips.evaluate({"alpha": np.zeros(1)})["Cm"][0])
    values["CD_0"] = float(strips.evaluate({"alpha": np.zeros(1)})["CD"][0])
    return aero_model(
        "ARM-Hawk, terms", text, values, Reference(strips.S, strips.b, strips.c), axes="stability"
    )


def _label(term: str) -> str:
    short = {"phat": "p", "qhat": "q", "rhat": "r", "1": "0", "alpha^2": "alpha2"}
    order = sorted(term.split("*"), key=lambda f: (*VARIABLES, "1", "alpha^2").index(f))
    return "_".join(short.get(f, f) for f in order)


def _slope(strips: StripModel, at: dict[str, float], c: str, factors: list[str]) -> float:
    """Central difference to the first factor; for a product, what unit wash changes of it."""
    first = factors[0]

    def one(wash: float) -> float:
        x: Array = np.array([_STEP, -_STEP])
        given: dict[str, Array] = {k: np.full(2, v) for k, v in at.items()}
        given["wash"] = np.full(2, wash)
        given[first] = given.get(first, np.zeros(2)) + x
        y = strips.evaluate(given)[c]
        return float((y[0] - y[1]) / (2.0 * _STEP))

    return one(1.0) - one(0.0) if factors[1:] == ["wash"] else one(0.5 if first == "wash" else 0.0)


if __name__ == "__main__":
    print(*armhawk_tables(False))
