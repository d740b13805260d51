"""Which parameters the data can hardly tell apart: a heat map per coefficient."""

from __future__ import annotations

import numpy as np

from alula.base.arrays import Array
from alula.identify.result import Identification
from alula.report.html import Html, join, table, tag
from alula.report.numbers import number
from alula.report.pictures import heat_map

_MOST = 60  # parameters of a map that can still be read
_STRONG = 0.9  # usual limit above which two estimates should not be read one by one


def correlation(result: Identification) -> Html:
    """Heat maps, and a table of the pairs above 0.9."""
    r = np.clip(result.correlations, -1.0, 1.0)
    names = [p.name for p in result.parameters]
    owners = np.array([p.coefficient for p in result.parameters])
    maps = []
    large: list[str] = []
    for name in dict.fromkeys(owners.tolist()):
        index = np.flatnonzero(owners == name)
        if not 2 <= len(index) <= _MOST:
            large += [str(name)] if len(index) > _MOST else []
            continue
        block = r[np.ix_(index, index)]
        title = f"Correlation of the parameters of {name}"
        picture = heat_map([names[k] for k in index], block, title)
        caption = tag("figcaption", tag("strong", name))
        maps.append(tag("figure", caption, tag("div", picture, class_="wide"), class_="keep"))
    return join(
        [
            tag(
                "p",
                "Correlation of the estimates, from −1 to 1. Near ±1 the data determine a "
                "combination of the two better than either. Empty: not identifiable.",
            ),
            tag("div", *maps, class_="maps"),
            tag(
                "p",
                f"No map of {', '.join(large)}: over {_MOST} parameters. The pairs below are of "
                "all.",
            )
            if large
            else "",
            _pairs(names, r),
            _across(owners, names, r),
        ]
    )


def _pairs(names: list[str], r: Array) -> Html:
    i, j = np.nonzero(np.tril(np.abs(np.nan_to_num(r)) >= _STRONG, -1))
    if not len(i):
        return tag("p", f"No two parameters are correlated above {_STRONG}.")
    order = np.argsort(-np.abs(r[i, j]))
    return table(
        f"Pairs correlated above {_STRONG}: read them together, not one by one.",
        ["First", "Second", "Correlation"],
        (
            [tag("code", names[i[k]]), tag("code", names[j[k]]), number(float(r[i[k], j[k]]), 4)]
            for k in order
        ),
        numeric=(2,),
    )


def _across(
    owners: np.ndarray[tuple[int, ...], np.dtype[np.str_]], names: list[str], r: Array
) -> Html:
    """One sentence on what the maps do not show: correlation between different coefficients."""
    apart = np.where(owners[:, None] != owners[None, :], np.abs(np.nan_to_num(r)), 0.0)
    if apart.size == 0 or apart.max() < 0.05:
        return Html("")
    i, j = np.unravel_index(int(apart.argmax()), apart.shape)
    return tag(
        "p",
        "Between parameters of different coefficients the largest is ",
        f"{number(float(r[i, j]), 2)} (",
        tag("code", names[i]),
        ", ",
        tag("code", names[j]),
        ").",
    )
