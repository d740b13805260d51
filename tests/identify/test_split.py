"""Which maneuvers are held out where the project leaves it open."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from alula.flight import Maneuver
from alula.identify.split import hold_out


def flown(aspect: str, count: int, kinds: tuple[str, ...] = ("3211",)) -> list[Maneuver]:
    return [
        Maneuver(f"{aspect}{i}", "log", kinds[i % len(kinds)], 100.0 * i, 100.0 * i + 20.0, aspect)
        for i in range(count)
    ]


def speeds(maneuvers: list[Maneuver]) -> dict[str, tuple[float, float]]:
    return {m.id: (30.0 + 3.0 * i, 1000.0) for i, m in enumerate(maneuvers)}


def test_a_fifth_of_each_aspect() -> None:
    long, lateral = flown("longitudinal", 10), flown("lateral", 15)
    lateral = [replace(m, log="other") for m in lateral]
    chosen = hold_out([*long, *lateral], speeds(long) | speeds(lateral))
    found = Counter(id.rstrip("0123456789") for id in chosen)
    assert found == {"longitudinal": 2, "lateral": 3}


def test_few_maneuvers_are_all_kept() -> None:
    four = flown("lateral", 4)
    assert hold_out(four, speeds(four)) == ()
    assert len(hold_out([*four, *flown("lateral", 5)[4:]], speeds(flown("lateral", 5)))) == 1


def test_the_projects_own_choice_stands() -> None:
    ten = flown("lateral", 10)
    ten[3] = replace(ten[3], held_out=True)
    assert hold_out(ten, speeds(ten)) == ()
    assert hold_out(flown("lateral", 10), {}, share=0.0) == ()


def test_repeatable_and_by_seed() -> None:
    ten = flown("longitudinal", 10)
    drawn = {hold_out(ten, speeds(ten), seed=s) for s in range(20)}
    assert len(drawn) > 5
    assert all(
        hold_out(ten, speeds(ten), seed=3) == hold_out(ten, speeds(ten), seed=3) for _ in "ab"
    )
    more = [*ten, *(replace(m, log="other") for m in flown("lateral", 7))]
    kept = [id for id in hold_out(more, speeds(more), seed=3) if id.startswith("long")]
    assert tuple(kept) == hold_out(ten, speeds(ten), seed=3)  # others do not change the draw


def test_one_of_each_part_of_the_envelope() -> None:
    """With ten speeds and two drawn, one is of the slower half, one of the faster."""
    ten = flown("longitudinal", 10)
    for seed in range(20):
        low, high = (int(id[-1]) for id in hold_out(ten, speeds(ten), seed=seed))
        assert low < 5 <= high


def test_a_kind_flown_once_stays_in_the_estimate() -> None:
    ten = flown("longitudinal", 10)
    ten[9] = replace(ten[9], kind="sweep")
    for seed in range(30):
        assert "longitudinal9" not in hold_out(ten, speeds(ten), seed=seed)


def test_maneuvers_that_share_samples_are_not_parted() -> None:
    five = flown("longitudinal", 5)
    five[1] = replace(five[1], start=10.0)  # overlaps the one before
    for seed in range(30):
        assert not {"longitudinal0", "longitudinal1"} & set(hold_out(five, {}, seed=seed))
