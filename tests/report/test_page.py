"""The page as text: complete, closed to the outside, the same each time, honest."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from alula.base.messages import note, refuse, warn
from alula.report import render
from report.example import MANEUVERS, example

LIMIT = 3_000_000  # bytes: what still goes through mail
HOSTILE = ("<img src=x onerror=alert(1)>", "</script><script>alert(1)</script>", '"\u2028\u202e]]>')


@pytest.fixture(scope="module")
def text() -> str:
    return render(example())


def scripts(text: str) -> list[str]:
    return re.findall(r"<script>(.*?)</script>", text, re.S)


def test_same_input_gives_the_same_bytes(text: str) -> None:
    assert render(example()) == text


def test_policy_allows_exactly_the_scripts_and_style_inside(text: str) -> None:
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy is not None
    inside = scripts(text) + re.findall(r"<style>(.*?)</style>", text, re.S)
    wanted = {base64.b64encode(hashlib.sha256(s.encode()).digest()).decode() for s in inside}
    assert set(re.findall(r"sha256-([^&']+)", policy[1])) == wanted
    assert "default-src &#x27;none&#x27;" in policy[1]
    assert "unsafe" not in policy[1]


def test_nothing_is_asked_from_outside(text: str) -> None:
    assert not re.search(r'(?:src|href)="(?!#)', text)
    assert not re.search(r"@import|url\(", text)
    assert " style=" not in text, "the policy forbids style attributes"


@pytest.mark.parametrize("rate", [25.0, 100.0, 1000.0])
def test_size_stays_under_the_limit(rate: float) -> None:
    assert len(render(example(rate)).encode()) < LIMIT


def test_size_stays_under_the_limit_with_many_maneuvers() -> None:
    report = example()
    assert report.reconstruction is not None
    many = replace(report.reconstruction, segments=report.reconstruction.segments * 8)
    assert len(render(replace(report, reconstruction=many)).encode()) < LIMIT


def test_a_sensor_without_samples_is_named() -> None:
    report = example()
    assert report.reconstruction is not None
    first = report.reconstruction.segments[0]
    none = np.empty(0)
    sensor = replace(
        first.sensors[0], t=none, measured=none, fitted=none, innovation=none, innovation_se=none,
        whiteness=np.nan,
    )  # fmt: skip
    segments = (replace(first, sensors=(sensor,)),)
    text = render(replace(report, reconstruction=replace(report.reconstruction, segments=segments)))
    assert "V, true airspeed: no sample, nothing to draw." in text


def test_all_samples_are_carried_where_they_fit(text: str) -> None:
    assert "hown thinned" not in text
    data = json.loads(re.search(r'id="alula-plots">(.*?)</script>', text, re.S)[1])  # type: ignore[index]
    assert {f["t"]["n"] for f in data["figures"]} == {626}  # 25 s at 25 Hz, both ends


def test_fewer_points_than_samples_are_announced_at_every_such_plot() -> None:
    text = render(example(1000.0))
    assert text.count("of 25001 samples") == text.count("data-plot=") > 0
    assert text.count("Shown thinned: ") > text.count("data-plot=")  # and how, once for each part


@pytest.mark.parametrize("name", HOSTILE)
def test_text_of_a_log_stays_text(name: str) -> None:
    report = example()
    assert report.reconstruction is not None
    assert report.identification is not None
    maneuver = replace(MANEUVERS[0], id=name, kind=name, log=name, configuration={name: name})
    segment = report.reconstruction.segments[0]
    sensor = replace(segment.sensors[0], name=name, unit=name)
    segment = replace(
        segment,
        maneuver=maneuver,
        motion=replace(segment.motion, maneuver=maneuver, controls={name: segment.motion.V}),
        sensors=(sensor,),
        state_names=(name, *segment.state_names[1:]),
        mismatch={name: 1.0},
    )
    parameter = replace(report.identification.parameters[0], name=name, coefficient=name, unit=name)
    fit = replace(next(iter(report.identification.fits.values())), coefficient=name, formula=name)
    series = replace(report.identification.series[0], coefficient=name, maneuver=name)
    channel = replace(report.cards[0].channels[0], name=name, source=name, unit=name)
    file = replace(report.cards[0].files[0], path=name)
    hostile = replace(
        report,
        name=name,
        path=name,
        date=name,
        aircraft={name: name},
        cards=(replace(report.cards[0], log=name, channels=(channel,), files=(file,)),),
        maneuvers=(maneuver,),
        reconstruction=replace(report.reconstruction, segments=(segment,), status=name),
        identification=replace(
            report.identification,
            parameters=(parameter, *report.identification.parameters[1:]),
            fits={name: fit},
            series=(series,),
            status=name,
        ),
        messages=(warn(name, where=name, expected=name, found=name, do=name),),
        provenance={name: {name: name}},
    )
    text = render(hostile)
    assert name not in text
    assert "<img" not in text
    assert len(scripts(text)) == len(scripts(render(report)))
    assert "\u2028" not in text
    assert "\u202e" not in text


def test_a_broken_encoding_does_not_stop_the_report() -> None:
    render(example(name="log \udcff\x00 one")).encode()


def test_held_out_maneuvers_are_labelled(text: str) -> None:
    held = re.findall(r"<figcaption><strong>([^<]*)</strong> <span class=\"tag\">([^<]*)", text)
    assert held == [(f"{c} · rudder", "held out: not used in the fit") for c in ("CY", "Cl")]
    assert "no maneuver was held out: <code>CZ</code>, <code>Cm</code>." in text


def test_what_is_not_identifiable_shows_no_value_and_its_combination(text: str) -> None:
    row = re.search(r"<tr><th scope=\"row\"><code>Cm_qhat</code>.*?</tr>", text)
    assert row is not None
    assert "not identifiable" in row[0]
    assert "Cm_qhat + 2.1 Cm_alphadot" in row[0]
    assert "±" not in row[0]
    assert "nan" not in row[0].lower()


def test_verdict_follows_the_worst_finding() -> None:
    def verdict(text: str) -> str:
        found = re.search(r'class="verdict-box (\w+)"', text)
        assert found is not None
        return found[1]

    report = example()
    assert report.identification is not None
    assert report.reconstruction is not None
    assert verdict(render(report)) == "bad"
    good = [replace(p, verdict="ok") for p in report.identification.parameters]
    fine = replace(report, identification=replace(report.identification, parameters=tuple(good)))
    assert verdict(render(fine)) == "good"
    good[2] = replace(good[2], verdict="weak")
    weak = replace(report, identification=replace(report.identification, parameters=tuple(good)))
    assert verdict(render(weak)) == "caution"
    # A symmetric airplane has trim constants that are zero: no fault of the data.
    named = next(p for p in good if p.name.endswith("_0"))
    zero = replace(named, verdict="weak", value=0.0, ci95=(-1e-4, 1e-4))
    trim = [zero if p is named else replace(p, verdict="ok") for p in good]
    flown = replace(report, identification=replace(report.identification, parameters=tuple(trim)))
    assert verdict(render(flown)) == "good"
    assert "zero within their error: 1 trim constant" in render(flown)
    failed = replace(fine, reconstruction=replace(report.reconstruction, converged=False))
    assert verdict(render(failed)) == "bad"
    error = refuse("x", where="x", expected="x", found="x", do="x").messages
    assert verdict(render(replace(fine, messages=error))) == "bad"


def test_angles_are_in_degrees_and_derivatives_per_radian(text: str) -> None:
    assert "−0.246 ± 0.018" in text  # b_alpha, -0.0043 ± 0.00031 rad
    assert re.search(r"<code>Cm_alpha</code>.*?−0.950 ± 0.020.*?1/rad", text)
    before, _, _ = text.partition('id="messages"')  # a message may speak of the log's own unit
    assert ">rad<" not in before


def test_stages_that_were_not_run_are_left_out() -> None:
    text = render(example(reconstruction=None, identification=None, cards=(), maneuvers=()))
    assert 'id="provenance"' in text
    assert 'id="parameters"' not in text
    assert "No model was identified" in text


def test_a_method_without_innovations_shows_residuals() -> None:
    report = example()
    assert report.reconstruction is not None
    segment = report.reconstruction.segments[0]
    nothing = np.full(len(segment.motion.t), np.nan)
    sensors = tuple(
        replace(s, innovation=nothing, innovation_se=nothing, whiteness=np.nan)
        for s in segment.sensors
    )
    changed = replace(
        report.reconstruction,
        method="ml",
        segments=(replace(segment, sensors=sensors),),
        nis_mean=np.nan,
        nis_interval=(np.nan, np.nan),
    )
    text = render(replace(report, reconstruction=changed))
    assert "This method has no innovations" in text
    assert "measured − fitted (m/s)" in text
    assert "innovation (m/s)" not in text
    assert "NaN" not in re.sub(r"<script.*?</script>", "", text, flags=re.S)


def test_a_reconstruction_alone_has_its_own_verdict() -> None:
    report = example()
    assert report.identification is not None
    nothing = replace(
        report.identification, parameters=(), fits={}, series=(), covariance=np.zeros((0, 0))
    )
    text = render(replace(report, identification=nothing))
    assert "All 0 parameters" not in text
    assert "these constants are not observable: k_beta" in text
    assert 'id="reconstruction"' in text
    for gone in ("parameters", "coefficients", "correlation"):
        assert f'id="{gone}"' not in text


def test_innovations_are_scaled_to_their_usual_band() -> None:
    """A filter's first samples, with the band of the initial covariance, flatten nothing."""
    report = example()
    assert report.reconstruction is not None
    segment = report.reconstruction.segments[0]
    n = len(segment.sensors[0].t)
    first = np.arange(n) < 4
    wave = np.sin(np.arange(n))
    sensor = replace(
        segment.sensors[0],  # airspeed, m/s: not converted
        innovation=np.where(first, -30.0, 0.3 * wave),
        innovation_se=np.where(first, 20.0, 0.25),
    )
    segments = (replace(segment, sensors=(sensor,)),)
    text = render(replace(report, reconstruction=replace(report.reconstruction, segments=segments)))
    data = json.loads(re.search(r'id="alula-plots">(.*?)</script>', text, re.S)[1])  # type: ignore[index]
    (limit,) = [p["limit"] for f in data["figures"] for p in f["panels"] if "limit" in p]
    assert limit == 1.0  # four times the median standard deviation of 0.25
    assert "4 of 626 innovations beyond this axis" in text
    assert "−30.0\u00a0m/s at 0\u00a0s" in text


