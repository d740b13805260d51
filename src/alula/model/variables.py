"""The variables of an aerodynamic model, and the coefficients it gives."""

from __future__ import annotations

# The base variables in the order of the core's slots 1 to 13; slot 0 is the constant 1.
# V in m/s, angles in rad, rates as pb/2V, qc/2V, rb/2V, dt 0 to 1, wash: the propeller's slipstream
# less the free stream, axial speeds over V.
VARIABLES = (
    "V", "alpha", "beta", "phat", "qhat", "rhat", "de", "da", "dr", "df", "dt", "mach", "wash",
)  # fmt: skip
# Beside them the lift coefficient, in the drag's formula only: CD = "1 + CL^2".
LIFT = "CL"
COEFFICIENTS = ("CX", "CY", "CZ", "Cl", "Cm", "Cn", "CD", "CL")
SHORT = {"phat": "p", "qhat": "q", "rhat": "r"}  # as they stand in a parameter's name
