"""Which maneuvers to hold out of the estimate, where the project leaves the choice open.

A model is judged on maneuvers that it never saw. Of each aspect with maneuvers enough a share is
set aside, drawn at random but stratified: the maneuvers are put in order of kind, airspeed and
height and cut into as many strata as are to be held out, and one is drawn of each. So the held-out
ones span the conditions flown, and the same seed holds out the same ones.
"""

from __future__ import annotations

import zlib
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from alula.flight import Maneuver

SHARE = 0.2
LEAST = 5  # maneuvers of an aspect, below which none can be spared
V_BIN = 0.1  # of the logarithm of airspeed: within it height decides the order


def hold_out(
    maneuvers: Sequence[Maneuver],
    conditions: Mapping[str, tuple[float, float]],
    *,
    share: float = SHARE,
    least: int = LEAST,
    seed: int = 0,
) -> tuple[str, ...]:
    """Ids of the maneuvers to hold out, in the order given; none where any is marked already.

    conditions: airspeed m/s and height m by id. share: of the maneuvers of each aspect
    (longitudinal, lateral, both), rounded, at least one. Aspects with fewer than `least` keep all.
    A maneuver that shares samples with another is not chosen, and of each kind one at least stays
    in the estimate.
    """
    if share <= 0.0 or any(m.held_out for m in maneuvers):
        return ()
    chosen: set[str] = set()
    for aspect in dict.fromkeys(m.aspect for m in maneuvers):
        group = [m for m in maneuvers if m.aspect == aspect]
        if len(group) < least:
            continue
        count = min(max(1, round(share * len(group))), len(group) - 1)
        # a seed of each aspect's own: more lateral maneuvers must not change the longitudinal ones
        rng = np.random.default_rng([seed, zlib.crc32(aspect.encode())])
        group.sort(key=lambda m: _order(m, conditions))
        kinds = Counter(m.kind for m in group)
        for stratum in np.array_split(np.arange(len(group)), count):
            free = [
                i
                for i in stratum.tolist()
                if kinds[group[i].kind] > 1 and not _shares(group[i], maneuvers)
            ]
            if free:
                found = group[free[int(rng.integers(len(free)))]]
                kinds[found.kind] -= 1
                chosen.add(found.id)
    return tuple(m.id for m in maneuvers if m.id in chosen)


def _order(
    m: Maneuver, conditions: Mapping[str, tuple[float, float]]
) -> tuple[str, int, float, str]:
    V, h = conditions.get(m.id, (0.0, 0.0))
    return m.kind, round(float(np.log(V)) / V_BIN) if V > 0.0 else 0, h, m.id


def _shares(m: Maneuver, others: Sequence[Maneuver]) -> bool:
    """Whether another maneuver holds some of the same samples."""
    return any(
        o.id != m.id and o.log == m.log and o.start < m.end and m.start < o.end for o in others
    )
