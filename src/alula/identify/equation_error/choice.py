"""Which regression is used: ordinary, ridge, principal components, stepwise or orthogonal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np

from alula.base.messages import BadInput, Message, note, refuse, warn
from alula.identify.coefficients import CoefficientData
from alula.identify.equation_error.diagnostics import pool_of
from alula.identify.equation_error.task import CoefficientTask
from alula.identify.regression.candidates import candidates
from alula.identify.regression.orthogonal_functions import orthogonal_functions
from alula.identify.regression.principal_components import CONDITION, principal_components
from alula.identify.regression.regress import Regression, Weighting, residual_weights
from alula.identify.regression.ridge import ridge
from alula.identify.regression.shrinkage import Flags
from alula.identify.regression.stepwise import LEVEL, stepwise
from alula.identify.regression.structure import Structure
from alula.model import parse

Kind = Literal["ordinary", "ridge", "pcr", "stepwise", "orthogonal"]
SELECTING = ("stepwise", "orthogonal")


@dataclass(frozen=True)
class RegressionChoice:
    """The kind of regression and what it needs.

    candidates: pool of terms (candidates.py), one for all coefficients or one each; the formula of
    the model is the core that stays. level: of stepwise. least_share: of orthogonal functions.
    ridge: k, 'hkb' or 'gcv'. components: how many to keep, 0 for those within `condition`.
    """

    regression: Kind = "ordinary"
    candidates: str | Mapping[str, str] = field(default_factory=dict)
    level: float = LEVEL
    least_share: float = 0.0
    ridge: float | Literal["hkb", "gcv"] = "hkb"
    components: int = 0
    condition: float = CONDITION

    def __post_init__(self) -> None:
        """Raises BadInput for what does not go together."""
        if self.regression not in get_args(Kind):
            raise _bad("regression", "one of " + ", ".join(get_args(Kind)), repr(self.regression))
        if self.regression in SELECTING and not self.candidates:
            raise _bad("candidates", "a pool such as '(1, alpha, qhat, de)^2'", "none")
        for name, good in (
            ("level", 0.0 < self.level < 1.0),
            ("least_share", 0.0 <= self.least_share < 1.0),
            ("condition", self.condition >= 1.0),
            ("components", self.components >= 0),
        ):
            if not good:
                raise _bad(name, "a number in its range", repr(getattr(self, name)))

    def pool(self, coefficient: str) -> str:
        """The candidates of a coefficient; '' where it has none."""
        if isinstance(self.candidates, str):
            return self.candidates
        return self.candidates.get(coefficient, "")

    def select(
        self,
        coefficient: str,
        formula: str,
        learn: Sequence[CoefficientData],
        common: bool,
        weighting: Weighting,
    ) -> tuple[str, Structure | None, tuple[Message, ...]]:
        """The formula to fit: the given one, with the candidates that were chosen."""
        pool = self.pool(coefficient)
        if self.regression not in SELECTING or not pool:
            return formula, None, ()
        core = parse(formula)
        known = {t.factors for t in core}
        terms = [t for t in candidates(pool) if t.factors not in known and t.factors]
        task = CoefficientTask(coefficient, formula, tuple(learn), common)
        weights = (1.0,) * len(learn)
        if weighting == "residual":
            equal = pool_of(task, terms, weights)
            weights = residual_weights(
                equal.split(equal.columns(range(len(terms)))), equal.split(equal.measured)
            )
        work = pool_of(task, terms, weights)
        if self.regression == "stepwise":
            found = stepwise(work, level=self.level)
        else:
            found = orthogonal_functions(work, least_share=self.least_share)
        chosen = [terms[j].formula for j in found.chosen]
        said = note(
            "structure_selected",
            where=f"model of {coefficient}",
            expected=f"the terms that the data ask for, of {len(terms)} candidates",
            found=(", ".join(chosen) or "none") + f" beside {formula}; {found.why}",
            do="Standard errors are those of the chosen model and leave out that it was chosen "
            "from the same data: judge it by maneuvers that are held out.",
        )
        return " + ".join([formula, *chosen]), found, (said,)

    def fit(
        self, coefficient: str, ordinary: Regression, free: Sequence[str]
    ) -> tuple[Regression, tuple[Message, ...]]:
        """The ordinary fit, or the biased one that is asked for and what is to be said of it."""
        flags: Flags = np.array([name in free for name in ordinary.names])
        if self.regression == "ridge":
            fit, k = ridge(ordinary, flags, self.ridge)
            how = f"ridge regression with k = {k:.3g} (scaled regressors)"
        elif self.regression == "pcr":
            fit, kept, index = principal_components(
                ordinary, flags, self.components or None, self.condition
            )
            how = (
                f"{kept} of {len(index)} principal components (condition indices "
                + ", ".join(f"{x:.3g}" for x in index)
                + ")"
            )
        else:
            return ordinary, ()
        bias = fit.bias
        assert bias is not None  # both methods carry the ordinary fit
        return fit, (_biased(coefficient, how, fit),)


def regression_choice(options: Mapping[str, Any]) -> RegressionChoice:
    """The choice by a project's [identify.options]; raises BadInput for what it does not know."""
    kinds: Mapping[str, type | tuple[type, ...]] = {
        "regression": str,
        "candidates": (str, Mapping),
        "level": (int, float),
        "least_share": (int, float),
        "ridge": (int, float, str),
        "components": (int, float),
        "condition": (int, float),
    }
    for name, value in options.items():
        if name not in kinds:
            raise _bad(name, "only " + ", ".join(kinds), repr(name))
        if isinstance(value, bool) or not isinstance(value, kinds[name]):
            raise _bad(
                name,
                "a number" if name not in ("regression", "candidates") else "text",
                repr(value),
            )
    given = dict(options)
    if "components" in given:
        if given["components"] != int(given["components"]):
            raise _bad("components", "a whole number", repr(given["components"]))
        given["components"] = int(given["components"])
    pools = given.get("candidates")
    if isinstance(pools, Mapping) and not all(isinstance(v, str) for v in pools.values()):
        raise _bad("candidates", "a line of text for each coefficient", repr(pools))
    return RegressionChoice(**given)


OPTIONS = frozenset(RegressionChoice.__dataclass_fields__)


def _biased(coefficient: str, how: str, fit: Regression) -> Message:
    bias = fit.bias
    assert bias is not None
    se = np.sqrt(np.diag(fit.coloured.covariance))
    worst = int(np.argmax(np.abs(bias) / np.where(se > 0.0, se, np.inf)))
    return warn(
        "biased_estimate",
        where=f"model of {coefficient}",
        expected="an unbiased estimate",
        found=f"{how}: biased by about {bias[worst]:.2g} in {fit.names[worst]}, "
        f"{abs(bias[worst]) / se[worst] if se[worst] > 0.0 else np.inf:.2g} standard errors",
        do="Good for predicting within the flown motion. Intervals include the estimated bias, "
        "which is uncertain itself; for derivatives fly a maneuver that parts the regressors.",
    )


def _bad(name: str, expected: str, found: str) -> BadInput:
    return refuse(
        "bad_option",
        where=f"identify.options.{name}",
        expected=expected,
        found=found,
        do="Correct it or take it out.",
    )
