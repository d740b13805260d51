"""Estimators and structure: each row's check in its own file."""

from __future__ import annotations

from verification.estimation import (
    campaign_coverage,
    collinear,
    dhc2,
    ill_posed,
    output_error_speed,
    plan_scatter,
    rls_speed,
    stall_identification,
    structure,
    twin_otter_output_error,
    unstable,
)
from verification.registry import rows


def speed(quick: bool) -> tuple[str, bool]:
    """Output error beside numba, and recursive least squares by the sample."""
    batch, first = output_error_speed.f(quick)
    recursive, second = rls_speed.check(quick)
    return f"{batch}; {recursive}", first and second


ROWS = {
    "Twin Otter 018 output error (model as in the data README)": (
        "CZ0 and the five slopes within two published standard errors, Cm0 within 1e-3; "
        "coloured-residual bounds within a factor 1.5 of the published",
        twin_otter_output_error.f,
    ),
    "`regression/swr_example.mat`": (
        "the true terms and only those, by stepwise and by orthogonal functions; values within "
        "two standard errors",
        structure.check,
    ),
    "DHC-2, columns 12 to 19": (
        "equation error with constants: truth to 4 digits; filter error with seeded white "
        "measurement noise (100 draws): pooled coverage of 95 % intervals 91 to 98 %, "
        "process-noise intensity within 20 %; output error on the same draws beside it, its bias "
        "named",
        dhc2.f,
    ),
    "SportStar virtual campaign, 200 seeds, truth = its aircraft file": (
        "output error pooled coverage 92 to 98 % in white, 88 to 99 % in coloured noise; equation "
        "error 85 to 99 % with the reconstruction's covariance carried, its bias from noisy "
        "regressors printed",
        campaign_coverage.campaign_coverage,
    ),
    "principal components and ridge on a collinear set, 2000 seeds": (
        "bias and variance within 5 % of the closed form",
        collinear.check,
    ),
    "`alula plan`": (
        "predicted standard errors within 30 % of the scatter of output-error estimates over 200 "
        "flights",
        plan_scatter.plan_scatter,
    ),
    "an unstable simulated aircraft (closed loop)": (
        "derivatives within two standard errors; collinearity between states and controls reported",
        unstable.unstable,
    ),
    "200 random ill-posed problems (collinear controls, no excitation, unobservable parameter, "
    "wrong sign of a control, saturated sensor), and beside them 200 well-posed ones": (
        "a verdict every time; never a wrong value (more than 4 of its own standard errors off) "
        "marked `ok`; of the well-posed at least 95 % of the parameters read `ok` and none is "
        "refused",
        ill_posed.ill_posed,
    ),
    "simulated stall with Kirchhoff truth": (
        "a1 and alpha* within 10 %, tau2 within 20 % or `not identifiable` when the flight is "
        "quasi-steady",
        stall_identification.stall_identification,
    ),
    "speed: 4 states, 10 parameters, 6 outputs, 1000 samples, cold start": (
        "under 0.01 s and 2.5 times numba in the same run on the baseline case (aim 5 times); "
        "recursive least squares, 8 parameters, under 1 µs a sample",
        speed,
    ),
}
rows("estimation", ROWS)
