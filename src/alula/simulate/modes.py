"""The natural motions of an aircraft: short period, phugoid, Dutch roll, roll, spiral.

A mode is recognized by which states take part in it, not by its place in a list. The participation
of state k in eigenvalue i is |v_ki w_ik|, right times left eigenvector (Perez-Arriaga, Verghese and
Schweppe, Selective Modal Analysis, IEEE PAS-101, 1982): it does not change with the units or the
order of the states. Eigenvalues and names are then matched so that the sum of participations is
largest, each name taking as many eigenvalues as it has states.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf, log, pi
from typing import Literal

import numpy as np

from alula.base.arrays import Array
from alula.base.messages import refuse
from alula.simulate.linearize import LinearModel

# The states in which each mode of a rigid aircraft lives.
_HOME: dict[str, tuple[str, ...]] = {
    "short_period": ("alpha", "q"),
    "phugoid": ("V", "theta"),
    "altitude": ("h",),
    "dutch_roll": ("beta", "r"),
    "roll": ("p",),
    "spiral": ("phi",),
    "heading": ("psi",),
    "position": ("north", "east", "lat", "lon"),
}
# Oscillations in which two of them have become one.
_MERGED = {
    frozenset(("roll", "spiral")): "roll_spiral",  # also called lateral phugoid
    frozenset(("short_period", "phugoid")): "third_oscillation",
}
# What the plant's further states belong to, by the beginning of their names.
_FURTHER = {
    "stall": "stall",
    "X": "stall",
    "charge": "battery",
    "fuel": "fuel",
    "rotor": "rotor",
    "omega": "rotor",
    "power": "engine",
    "engine": "engine",
}
_ACTUATORS = ("de", "da", "dr", "df", "dt")
WORDS = {
    "short_period": "short period",
    "phugoid": "phugoid",
    "dutch_roll": "Dutch roll",
    "roll": "roll",
    "spiral": "spiral",
    "altitude": "altitude",
    "roll_spiral": "roll-spiral oscillation",
    "third_oscillation": "third oscillation (short period and phugoid merged)",
}
_REAL = 1e-9  # of the size of the matrix: below it an imaginary part is rounding
_ROUNDING = 1e-13  # of the size of the matrix: what a root at zero comes out as
_REST = 1e-9  # 1/s: a root below it neither grows nor decays


@dataclass(frozen=True)
class Mode:
    """One real eigenvalue or one conjugate pair (imag > 0), 1/s.

    family: the name shared by both roots where an oscillation has fallen apart into two. name: its
    own. participation: share of each state, the sum being one. shape: the eigenvector by state, its
    largest part (speeds divided by the airspeed, heights by 100 m) being one.
    """

    name: str
    family: str
    eigenvalue: complex
    participation: dict[str, float] = field(default_factory=dict)
    shape: dict[str, complex] = field(default_factory=dict)

    @property
    def form(self) -> Literal["oscillation", "aperiodic"]:
        """Whether it swings."""
        return "oscillation" if self.eigenvalue.imag > 0.0 else "aperiodic"

    @property
    def words(self) -> str:
        """The name as a person writes it."""
        text = WORDS.get(self.family, self.family.replace("_", " "))
        return text + self.name.removeprefix(self.family).replace("_", ", ")

    @property
    def stable(self) -> bool:
        """Whether it decays."""
        return self.eigenvalue.real < 0.0

    @property
    def frequency(self) -> float | None:
        """Undamped natural frequency, rad/s; None where aperiodic."""
        return abs(self.eigenvalue) if self.form == "oscillation" else None

    @property
    def damping(self) -> float | None:
        """Damping ratio; None where aperiodic."""
        if self.form == "aperiodic":
            return None
        return -self.eigenvalue.real / abs(self.eigenvalue)

    @property
    def period(self) -> float | None:
        """Of the damped oscillation, s; None where aperiodic."""
        return 2.0 * pi / self.eigenvalue.imag if self.form == "oscillation" else None

    @property
    def time_constant(self) -> float | None:
        """-1/root, s, negative where it diverges; None where it swings or rests."""
        root = self.eigenvalue.real
        return -1.0 / root if self.form == "aperiodic" and abs(root) > _REST else None

    @property
    def time_to_half(self) -> float | None:
        """s; None where it does not decay."""
        return log(2.0) / -self.eigenvalue.real if self.eigenvalue.real < -_REST else None

    @property
    def time_to_double(self) -> float | None:
        """s; None where it does not grow."""
        return log(2.0) / self.eigenvalue.real if self.eigenvalue.real > _REST else None

    @property
    def cycles_to_tenth(self) -> float | None:
        """Cycles until a tenth of the amplitude is left; infinite where it does not decay."""
        if self.form == "aperiodic":
            return None
        decay = -self.eigenvalue.real
        return self.eigenvalue.imag * log(10.0) / (2.0 * pi * decay) if decay > 0.0 else inf


def modes_of(
    linear: LinearModel, V: float = 1.0, *, states: Sequence[str] | None = None
) -> tuple[Mode, ...]:
    """The modes of a linear model, fastest first.

    V: airspeed, m/s, that speeds in the shapes are divided by. states: only these; couplings to
    the others are dropped. Raises BadInput where A is not finite.
    """
    part = linear if states is None else linear.part(states)
    A = np.asarray(part.A)
    if not np.isfinite(A).all():
        raise refuse(
            "not_finite",
            where="modes",
            expected="a finite matrix A",
            found="elements that are not",
            do="Linearize at a point inside the model's range.",
        )
    # Equal sizes before the eigenvalues are sought: units differ by orders of magnitude.
    unit = np.array([_unit(name, V) for name in part.states])
    roots, right = np.linalg.eig(A * unit / unit[:, None])
    share = _participation(right)
    families = [family_of(name) for name in part.states]
    distinct = list(dict.fromkeys(families))
    at_home = np.stack(
        [share[[f == family for f in families]].sum(axis=0) for family in distinct], axis=1
    )
    from scipy.optimize import linear_sum_assignment  # slow to import

    # One column for each state of a family: as many eigenvalues may take its name.
    columns = [distinct.index(f) for f in families]
    order = np.lexsort((roots.imag, roots.real))  # ties fall the same way in any order of states
    rows, chosen = linear_sum_assignment(at_home[order][:, columns], maximize=True)
    given: dict[int, str] = {
        int(order[r]): distinct[columns[c]] for r, c in zip(rows, chosen, strict=True)
    }
    size = float(np.abs(A * unit / unit[:, None]).max(initial=0.0))
    found = []
    for i, root in enumerate(roots):
        value = complex(root)
        if abs(value.imag) <= _REAL * size:
            value = complex(value.real if abs(value.real) > _ROUNDING * size else 0.0, 0.0)
        elif value.imag < 0.0:
            continue
        family = given[i]
        if value.imag > 0.0:
            twin = int(np.argmin(np.abs(roots - np.conj(root))))
            family = _merged(given[i], given[twin])
        shape = right[:, i] / right[np.argmax(np.abs(right[:, i])), i]
        found.append(
            Mode(
                family,
                family,
                value,
                dict(zip(part.states, share[:, i].tolist(), strict=True)),
                dict(zip(part.states, (complex(z) for z in shape), strict=True)),
            )
        )
    # Eight digits: roots that differ by rounding alone stand in the order of their names.
    found.sort(key=lambda m: (-float(f"{abs(m.eigenvalue):.8g}"), m.family, m.eigenvalue.real))
    return tuple(_with_own_names(found))


def family_of(state: str) -> str:
    """The mode that lives in a state: of a rigid aircraft, or of what else the plant holds."""
    for family, home in _HOME.items():
        if state in home:
            return family
    if state in _ACTUATORS:
        return f"actuator_{state}"
    for beginning, family in _FURTHER.items():
        if state == beginning or state.startswith(f"{beginning}_"):
            return family
    return state


def _participation(right: Array) -> Array:
    """|v_ki w_ik| (state, eigenvalue), each column adding up to one."""
    # Roots that coincide (heading and place, all at zero) may share eigenvectors; the pseudoinverse
    # then still tells in which states they live.
    try:
        left = np.linalg.inv(right)
    except np.linalg.LinAlgError:
        left = np.linalg.pinv(right)
    share = np.abs(right * left.T)
    return np.asarray(share / share.sum(axis=0))


def _unit(state: str, V: float) -> float:
    return {"V": V, "h": 100.0}.get(state, 1.0)


def _merged(a: str, b: str) -> str:
    if a == b:
        return a
    return _MERGED.get(frozenset((a, b)), "_".join(sorted((a, b))))


def _with_own_names(modes: list[Mode]) -> list[Mode]:
    """Several roots of one family, fastest first: 'short_period_1', 'short_period_2'."""
    count = {m.family: sum(o.family == m.family for o in modes) for m in modes}
    seen: dict[str, int] = {}
    out = []
    for m in modes:
        seen[m.family] = seen.get(m.family, 0) + 1
        name = m.family if count[m.family] == 1 else f"{m.family}_{seen[m.family]}"
        out.append(Mode(name, m.family, m.eigenvalue, m.participation, m.shape))
    return out
