"""From a flight log to an aerodynamic model with error bars."""

from __future__ import annotations

import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from verification.main_job.harv import harv_reconstruction
from verification.main_job.published import ATTAS_BIASES, TWIN_OTTER
from verification.places import DATA
from verification.registry import row
from verification.run import (
    ROOT,
    command,
    constants,
    identified,
    parameters,
    run_tests,
    within,
)


@row(
    "main-job",
    "Twin Otter 018, columns as recorded",
    "Cm_alpha, Cm_q, Cm_de as published to 0.1 %, CZ slopes to 0.5 %; coloured-residual standard "
    "errors within 5 % of the published, plain ones beside",
)
def twin_otter(quick: bool) -> tuple[str, bool]:
    _, envelope = identified("twin_otter.toml")
    found = parameters(envelope["result"])
    values = within(
        {n: found[n]["value"] for n in TWIN_OTTER},
        {n: (v, m * abs(v)) for n, (v, _, m) in TWIN_OTTER.items()},
    )
    errors = within(
        {n: found[n]["se"] for n in TWIN_OTTER},
        {n: (se, 0.05 * se) for n, (_, se, _) in TWIN_OTTER.items()},
    )
    plain = all(found[n]["se_white"] > 0 for n in TWIN_OTTER)
    return f"values: {values[0]}; standard errors: {errors[0]}", values[1] and errors[1] and plain


@row(
    "main-job",
    "ATTAS, three maneuvers, maximum likelihood",
    "b_ax, b_ay within 2e-3, b_az within 1e-2 m/s2, rates within 1e-4 rad/s of the published; "
    "open-loop mismatch V < 0.3 m/s, alpha < 0.2 deg, theta < 0.2 deg; the filters agree within "
    "3 sigma of their own",
)
def attas_reconstruction(quick: bool) -> tuple[str, bool]:
    _, envelope = identified("attas.toml", "ml")
    reconstruction = envelope["result"]["reconstruction"]
    reference = constants(envelope["result"])
    biases = within({n: reference[n][0] for n in ATTAS_BIASES}, ATTAS_BIASES)
    m = reconstruction["mismatch"]
    limits = {"V": 0.3, "alpha_deg": 0.2, "theta_deg": 0.2}
    close = all(m[n] < most for n, most in limits.items())
    apart = {}
    for name in ("ekf", "ukf"):
        other = constants(identified("attas.toml", name)[1]["result"])
        apart[name] = max(abs(other[n][0] - reference[n][0]) / other[n][1] for n in ATTAS_BIASES)
    got = (
        f"{biases[0]}; V {m['V']:.3f} m/s, alpha {m['alpha_deg']:.3f} deg, theta "
        f"{m['theta_deg']:.3f} deg; from the maximum likelihood: "
        + ", ".join(f"{n} {a:.1f} sigma" for n, a in apart.items())
    )
    return got, biases[1] and close and all(a <= 3 for a in apart.values())


# The data's independent fit, moments halved: the book's lateral length is the half span.
ATTAS_CLOSE = {
    "CL_alpha": 5.222,
    "CY_beta": -1.0035,
    "Cl_p": -0.3845,
    "Cl_da": -0.0975,
    "Cn_beta": 0.12725,
    "Cn_dr": -0.0718,
}
ATTAS_LOOSE = {"Cl_beta": -0.051, "Cl_r": 0.1195, "Cn_r": -0.0665, "Cn_p": -0.022}
ATTAS_R2 = {"CL": 0.99, "Cl": 0.975, "CY": 0.96, "Cn": 0.955}


@row(
    "main-job",
    "ATTAS equation error",
    "R2: CL > .99, Cl > .975, CY > .96, Cn > .955; main derivatives within 6 % of the data's "
    "values; Cl_beta, Cl_r, Cn_r, Cn_p within the larger of 20 % and 3 coloured standard errors",
)
def attas_equation_error(quick: bool) -> tuple[str, bool]:
    result = identified("attas.toml")[1]["result"]
    found = parameters(result)
    fits = {n: result["fit"][n]["r2"] for n in ATTAS_R2}
    margins = {n: (v, 0.06 * abs(v)) for n, v in ATTAS_CLOSE.items()}
    for n, v in ATTAS_LOOSE.items():
        margins[n] = (v, max(0.2 * abs(v), 3 * found[n]["se"]))
    slopes = within({n: found[n]["value"] for n in margins}, margins)
    r2 = ", ".join(f"{n} {v:.4f}" for n, v in fits.items())
    return f"R2 {r2}; {slopes[0]}", slopes[1] and all(fits[n] > ATTAS_R2[n] for n in fits)


