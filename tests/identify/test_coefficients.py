"""Coefficients from motion, against rigid-body mechanics written another way."""

from dataclasses import replace

import numpy as np
import pytest

from alula.base.messages import BadInput
from alula.flight import Maneuver, Motion
from alula.identify import (
    Reference,
    Thrust,
    coefficients_as_recorded,
    coefficients_from_motion,
    identify_equation_error,
)

N = 50
REFERENCE = Reference(S=10.0, b=8.0, c=1.3, point=np.array([0.4, 0.0, 0.1]))


def motion(seed=0, **replaced) -> Motion:
    """Arbitrary but smooth time histories; nothing here needs them to be flyable."""
    rng = np.random.default_rng(seed)
    t = np.arange(N) * 0.02

    def wave(size, mean=0.0):
        return mean + size * np.sin(rng.uniform(1, 6) * t + rng.uniform(0, 6))

    values = {
        name: wave(size)
        for name, size in {
            "beta": 0.1, "p": 0.5, "q": 0.3, "r": 0.2, "pdot": 2.0, "qdot": 1.0, "rdot": 0.7,
            "ax": 1.0, "ay": 2.0, "phi": 0.5, "theta": 0.2, "psi": 1.0,
        }.items()
    }  # fmt: skip
    values |= {"V": wave(3.0, 40.0), "alpha": wave(0.1, 0.1), "az": wave(3.0, -9.8)}
    values |= {"h": wave(5.0, 500.0), "rho": np.full(N, 1.1)} | replaced
    return Motion(Maneuver("m", "log", "", 0.0, 1.0), t, **values)


def mass_properties(cg=(0.0, 0.0, 0.0)):
    inertia = np.array([[800.0, -12.0, -90.0], [-12.0, 1100.0, 7.0], [-90.0, 7.0, 1700.0]])
    return {
        "mass": np.full(N, 560.0),
        "cg": np.tile(np.array(cg), (N, 1)),
        "inertia": np.tile(inertia, (N, 1, 1)),
    }


def test_moments_are_the_rate_of_angular_momentum():
    """Rotate h = J w into a frame that does not turn and difference it: dh/dt there is M.

    The body turns steadily about a skewed axis, so that its attitude is known in closed form.
    """
    omega = np.array([0.4, -0.3, 0.5])
    steady = {k: np.full(N, w) for k, w in zip("pqr", omega, strict=True)}
    still = {k: np.zeros(N) for k in ("pdot", "qdot", "rdot")}
    m = motion(**steady, **still)
    properties = mass_properties()
    got = coefficients_from_motion(
        m, replace(REFERENCE, point=np.zeros(3)), thrust=(), **properties
    )
    h = properties["inertia"][0] @ omega

    def rotated(dt):  # Rodrigues: body to inertial after turning for dt
        size = np.linalg.norm(omega)
        k, angle = omega / size, size * dt
        return (
            h * np.cos(angle) + np.cross(k, h) * np.sin(angle) + k * (k @ h) * (1 - np.cos(angle))
        )

    moment = (rotated(1e-5) - rotated(-1e-5)) / 2e-5
    scale = 0.5 * 1.1 * m.V**2 * REFERENCE.S
    for name, length, value in zip(("Cl", "Cm", "Cn"), (8.0, 1.3, 8.0), moment, strict=True):
        assert got.coefficients[name] * scale * length == pytest.approx(value, rel=1e-6, abs=1e-6)


def test_symmetric_aircraft_agrees_with_the_printed_equations():
    """Dittrich 2016, Eq. (3.46d) to (3.46f), written out for Ixy = Iyz = 0."""
    m, properties = motion(), mass_properties()
    jx, jy, jz, jxz = 800.0, 1100.0, 1700.0, 90.0
    properties["inertia"] = np.tile(np.array([[jx, 0, -jxz], [0, jy, 0], [-jxz, 0, jz]]), (N, 1, 1))
    got = coefficients_from_motion(m, replace(REFERENCE, point=np.zeros(3)), **properties)
    scale = 0.5 * 1.1 * m.V**2 * REFERENCE.S
    p, q, r = m.p, m.q, m.r
    roll = jx * m.pdot - jxz * m.rdot + q * r * (jz - jy) - p * q * jxz
    pitch = jy * m.qdot + p * r * (jx - jz) + jxz * (p**2 - r**2)
    yaw = -jxz * m.pdot + jz * m.rdot + p * q * (jy - jx) + q * r * jxz
    assert got.coefficients["Cl"] == pytest.approx(roll / scale / 8.0, rel=1e-12)
    assert got.coefficients["Cm"] == pytest.approx(pitch / scale / 1.3, rel=1e-12)
    assert got.coefficients["Cn"] == pytest.approx(yaw / scale / 8.0, rel=1e-12)