def test_motion_as_recorded_is_not_called_a_reconstruction() -> None:
    report = example()
    assert report.reconstruction is not None
    nothing = np.empty((626, 0))
    segment = replace(
        report.reconstruction.segments[0],
        state_names=(), states=nothing, states_se=nothing, sensors=(), mismatch={},
    )  # fmt: skip
    changed = replace(
        report.reconstruction, method="none", segments=(segment,), constants=(),
        nis_mean=np.nan, nis_interval=(np.nan, np.nan), status="motion as recorded",
    )  # fmt: skip
    text = render(replace(report, reconstruction=changed))
    assert "<h2>Motion as recorded</h2>" in text
    assert "Motion at the center of gravity" in text
    for empty in ("States with their", "Sensors: measured", "no innovations", "No constants"):
        assert empty not in text


def test_constants_of_each_maneuver_share_a_row() -> None:
    report = example()
    assert report.reconstruction is not None
    first = report.reconstruction.constants[0]
    both = (
        replace(first, name="b_ax[elevator]"),
        replace(first, name="b_ax[rudder]", value=0.5, se=0.1, observable=False),
    )
    changed = replace(report.reconstruction, constants=both, constants_cov=np.eye(2))
    text = render(replace(report, reconstruction=changed))
    (row,) = re.findall(r'<tr><th scope="row"><code>b_ax</code>.*?</tr>', text)
    assert "0.0312 ± 0.0011" in row
    assert re.search(r"0\.50 ± 0\.10.*not observable", row)
    assert row.count("not observable") == 1
    assert "<code>elevator</code></th>" in text


