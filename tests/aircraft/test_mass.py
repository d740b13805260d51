"""Mass properties against sums over particles, which know no parallel-axis theorem."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from particles import cloud, sums, table

from alula.aircraft import Aircraft, check_inertia, load_aircraft
from alula.aircraft.mass import inertia_tensor
from alula.base.messages import BadInput

HEAD = """schema = "alula.aircraft/1"
name = "cloud"
[reference]
S = 10.0
b = 8.0
c = 1.25
"""
# Sums of some hundred terms in double precision.
CLOSE = {"rtol": 1e-12, "atol": 1e-9}


def load(tmp_path: Path, text: str) -> Aircraft:
    path = tmp_path / "aircraft.toml"
    path.write_text(text)
    return load_aircraft(path)


def components(frame: str = "body") -> tuple[str, list[tuple[np.ndarray, np.ndarray]]]:
    turn = np.diag([-1.0, 1.0, -1.0]) if frame == "design" else np.eye(3)
    parts = [cloud(i, 40, at) for i, at in enumerate([(0.5, 0.1, -0.2), (-4.0, 0.3, -1.0)])]
    text = HEAD + f'[datum]\nname = "firewall"\nframe = "{frame}"\n'
    for i, (m, r) in enumerate(parts):
        mass, cg, J = sums(m, r @ turn)
        text += (
            f'[[mass.components]]\nname = "part {i}"\nmass = {mass}\n'
            f"position = {cg.tolist()}\ninertia = {table(J)}\n"
        )
    return text, parts


@pytest.mark.parametrize("frame", ["body", "design"])
def test_components_add_up_to_the_whole(tmp_path: Path, frame: str) -> None:
    text, parts = components(frame)
    mass, cg, J = sums(*(np.concatenate(x) for x in zip(*parts, strict=True)))
    got = load(tmp_path, text).mass_properties(np.zeros(1))
    np.testing.assert_allclose(got.mass, [mass], **CLOSE)
    np.testing.assert_allclose(got.cg, [cg], **CLOSE)
    np.testing.assert_allclose(got.inertia, [J], **CLOSE)


@pytest.mark.parametrize("burned", [0.0, 0.25, 1.0])
def test_fuel_burn_moves_mass_cg_and_inertia(tmp_path: Path, burned: float) -> None:
    """Fuel whose particles all lose the same share is what the model says burns."""
    text, parts = components()
    fuel_m, fuel_r = cloud(7, 30, (1.5, -0.4, 0.6))
    mass, cg, J = sums(fuel_m, fuel_r)
    text += f"[mass.fuel]\nmass = {mass}\nposition = {cg.tolist()}\ninertia = {table(J)}\n"
    aircraft = load(tmp_path, text)
    got = aircraft.mass_properties(np.array([0.0, burned * mass]))
    m = np.concatenate([*(p[0] for p in parts), (1.0 - burned) * fuel_m])
    r = np.concatenate([*(p[1] for p in parts), fuel_r])
    want = sums(m, r)
    for value, truth in zip((got.mass, got.cg, got.inertia), want, strict=True):
        np.testing.assert_allclose(value[1], truth, **CLOSE)
    np.testing.assert_array_equal(aircraft.reference_point, got.cg[0])


def test_totals_include_the_fuel(tmp_path: Path) -> None:
    """The same aircraft by totals and by components burns alike."""
    text, parts = components()
    fuel = "[mass.fuel]\nmass = 20.0\nposition = [1.5, -0.4, 0.6]\n"
    m = np.concatenate([*(p[0] for p in parts), [20.0]])
    r = np.concatenate([*(p[1] for p in parts), [[1.5, -0.4, 0.6]]])
    mass, cg, J = sums(m, r)
    totals = f"[mass]\nmass = {mass}\ncg = {cg.tolist()}\n" + table(J).strip("{}").replace(
        ", ", "\n"
    )
    used = np.linspace(0.0, 20.0, 5)
    one = load(tmp_path, text + fuel).mass_properties(used)
    other = load(tmp_path, HEAD + totals + "\n" + fuel).mass_properties(used)
    for a, b in zip(vars(one).values(), vars(other).values(), strict=True):
        np.testing.assert_allclose(a, b, **CLOSE)


def test_without_fuel_table_nothing_changes(tmp_path: Path) -> None:
    text, _ = components()
    got = load(tmp_path, text).mass_properties(np.array([0.0, 50.0]))
    assert got.mass[0] == got.mass[1]
    np.testing.assert_array_equal(got.inertia[0], got.inertia[1])


def test_missing_fuel_samples_stay_missing(tmp_path: Path) -> None:
    text, _ = components()
    text += "[mass.fuel]\nmass = 20.0\nposition = [1.5, -0.4, 0.6]\n"
    aircraft = load(tmp_path, text)
    got = aircraft.mass_properties(np.array([5.0, np.nan]))
    assert np.isfinite(got.mass[0])
    assert np.isnan(got.mass[1])
    assert np.isnan(aircraft.mass_properties(np.full(3, np.nan)).inertia).all()


def test_values_cannot_be_written_to(tmp_path: Path) -> None:
    text, _ = components()
    aircraft = load(tmp_path, text)
    with pytest.raises(ValueError, match="read-only"):
        aircraft.mass_properties(np.zeros(1)).mass[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        aircraft.reference_point[0] = 1.0


@pytest.mark.parametrize("seed", range(20))
def test_every_real_body_passes_the_inertia_check(seed: int) -> None:
    m, r = cloud(seed, 4, (0.0, 0.0, 0.0))
    assert check_inertia(sums(m, r)[2], "cloud") == ()


def test_a_flat_plate_lies_on_the_limit_and_passes() -> None:
    m, r = cloud(3, 50, (0.0, 0.0, 0.0))
    r[:, 2] = 0.0
    assert check_inertia(sums(m, r)[2], "plate") == ()


def test_a_miss_within_rounding_is_a_warning() -> None:
    (message,) = check_inertia(inertia_tensor(10.0, 10.0, 20.1), "rounded")  # 0.5 % over
    assert message.code == "inertia_at_limit"
    assert message.level == "warning"


def test_a_miss_beyond_rounding_is_refused() -> None:
    with pytest.raises(BadInput, match=r"10, 10, 20\.5 kg m2"):  # 2.4 % over
        check_inertia(inertia_tensor(10.0, 10.0, 20.5), "wrong")