def test_lift_and_drag_are_the_body_force_turned_by_alpha():
    got = coefficients_from_motion(motion(), REFERENCE, **mass_properties()).coefficients
    assert np.hypot(got["CD"], got["CL"]) == pytest.approx(np.hypot(got["CX"], got["CZ"]))
    level = coefficients_from_motion(
        motion(alpha=np.zeros(N)), REFERENCE, **mass_properties()
    ).coefficients
    assert level["CL"] == pytest.approx(-level["CZ"])
    assert level["CD"] == pytest.approx(-level["CX"])


def test_moments_about_one_point_do_not_depend_on_the_loading():
    """The same forces applied at one point P, seen from two centers of gravity.

    The aerodynamic force acts at P (no moment about it); each loading then turns as mechanics says.
    """
    base = motion()
    for cg in ((0.0, 0.0, 0.0), (-0.3, 0.02, 0.05)):
        properties = mass_properties(cg)
        force = 560.0 * np.column_stack([base.ax, base.ay, base.az])
        moment = np.cross(REFERENCE.point - np.array(cg), force)
        w = np.column_stack([base.p, base.q, base.r])
        j = properties["inertia"][0]
        wdot = np.linalg.solve(j, (moment - np.cross(w, w @ j.T)).T).T
        m = replace(base, pdot=wdot[:, 0], qdot=wdot[:, 1], rdot=wdot[:, 2])
        got = coefficients_from_motion(m, REFERENCE, **properties).coefficients
        for name in ("Cl", "Cm", "Cn"):
            assert got[name] == pytest.approx(0.0, abs=1e-12)  # rounding of moments of 1e4 N m


def test_thrust_force_and_moment_are_removed():
    """An engine that alone holds the aircraft leaves no aerodynamic force and moment."""
    pull = np.linspace(900.0, 1500.0, N)
    direction = np.array([np.cos(0.05), 0.0, -np.sin(0.05)])
    arm = np.array([0.5, 0.7, -0.4])
    force = pull[:, None] * direction
    still = {k: np.zeros(N) for k in ("p", "q", "r")}
    properties = mass_properties()
    wdot = np.linalg.solve(properties["inertia"][0], np.cross(arm, force).T).T
    m = motion(
        ax=force[:, 0] / 560.0, ay=force[:, 1] / 560.0, az=force[:, 2] / 560.0,
        pdot=wdot[:, 0], qdot=wdot[:, 1], rdot=wdot[:, 2], **still,
    )  # fmt: skip
    got = coefficients_from_motion(
        m, REFERENCE, thrust=[Thrust(arm, direction, pull, 0.1)], **properties
    )
    for name, values in got.coefficients.items():
        assert values == pytest.approx(0.0, abs=1e-12), name
    assert got.labels == {}
    (way,) = got.perturbed  # ten percent more thrust: ten percent of it is missed
    scale = 0.5 * 1.1 * m.V**2 * REFERENCE.S
    assert way.coefficients["CX"] == pytest.approx(-0.1 * force[:, 0] / scale)


def test_without_thrust_it_says_so():
    got = coefficients_from_motion(motion(), REFERENCE, **mass_properties())
    assert got.labels["CX"] == "including thrust"
    assert [m.code for m in got.messages] == ["including_thrust"]


def test_rates_are_made_dimensionless_with_the_full_span_and_the_chord():
    m = motion()
    v = coefficients_from_motion(m, REFERENCE, **mass_properties()).variables
    assert v["phat"] == pytest.approx(m.p * 8.0 / 2.0 / m.V)
    assert v["qhat"] == pytest.approx(m.q * 1.3 / 2.0 / m.V)
    assert v["rhat"] == pytest.approx(m.r * 8.0 / 2.0 / m.V)
    # ISO 2533: the speed of sound at 500 m is 338.37 m/s; h varies by 5 m
    assert v["mach"] == pytest.approx(m.V / 338.37, rel=1e-4)


