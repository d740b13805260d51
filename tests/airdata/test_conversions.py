"""Conversions against published tables, and there and back."""

from __future__ import annotations

import numpy as np
import pytest

from alula.airdata import conversions as c


@pytest.mark.parametrize(
    ("mach", "p_over_total"),
    # NACA Report 1135, Table I (gamma = 1.4): p/p_t, four digits.
    [(0.1, 0.9930), (0.3, 0.9395), (0.5, 0.8430), (0.7, 0.7209), (0.9, 0.5913), (1.0, 0.5283)],
)
def test_impact_pressure(mach: float, p_over_total: float) -> None:
    assert 1.0 / (1.0 + c.impact_ratio(mach)) == pytest.approx(p_over_total, abs=5e-5)


def test_pressure_and_density_altitude() -> None:
    """U.S. Standard Atmosphere 1976, Table I: geopotential heights of the layers' bases."""
    # The printed pressures have six to seven digits: 1 cm at 11 km, 4 cm at 32 km.
    heights = c.pressure_altitude([101325.0, 22632.06, 5474.889, 868.0187])
    assert heights == pytest.approx([0.0, 11000.0, 20000.0, 32000.0], abs=0.05)
    # Densities have five digits: 0.5e-5 of 8 km is 0.4 m at sea level.
    assert c.density_altitude([1.2250, 0.36391]) == pytest.approx([0.0, 11000.0], abs=0.5)
    assert c.pressure_at(c.pressure_altitude(7.0e4)) == pytest.approx(7.0e4, rel=1e-12)
    assert c.geometric_height(11000.0) == pytest.approx(11019.1, abs=0.1)


def test_calibrated_airspeed_by_hand() -> None:
    """Mach 0.78 at 35000 ft, where the standard has 23842 Pa and 218.81 K, in plain powers."""
    impact = 23842.0 * ((1.0 + 0.2 * 0.78**2) ** 3.5 - 1.0)
    by_hand = 340.294 * (5.0 * ((impact / 101325.0 + 1.0) ** (2.0 / 7.0) - 1.0)) ** 0.5
    cas = c.cas_of_mach(0.78, c.pressure_at(35000 * 0.3048))
    assert cas == pytest.approx(by_hand, rel=1e-4)  # the printed pressure has five digits
    tas = 0.78 * (1.4 * 287.053 * 218.81) ** 0.5
    assert c.tas_of_cas(cas, 23842.0, 218.81) == pytest.approx(tas, rel=1e-4)


def test_slow_flight_is_incompressible() -> None:
    """At 20 m/s compressibility is M2/4 of the impact pressure, 9e-4: TAS over CAS goes by
    density."""
    pressure, temperature = 80000.0, 275.0
    density = pressure / (287.0529 * temperature)
    tas = c.tas_of_cas(20.0, pressure, temperature)
    assert tas / 20.0 == pytest.approx(np.sqrt(1.225 / density), rel=1e-3)
    assert c.eas_of_tas(tas, pressure, temperature) == pytest.approx(20.0, rel=1e-3)


def test_there_and_back() -> None:
    cas = np.linspace(2.0, 180.0, 40)
    pressure, temperature = 5e4, 250.0
    for there, back in (
        (c.tas_of_cas(cas, pressure, temperature), c.cas_of_tas),
        (c.eas_of_tas(cas, pressure, temperature), c.tas_of_eas),
    ):
        assert back(there, pressure, temperature) == pytest.approx(cas, rel=1e-12)
    assert c.ias_of_cas(c.cas_of_ias(cas, 25.0), 25.0) == pytest.approx(cas, rel=1e-9)
    assert c.mach_of(c.impact_ratio(0.6)) == pytest.approx(0.6, rel=1e-13)


def test_indicated_airspeed() -> None:
    """A port 30 Pa too high at 30 m/s: the impact pressure lacks 30 of 552.5 Pa."""
    indicated = c.ias_of_cas(30.0, 30.0)
    assert indicated == pytest.approx(30.0 * np.sqrt(1.0 - 30.0 / 552.5), abs=2e-3)


def test_total_temperature() -> None:
    assert c.static_temperature(300.0, 0.5) == pytest.approx(300.0 / 1.05, rel=1e-13)
    assert c.static_temperature(300.0, 0.5, 0.9) == pytest.approx(300.0 / 1.045, rel=1e-13)


def test_outside_the_domain_is_nan_there_only() -> None:
    found = c.tas_of_cas([50.0, np.nan, 50.0, 50.0, -5.0], [9e4, 9e4, 0.0, 9e4, 9e4], 280.0)
    assert np.isfinite(found).tolist() == [True, False, False, True, False]
    assert np.isnan(c.mach_of([-0.01, 1.0])).all()
    assert np.isnan(c.impact_ratio(1.2))
    assert np.isnan(c.pressure_altitude([-1.0, np.inf - np.inf])).all()
