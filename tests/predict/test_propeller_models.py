"""The two propeller models from Python: reference values, balances, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.aircraft.propeller_files import read_apc, read_qprop, read_uiuc_geometry
from alula.base.messages import BadInput
from alula.predict.propeller_blade_element import (
    blade_element,
    blade_element_loads,
    blade_element_windmill,
)
from alula.predict.propeller_momentum import MomentumPropeller, momentum_propeller, windmill_J
from data import data
from predict.propellers import PARAMETERS, blades

RHO = 1.225


def test_qprops_case() -> None:
    """QPROP 1.22 on the same file, as the reference states it; its wake has another form: 3 %."""
    (T,), (Q,) = blade_element_loads(
        read_qprop(data("propellers", "cam6x3.def")), [5.0], [2.0 * np.pi * 14020.0 / 60.0]
    )
    assert pytest.approx(2.644, rel=0.03) == T
    assert pytest.approx(0.0288, rel=0.03) == Q


def test_files_of_others_state_one_propeller() -> None:
    """UIUC's photographs and APC's drawing agree on the chord to 6 % of the largest."""
    uiuc = read_uiuc_geometry(data("propellers", "apc_10x7sf", "uiuc_data", "apcsf_10x7_geom.txt"))
    apc = read_apc(data("propellers", "apc_10x7sf", "10x7SF-PERF.PE0"))
    assert uiuc.radius == pytest.approx(apc.radius) == pytest.approx(0.127)
    assert uiuc.count == apc.count == 2
    r = np.linspace(0.04, 0.115, 20)
    chord = np.interp(r, uiuc.r, uiuc.chord), np.interp(r, apc.r, apc.chord)
    assert np.max(np.abs(chord[0] - chord[1])) < 0.06 * np.max(apc.chord)


def test_momentum_loads_are_the_exact_solution_and_the_wake_balances() -> None:
    b = blades()
    propeller = MomentumPropeller(b, PARAMETERS)
    omega, n, D = 500.0, 500.0 / (2.0 * np.pi), b.diameter
    for J in (0.0, 0.2, 0.4):
        V = J * n * D
        loads = propeller.loads(omega, (V, 0.0, 0.0), density=RHO)
        curve = momentum_propeller(b, J, PARAMETERS)
        # 49 knots of a cubic: 3e-4 of the largest, see the core's test of the table
        assert loads.force[0] == pytest.approx(curve.CT[0] * RHO * n**2 * D**4, rel=1e-3)
        assert loads.torque * omega == pytest.approx(curve.CP[0] * RHO * n**3 * D**5, rel=1e-3)
        wake = propeller.slipstream(omega, V, RHO)
        flow = RHO * np.pi * b.radius**2 * wake.u1
        assert flow * (wake.U_i - V) == pytest.approx(loads.force[0], rel=1e-9)
        swirl = 0.5 * flow * wake.Omega_i * wake.R_i**2
        assert swirl == pytest.approx(loads.torque, rel=1e-9)


def test_a_propeller_is_a_fin_damps_pitch_and_yaws_left_at_alpha() -> None:
    propeller = MomentumPropeller(blades(), PARAMETERS)
    assert propeller.loads(500.0, (15.0, 2.0, 0.0)).force[1] < 0.0
    climbing = propeller.loads(500.0, (15.0, 0.0, 2.0))
    assert climbing.force[2] < 0.0
    assert climbing.moment[2] < 0.0
    assert propeller.loads(500.0, (15.0, 0.0, 0.0), (0.0, 1.0, 0.0)).moment[1] < 0.0
    left = MomentumPropeller(blades(sense="left"), PARAMETERS)
    assert left.loads(500.0, (15.0, 0.0, 2.0)).moment[2] == pytest.approx(-climbing.moment[2])


def test_efficiency_is_power_out_over_power_in_and_below_froude() -> None:
    for curve in (
        momentum_propeller(blades(), np.linspace(0.0, 0.5, 6), PARAMETERS),
        blade_element(blades(), np.linspace(0.0, 0.5, 6), 5000.0),
    ):
        assert curve.eta[0] == 0.0
        J, CT = curve.J[1:], curve.CT[1:]
        # T = rho pi R^2 u1 (u2 - V): V/u1 is the most that any disk of this thrust can give
        ideal = 2.0 / (1.0 + np.sqrt(1.0 + 8.0 * np.maximum(CT, 0.0) / (np.pi * J**2)))
        assert np.all(curve.eta[1:] < ideal)


def test_reverse_windmill_and_standing_are_refused_without_a_number() -> None:
    b = blades()
    last = windmill_J(b, PARAMETERS)
    for J in (-0.01, last + 0.01, 2.0, 10.0):
        with pytest.raises(BadInput, match="outside_propeller_model"):
            momentum_propeller(b, [0.1, J], PARAMETERS)
    end = blade_element_windmill(b, 5000.0)
    # 2.0 and 10.0: stalled blades ask for power again, far behind the windmill
    for J in (-0.01, end + 0.01, 2.0, 10.0):
        with pytest.raises(BadInput, match="outside_propeller_model"):
            blade_element(b, [0.1, J], 5000.0)
    assert blade_element(b, end - 0.01, 5000.0).CP[0] > 0.0
    with pytest.raises(BadInput, match="standing"):
        blade_element(b, 0.1, 0.0)
    flying = MomentumPropeller(b, PARAMETERS)
    for omega, V in ((0.0, 10.0), (500.0, -1.0), (100.0, 30.0)):
        with pytest.raises(BadInput, match="outside_propeller_model"):
            flying.loads(omega, (V, 0.0, 0.0))
        with pytest.raises(BadInput, match="outside_propeller_model"):
            flying.slipstream(omega, V)


def test_what_cannot_be_computed_is_refused() -> None:
    b = blades()
    for J in ([], [np.nan], [[0.1, 0.2]]):
        with pytest.raises(BadInput, match="bad_advance_ratio"):
            momentum_propeller(b, J, PARAMETERS)
    with pytest.raises(BadInput, match="no_momentum_parameters"):
        momentum_propeller(b, 0.1)
    with pytest.raises(BadInput, match="bad_momentum_parameters"):
        momentum_propeller(b, 0.1, replace(PARAMETERS, c_d_alpha=np.nan))
    with pytest.raises(BadInput, match="no_blade_polar"):
        blade_element(replace(b, polars=()), 0.1, 5000.0)
    with pytest.raises(BadInput, match="bad_polar"):
        blade_element(replace(b, polars=(replace(b.polars[0], c_d_0=np.inf),)), 0.1, 5000.0)
    with pytest.raises(BadInput, match="uneven_stations"):
        blade_element(b, 0.1, 5000.0, rule="stations")


def test_polars_of_stations_and_tables() -> None:
    """One polar per station, all alike, is that polar; so is its table, to its own lines."""
    b = blades()
    free = replace(b.polars[0], c_l_min=-9.0, c_l_max=9.0, mach_corrected=False)  # as a table
    b = replace(b, polars=(free,))
    one = blade_element(b, 0.3, 5000.0)
    many = blade_element(replace(b, polars=b.polars * 6), 0.3, 5000.0)
    assert many.CT[0] == pytest.approx(one.CT[0], rel=1e-12)
    p = b.polars[0]
    alpha = np.radians(np.linspace(-30.0, 30.0, 1200))
    c_l = p.c_l_0 + p.c_l_alpha * alpha
    c_d = p.c_d_0 + p.c_d_2_upper * (c_l - p.c_l_cd0) ** 2
    tabled = replace(p, table=(alpha, c_l, c_d))
    found = blade_element(replace(b, polars=(tabled,)), 0.3, 5000.0)
    assert found.CT[0] == pytest.approx(one.CT[0], rel=1e-4)
    assert found.CP[0] == pytest.approx(one.CP[0], rel=1e-4)


def test_the_simulators_propeller_has_the_same_curves() -> None:
    b = blades(sense="left")
    curve = momentum_propeller(b, np.linspace(0.0, 0.55, 60), PARAMETERS)
    p, messages = curve.propeller(b, 0.002)
    assert messages == ()
    assert len(p.J) == 24
    assert (p.sense, p.diameter, p.inertia) == (-1.0, b.diameter, 0.002)
    assert np.interp(0.3, p.J, p.CT) == pytest.approx(np.interp(0.3, curve.J, curve.CT), rel=5e-3)
    few = momentum_propeller(b, [0.0, 0.2, 0.4], PARAMETERS)
    assert np.array_equal(few.propeller(b, 0.002)[0].CP, few.CP)
