"""Several maneuvers and one model as the optimizer's problem: what is a parameter, and where.

Parameters: the model's terms that are neither fixed nor tied, then of each maneuver its initial
states ('alpha(0)[id]') and the biases of its outputs ('b_az[id]'); where constants are not common,
the constant terms too ('Cm_0[id]').
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.identify.flown.core_maneuver import ManeuverInCore, Spread, in_core
from alula.identify.flown.measured_maneuver import CONTROLS, OUTPUTS, STATES, MeasuredManeuver
from alula.identify.typical import constant_name
from alula.model import AeroModel

STATE_SETS: Mapping[str, tuple[str, ...]] = {
    "longitudinal": ("V", "alpha", "theta", "q"),
    "lateral": ("beta", "p", "r", "phi"),
    "six": STATES,
}
MAX_COLUMNS = 64  # of one maneuver, core/include/alula/math/capacity.hpp


@dataclass(frozen=True)
class Sums:
    """One evaluation with m outputs and k parameters; J are the outputs' slopes, e the residuals.

    information: (m, k, k), sums of J J'; gradient: (m, k), of J e; squares: (m,), of e^2; counts:
    (m,). finite: whether every maneuver was flown to its end.
    """

    information: Array
    gradient: Array
    squares: Array
    counts: Array
    finite: bool


@dataclass(frozen=True)
class Setting:
    """What is estimated, and how the motion is flown.

    states: of `STATES`, or the name of a set. outputs: those that are compared. fixed: values of
    terms that stay. tied: term by (another term, factor). initial: 'estimate', or 'measured' for
    the first sample of each state as it stands in the maneuver's motion. biases: outputs with a
    bias for each maneuver. common_constant: one constant term for all maneuvers. stabilize: how
    strongly states are pulled to their measurements, 1/s, by name. substeps: RK4 steps a sample.
    """

    states: tuple[str, ...]
    outputs: tuple[str, ...]
    fixed: Mapping[str, float] = field(default_factory=dict)
    tied: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    initial: str = "estimate"
    biases: tuple[str, ...] = ()
    common_constant: bool = True
    stabilize: Mapping[str, float] = field(default_factory=dict)
    substeps: int = 1


class FlightProblem:
    """The problem of `setting` on maneuvers with one model; its values are the start.

    names: (k,) of the parameters. belongs: (k,) the coefficient, state or output of each. start:
    (k,).
    """

    def __init__(
        self, maneuvers: Sequence[MeasuredManeuver], model: AeroModel, setting: Setting
    ) -> None:
        self.maneuvers, self.model, self.setting = tuple(maneuvers), model, setting
        self._check()
        self.names: list[str] = []
        self.belongs: list[str] = []
        self._start: list[float] = []
        self._values = [model.values.copy() for _ in maneuvers]
        self._terms: list[list[int]] = [[] for _ in maneuvers]  # global column of each term
        self._weights = [np.ones(len(model.values)) for _ in maneuvers]
        self._add_terms()
        self._initial, self._bias = self._add_own()
        self.start = np.array(self._start)
        self._fits = [self._in_core(i) for i in range(len(self.maneuvers))]

    @property
    def readings(self) -> list[Array]:
        """Measured outputs (n, m) of each maneuver, NaN where a sensor says nothing."""
        return [
            np.column_stack([m.outputs[n] for n in self.setting.outputs]) for m in self.maneuvers
        ]

    def _check(self) -> None:
        s, names = self.setting, self.model.names
        for key, what in (("states", s.states), ("outputs", s.outputs)):
            known = STATES if key == "states" else OUTPUTS
            bad = [name for name in what if name not in known]
            if bad or not what:
                raise _refused(
                    key,
                    f"some of {', '.join(known)}",
                    ", ".join(bad) or "none",
                    "Correct the list.",
                )
        bad = [name for name in s.fixed if name not in names]
        if bad:
            raise _refused(
                "fixed", f"terms of the model: {', '.join(names)}", ", ".join(bad), "Correct it."
            )
        check_tied("output error", s.tied, names)
        bad = [name for name in s.biases if name not in s.outputs]
        if bad:
            raise _refused("biases", "outputs", ", ".join(bad), "Name outputs that are compared.")
        bad = [n for n in s.stabilize if n not in s.states or n not in s.outputs]
        if bad:
            raise _refused(
                "stabilize",
                "states that are outputs",
                ", ".join(bad),
                "Measure them, or leave out.",
            )
        if s.initial not in ("estimate", "measured"):
            raise _refused("initial", "'estimate' or 'measured'", repr(s.initial), "Choose one.")
        if not self.maneuvers:
            raise _refused("maneuvers", "at least one", "none", "Give a maneuver to learn from.")
        for m in self.maneuvers:
            missing = [name for name in s.outputs if name not in m.outputs]
            if missing:
                raise _refused(
                    f"maneuver {m.maneuver.id}",
                    f"outputs {', '.join(s.outputs)}",
                    f"no {', '.join(missing)}",
                    "Map their channels, or compare fewer outputs.",
                )
            needed = {v for _, term in self.model.terms for f in term.factors for v in f.variables}
            missing = sorted(needed & set(CONTROLS) - m.controls.keys())
            if missing:
                raise refuse(
                    "missing_variable",
                    where=f"maneuver {m.maneuver.id}",
                    expected=f"controls {', '.join(sorted(needed & set(CONTROLS)))}",
                    found=f"no {', '.join(missing)}",
                    do="Map their channels, or drop their terms.",
                )

    def _column(self, name: str, coefficient: str, start: float) -> int:
        self.names.append(name)
        self.belongs.append(coefficient)
        self._start.append(float(start))
        return len(self.names) - 1

    def _add_terms(self) -> None:
        s, model = self.setting, self.model
        column: dict[tuple[str, int], int] = {}
        several = len(self.maneuvers) > 1 and not s.common_constant
        for (coefficient, _), name, value in zip(
            model.terms, model.names, model.values, strict=True
        ):
            if name in s.fixed or name in s.tied:
                continue
            own = several and name == constant_name(coefficient)
            if not own:
                shared = self._column(name, coefficient, value)
            for i, m in enumerate(self.maneuvers):
                column[name, i] = (
                    self._column(f"{name}[{m.maneuver.id}]", coefficient, value) if own else shared
                )
        for i in range(len(self.maneuvers)):
            for k, name in enumerate(model.names):
                source, factor = s.tied.get(name, (name, 1.0))
                self._weights[i][k] = factor
                self._terms[i].append(column.get((source, i), -1))
                if source in s.fixed:
                    self._values[i][k] = factor * s.fixed[source]

    def _add_own(self) -> tuple[list[list[int]], list[list[int]]]:
        s = self.setting
        initial, bias = [], []
        for m in self.maneuvers:
            tag = f"[{m.maneuver.id}]"
            here = [-1] * len(STATES)
            if s.initial == "estimate":
                for name in (n for n in STATES if n in s.states):
                    here[STATES.index(name)] = self._column(
                        f"{name}(0){tag}", name, _first(m, name)
                    )
            initial.append(here)
            bias.append(
                [self._column(f"b_{n}{tag}", n, 0.0) if n in s.biases else -1 for n in s.outputs]
            )
        return initial, bias

    def _in_core(self, i: int) -> ManeuverInCore:
        m, s = self.maneuvers[i], self.setting
        used = sorted({c for c in (*self._terms[i], *self._initial[i], *self._bias[i]) if c >= 0})
        if len(used) > MAX_COLUMNS:
            raise _refused(
                f"maneuver {m.maneuver.id}",
                f"at most {MAX_COLUMNS} parameters that act on one maneuver",
                f"{len(used)}",
                "Fix some, or take terms out.",
            )
        local = {c: j for j, c in enumerate(used)} | {-1: -1}
        fit = in_core(m, self.model, s.states, s.outputs, s.stabilize, s.substeps)
        fit.columns(
            len(used),
            [local[c] for c in self._terms[i]],
            self._weights[i],
            [local[c] for c in self._initial[i]],
            [local[c] for c in self._bias[i]],
        )
        terms = np.array(self._terms[i], dtype=np.int64)
        first = np.array([m.motion[name][0] for name in STATES], dtype=np.float64)
        return ManeuverInCore(
            fit,
            np.array(used, dtype=np.int64),
            Spread(self._values[i], terms, self._weights[i]),
            Spread(first, np.array(self._initial[i])),
            Spread(np.zeros(len(s.outputs)), np.array(self._bias[i])),
            len(m.t),
        )

    def evaluate(self, theta: Array) -> Sums:
        """The sums over all maneuvers at the parameters (k,)."""
        k, m = len(self.names), len(self.setting.outputs)
        parts = [fit.core.sums(*fit.arguments(theta)) for fit in self._fits]
        if len(parts) == 1 and len(self._fits[0].used) == k:
            flown, information, gradient, squares, counts = parts[0]
            finite = flown == self._fits[0].samples
            return Sums(information, gradient, squares, counts, finite)
        whole, slope = np.zeros((m, k, k)), np.zeros((m, k))
        for fit, (_, information, gradient, _, _) in zip(self._fits, parts, strict=True):
            whole[:, fit.used[:, None], fit.used] += information
            slope[:, fit.used] += gradient
        squares = np.sum([p[3] for p in parts], axis=0)
        counts = np.sum([p[4] for p in parts], axis=0)
        finite = all(p[0] == fit.samples for fit, p in zip(self._fits, parts, strict=True))
        return Sums(whole, slope, squares, counts, finite)

    def flight(self, theta: Array, i: int) -> tuple[Array, Array]:
        """Outputs (n, m) of maneuver i and their slopes (n, m, k); NaN behind a divergence."""
        fit = self._fits[i]
        flown, y, slopes = fit.core.flight(*fit.arguments(theta), True)
        y[flown:] = np.nan
        whole = np.zeros((*y.shape, len(self.names)))
        whole[:, :, fit.used] = slopes
        return y, whole

    def model_at(self, theta: Array) -> dict[str, float]:
        """Values of all terms by name, tied and fixed ones included; constants of maneuver 0."""
        values = self._fits[0].values.at(theta)
        return dict(zip(self.model.names, values.tolist(), strict=True))


def check_tied(method: str, tied: Mapping[str, tuple[str, float]], names: Sequence[str]) -> None:
    """Refuse ties of what is no term of the model, or to what is tied itself."""
    for name, (other, factor) in tied.items():
        if name not in names:
            expected, found, do = f"terms of the model: {', '.join(names)}", name, "Correct it."
        elif other not in names or other in tied or not np.isfinite(factor):
            expected = "a term that is not tied itself, and a finite factor"
            found, do = f"{name} = {factor} {other}", "Tie terms to one that is estimated or fixed."
        else:
            continue
        raise refuse(
            "output_error" if method == "output error" else "filter_error",
            where=f"{method}, tied",
            expected=expected,
            found=found,
            do=do,
        )


def _first(m: MeasuredManeuver, name: str) -> float:
    """Where a state begins: the mean of its first readings, or of the motion's."""
    readings = m.outputs.get(name, m.motion[name])[:3]
    readings = readings[np.isfinite(readings)]
    return float(np.mean(readings)) if len(readings) else float(m.motion[name][0])


def _refused(what: str, expected: str, found: str, do: str) -> Exception:
    return refuse(
        "output_error", where=f"output error, {what}", expected=expected, found=found, do=do
    )