def test_constant_states_are_told_by_the_table_and_not_drawn() -> None:
    report = example()
    assert report.reconstruction is not None
    segment = report.reconstruction.segments[0]
    n = len(segment.motion.t)
    added = replace(
        segment,
        state_names=(*segment.state_names, "b_ax", "b_q"),
        states=np.column_stack([segment.states, np.full(n, 0.03), np.linspace(0, 1e-3, n)]),
        states_se=np.column_stack([segment.states_se, np.full(n, 0.001), np.full(n, 1e-4)]),
    )
    changed = replace(report.reconstruction, segments=(added,))
    text = render(replace(report, reconstruction=changed))
    assert "<code>b_ax</code>: one value throughout" in text
    assert "<strong>b_q, bias of pitch rate</strong>" in text  # a walking bias is drawn
    assert "<strong>b_ax, " not in text


def test_many_notes_of_one_kind_fold_and_each_is_there() -> None:
    report = example()
    notes = tuple(
        note(
            "converted", where=f"/data/flights/one.csv: channel c{k}", expected="as recorded",
            found=f"column {k} in deg", do="It is now in rad.",
        )
        for k in range(45)
    )  # fmt: skip
    bad = tuple(
        warn("odd", where=f"channel w{k}", expected="x", found="y", do="z") for k in range(5)
    )
    text = render(replace(report, messages=(*notes, *bad)))
    after = text.partition('id="messages"')[2].partition('id="provenance"')[0]
    (folded,) = re.findall(r"<details><summary>(?:(?!</details>).)*channel c0.*?</details>", after)
    assert all(f"column {k} in deg" in folded for k in range(45))
    assert after.count("<code>converted</code>") == 1
    assert after.count("<code>odd</code>") == 5, "warnings stay one by one"
    assert after.index("channel w4") < after.index("channel c0"), "and come first"
    assert ">one.csv: channel c7<" in folded
    assert 'title="/data/flights/one.csv: channel c7"' in folded


