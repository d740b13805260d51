"""Each tolerance of the regulation: met just inside, not met just outside, else not judged.

14 CFR Part 60 (1-1-14 edition), Table A2A, 2.c.9 to 2.d.7.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from alula.base.arrays import Array
from alula.flight import Maneuver
from alula.simulate import doublet
from alula.validate import ChannelMatch, Evidence, Flown, judge, quality, tolerances
from alula.validate.flown import AXIS, UNITS

DEG = np.pi / 180.0
G = 9.80665
T = np.arange(0.0, 30.0, 0.02)
START, END = 2.0, 4.0  # of the input
IN = (T >= START) & (T <= END + 5.0)  # judged
PULSE = np.where((T > 5.0) & (T < 5.5), 1.0, 0.0)


def flown(kind: str, control: str, measured: dict[str, Array], model: dict[str, Array]) -> Flown:
    """A flight in which the given channels differ; all others agree."""
    aspect = "longitudinal" if control == "de" else "lateral"
    base = np.sin(T) * 5.0 * DEG
    channels = {}
    for name, unit in UNITS.items():
        z = measured.get(name, base)
        y = model.get(name, z)
        channels[name] = ChannelMatch(
            name, unit, z, y, None, quality(z, y), in_axis=name in AXIS[aspect]
        )
    return Flown(
        maneuver=Maneuver("m", "log", kind, 0.0, 30.0, aspect),
        seen="no",
        t=T,
        channels=channels,
        controls={control: doublet(3.0 * DEG, START, 1.0).value(T)},
        asked=30.0,
    )


def rows(flight: Flown, entry: str) -> list[Evidence]:
    return [row for row in judge(flight) if row.entry == entry]


Z = np.sin(T) * 5.0 * DEG


@pytest.mark.parametrize(("share", "verdict"), [(0.99, "pass"), (1.01, "fail")])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_short_period_normal_acceleration(share: float, verdict: str, sign: float) -> None:
    off = sign * share * 0.10 * G * PULSE
    flight = flown("3211", "de", {"az": -G + Z}, {"az": -G + Z + off})
    pitch, normal = rows(flight, "2.c.10")
    assert (pitch.verdict, normal.verdict) == ("pass", verdict)
    (c,) = normal.criteria
    assert c.unit == "g"
    assert c.deviation == pytest.approx(-sign * share * 0.10)  # up is positive in g
    assert c.tolerance == 0.10


@pytest.mark.parametrize(
    ("angle", "rate", "verdict"),
    [(0.99, 9.0, "pass"), (9.0, 0.99, "pass"), (1.01, 1.01, "fail"), (0.99, 0.99, "pass")],
)
def test_short_period_pitch_angle_or_rate(angle: float, rate: float, verdict: str) -> None:
    model = {"theta": Z + angle * 1.5 * DEG * PULSE, "q": Z + rate * 2.0 * DEG * PULSE}
    pitch, normal = rows(flown("3211", "de", {}, model), "2.c.10")
    assert (pitch.verdict, normal.verdict) == (verdict, "pass")
    assert [c.met for c in pitch.criteria] == [angle < 1.0, rate < 1.0]
    assert pitch.window == pytest.approx((START, END + 5.0), abs=0.021)


def test_only_the_response_is_judged() -> None:
    """What lies before the input, or more than 5 s behind it, belongs to other tests."""
    off = 20.0 * DEG * ~IN
    assert {
        e.verdict for e in judge(flown("3211", "de", {}, {"theta": Z + off, "q": Z + off}))
    } == {"pass"}


@pytest.mark.parametrize(
    ("control", "channel", "entry"), [("da", "p", "2.d.2"), ("dr", "r", "2.d.6")]
)
@pytest.mark.parametrize(
    ("measured", "off", "verdict"),
    [(5.0, 1.99, "pass"), (5.0, 2.01, "fail"), (40.0, 3.9, "pass"), (40.0, 4.1, "fail")],
)
def test_rates_within_two_degrees_or_ten_percent(
    control: str, channel: str, entry: str, measured: float, off: float, verdict: str
) -> None:
    z = measured * DEG * PULSE
    flight = flown("doublet", control, {channel: z}, {channel: z + off * DEG * PULSE})
    (row,) = rows(flight, entry)
    assert row.verdict == verdict
    (c,) = row.criteria
    assert c.tolerance == pytest.approx(max(2.0, 0.1 * measured))
    if verdict == "fail":
        outside = float(PULSE.sum()) / float(IN.sum())
        assert c.within_share == pytest.approx(1.0 - outside, abs=0.005)
    half = tolerances(flight)[channel]
    assert np.isfinite(half).sum() == pytest.approx(IN.sum(), abs=2)
    assert np.nanmax(half) == pytest.approx(max(2.0, 0.1 * measured) * DEG)


def wave(period: float, damping: float, lag: float = 0.0, end: float = END) -> Array:
    w = 2.0 * np.pi / period
    s = w * damping / np.sqrt(1.0 - damping**2)
    x = np.maximum(T - end, 0.0)
    return np.asarray(4.0 * DEG * np.exp(-s * x) * np.cos(w * (T - end - lag)))


def dutch_roll(period: float, damping: float, lag: float = 0.6) -> dict[str, Array]:
    a = wave(period, damping)
    return {
        "phi": a, "p": np.gradient(a, T), "r": 0.5 * wave(period, damping, 0.9),
        "beta": wave(period, damping, lag),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("measured", "model", "verdicts"),
    [
        ((3.0, 0.10), (3.45, 0.11), ("pass", "pass")),  # 0.5 s goes before 10 %
        ((3.0, 0.10), (3.55, 0.11), ("fail", "pass")),
        ((8.0, 0.05), (8.75, 0.06), ("pass", "pass")),  # 10 % goes before 0.5 s
        ((8.0, 0.05), (8.90, 0.06), ("fail", "pass")),
        ((3.0, 0.10), (3.0, 0.119), ("pass", "pass")),
        ((3.0, 0.10), (3.0, 0.125), ("pass", "fail")),
        ((3.0, 0.30), (3.0, 0.325), ("pass", "pass")),  # the time to half is within 10 %
        ((3.0, 0.02), (3.0, -0.015), ("pass", "fail")),
    ],
)
def test_dutch_roll_period_and_damping(measured, model, verdicts) -> None:
    flight = flown("doublet", "dr", dutch_roll(*measured), dutch_roll(*model))
    period, damping, _ = rows(flight, "2.d.7")
    assert (period.verdict, damping.verdict) == verdicts
    (c,) = period.criteria
    assert c.measured == pytest.approx(measured[0], rel=0.01)
    assert damping.criteria[0].model == pytest.approx(model[1], abs=0.002)


@pytest.mark.parametrize(("lag", "verdict"), [(1.55, "pass"), (1.65, "fail")])
def test_time_between_peaks_of_bank_and_sideslip(lag: float, verdict: str) -> None:
    flight = flown("doublet", "dr", dutch_roll(6.0, 0.05), dutch_roll(6.0, 0.05, lag))
    *_, peaks = rows(flight, "2.d.7")
    assert peaks.verdict == verdict
    assert peaks.criteria[0].deviation == pytest.approx(lag - 0.6, abs=0.01)


@pytest.mark.parametrize(("period", "verdict"), [(9.8, "pass"), (10.2, "fail")])
def test_phugoid_period(period: float, verdict: str) -> None:
    def of(p: float) -> dict[str, Array]:
        return {"V": 50.0 + 100.0 * wave(p, 0.04), "theta": wave(p, 0.04, 1.0)}

    flight = flown("phugoid", "de", of(9.0), of(period))
    period_row, damping = rows(flight, "2.c.9")
    assert (period_row.verdict, damping.verdict) == (verdict, "pass")


def test_too_few_cycles_are_not_judged() -> None:
    flight = flown("doublet", "dr", dutch_roll(3.0, 0.75), dutch_roll(3.0, 0.4))
    assert {row.verdict for row in rows(flight, "2.d.7")} == {"not_judged"}
    assert "visible cycles" in rows(flight, "2.d.7")[0].reason


def test_noise_that_hides_the_damping_is_not_judged() -> None:
    random = np.random.default_rng(2)
    gusts = np.ones(50) / np.sqrt(50.0)  # correlated over 1 s, 0.4 deg
    noisy = {
        n: z + 0.4 * DEG * np.convolve(random.standard_normal(len(T)), gusts, "same")
        for n, z in dutch_roll(6.0, 0.2).items()
    }
    _, damping, _ = rows(flown("doublet", "dr", noisy, dutch_roll(6.0, 0.21)), "2.d.7")
    assert damping.verdict == "not_judged"
    assert "standard error" in damping.reason
    assert all(c.met is None for c in damping.criteria)
    # but a model that is far off is, however noisy the measurement
    period, *_ = rows(flown("doublet", "dr", noisy, dutch_roll(9.0, 0.2)), "2.d.7")
    assert period.verdict == "fail"


def test_what_does_not_oscillate() -> None:
    random = np.random.default_rng(3)
    noise = {n: DEG * random.standard_normal(len(T)) for n in ("phi", "p", "r", "beta")}
    flight = flown("doublet", "dr", noise, dutch_roll(3.0, 0.1))
    assert {row.verdict for row in rows(flight, "2.d.7")} == {"not_judged"}
    still = {n: np.zeros(len(T)) for n in noise}
    flight = flown("doublet", "dr", dutch_roll(3.0, 0.1), still)
    assert {row.verdict for row in rows(flight, "2.d.7")} == {"fail"}


@pytest.mark.parametrize(
    ("kind", "control", "entries"),
    [
        ("3211", "de", {"2.c.10"}),
        ("short period", "de", {"2.c.10"}),
        ("Phugoid", "de", {"2.c.9"}),
        ("bank_to_bank", "da", {"2.d.2"}),
        ("aileron_step", "da", {"2.d.2"}),
        ("dutch-roll", "dr", {"2.d.7"}),
        ("doublet", "dr", {"2.d.6", "2.d.7"}),
        ("rudder_response", "dr", {"2.d.6"}),
        ("spiral", "da", set()),
    ],
)
def test_tests_follow_from_kind_or_control(kind: str, control: str, entries: set[str]) -> None:
    assert {row.entry for row in judge(flown(kind, control, {}, {}))} == entries


def test_a_flight_that_ended_before_the_response_fails() -> None:
    whole = flown("3211", "de", {}, {})
    short = slice(0, 120)  # 2.4 s
    cut = replace(
        whole,
        t=T[short],
        channels={
            n: replace(c, measured=c.measured[short], model=c.model[short])
            for n, c in whole.channels.items()
        },
        controls={n: u[short] for n, u in whole.controls.items()},
        diverged_at=2.4,
    )
    assert {row.verdict for row in judge(cut)} == {"fail"}
    assert all("2.4 s" in row.reason for row in judge(cut))
