"""Flight simulator, linear models, virtual flights and export: each row's check in its own file."""

from __future__ import annotations

from verification.registry import rows
from verification.simulator import (
    exported_jsbsim,
    linearization,
    modes,
    nesc,
    nesc_f16,
    rotor_moments,
    simulation_speed,
    tumbling,
    turbulence,
    virtual_campaign,
)

ROWS = {
    "NESC check cases 1, 2, 3, 6, 7, 9": (
        "inside the data README's spread: case 2 against sims 01 and 04, the others against "
        "04 (06 shown)",
        nesc.check,
    ),
    "NESC 11 (F-16 from its DAVE-ML files)": (
        "initial trim and forces as recorded; 20 s of flight inside the spread of sims 02 and 04",
        nesc_f16.nesc_f16,
    ),
    "torque-free tumbling, rate times step 0.005, 1e6 steps": (
        "energy and angular momentum drift under 1e-9 relative",
        tumbling.check,
    ),
    "linearization": (
        "equals central differences to 1e-7 and the corrected closed forms of Dittrich 2.79; "
        "under 1 ms",
        linearization.linearization,
    ),
    "modes": (
        "X8 and SportStar: equal the eigenvalues of the full linear model, names stay under "
        "reordering of states",
        modes.modes,
    ),
    "propeller and gyroscopic moments": (
        "sign tests on all three axes, both senses of rotation",
        rotor_moments.check,
    ),
    "Dryden": ("spectra within 10 % of the specification", turbulence.check),
    "speed, one thread, RK4, SportStar with propeller and steady wind (turbulence, stall states, "
    "tables off; figures with them printed)": (
        "at least 500 000 steps/s from one Python call (aim 1 000 000) and 25 times JSBSim's "
        "c172p in the same run",
        simulation_speed.check,
    ),
    "exported SportStar flown in JSBSim, 20 s elevator doublet and rudder doublet": (
        "V within 0.2 m/s, angles within 0.1 deg of Alula's own flight (say what remains)",
        exported_jsbsim.exported_jsbsim,
    ),
    "virtual campaign of 124 maneuvers": (
        "flown and written in under 10 s on 2 cores; same seed, same bytes",
        virtual_campaign.virtual_campaign,
    ),
}
rows("simulator", ROWS)
