"""Speed of output error: the baseline's longitudinal case beside its numba program, in turn.

4 states, 10 parameters, 6 outputs, 1000 samples, drag CD0 + K CL^2. Both estimate from the same
first values, 15 % off, with the noise known. Ours counts from measurements to estimates with their
Cramer-Rao bounds, the copy into the core included, the reading of the formulas not, as the peer's
formulas are in its program; the first of all runs, in a fresh process, is told
apart: there numba compiles. Both use one thread, and processor time is taken: on an idle machine it
is what the clock shows.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np

import cases
from alula.flight import Maneuver
from alula.identify import Reference
from alula.identify.flown.fit import OutputErrorFit, fit_output_error
from alula.identify.flown.measured_maneuver import STATES, MeasuredManeuver
from alula.identify.flown.problem import Setting
from alula.model import AeroModel, aero_model
from alula.model import Reference as ModelReference

FORMULAS = {"CL": "1 + alpha + qhat + de", "CD": "1 + CL^2", "Cm": "1 + alpha + qhat + de"}
NAMES = (
    "CL_0", "CL_alpha", "CL_q", "CL_de", "CD_0", "CD_CL2", "Cm_0", "Cm_alpha", "Cm_q", "Cm_de",
)  # fmt: skip
OUTPUTS = ("V", "alpha", "theta", "q", "ax", "az")
SPAN = 9.0  # m; no lateral motion sees it


def baseline() -> Any:
    """The baseline's module, or ModuleNotFoundError."""
    folder = str(cases.BASELINES)
    if folder not in sys.path:
        sys.path.insert(0, folder)
    import output_error

    return output_error


def case(b: Any, data: dict[str, Any]) -> tuple[MeasuredManeuver, AeroModel]:
    """The case as Alula's values."""
    n = len(data["t"])
    force = np.zeros((n, 3))
    force[:, 0] = data["inputs"][:, 1]
    start = dict.fromkeys(STATES, np.zeros(n))
    start |= {
        k: np.full(n, x) for k, x in zip(("V", "alpha", "theta", "q"), data["x0"], strict=True)
    }
    maneuver = MeasuredManeuver(
        maneuver=Maneuver("case", "case", "3211", 0.0, 20.0),
        t=data["t"],
        outputs=dict(zip(OUTPUTS, data["measurements"].T, strict=True)),
        motion=start,
        controls={"de": data["inputs"][:, 0]},
        rho=np.full(n, b.RHO),
        reference=Reference(b.AREA, SPAN, b.CHORD, np.zeros(3)),
        mass=b.MASS,
        inertia=np.diag([b.INERTIA, b.INERTIA, 2.0 * b.INERTIA]),
        speed_of_sound=np.full(n, 340.0),
        force=force,
        moment=np.zeros((n, 3)),
        arm=np.zeros(3),
        gravity=b.G0,
    )
    model = aero_model(
        "case", FORMULAS, dict(zip(NAMES, data["start"].tolist(), strict=True)),
        ModelReference(b.AREA, SPAN, b.CHORD), axes="stability",
    )  # fmt: skip
    return maneuver, model


def ours(maneuver: MeasuredManeuver, model: AeroModel, sigma: Any) -> OutputErrorFit:
    """From readings and formulas to estimates."""
    setting = Setting(("V", "alpha", "theta", "q"), OUTPUTS, initial="measured")
    noise = dict(zip(OUTPUTS, sigma.tolist(), strict=True))
    return fit_output_error([maneuver], model, setting, noise=noise)


def measured(rounds: int) -> dict[str, float]:
    """Seconds of both (best and first), and how far apart their results are.

    apart: largest difference of estimates in standard errors; errors: of their errors, relative.
    """
    b = baseline()
    data = b.case()
    maneuver, model = case(b, data)
    seconds: dict[str, list[float]] = {"ours": [], "numba": []}
    found: dict[str, Any] = {}
    for _ in range(rounds + 1):
        for name, run in (
            ("ours", lambda: ours(maneuver, model, data["sigma"])),
            ("numba", lambda: b.numba(data)),
        ):
            begin = time.thread_time()
            found[name] = run()
            seconds[name].append(time.thread_time() - begin)
    fit, (theirs, se, _) = found["ours"], found["numba"]
    value = np.array([fit.params[n] for n in NAMES])
    order = [fit.problem.names.index(n) for n in NAMES]
    own = np.sqrt(np.diag(np.linalg.inv(fit.found.information)))[order]
    return {
        "ours": min(seconds["ours"][1:]),
        "numba": min(seconds["numba"][1:]),
        "ours_first": seconds["ours"][0],
        "numba_first": seconds["numba"][0],
        "apart": float(np.max(np.abs(value - theirs) / se)),
        "errors": float(np.max(np.abs(own / se - 1.0))),
    }


def bench_row(rounds: int = 12) -> dict[str, Any]:
    """A row of build/bench.json. Raises SystemExit where the results are not the same."""
    got = measured(rounds)
    if not got["apart"] <= 1e-3:
        raise SystemExit(f"output error: {got['apart']:.1e} standard errors apart: no ratio counts")
    return {
        "name": "output_error",
        "ours_s": got["ours"],
        "peer": "output_error_numba",
        "peer_s": got["numba"],
        "ratio": got["numba"] / got["ours"],
        "allocations": None,
    }


def f(quick: bool) -> tuple[str, bool]:
    """The row: baseline case to 1e-3 standard errors, under 0.01 s, 2.5 times numba."""
    got = measured(5 if quick else 20)
    ratio = got["numba"] / got["ours"]
    words = (
        f"{1e3 * got['ours']:.1f} ms against numba's {1e3 * got['numba']:.1f} ms: {ratio:.1f} "
        f"times (first run {1e3 * got['ours_first']:.0f} ms, numba with its compiler "
        f"{got['numba_first']:.1f} s); {got['apart']:.0e} standard errors apart"
    )
    good = got["apart"] <= 1e-3 and got["errors"] <= 1e-3
    return words, good and got["ours"] < 0.01 and ratio >= 2.5