FOOT = 0.3048


@row(
    "main-job",
    "HARV",
    "ax, az bias and both scale errors within three published standard errors; q bias within "
    "5e-5 rad/s",
)
def harv(quick: bool) -> tuple[str, bool]:
    from scipy.io import loadmat

    published = loadmat(DATA / "harv" / "compat_lon_example.mat")
    names = ("b_ax", "b_az", "b_q", "k_alpha", "k_theta")
    # The source's biases are added to the measurement; ours are in it.
    units = np.array([-FOOT, -FOOT, -1.0, 1.0, 1.0])
    value = published["pc"].ravel()[:5] * units
    se = np.sqrt(np.diag(published["crbc"]))[:5] * abs(units)
    margin = dict(zip(names, 3 * se, strict=True)) | {"b_q": 5e-5}
    done = harv_reconstruction(DATA / "harv" / "compat_lon_example.mat")
    found = {c.name: (c.value, c.se) for c in done.constants}
    return within(
        {n: found[n][0] for n in names},
        {n: (float(v), float(margin[n])) for n, v in zip(names, value, strict=True)},
    )


@row(
    "main-job",
    "Citation two-step, 100 fixed independent seeds",
    "wind and biases recovered; pooled coverage of 95 % intervals 92 to 98 %, no parameter under "
    "86 %; average NEES in its 95 % bounds at 90 % or more of the times after 10 s; what de3211 "
    "cannot observe is reported, not counted",
)
def citation_two_step(quick: bool) -> tuple[str, bool]:
    from verification.main_job import two_step, two_step_linear

    seeds, every, folder = range(3 if quick else 100), 4 if quick else 1, DATA / "citation_two_step"
    v = two_step.monte_carlo(folder, seeds, every=every)
    paired = two_step_linear.paired_table(folder, seeds, every=every)
    worst = min(v.coverage, key=lambda n: v.coverage[n])
    each = ", ".join(f"{name} {100 * share:.0f} %" for name, share in v.nees_inside.items())
    low = min(v.nees_inside, key=lambda n: v.nees_inside[n])
    apart = max(paired.values(), key=lambda p: abs(p.difference))
    got = (
        f"{len(seeds)} seeds x 5 recordings: pooled {100 * v.pooled:.1f} %, least {worst} "
        f"{100 * v.coverage[worst]:.0f} %; average NEES of all flights inside at "
        f"{100 * v.nees_pooled:.0f} % of the times (by recording: {each}; "
        f"an exactly linear filter under the same noise: {low} "
        f"{100 * paired[low].linear_inside:.0f} %; NEES minus the linear filter's at most "
        f"{abs(apart.difference):.4f} +- {apart.error:.4f} of the freedom); "
        f"not observable: {', '.join(v.unobservable) or 'none'}"
    )
    least = v.nees_inside[low]  # of every recording, not only of their average
    held = 0.92 <= v.pooled <= 0.98 and v.coverage[worst] >= 0.86 and least >= 0.9
    return got, held and not quick


@row(
    "main-job",
    "demo's truth",
    "inside the 99.9 % intervals; over 200 seeds pooled coverage 92 to 98 %, none under 88 %; each "
    "excited derivative reads ok, standard error under 10 % for the seven main ones",
)
def demo_truth(quick: bool) -> tuple[str, bool]:
    from verification.main_job.demo_coverage import coverage, run_seeds

    runs = run_seeds(range(1000, 1004 if quick else 1200))
    c = coverage(runs)
    main = {"Cm_alpha", "Cm_q", "Cm_de", "Cl_p", "Cl_da", "Cn_beta", "Cn_dr"}
    first = runs[0]
    far = [e.name for e in first if _beyond(e)]
    share = float(np.mean([_beyond(e) for run in runs for e in run]))
    unclear = [e.name for e in first if not e.name.endswith("_0") and e.verdict != "ok"]
    wide = max(e.se / abs(e.value) for e in first if e.name in main)
    got = (
        f"{len(runs)} seeds: pooled {100 * c.pooled:.1f} %, least {c.worst[0]} "
        f"{100 * c.worst[1]:.0f} %; outside 99.9 %: "
        f"{far or 'none'} (of all seeds {100 * share:.2f} %); not ok: {unclear or 'none'}; "
        f"largest standard error of the main ones {100 * wide:.1f} %"
    )
    held = 0.92 <= c.pooled <= 0.98 and c.worst[1] >= 0.88
    return got, held and not quick and not far and not unclear and wide < 0.1


