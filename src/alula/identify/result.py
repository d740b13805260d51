"""What identification returns: parameters with error bars and verdicts, fits, residuals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import Message

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from alula.identify.equation_error.diagnostics import Diagnostics
    from alula.identify.regression.structure import Structure

Verdict = Literal["ok", "weak", "not_identifiable"]


@dataclass(frozen=True)
class Tie:
    """One member of a combination that the data do not resolve, with its weight."""

    name: str
    weight: float


@dataclass(frozen=True)
class Parameter:
    """One estimated parameter.

    se_white: standard error if residuals were white. se: with coloured residuals and the
    reconstruction's uncertainty. ci95: by `se` and Student's t. bias: of an estimate that is biased
    by its method (ridge, principal components), its estimated bias, which `se` leaves out and
    `ci95` includes; None where the method is unbiased.
    """

    name: str  # 'Cm_alpha'; constants of several maneuvers: 'Cm_0[elevator]'
    coefficient: str
    value: float
    se_white: float
    se: float
    ci95: tuple[float, float]
    verdict: Verdict
    tied_to: tuple[Tie, ...]
    unit: str
    vif: float  # variance inflation factor
    truth: float | None = None
    bias: float | None = None

    @property
    def zero_constant(self) -> bool:
        """Weak because it is a trim constant that is zero as closely as the data tell."""
        constant = self.name.split("[")[0] == f"{self.coefficient}_0"
        return constant and self.verdict == "weak" and self.ci95[0] <= 0.0 <= self.ci95[1]


@dataclass(frozen=True)
class Fit:
    """How one coefficient's model fits, over all its maneuvers.

    diagnostics: whether the model is enough and what the residuals say. structure: how its terms
    were chosen. None where the method does not tell.
    """

    coefficient: str
    formula: str
    r2: float
    rrmse: float
    n: int
    n_held_out: int
    r2_held_out: float
    durbin_watson: float
    diagnostics: Diagnostics | None = None
    structure: Structure | None = None


@dataclass(frozen=True)
class Series:
    """Measured and modeled coefficient or output over one maneuver; (n,) each.

    over: unit of t: s, or Hz where amplitudes of transforms are compared and t is their frequency.
    """

    coefficient: str
    maneuver: str
    t: Array
    measured: Array
    model: Array
    held_out: bool
    over: Literal["s", "Hz"] = "s"


@dataclass(frozen=True)
class History:
    """Estimates over time, of a recursive method, over one maneuver.

    names: (k,) of the parameters. t: (n,) s. value: (n, k). se: (n, k) standard errors as the
    method has them in flight, NaN before there are enough samples. factor: (n,) forgetting used.
    """

    coefficient: str
    maneuver: str
    names: tuple[str, ...]
    t: Array
    value: Array
    se: Array
    factor: Array


@dataclass(frozen=True)
class Identification:
    """The result of one identification; statsmodels' words for what they know.

    A parameter that is not identifiable has NaN for value and errors, and NaN in `covariance`.
    labels: what a coefficient includes beyond aerodynamics ('including thrust'). fits: by
    coefficient, or by output where outputs are compared; formulas: by coefficient, where fits are
    not. fixed: values of the formulas' terms that were not estimated. tied: terms that are a factor
    times another. uncertainty: what the parameters' `se` is, in words.
    """

    method: str
    parameters: tuple[Parameter, ...]
    fits: Mapping[str, Fit]
    series: tuple[Series, ...]
    covariance: Array  # of all parameters, in their order
    status: str
    messages: tuple[Message, ...] = ()
    histories: tuple[History, ...] = ()  # of recursive methods
    labels: Mapping[str, str] = field(default_factory=dict)
    formulas: Mapping[str, str] = field(default_factory=dict)
    uncertainty: str = "coloured residuals"
    fixed: Mapping[str, float] = field(default_factory=dict)
    tied: Mapping[str, tuple[str, float]] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Parameter:
        """The parameter `name`; raises KeyError."""
        for parameter in self.parameters:
            if parameter.name == name:
                return parameter
        raise KeyError(name)

    @property
    def identifiable(self) -> bool:
        """Whether the data determine every parameter."""
        return all(p.verdict != "not_identifiable" for p in self.parameters)

    @property
    def params(self) -> pd.Series[float]:
        """Values by name."""
        return self._column([p.value for p in self.parameters])

    @property
    def bse(self) -> pd.Series[float]:
        """Standard errors by name: coloured residuals and all that lies outside the fit."""
        return self._column([p.se for p in self.parameters])

    def cov_params(self) -> pd.DataFrame:
        """Covariance of all parameters, by name in both directions."""
        import pandas as pd

        names = [p.name for p in self.parameters]
        return pd.DataFrame(self.covariance, index=names, columns=names)

    def conf_int(self) -> pd.DataFrame:
        """The 95 % intervals by name, columns 'lower' and 'upper'."""
        import pandas as pd

        names = [p.name for p in self.parameters]
        return pd.DataFrame(
            [p.ci95 for p in self.parameters], index=names, columns=["lower", "upper"]
        )

    @property
    def correlations(self) -> Array:
        """Correlation of the estimates, (k, k); NaN where there is no estimate."""
        se = np.sqrt(np.diag(self.covariance))
        se = np.where(se > 0.0, se, np.nan)
        out: Array = self.covariance / np.outer(se, se)
        return out

    @property
    def resid(self) -> dict[str, Array]:
        """Measured minus model by coefficient, the maneuvers learned from one after another."""
        return {
            name: np.concatenate(
                [
                    s.measured - s.model
                    for s in self.series
                    if s.coefficient == name and not s.held_out
                ]
            )
            for name in self.fits
        }

    @property
    def rsquared(self) -> dict[str, float]:
        """R2 by coefficient, on the maneuvers learned from."""
        return {name: fit.r2 for name, fit in self.fits.items()}

    def summary(self) -> str:
        """The result as plain text."""
        from alula.identify.text import summary

        return summary(self)

    def plot(self) -> Figure:
        """Measured and modeled coefficients over time, a matplotlib figure."""
        from alula.identify.plot import plot

        return plot(self)

    def _column(self, values: list[float]) -> pd.Series[float]:
        import pandas as pd

        return pd.Series(values, index=[p.name for p in self.parameters], dtype="float64")
