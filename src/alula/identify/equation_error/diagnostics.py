"""What every regression is asked after the fit, whichever method made it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from alula.base.messages import Message
from alula.identify.equation_error.task import CoefficientTask, variables_of
from alula.identify.regression.lack_of_fit import LackOfFit, lack_of_fit
from alula.identify.regression.linearity import Linearity, linearity, second_order
from alula.identify.regression.regress import Regression
from alula.identify.regression.residual_tests import (
    InputCorrelation,
    Whiteness,
    input_correlations,
    ljung_box,
)
from alula.identify.regression.structure import Pool
from alula.identify.trust.feedback import CONTROLS, Feedback, feedback, warn_of_feedback
from alula.model.terms import Term


@dataclass(frozen=True)
class Diagnostics:
    """The answers for one coefficient's model.

    whiteness: which standard error to believe. inputs: what residuals still owe to each control.
    lack_of_fit, linearity: whether the model is enough. feedback: controls that follow states.
    """

    whiteness: Whiteness
    inputs: tuple[InputCorrelation, ...]
    lack_of_fit: LackOfFit
    linearity: Linearity
    feedback: tuple[Feedback, ...]

    @property
    def words(self) -> str:
        """One line for the summary."""
        parts = []
        if np.isfinite(self.whiteness.p):
            white = "white" if self.whiteness.white else "coloured"
            parts.append(f"residuals {white} (Ljung-Box p {self.whiteness.p:.2g})")
        parts += [
            f"residuals follow {c.input} by {c.lag} samples (r {c.correlation:+.2f})"
            for c in self.inputs
            if c.significant
        ]
        parts += [self.linearity.words, self.lack_of_fit.words]
        return "; ".join(parts)


def diagnose(task: CoefficientTask, fit: Regression) -> tuple[Diagnostics, tuple[Message, ...]]:
    """All tests of one coefficient's fit, and warnings where a control follows the states."""
    names = list(
        dict.fromkeys(v for t in task.formula_terms for f in t.factors for v in f.variables)
    )
    variables = [variables_of(item) for item in task.learn]
    controls = [
        c
        for c in CONTROLS
        if all(c in v for v in variables) and any(np.ptp(v[c]) for v in variables)
    ]
    found = Diagnostics(
        whiteness=ljung_box(fit.residuals),
        inputs=input_correlations(fit.residuals, {c: [v[c] for v in variables] for c in controls}),
        lack_of_fit=lack_of_fit(
            fit,
            [
                np.column_stack([np.ones(len(item.t)), *(v[n] for n in names)])
                for item, v in zip(task.learn, variables, strict=True)
            ],
        ),
        linearity=linearity(pool_of(task, second_order(task.formula_terms), fit.weights)),
        feedback=feedback(variables, names),
    )
    return found, warn_of_feedback(task.coefficient, found.feedback)


def pool_of(task: CoefficientTask, terms: Sequence[Term], weights: Sequence[float]) -> Pool:
    """Candidate terms beside the task's own model, maneuvers weighted as given."""
    core, candidates, measured = [], [], []
    for weight, block, item in zip(weights, task.blocks(None), task.learn, strict=True):
        root = np.sqrt(weight)
        matrix = np.empty((len(item.t), len(terms)))
        for j, term in enumerate(terms):
            matrix[:, j] = term.values(variables_of(item))
        core.append(root * block.regressors)
        candidates.append(root * task.smoothed(item, matrix))
        measured.append(root * block.measured)
    columns = np.vstack(core)
    order = [task.names.index(n) for n in task.free]
    order += [i for i in range(len(task.names)) if i not in order]
    return Pool(
        names=tuple(t.formula for t in terms),
        core=columns[:, order],
        candidates=np.vstack(candidates),
        measured=np.concatenate(measured),
        ends=tuple(np.cumsum([len(m) for m in measured])[:-1].tolist()),
        free=len(task.free),
    )
