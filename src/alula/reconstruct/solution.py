"""What every method hands over: states along each record, constants, and directions of doubt."""

from __future__ import annotations

from dataclasses import dataclass

from alula.base.arrays import Array
from alula.base.messages import Message


@dataclass(frozen=True)
class RecordSolution:
    """One record. states, states_se (n, k); fitted, innovation, deviation (n, sensors): what the
    sensors should read, reading minus prediction and its standard deviation (NaN where none).
    start (k,): the state at the first sample, from which the open loop starts. doubt (d, n, k):
    how the states move along each independent direction of the solution's uncertainty.
    """

    states: Array
    states_se: Array
    fitted: Array
    innovation: Array
    deviation: Array
    start: Array
    doubt: Array


@dataclass(frozen=True)
class Solution:
    """All records of one problem. constants, covariance: of the free unknowns, in their order.

    informed: (constants,) share of the prior's standard deviation that the data took away.
    sigma: (sensors,) the measurement standard deviations as used or estimated.
    """

    records: tuple[RecordSolution, ...]
    constants: Array
    covariance: Array
    informed: Array
    sigma: Array
    nis: float  # summed over the records
    readings: int
    converged: bool
    status: str
    messages: tuple[Message, ...] = ()