def _beyond(estimate) -> bool:
    """Whether the truth lies outside the 99.9 % interval, by the half width of the 95 % one."""
    se = (estimate.high - estimate.low) / (2 * 1.959964)
    return abs(estimate.value - estimate.truth) > 3.29 * se


@row(
    "main-job",
    "two collinear regressors; an unexcited parameter",
    "not_identifiable, combination named, exit 1",
)
def collinear(quick: bool) -> tuple[str, bool]:
    rng = np.random.default_rng(1)
    t = np.arange(0.0, 10.0, 0.02)
    alpha = 0.05 + 0.03 * np.sin(1.7 * t) + 0.02 * np.sin(4.1 * t)
    de = 0.04 * np.sign(np.sin(1.1 * t))
    q = np.gradient(alpha, t)
    noise = rng.standard_normal
    channels = {
        "t": t,
        "V": 60.0 + 0.1 * noise(t.size),
        "alpha": alpha,
        "beta": 2.0 * alpha,
        "p": np.zeros_like(t) + 1e-5 * noise(t.size),
        "q": q,
        "r": 1e-5 * noise(t.size),
        "phi": 1e-4 * noise(t.size),
        "theta": alpha,
        "psi": 1e-4 * noise(t.size),
        "ax": 0.5 + 0.01 * noise(t.size),
        "ay": 0.01 * noise(t.size),
        "az": -9.8 - 60.0 * (alpha - 0.05) + 0.01 * noise(t.size),
        "de": de,
        "dr": np.zeros_like(t),
    }
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        np.savez(root / "log.npz", **channels)
        source = "\n".join(f'{n} = {{from = "{n}", unit = "{_unit(n)}"}}' for n in channels)
        aircraft = ROOT / "aircraft" / "sportstar.toml"
        (root / "project.toml").write_text(
            f'schema = "alula.project/1"\nname = "collinear"\naircraft = "{aircraft}"\n'
            f'[[logs]]\nid = "log"\npath = "log.npz"\n[channels]\n{source}\n'
            '[[maneuvers]]\nid = "m"\nlog = "log"\nkind = "3211"\nstart = 0.0\nend = 9.9\n'
            '[reconstruct]\nfilter = "none"\n[identify]\nmethod = "ee"\n[identify.models]\n'
            'CZ = "1 + alpha + beta"\nCY = "1 + dr"\n'
        )
        code, envelope = command("identify", root / "project.toml")
    found = parameters(envelope["result"])
    verdicts = {n: found[n]["verdict"] for n in ("CZ_alpha", "CZ_beta", "CY_dr")}
    tied = [t["name"] for t in found["CZ_alpha"]["tied_to"]]
    got = f"{verdicts}, CZ_alpha tied to {tied}, exit {code}"
    return got, (
        set(verdicts.values()) == {"not_identifiable"} and tied == ["CZ_beta"] and code == 1
    )


def _unit(channel: str) -> str:
    if channel in ("ax", "ay", "az"):
        return "m/s2"
    if channel in ("p", "q", "r"):
        return "rad/s"
    return {"t": "s", "V": "m/s"}.get(channel, "rad")


@row("main-job", "weighing", "recovers a synthetic CG to 1 mm")
def weighing(quick: bool) -> tuple[str, bool]:
    from alula.aircraft import center_of_gravity

    mass, cg = 375.0, np.array([-0.312, 0.021, -0.164])
    axles = np.array([[1.21, 0.0, 0.92], [-0.68, -0.95, 0.88], [-0.66, 0.96, 0.88]])
    angles, readings = [0.0, 0.0, 6.0, 9.0, 12.0], []
    for angle in angles:  # statics in the Earth's axes: vertical forces, moments about the CG
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        lever = (axles - cg) @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]).T
        forces = np.linalg.solve(np.vstack([np.ones(3), lever[:, :2].T]), [mass, 0.0, 0.0])
        readings.append(forces.round(2))  # scales that show 10 g
    off = float(np.abs(center_of_gravity(readings, angles, axles).cg - cg).max())
    return f"{1e3 * off:.3f} mm", off < 1e-3


