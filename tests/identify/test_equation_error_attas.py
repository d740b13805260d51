"""ATTAS: three maneuvers against an independent least-squares fit of the same recordings."""

import pytest
from identify_flights import attas, attas_motion, window

from alula.identify import identify_equation_error
from alula.identify.equation_error.state_space import identify_state_space

MODELS = {
    "CL": "1 + alpha",
    "Cm": "1 + alpha + qhat + de",
    "CY": "1 + beta",
    "Cl": "1 + beta + phat + rhat + da",
    "Cn": "1 + beta + phat + rhat + dr",
}
# An independent fit, converted to pb/2V with b the full span.
CLOSE = {
    "CL_alpha": 5.222,
    "CY_beta": -1.0035,
    "Cl_p": -0.769 / 2,
    "Cl_da": -0.195 / 2,
    "Cn_beta": 0.2545 / 2,
    "Cn_dr": -0.1436 / 2,
}
LOOSE = {"Cl_beta": -0.102 / 2, "Cl_r": 0.239 / 2, "Cn_r": -0.133 / 2, "Cn_p": -0.044 / 2}


@pytest.fixture(scope="module")
def result():
    maneuvers = [attas("Elv1", "longitudinal"), attas("Ail1", "lateral"), attas("Rud1", "lateral")]
    return identify_equation_error(maneuvers, MODELS)


@pytest.mark.parametrize(
    ("coefficient", "r2"), [("CL", 0.99), ("Cl", 0.975), ("CY", 0.96), ("Cn", 0.955)]
)
def test_fit(result, coefficient, r2):
    assert result.rsquared[coefficient] > r2


@pytest.mark.parametrize("name", CLOSE)
def test_main_derivatives(result, name):
    assert result[name].value == pytest.approx(CLOSE[name], rel=0.06)  # preprocessing differs
    assert result[name].verdict == "ok"


@pytest.mark.parametrize("name", LOOSE)
def test_cross_derivatives(result, name):
    reference = LOOSE[name]
    margin = max(0.2 * abs(reference), 3.0 * result[name].se)
    assert result[name].value == pytest.approx(reference, abs=margin)


def test_maneuvers_share_derivatives_but_not_the_constant(result):
    names = [p.name for p in result.parameters]
    assert "Cl_0[Ail1]" in names
    assert "Cl_0[Rud1]" in names
    assert "Cl_beta" in names
    assert "Cm_0" in names  # one longitudinal maneuver: no suffix
    assert not any("Elv1" in n for n in names)  # its aspect does not serve the lateral model


def test_held_out_part_is_predicted_not_learned():
    """The second half of the rudder maneuver, from the first and the aileron maneuver."""
    learned = [attas("Ail1", "lateral"), window(attas("Rud1", "lateral"), 0.0, 15.0)]
    unseen = window(attas("Rud1", "lateral"), 15.0, 30.0, held_out=True)
    result = identify_equation_error([*learned, unseen], {"Cn": MODELS["Cn"]})
    alone = identify_equation_error(learned, {"Cn": MODELS["Cn"]})
    assert result.params.tolist() == alone.params.tolist()
    assert result.fits["Cn"].n_held_out == len(unseen.t)
    assert result.fits["Cn"].r2_held_out > 0.9  # 0 were a model that predicts nothing
    assert [s.held_out for s in result.series] == [False, False, True]


def test_state_equations_are_kinematically_true_and_stable():
    """Rows that physics dictates come out as physics says: theta' = q, phi' = p + ..."""
    motion, _ = attas_motion("Elv1", "longitudinal")
    lon = identify_state_space([motion], "longitudinal")
    q = lon.states.index("q")
    assert lon.A[lon.states.index("theta"), q] == pytest.approx(1.0, abs=0.01)  # small bank
    assert lon.A[lon.states.index("alpha"), q] == pytest.approx(1.0, abs=0.1)  # 1 - CZq effect
    assert lon.A[q, lon.states.index("alpha")] < 0.0  # statically stable
    assert lon.B[q, 0] < 0.0  # elevator down pitches down
    assert (lon.A_se[q] > 0.0).all()
    lateral = [attas_motion(n, "lateral")[0] for n in ("Ail1", "Rud1")]
    lat = identify_state_space(lateral, "lateral")
    assert lat.inputs == ("da", "dr")
    assert lat.A[lat.states.index("phi"), lat.states.index("p")] == pytest.approx(1.0, abs=0.01)
    assert lat.A[1, 1] < 0.0  # roll damping
