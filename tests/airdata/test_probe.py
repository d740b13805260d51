"""Five-hole probe: fit to the author's CFD points, inverse, errors, table, bad input."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest

from alula.airdata.cp_fit import Cp, approximated_cp, fit_cp, harmonic_cp, read_points
from alula.airdata.probe import STATUS, FiveHoleProbe, watched
from alula.airdata.probe_table import probe_table
from alula.base.messages import BadInput
from data import data

DEG = np.pi / 180.0


def probe(**changed: float) -> FiveHoleProbe:
    """Pusztai's printed one, 2.4 cos2 - 1.4 at 45 deg."""
    return FiveHoleProbe(harmonic_cp([-0.2, 0.0, 1.2]), 45.0 * DEG, **changed)


def wavy() -> FiveHoleProbe:
    """One with a sine and higher harmonics, and a center port of its own."""
    return FiveHoleProbe(
        Cp(np.array([-1.3677, 0.0, 2.3661]), 0.16835),
        45.0 * DEG,
        harmonic_cp([-0.2, 0.03, 1.15, 0.02]),
    )


def grid(edge: float, points: int = 25) -> tuple[np.ndarray, np.ndarray]:
    a, b = np.meshgrid(*[np.linspace(-edge, edge, points) * DEG] * 2)
    return a.ravel(), b.ravel()


def test_fit_of_the_cfd_points() -> None:
    points = read_points(data("armhawk", "probe_cfd", "cp_over_theta.csv"), (1, 2))
    assert points.shape == (25, 2)
    fit = fit_cp((points[:, 0] + 45.0) * DEG, points[:, 1])
    assert fit.rms < 0.007  # the errata's figure, found there by another hand
    assert np.max(np.abs(fit.cp - (2.4 * np.cos(fit.theta) ** 2 - 1.4))) == pytest.approx(
        0.184, abs=0.001
    )
    # Both forms are the same curve.
    assert fit.as_printed()(fit.theta) == pytest.approx(fit.as_port_angle()(fit.theta - fit.phase))
    assert fit.as_printed()(fit.theta) == pytest.approx(fit.cp, abs=fit.largest + 1e-12)


def test_fit_finds_what_was_put_in() -> None:
    theta = np.linspace(0.0, 1.5, 30)
    a = (0.2, 1.1, -0.15)
    noise = 0.01 * np.random.default_rng(1).standard_normal(30)
    fit = fit_cp(theta, a[0] * np.sin(2 * theta) + a[1] * np.cos(2 * theta) + a[2] + noise)
    # Within four standard errors, which themselves follow from noise of 0.01.
    assert np.all(np.abs(fit.a - a) < 4.0 * np.sqrt(np.diag(fit.covariance)))
    assert fit.rms == pytest.approx(0.01, rel=0.4)


def test_any_cp_is_approximated() -> None:
    """The potential flow about a sphere, c_p = 1 - 9/4 sin2, and a rational function."""
    sphere, off = approximated_cp(lambda x: 1.0 - 2.25 * np.sin(x) ** 2, 0.0, 1.5)
    assert off < 1e-6
    assert sphere(0.7) == pytest.approx(1.0 - 2.25 * np.sin(0.7) ** 2, abs=1e-6)
    _, off = approximated_cp(lambda x: 1.0 / (1.0 + 2.0 * x**2), 0.0, 1.5)
    assert off < 1e-3


@pytest.mark.parametrize("made", [probe, wavy])
def test_inverse_after_forward(made) -> None:
    one = made()
    a, b = grid(35.0)
    for q in (20.0, 800.0):
        found = one.flow(one.pressures(q, a, b))
        assert found.valid.all()
        assert np.max(np.abs(found.alpha - a)) < 1e-9  # Newton's last step squared
        assert np.max(np.abs(found.beta - b)) < 1e-9
        assert found.q == pytest.approx(np.full(len(a), q), rel=1e-9)
        assert np.max(found.iterations) <= 8
    assert one.valid_angle() > 35.0 * DEG


def test_error_map_is_what_noise_does() -> None:
    one, random = wavy(), np.random.default_rng(3)
    q, a, b, sigma = 500.0, 0.3, -0.2, np.array([2.0, 1.0, 1.5])
    n = 20000
    p = one.pressures(q, a, b) + sigma * random.standard_normal((n, 3))
    found = one.flow(p)
    scatter = [np.std(found.alpha), np.std(found.beta), np.std(found.q)]
    # Standard deviations of 20000 numbers scatter by 0.5 %.
    assert one.errors(q, a, b, sigma)[0] == pytest.approx(scatter, rel=0.03)
    axis, maps = one.error_map(q, 2.0, 5)
    assert maps[0].shape == (5, 5)
    assert maps[0][4, 0] == pytest.approx(one.errors(q, axis[4], axis[0], 2.0)[0, 0])


