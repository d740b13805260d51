"""Real aircraft: what their models do on flights that nobody here made."""

from __future__ import annotations

from pathlib import Path

import pytest

from alula.campaign.validate import run_validation
from data import data

REAL = Path(__file__).parents[2] / "examples" / "real"


def test_attas_closes_with_its_own_forces_and_moments() -> None:
    """No longitudinal model at all: thrust, mass, inertia and recorded coefficients alone.

    Twenty-five seconds of integration from the reconstructed start return to the flight, which
    shows that the equations of motion, the density and the reconstruction agree.
    """
    data("attas", "fAttasElv1.mat")
    done = run_validation(str(REAL / "attas.toml"), only=["elevator"], draws=0)
    (one,) = done.validation.flown
    assert set(one.as_recorded) == {"CX", "CZ", "Cm"}
    for name, least in (("q", 0.999), ("theta", 0.995), ("alpha", 0.97), ("V", 0.98)):
        # measured .9998, .998, .984, .995; what is left is open-loop drift of moment errors
        assert one.channels[name].quality.r2 > least


def test_attas_longitudinal_model_flies_like_the_aircraft() -> None:
    """On the maneuver it was estimated from, and labeled so: the open-loop match of the fit."""
    data("attas", "fAttasElv1.mat")
    done = run_validation(str(REAL / "attas.toml"), draws=0)
    one = next(f for f in done.validation.flown if f.maneuver.id == "elevator")
    assert one.seen == "yes"
    assert min(one.channels[n].quality.r2 for n in ("alpha", "q", "theta", "az")) > 0.98
    rows = [e for e in done.validation.evidence if e.maneuver == "elevator"]
    assert {row.verdict for row in rows} == {"pass"}
    # the rudder maneuver oscillates freely for some 18 s: published period of this Dutch roll is
    # not stated, but peaks of sideslip can be counted: four periods in 14.5 s, within a sample each
    period = next(e for e in done.validation.evidence if "of period" in e.tolerance)
    assert period.criteria[0].measured == pytest.approx(14.5 / 4.0, rel=0.05)


def test_citation_doublets_from_3211s() -> None:
    """Exact states; identified on three inputs, flown on two others, trimmed before the input."""
    data("citation_two_step", "dadoublet.mat")
    done = run_validation(str(REAL / "citation_two_step.toml"), draws=0, trim="entry")
    flown = {f.maneuver.id: f for f in done.validation.flown}
    assert {f.seen for f in flown.values()} == {"no"}
    # a linear model of a nonlinear simulation with lagging actuators: nine tenths are explained
    for id, names in (("dadoublet", ("p", "phi", "beta", "ay")), ("drdoublet", ("beta", "r"))):
        assert min(flown[id].channels[n].quality.r2 for n in names) > 0.85
    # its Dutch roll is damped within a fraction of a cycle: no period to judge
    rows = [e for e in done.validation.evidence if e.entry == "2.d.7"]
    assert {row.verdict for row in rows} == {"not_judged"}