def test_uncertain_thrust_widens_drag_but_not_roll():
    """Thrust known to 20 %: the constant of CX is uncertain by 20 % of the thrust coefficient."""
    pull = np.full(N, 1000.0)
    exact = Thrust(np.zeros(3), np.array([1.0, 0, 0]), pull)
    vague = replace(exact, relative_se=0.2)
    models = {"CX": "1", "Cl": "1"}
    low, high = (
        identify_equation_error(
            [coefficients_from_motion(motion(), REFERENCE, thrust=[e], **mass_properties())], models
        )
        for e in (exact, vague)
    )
    shift = 0.2 * np.mean(1000.0 / (0.5 * 1.1 * motion().V ** 2 * REFERENCE.S))
    assert high["CX_0"].se ** 2 - low["CX_0"].se ** 2 == pytest.approx(shift**2, rel=1e-6)
    assert high["Cl_0"].se == pytest.approx(low["Cl_0"].se)
    assert high["CX_0"].ci95[1] - high["CX_0"].ci95[0] > 3.9 * shift


def test_reconstruction_uncertainty_is_carried_into_error_bars():
    """A bias of ay known to 0.05 m/s2: CY's constant is uncertain by m 0.05 / (qbar S)."""
    m = motion(V=np.full(N, 40.0))
    off = replace(m, ay=m.ay + 0.05)
    item = coefficients_from_motion(m, REFERENCE, perturbed=[off], **mass_properties())
    plain = coefficients_from_motion(m, REFERENCE, **mass_properties())
    got = identify_equation_error([item], {"CY": "1 + beta"})
    without = identify_equation_error([plain], {"CY": "1 + beta"})
    shift = 560.0 * 0.05 / (0.5 * 1.1 * 40.0**2 * 10.0)
    added = got["CY_0"].se ** 2 - without["CY_0"].se ** 2
    assert added == pytest.approx(shift**2, rel=1e-6)
    assert got["CY_beta"].se == pytest.approx(without["CY_beta"].se)
    assert got["CY_0"].se_white == without["CY_0"].se_white  # the plain one stays plain


def test_a_shared_cause_does_not_average_out():
    """Two maneuvers with the same bias: its share does not fall with their number."""
    m = motion(V=np.full(N, 40.0))
    off = replace(m, ay=m.ay + 0.05)
    shift = 560.0 * 0.05 / (0.5 * 1.1 * 40.0**2 * 10.0)
    for shared, expected in ((True, shift), (False, shift / np.sqrt(2.0))):
        items = []
        for name in ("a", "b"):
            own = replace(m, maneuver=replace(m.maneuver, id=name))
            items.append(
                coefficients_from_motion(
                    own, REFERENCE, perturbed=[replace(off, maneuver=own.maneuver)],
                    shared=shared, **mass_properties(),
                )
            )  # fmt: skip
        got = identify_equation_error(items, {"CY": "1 + beta"}, common_constant=True)
        bare = identify_equation_error(
            [replace(i, perturbed=()) for i in items], {"CY": "1 + beta"}, common_constant=True
        )
        added = np.sqrt(got["CY_0"].se ** 2 - bare["CY_0"].se ** 2)
        assert added == pytest.approx(expected, rel=1e-6)


def test_recorded_coefficients_go_as_they_are():
    cz = np.linspace(-0.4, -0.5, N)
    m = motion(recorded={"CZ": cz, "qhat": np.full(N, 0.01)})
    got = coefficients_as_recorded(m, REFERENCE)
    assert list(got.coefficients) == ["CZ"]
    assert got.coefficients["CZ"].tolist() == cz.tolist()
    assert got.variables["qhat"].tolist() == [0.01] * N
    with pytest.raises(BadInput, match="no_recorded_coefficients"):
        coefficients_as_recorded(motion(), REFERENCE)


def test_bad_motion_is_refused():
    spoiled = motion()
    ay = spoiled.ay.copy()
    ay[7] = np.nan
    with pytest.raises(BadInput, match=r"maneuver m, ay: .* 1 of 50"):
        coefficients_from_motion(replace(spoiled, ay=ay), REFERENCE, **mass_properties())
    with pytest.raises(BadInput, match="airspeed_not_positive"):
        coefficients_from_motion(motion(V=np.zeros(N)), REFERENCE, **mass_properties())
    with pytest.raises(BadInput, match="wrong_length"):
        coefficients_from_motion(
            motion(), REFERENCE, **(mass_properties() | {"mass": np.full(3, 560.0)})
        )


def test_constant_mass_may_be_given_once():
    full = mass_properties()
    once = {k: v[:1] for k, v in full.items()}
    a = coefficients_from_motion(motion(), REFERENCE, **full).coefficients
    b = coefficients_from_motion(motion(), REFERENCE, **once).coefficients
    for name in a:
        assert a[name].tolist() == b[name].tolist()