@row(
    "main-job",
    "the bad-input list",
    "one test per item in tests/bad_input/: exit code 2 or a named warning, no traceback",
)
def bad_input(quick: bool) -> tuple[str, bool]:
    return run_tests("tests/bad_input")


@row(
    "main-job",
    "filters, speed",
    "unscented at least 3 times numba in the same run with _core_v3, 2 times with _core; extended "
    "5 times the numba unscented and faster than the numba extended filter; zero allocations",
)
def filter_speed(quick: bool) -> tuple[str, bool]:
    import bench
    import cases

    if not cases.available():
        return f"peers not found in {cases.BASELINES}", False
    # Enough rounds that each meets a quiet moment of a shared machine: few flatter the shorter run.
    rows = bench.filter_rows(6 if quick else 40)
    least = {
        ("ukf_core_v3", "ukf_numba"): 3.0,
        ("ukf_core", "ukf_numba"): 2.0,
        ("ekf_core_v3", "ukf_numba"): 5.0,
        ("ekf_core", "ukf_numba"): 5.0,
        ("ekf_core_v3", "ekf_numba"): 1.0,
        ("ekf_core", "ekf_numba"): 1.0,
    }
    got = "; ".join(
        f"{r['name']} {r['ratio']:.2f} ({r['ratio_median']:.2f} by medians) x {r['peer']}"
        for r in rows
    )
    fast = all(r["ratio"] >= least.get((r["name"], r["peer"]), 0.0) for r in rows)
    still = all(r["allocations"] == 0 for r in rows)
    return f"{got}; allocations {'none' if still else 'not none'}", fast and still


@row(
    "main-job",
    "`alula identify` on the ATTAS project with report",
    "under 4 s; `alula --help` imports neither NumPy nor pandas",
)
def identify_seconds(quick: bool) -> tuple[str, bool]:
    project = ROOT / "examples" / "real" / "attas.toml"
    best = np.inf
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(1 if quick else 3):
            begin = time.perf_counter()
            command("identify", project, "--report", Path(folder) / "report.html")
            best = min(best, time.perf_counter() - begin)
    helped = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "alula", "--help"],
        capture_output=True,
        text=True,
        cwd=ROOT,
    )
    heavy = sorted(set(re.findall(r"\| +(numpy|pandas)$", helped.stderr, re.M)))
    got = f"{best:.2f} s; --help exits {helped.returncode}, imports {heavy or 'neither'}"
    return got, best < 4.0 and helped.returncode == 0 and not heavy


@row(
    "main-job",
    "report",
    "under 3 MB, no request to anywhere, no script from a channel name, every plot readable",
)
def report(quick: bool) -> tuple[str, bool]:
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "report.html"
        command("identify", ROOT / "examples" / "real" / "attas.toml", "--report", page)
        size = page.stat().st_size / 1e6
    summary, passed = run_tests("tests/report")
    return f"ATTAS {size:.2f} MB; in the browser: {summary}", passed and size < 3.0


@row(
    "main-job",
    "fresh clone, no caches of ours",
    "both README commands exit 0; compiling under 100 s of processor time",
)
def fresh_clone(quick: bool) -> tuple[str, bool]:
    if quick:
        return "not run in a quick look", False
    env = {name: value for name, value in os.environ.items() if name != "INSTRUCTION_SETS"}
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "alula"
        subprocess.run(["git", "clone", "-q", str(ROOT), str(clone)], check=True)
        codes = {
            target: subprocess.run(
                ["make", target], cwd=clone, env=env, capture_output=True
            ).returncode
            for target in ("demo", "test")
        }
        # Once more without pip, whose own work is not compiling.
        cmake = clone / ".venv" / "bin" / "cmake"
        build = next((clone / "build" / "host").glob("CMakeCache.txt")).parent
        before = _processor_time()
        again = [cmake, "--build", build, "--clean-first", "--parallel", str(os.cpu_count())]
        subprocess.run(again, check=True, capture_output=True)
        compiling = _processor_time() - before
    holds = all(code == 0 for code in codes.values()) and compiling < 100.0
    return f"{codes}; compiling {compiling:.0f} s with {os.cpu_count()} jobs", holds


def _processor_time() -> float:
    """Of all child processes that have ended, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
