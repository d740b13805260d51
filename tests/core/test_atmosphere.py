"""The standard atmosphere as NASA's simulators have it (NESC check case 6, columns of the air)."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from alula.core import core
from data import data

FT, SLUG_FT3, LBF_FT2, RANKINE = 0.3048, 515.378818393, 47.88025898, 5.0 / 9.0


@pytest.mark.parametrize("simulator", ["04", "06"])
def test_air_of_the_check_case(simulator: str) -> None:
    # Simulators 01, 02 and 03 interpolate tables (1e-3 off one another); 04 and 06 compute.
    path = data("nesc_6dof", "Atmos_06_DroppedSphereEllipsoidalNoWind")
    table = pd.read_csv(path / f"Atmos_06_sim_{simulator}.csv")
    out = np.empty((len(table), 4))
    core.standard_atmosphere(table["altitudeMsl_ft"].to_numpy() * FT, out)
    for column, name, unit, tolerance in (
        (0, "ambientTemperature_dgR", RANKINE, 1e-9),
        (1, "ambientPressure_lbf_ft2", LBF_FT2, 3e-5),  # their pressures differ by 1e-5
        (2, "airDensity_slug_ft3", SLUG_FT3, 3e-5),  # 06 by 2e-5, 04 by 4e-7
        (3, "speedOfSound_ft_s", FT, 2e-6),  # the gas constant's sixth digit
    ):
        expected = table[name].to_numpy() * unit
        np.testing.assert_allclose(out[:, column], expected, rtol=tolerance)


def test_shape_is_checked() -> None:
    with pytest.raises(ValueError, match=r"\(n, 4\)"):
        core.standard_atmosphere(np.zeros(3), np.empty((3, 3)))
