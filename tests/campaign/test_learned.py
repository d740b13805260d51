"""What a model saw is told by the hashes and windows that it carries."""

from __future__ import annotations

import numpy as np
import pytest

from alula.campaign.learned import LEARNED, learned_from, seen_by
from alula.flight import Flight, Maneuver, SourceFile
from alula.identify import CoefficientData
from alula.model import AeroModel, Reference, aero_model

HASH, OTHER = "ab" * 32, "cd" * 32


def flight(sha: str) -> Flight:
    return Flight("log", {}, (SourceFile("/a/log.csv", sha, 3, 3, 0, 0),))


def model(**provenance: str) -> AeroModel:
    values = {"Cm_0": 0.0}
    return aero_model("m", {"Cm": "1"}, values, Reference(1, 1, 1), provenance=provenance)


def maneuver(start: float, end: float) -> Maneuver:
    return Maneuver("m-1.2 b", "log", "", start, end)


def learned(start: float, end: float) -> str:
    item = CoefficientData(maneuver(start, end), np.zeros(2), {}, {})
    return learned_from([item], {"log": flight(HASH)})


@pytest.mark.parametrize(
    ("start", "end", "seen"),
    [
        (0.0, 10.0, "no"),
        (0.0, 10.1, "yes"),
        (12.0, 13.0, "yes"),
        (19.9, 30.0, "yes"),
        (20.0, 30.0, "no"),
    ],
)
def test_windows_that_overlap_were_seen(start: float, end: float, seen: str) -> None:
    made = model(**{LEARNED: learned(10.0, 20.0), "/a/log.csv": HASH})
    assert seen_by(made, maneuver(start, end), flight(HASH)) == seen
    assert seen_by(made, maneuver(start, end), flight(OTHER)) == "no"


def test_every_digit_of_a_window_counts() -> None:
    made = model(**{LEARNED: learned(1e-7, 53554.500000001)})
    assert seen_by(made, maneuver(53554.5, 53560.0), flight(HASH)) == "yes"
    assert seen_by(made, maneuver(53554.500000001, 53560.0), flight(HASH)) == "no"


def test_hashes_without_windows_count_as_seen_and_neither_as_unknown() -> None:
    assert seen_by(model(**{"/a/log.csv": HASH}), maneuver(0, 1), flight(HASH)) == "yes"
    assert seen_by(model(**{"/a/log.csv": HASH}), maneuver(0, 1), flight(OTHER)) == "no"
    assert seen_by(model(method="book"), maneuver(0, 1), flight(HASH)) == "unknown"