def test_table_keeps_its_stated_error() -> None:
    one = wavy()
    table = probe_table(one, 0.02 * DEG)
    a, b = np.random.default_rng(5).uniform(-34.9 * DEG, 34.9 * DEG, (2, 5000))
    found = table.flow(one.pressures(300.0, a, b))
    assert found.valid.all()
    assert 0.0 < table.error_alpha < 0.02 * DEG
    # Stated at four points a cell and axis: between them a parabola may rise 10 % further.
    assert np.max(np.abs(found.alpha - a)) < 1.1 * table.error_alpha
    assert np.max(np.abs(found.beta - b)) < 1.1 * table.error_beta
    assert np.max(np.abs(found.q / 300.0 - 1.0)) < 1.1 * table.error_q + 1e-6
    assert probe_table(one, 0.1 * DEG).bytes <= table.bytes
    with pytest.raises(BadInput, match="probe_table_error"):
        probe_table(one, 1e-9)


def test_table_header_compiles(tmp_path: Path) -> None:
    """The header is for C++: the compiler of the machine reads it and looks a flow up."""
    one = wavy()
    (tmp_path / "probe_table.h").write_text(probe_table(one, 0.1 * DEG).header())
    p = one.pressures(500.0, 0.2, -0.1)[0]
    (tmp_path / "main.cpp").write_text(
        '#include "probe_table.h"\n#include <cstdio>\nint main() {\n'
        "  alula::airdata::ProbeFlow<float> f;\n"
        f"  alula::airdata::probe_lookup(probe_table, {{{p[0]}f, {p[1]}f, {p[2]}f}}, f);\n"
        '  std::printf("%.6f %.6f %.6f", f.alpha, f.beta, f.q);\n}\n'
    )
    core = Path(__file__).parents[2] / "core" / "include"
    try:
        subprocess.run(
            ["c++", "-std=c++20", f"-I{core}", "main.cpp", "-o", "main"], cwd=tmp_path, check=True
        )
    except FileNotFoundError:
        pytest.skip("no C++ compiler")
    said = subprocess.run([tmp_path / "main"], capture_output=True, text=True, check=True).stdout
    alpha, beta, q = map(float, said.split())
    assert (alpha, beta) == pytest.approx((0.2, -0.1), abs=0.1 * DEG)
    assert q == pytest.approx(500.0, rel=0.01)


def test_what_is_no_flow_is_counted() -> None:
    one = probe()
    good = one.pressures(500.0, 0.1, 0.0)[0]
    rows = [good, [np.nan, 0, 0], [0, 0, 0], [-400, 0, 0], one.pressures(500.0, 0.75, 0.0)[0]]
    found = one.flow(rows)
    names = [STATUS[k] for k in found.status]
    assert names == ["ok", "not_finite", "no_flow", "from_behind", "outside_domain"]
    assert np.isnan(found.alpha[1:]).all()
    assert {m.code for m in found.messages} == {f"probe_{n}" for n in names[1:]}
    assert all("1 of 5" in m.found for m in found.messages)


def test_saturated_and_stuck_ports() -> None:
    p = probe().pressures(500.0, np.linspace(0.0, 0.3, 40), 0.01)
    p[5, 1] = 2000.0
    p[20:36, 2] = p[20, 2]
    clean, messages = watched(p, -2000.0, 2000.0, stuck_after=10)
    assert np.flatnonzero(np.isnan(clean[:, 0])).tolist() == [5, *range(30, 36)]
    assert [m.code for m in messages] == ["probe_saturated", "probe_stuck"]
    assert watched(p, -3000.0, 3000.0)[1] == ()


def test_bad_input() -> None:
    with pytest.raises(BadInput, match="no_probe"):
        FiveHoleProbe(harmonic_cp([0.5]), 45.0 * DEG)  # c_p that does not change
    with pytest.raises(BadInput, match="no_probe"):
        probe(domain=2.0)
    with pytest.raises(BadInput, match="probe_pressures"):
        probe().flow(np.zeros((3, 2)))
    with pytest.raises(BadInput, match="probe_points"):
        fit_cp([0.0, 0.1, 0.2], [1.0, 0.9, 0.8])
    with pytest.raises(BadInput, match="probe_points"):
        fit_cp(np.linspace(0.0, 0.05, 10), np.ones(10))
    with pytest.raises(BadInput, match="probe_points"):
        fit_cp(np.linspace(0.0, 1.0, 10), np.full(10, np.nan))


def test_unreadable_points(tmp_path: Path) -> None:
    (tmp_path / "x.csv").write_text("# nothing\nName,P1\nDP 0,here\n")
    with pytest.raises(BadInput, match="probe_table"):
        read_points(tmp_path / "x.csv", (1,))
    with pytest.raises(BadInput, match="probe_table"):
        read_points(tmp_path / "absent.csv", (1,))