def test_long_paths_and_hashes_are_short_in_sight_and_whole_in_provenance() -> None:
    report = example()
    path, digest = "/home/someone/campaign 3/fAttasElv1.mat", "0123456789abcdef" * 4
    file = replace(report.cards[0].files[0], path=path, sha256=digest)
    cards = (replace(report.cards[0], files=(file,)),)
    text = render(replace(report, cards=cards, path="/home/someone/attas.toml"))
    before, _, provenance = text.partition('id="provenance"')
    assert f'<code title="{path}">fAttasElv1.mat</code>' in before
    assert f'<code title="{digest}">0123456789ab…</code>' in before
    assert '<code title="/home/someone/attas.toml">attas.toml</code>' in before
    assert path in provenance
    assert digest in provenance


def test_truth_stands_beside_the_estimate() -> None:
    report = example()
    assert report.identification is not None
    first, *rest = report.identification.parameters
    known = replace(first, truth=1.2345)
    text = render(
        replace(report, identification=replace(report.identification, parameters=(known, *rest)))
    )
    row = re.search(rf"<tr><th scope=\"row\"><code>{re.escape(first.name)}</code>.*?</tr>", text)
    assert row is not None
    assert ">1.234<" in row[0] or ">1.235<" in row[0]
    assert 'class="truth"' in row[0]


def test_every_message_is_there_once(text: str) -> None:
    for message in example().all_messages():
        assert text.count(f"<code>{message.code}</code>") == 1


def test_tables_have_captions_and_headings_do_not_jump(text: str) -> None:
    assert text.count("<table") == text.count("<caption")
    levels = [int(n) for n in re.findall(r"<h([1-6])", text)]
    assert levels[0] == 1
    assert all(b <= a + 1 for a, b in pairwise(levels))


def _luminance(color: str) -> float:
    """Relative luminance by WCAG 2.1."""
    code = color.lstrip("#")
    code = code if len(code) == 6 else "".join(2 * c for c in code)
    parts = [int(code[k : k + 2], 16) / 255 for k in (0, 2, 4)]
    linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return float(np.dot(linear, [0.2126, 0.7152, 0.0722]))


def _contrast(a: str, b: str) -> float:
    high, low = sorted((_luminance(a), _luminance(b)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("start", [":root{", ":root[data-theme=dark]{"])
def test_contrast_of_words_and_curves(text: str, start: str) -> None:
    block = text.partition(start)[2].partition("}")[0]
    colors = dict(re.findall(r"--([\w-]+):(#[0-9a-f]{3,6});", block))
    for name in ("ink", "muted", "link", "good", "caution", "bad", "plot-ink", "plot-muted"):
        for ground in ("paper", "soft"):  # 4.5 and 3: WCAG 2.1, 1.4.3 and 1.4.11, level AA
            assert _contrast(colors[name], colors[ground]) >= 4.5, (name, ground)
    for name in ("measured", "model", "residual"):
        assert _contrast(colors[f"plot-{name}"], colors["plot-paper"]) >= 3, name
    for step in range(11):
        for sign in "pm":
            word = colors["over"] if step >= 7 else colors["ink"]
            assert _contrast(word, colors[f"{sign}{step}"]) >= 4.5, (sign, step)
