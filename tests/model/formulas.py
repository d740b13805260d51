"""Random models for property tests."""

from __future__ import annotations

from hypothesis import strategies as st

from alula.model import AXES, VARIABLES, AeroModel, Factor, Reference, aero_model
from alula.model.terms import product

factors = st.builds(
    Factor,
    st.sampled_from(VARIABLES),
    st.integers(1, 3),
    st.sampled_from(["plain", "abs"]),
) | st.builds(
    Factor,
    st.sampled_from(VARIABLES),
    st.integers(1, 3),
    st.just("ramp"),
    st.floats(-0.5, 0.5).map(lambda x: round(x, 3) + 0.0),
)
# At most 8 products of at most 2 cubes: below the 64 steps that the table holds.
terms = st.lists(st.lists(factors, max_size=2).map(product), min_size=1, max_size=3, unique=True)


@st.composite
def models(draw: st.DrawFn) -> AeroModel:
    axes = draw(st.sampled_from(["body", "stability"]))
    chosen = draw(st.lists(st.sampled_from(AXES[axes]), min_size=1, max_size=3, unique=True))
    formulas, values = {}, {}
    for coefficient in chosen:
        own = draw(terms)
        formulas[coefficient] = " + ".join(t.formula for t in own)
        for t in own:
            values[t.name(coefficient)] = draw(st.floats(-30.0, 30.0))
    return aero_model("random", formulas, values, Reference(10.6, 8.65, 1.25), axes=axes)
