"""What identification returns: parameters with error bars and verdicts, fits, residuals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from alula.base.arrays import Array
from alula.base.messages import Message

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
    reconstruction's uncertainty. ci95: by `se` and Student's t.
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


@dataclass(frozen=True)
class Fit:
    """How one coefficient's model fits, over all its maneuvers."""

    coefficient: str
    formula: str
    r2: float
    rrmse: float
    n: int
    n_held_out: int
    r2_held_out: float
    durbin_watson: float


@dataclass(frozen=True)
class Series:
    """Measured and modeled coefficient over one maneuver; (n,) each."""

    coefficient: str
    maneuver: str
    t: Array
    measured: Array
    model: Array
    held_out: bool


@dataclass(frozen=True)
class Identification:
    """The result of one identification; statsmodels' words for what they know."""

    method: str
    parameters: tuple[Parameter, ...]
    fits: Mapping[str, Fit]
    series: tuple[Series, ...]
    covariance: Array  # of all parameters, in their order
    status: str
    messages: tuple[Message, ...] = ()
