"""Several predictions of one aircraft to one value for each derivative, with an honest error.

The rule: the mean weighted by inverse variances. Its variance: the methods' own, averaged with the
same weights, plus their spread about the mean. The own part does not fall with the number of
methods, since all stand on the same geometry and the same linear theory. Before that each
method's error is raised to at least `FLOOR` of its value, or of the size that the derivative has on
ordinary airplanes: a mesh error of zero is no knowledge of the flight, nor is a tenth of a value
that happens to be small.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import hypot, sqrt

from alula.base.messages import refuse
from alula.predict.axes import along
from alula.predict.derivatives import Derivatives, Estimate

# Root mean square of (predicted/flown - 1) over C_L_alpha and C_L_de by Tornado, AVL and Datcom,
# Dittrich 2016, Table 4.4: the best that such methods did against flight.
FLOOR = 0.05
# Sizes on conventional light airplanes (compare Nelson, Flight Stability and Automatic Control,
# 1998, app. B), for the floor only.
SIZE = {
    "CL_0": 0.3, "CL_alpha": 5.0, "CL_q": 8.0, "CL_alphadot": 2.0, "CL_de": 0.4, "CL_df": 0.8,
    "Cm_0": 0.1, "Cm_alpha": 1.0, "Cm_q": 12.0, "Cm_alphadot": 5.0, "Cm_de": 1.2, "Cm_df": 0.2,
    "CD_0": 0.03, "CD_alpha": 0.3, "CD_alpha2": 1.5,
    "CY_beta": 0.4, "CY_p": 0.1, "CY_r": 0.2, "CY_da": 0.05, "CY_dr": 0.2,
    "Cl_beta": 0.1, "Cl_p": 0.5, "Cl_r": 0.1, "Cl_da": 0.2, "Cl_dr": 0.02,
    "Cn_beta": 0.08, "Cn_p": 0.05, "Cn_r": 0.1, "Cn_da": 0.02, "Cn_dr": 0.08,
}  # fmt: skip

# Derivatives that flight does not tell apart from others, by what they are compared with.
PAIRS = {
    "CL_q": ("CL_alphadot", 1.0),
    "Cm_q": ("Cm_alphadot", 1.0),
    "CY_r": ("CY_betadot", -1.0),
    "Cl_r": ("Cl_betadot", -1.0),
    "Cn_r": ("Cn_betadot", -1.0),
}


def combine(
    predictions: Sequence[Derivatives], *, prefer: Mapping[str, str] | None = None
) -> Derivatives:
    """One prediction of several, in stability axes. prefer: the method taken, by derivative.

    A preferred value keeps the spread of all methods in its error. Raises BadInput for no
    prediction, two of one method, and a preferred method that is none of them.
    """
    predictions = [along(d, "stability") for d in predictions]
    methods = [d.method for d in predictions]
    _check(methods, prefer or {})
    names = dict.fromkeys(name for d in predictions for name in d.values)
    values = {name: _one(name, predictions, (prefer or {}).get(name)) for name in names}
    conditions = {
        f"{d.method}: {key}": text for d in predictions for key, text in d.conditions.items()
    }
    notes = [f"{d.method}: {note}" for d in predictions for note in d.notes]
    angles = {
        d.method: d.conditions["alpha_deg"] for d in predictions if "alpha_deg" in d.conditions
    }
    if angles:
        conditions["alpha_deg"] = next(iter(angles.values()))
        if len({round(float(a), 1) for a in angles.values()}) > 1:
            said = ", ".join(f"{m} {a} deg" for m, a in angles.items())
            notes.append(f"predicted at different angles of attack: {said}")
    return Derivatives(" and ".join(methods), values, conditions, tuple(notes))


def added(method: str, parts: Sequence[Derivatives]) -> Derivatives:
    """Parts that add up, such as lattice and bodies; errors as of independent parts.

    The axes are the first one's.
    """
    parts = [along(d, parts[0].axes) for d in parts]
    names = dict.fromkeys(name for d in parts for name in d.values)
    values = {}
    for name in names:
        given = [d.values[name] for d in parts if name in d.values]
        values[name] = Estimate(
            sum(e.value for e in given),
            hypot(*(e.se for e in given)),
            " + ".join(e.source for e in given),
        )
    conditions = {k: v for d in reversed(parts) for k, v in d.conditions.items()}
    notes = tuple(n for d in parts for n in d.notes)
    return Derivatives(method, values, conditions, notes, parts[0].axes)


def as_flown(prediction: Derivatives) -> dict[str, Estimate]:
    """The derivatives as flight shows them: Cm_q + Cm_alphadot, Cn_r - Cn_betadot and so on.

    Keys are written that way where both parts are predicted, and are plain names elsewhere.
    """
    partners = {partner for partner, _ in PAIRS.values()}
    out = {}
    for name, e in prediction.values.items():
        if name in partners:
            continue
        partner, sign = PAIRS.get(name, ("", 1.0))
        other = prediction.values.get(partner)
        if other is None:
            out[name] = e
            continue
        key = f"{name} {'+' if sign > 0.0 else '-'} {partner}"
        # Both hang on the same tail lift: their errors are taken to go together.
        out[key] = Estimate(e.value + sign * other.value, e.se + other.se,
                            f"{e.source}; {other.source}")  # fmt: skip
    return out


def _one(name: str, predictions: Sequence[Derivatives], preferred: str | None) -> Estimate:
    given = [(d.method, d.values[name]) for d in predictions if name in d.values]
    least = FLOOR * SIZE.get(name, 0.0)
    se = [max(e.se, FLOOR * abs(e.value), least) for _, e in given]
    exact = min(se) <= 0.0  # a value that is zero by symmetry
    weights = [1.0 if exact else s**-2 for s in se]
    total = sum(weights)
    mean = sum(w * e.value for w, (_, e) in zip(weights, given, strict=True)) / total
    own = sum(w * s**2 for w, s in zip(weights, se, strict=True)) / total
    chosen = next((e.value for m, e in given if m == preferred), mean)
    spread = sum(w * (e.value - chosen) ** 2 for w, (_, e) in zip(weights, given, strict=True))
    said = "; ".join(f"{m} {e.value:.4g} +- {s:.2g}" for (m, e), s in zip(given, se, strict=True))
    how = f"{preferred} preferred" if preferred in dict(given) else "inverse-variance mean"
    source = f"{how} of {said}; se: own {sqrt(own):.2g}, between methods {sqrt(spread / total):.2g}"
    if len(given) == 1:
        source = f"{given[0][0]}, se at least {FLOOR:.0%}: {given[0][1].source}"
    return Estimate(chosen, sqrt(own + spread / total), source)


def _check(methods: Sequence[str], prefer: Mapping[str, str]) -> None:
    if not methods or len(set(methods)) < len(methods):
        raise refuse(
            "no_prediction",
            where="combining predictions",
            expected="at least one prediction, each by a method of its own",
            found=", ".join(methods) or "none",
            do="Predict with at least one method, and each method once.",
        )
    for name, method in prefer.items():
        if method not in methods:
            raise refuse(
                "unknown_method",
                where=f"combining predictions, preferred for {name}",
                expected=f"one of {', '.join(methods)}",
                found=f"'{method}'",
                do="Correct the method's name.",
            )
