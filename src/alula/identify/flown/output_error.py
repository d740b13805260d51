"""Output error: the parameters with which the flown motion comes closest to the measured one.

Maximum likelihood where sensors are noisy and the air is still (Dittrich 2016, Eq. (3.49) to
(3.65); Jategaonkar, Flight Vehicle System Identification, 2nd ed. 2015, ch. 4; Klein and Morelli,
Aircraft System Identification, 2nd ed. 2016, ch. 6). The nonlinear equations of motion are flown in
the core with any formula of the model grammar; sensitivities are variational. The covariance of the
noise is estimated along, R = mean of e e' (Eq. (3.51)), diagonal unless asked otherwise, which
turns the cost into N/2 ln det R, or the sum of N/2 ln r_i.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message, note, refuse
from alula.identify.equation_error.task import need_models
from alula.identify.flown.core_maneuver import formula_model
from alula.identify.flown.fit import Covariance, OutputErrorFit, fit_output_error
from alula.identify.flown.good_enough import good_enough
from alula.identify.flown.measured_maneuver import MeasuredManeuver
from alula.identify.flown.output_likelihood import likelihood_of
from alula.identify.flown.problem import STATE_SETS, FlightProblem, Setting
from alula.identify.flown.saturation import without_saturated
from alula.identify.flown.start import regressor_variables, start_values
from alula.identify.likelihood.named_search import prior_blocks
from alula.identify.likelihood.optimizer import Algorithm, minimize
from alula.identify.likelihood.parameters import Fitted, Prior, assembled
from alula.identify.result import Identification, Parameter
from alula.identify.trust.control_sign import signs_checked
from alula.identify.trust.feedback import Feedback, distrusted, feedback, warn_of_feedback
from alula.identify.trust.identifiability import UNCERTAIN
from alula.identify.typical import typical_magnitude
from alula.model import AeroModel, parse

StateSet = Literal["longitudinal", "lateral", "six"]


def identify_output_error(
    maneuvers: Sequence[MeasuredManeuver],
    models: Mapping[str, str],
    *,
    states: StateSet | Sequence[str] = "longitudinal",
    outputs: Sequence[str],
    start: Mapping[str, float] | None = None,
    fixed: Mapping[str, float] | None = None,
    tied: Mapping[str, tuple[str, float]] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    priors: Mapping[str, Prior] | None = None,
    initial: str = "estimate",
    biases: Sequence[str] = (),
    common_constant: bool = True,
    stabilize: Mapping[str, float] | None = None,
    noise: Mapping[str, float] | None = None,
    covariance: Covariance = "diagonal",
    algorithm: Algorithm = "gauss_newton",
    substeps: int = 1,
    scales: Mapping[str, float] | None = None,
    truth: Mapping[str, float] | None = None,
) -> Identification:
    """Derivatives from outputs, over all maneuvers at once.

    models: formula by coefficient; CD or CL among them: stability axes, CD may name CL. states: of
    V alpha beta p q r phi theta, or 'longitudinal' (V alpha theta q), 'lateral' (beta p r phi),
    'six' (all); what is not a state is taken as measured. outputs: what is compared. start: values
    of terms, others by equation error. initial, biases, common_constant, stabilize (1/s by state),
    substeps: see `Setting`. noise: standard deviations where they are known; else estimated.
    covariance: of the residuals, 'full' where the errors of different outputs go together, as
    those of a model do.

    A held-out maneuver is predicted with the derivatives of the others; its initial states, biases
    and own constants are fitted to itself. Raises BadInput for names that do not exist and for
    data that lack what the model needs; a search that fails is a result whose status says why.
    """
    need_models(models)
    whole = [without_saturated(m) for m in maneuvers]
    maneuvers = [m for m, _ in whole]
    learn = [m for m in maneuvers if not m.maneuver.held_out]
    if not learn or len({m.maneuver.id for m in maneuvers}) < len(maneuvers):
        raise refuse(
            "no_maneuver",
            where="output error",
            expected="at least one maneuver that is not held out, each with its own id",
            found=", ".join(m.maneuver.id for m in maneuvers) or "none",
            do="Give one, or take `held_out` away.",
        )
    setting = Setting(
        states=STATE_SETS[states] if isinstance(states, str) else tuple(states),
        outputs=tuple(outputs),
        fixed=fixed or {},
        tied=tied or {},
        initial=initial,
        biases=tuple(biases),
        common_constant=common_constant,
        stabilize=stabilize or {},
        substeps=substeps,
    )
    terms = [t.name(c) for c, formula in models.items() for t in parse(formula)]
    # a project's first values of noises are for filter error
    strange = [n for n in start or () if n not in terms and not n.startswith(("F_", "sigma_"))]
    if strange:
        raise refuse(
            "unknown_parameter",
            where="output error, start",
            expected="terms of the model: " + ", ".join(terms),
            found=", ".join(strange),
            do="Correct the names.",
        )
    values = {**start_values(learn, models, {**(fixed or {}), **(start or {})})}
    model = formula_model(models, values, learn[0].reference)
    fit = fit_output_error(
        learn, model, setting, noise=noise, bounds=bounds, priors=priors, algorithm=algorithm,
        covariance=covariance,
    )  # fmt: skip
    problem, found = fit.problem, fit.found
    said = [*(m for _, messages in whole for m in messages), *fit.messages, *_pulled(setting)]
    followed: dict[str, tuple[Feedback, ...]] = {}
    enough = good_enough(models, problem.names)
    fitted: list[Fitted] = []
    blocks = []
    if found.converged:
        blocks = fit.likelihood.blocks(found.value)
        blocks += prior_blocks(problem.names, found.value, priors or {})
        for i, m in enumerate(learn):
            fitted += _fitted(m, problem.flight(found.value, i)[0], setting.outputs)
        followed = _followed(fit, models)
        said += [m for c, laws in followed.items() for m in warn_of_feedback(c, laws)]
        for m in maneuvers:
            if m.maneuver.held_out:
                fitted += _predicted(m, fit, model, setting)
    result = assembled(
        "output error",
        problem.names,
        {name.split("[")[0]: c for name, c in zip(problem.names, problem.belongs, strict=True)},
        blocks,
        found,
        fitted,
        {},
        scales={**enough, **(scales or {})},
        truth=truth,
        messages=said,
    )
    parameters = result.parameters
    if setting.stabilize:
        parameters = tuple(distrusted(p, followed.get(p.coefficient, ())) for p in parameters)
    lost = {p.coefficient for p in parameters if p.verdict == "not_identifiable"}
    parameters = tuple(_plausible(p) if p.coefficient in lost else p for p in parameters)
    parameters, turned = signs_checked(parameters)
    return replace(
        result,
        parameters=parameters,
        formulas=dict(models),
        fixed={n: v for n, v in (fixed or {}).items() if n in terms},
        tied=dict(tied or {}),
        messages=(*result.messages, *turned),
        status=result.status + "".join(f"; sign contradicted: {m.where}" for m in turned),
    )


def _predicted(
    m: MeasuredManeuver, fit: OutputErrorFit, model: AeroModel, setting: Setting
) -> list[Fitted]:
    """A held-out maneuver: the derivatives stay, what belongs to the maneuver itself is fitted."""
    values = fit.problem.model_at(fit.found.value)
    several = len(fit.problem.maneuvers) > 1 and not setting.common_constant
    own = [n for n in values if several and n.endswith("_0")]
    known = {n: v for n, v in values.items() if n not in own and n not in setting.tied}
    start = replace(model, values=np.array([values[n] for n in model.names]))
    problem = FlightProblem([m], start, replace(setting, fixed={**setting.fixed, **known}))
    found = minimize(likelihood_of(problem, None, False), problem.start)
    return _fitted(m, problem.flight(found.value, 0)[0], setting.outputs)


def _fitted(m: MeasuredManeuver, y: Array, outputs: Sequence[str]) -> list[Fitted]:
    return [
        Fitted(name, m.maneuver.id, m.t, m.outputs[name], y[:, o], m.maneuver.held_out)
        for o, name in enumerate(outputs)
    ]


def _followed(fit: OutputErrorFit, models: Mapping[str, str]) -> dict[str, tuple[Feedback, ...]]:
    """Controls that follow the states, in the motion as the model flew it: without noise."""
    variables = []
    for i, m in enumerate(fit.problem.maneuvers):
        y, _ = fit.problem.flight(fit.found.value, i)
        flown = dict(zip(fit.problem.setting.outputs, y.T, strict=True))
        variables.append(regressor_variables(replace(m, outputs=flown)))
    out = {}
    for coefficient, formula in models.items():
        names = {v for term in parse(formula) for f in term.factors for v in f.variables}
        out[coefficient] = feedback(variables, sorted(names))
    return out


def _pulled(setting: Setting) -> tuple[Message, ...]:
    if not setting.stabilize:
        return ()
    words = ", ".join(f"{name} {gain:g}/s" for name, gain in setting.stabilize.items())
    return (
        note(
            "stabilized",
            where="output error",
            expected="a motion that the inputs alone determine",
            found=f"states pulled to their measurements: {words}",
            do="Its noise enters the model there: keep the gains as small as the search allows, "
            "and compare with filter error.",
        ),
    )


def _plausible(p: Parameter) -> Parameter:
    """'weak' where a value is beyond any airplane's, beside others that the data do not determine.

    The search may have gone far along what is flat; a standard error is of the place it ended at.
    """
    typical = typical_magnitude(p.coefficient, p.name)
    far = typical is not None and abs(p.value) > UNCERTAIN * typical
    return replace(p, verdict="weak") if far and p.verdict == "ok" else p
