"""The page as a reader meets it, in a browser."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from alula.report import render
from report.conftest import Opened
from report.example import example
from report.test_page import HOSTILE

Visit = Callable[..., Opened]

# Pixels of a panel's curve: close to the color of one of the pens.
CURVE_PIXELS = """host => {
  const c = host.querySelector('canvas'), style = getComputedStyle(host);
  const pens = ['measured', 'model', 'residual'].map(n => style.getPropertyValue('--plot-' + n))
    .map(h => [1, 3, 5].map(i => parseInt(h.trim().slice(i, i + 2), 16)));
  const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
  let n = 0;
  for (let i = 0; i < d.length; i += 4) {
    if (pens.some(p => p.every((v, k) => Math.abs(v - d[i + k]) < 24))) n++;
  }
  return n;
}"""


@pytest.fixture(scope="module")
def text() -> str:
    return render(example())


@pytest.mark.parametrize(("width", "scheme"), [(1280, "light"), (1280, "dark"), (400, "light")])
def test_opens_offline_without_complaint_and_every_plot_shows_a_curve(
    visit: Visit, text: str, width: int, scheme: str
) -> None:
    opened = visit(text, width, scheme)
    assert opened.plots() == text.count("data-plot=") > 60
    pixels = opened.page.locator("[data-plot]").evaluate_all(f"all => all.map({CURVE_PIXELS})")
    assert min(pixels) > 150  # a flat line across the narrowest plot has about 300
    assert [r for r in opened.requests if not r.startswith("file://")] == []
    assert len(opened.requests) == 1, "the page itself and nothing else"
    assert opened.complaints == []
    wide = opened.page.evaluate("document.documentElement.scrollWidth")
    assert wide <= width, "the page scrolls only downward; wide tables scroll in their own box"


@pytest.mark.parametrize("name", HOSTILE)
def test_a_name_from_a_log_runs_no_script(visit: Visit, name: str) -> None:
    report = example()
    channel = replace(report.cards[0].channels[0], name=name, source=name)
    maneuvers = (replace(report.maneuvers[0], kind=name), *report.maneuvers[1:])
    card = replace(report.cards[0], channels=(channel,))
    opened = visit(render(replace(report, name=name, cards=(card,), maneuvers=maneuvers)))
    assert opened.complaints == []
    assert opened.page.locator("img").count() == 0
    if "\u2028" not in name:  # signs that cannot be seen are replaced
        assert opened.page.locator("h1").inner_text() == name


def test_policy_stops_a_foreign_script(visit: Visit, text: str) -> None:
    opened = visit(text.replace("</main>", "<script>document.title = 'x'</script></main>"))
    assert opened.page.title() != "x"
    assert any("Content Security Policy" in c for c in opened.complaints)


def test_keys_zoom_pan_and_reset_the_plots_of_a_maneuver_together(visit: Visit, text: str) -> None:
    opened = visit(text)
    host = opened.page.locator('[data-plot="0"]')
    host.focus()
    opened.page.keyboard.press("+")
    opened.settle()
    low, high = opened.drawn(0)
    assert high - low == pytest.approx(0.7 * 25.0, abs=1e-3)
    assert opened.drawn(1) == (low, high)
    last = opened.plots() - 1
    assert opened.drawn(last) == (60.0, 85.0), "another maneuver stays where it is"
    opened.page.keyboard.press("ArrowRight")
    opened.settle()
    assert opened.drawn(1)[0] == pytest.approx(low + 0.1 * (high - low), abs=1e-3)
    for _ in range(40):
        opened.page.keyboard.press("ArrowRight")
    opened.settle()
    assert opened.drawn(0)[1] == pytest.approx(25.0), "cannot be moved off the data"
    opened.page.keyboard.press("0")
    opened.settle()
    assert opened.drawn(0) == opened.drawn(1) == (0.0, 25.0)
    opened.page.keyboard.press("]")
    opened.page.keyboard.press("]")
    spoken = host.locator(".live").inner_text()
    # the middle is 12.5 s, the nearest sample 12.52 s, and the next one 0.04 s further
    assert "t = 12.56 s" in spoken
    assert "velocity forward (m/s)" in spoken


def test_pointer_drags_pans_wheels_and_resets(visit: Visit, text: str) -> None:
    opened = visit(text)
    host, mouse = opened.page.locator('[data-plot="0"]'), opened.page.mouse
    host.scroll_into_view_if_needed()
    box = host.bounding_box()
    left, right, y = box["x"] + 54, box["x"] + box["width"] - 10, box["y"] + 60

    def at(share: float) -> float:
        return float(left + share * (right - left))

    def drag(start: float, end: float) -> None:
        mouse.move(at(start), y)
        mouse.down()
        mouse.move(at(end), y, steps=4)
        mouse.up()
        opened.settle()

    scrolled = opened.page.evaluate("scrollY")
    mouse.move(at(0.5), y)
    mouse.wheel(0, -60)
    opened.page.wait_for_function(f"() => scrollY !== {scrolled}")
    assert opened.drawn(0) == (0.0, 25.0), "the wheel scrolls until a plot is chosen"
    mouse.wheel(0, 60)
    opened.page.wait_for_function(f"() => scrollY === {scrolled}")

    drag(0.2, 0.6)
    low, high = opened.drawn(0)
    # one pixel of about 500 is 0.05 s
    assert (low, high) == (pytest.approx(5.0, abs=0.1), pytest.approx(15.0, abs=0.1))
    opened.page.keyboard.down("Shift")
    drag(0.5, 0.4)
    opened.page.keyboard.up("Shift")
    assert opened.drawn(0)[0] == pytest.approx(low + 1.0, abs=0.1)
    mouse.wheel(0, -100)
    opened.settle()
    assert opened.drawn(0)[1] - opened.drawn(0)[0] < high - low
    mouse.dblclick(at(0.5), y)
    opened.settle()
    assert opened.drawn(0) == (0.0, 25.0)


def test_theme_button_turns_page_and_plots(visit: Visit, text: str) -> None:
    opened = visit(text)
    corner = """() => [...document.querySelector('canvas').getContext('2d')
        .getImageData(0, 0, 1, 1).data].slice(0, 3)"""
    light = opened.page.evaluate(corner)
    opened.page.get_by_role("button", name="Dark page").click()
    opened.settle()
    dark = opened.page.evaluate(corner)
    assert sum(light) > 600 > 150 > sum(dark)


def test_paper_is_light_and_holds_every_plot(visit: Visit, text: str, tmp_path: Path) -> None:
    opened = visit(text, scheme="dark")
    opened.page.evaluate(
        "() => addEventListener('beforeprint', () => { window.atPrint ="
        " [...document.querySelectorAll('canvas')].map(c => [c.width,"
        " ...c.getContext('2d').getImageData(0, 0, 1, 1).data]) })"
    )
    file = tmp_path / "report.pdf"
    opened.page.pdf(path=file, prefer_css_page_size=True, print_background=True)
    printed = opened.page.evaluate("window.atPrint")
    assert len(printed) == opened.plots()
    assert {tuple(p[1:4]) for p in printed} == {(255, 255, 255)}
    assert {p[0] for p in printed} == {1050}  # 350 px wide, three dots to the pixel
    assert file.read_bytes().count(b"/Type /Page\n") > 10
    opened.settle()
    assert opened.page.evaluate("document.documentElement.dataset.theme ?? null") is None
    assert opened.complaints == []


def test_tables_read_without_script(browser: Any, text: str) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.set_content(text)
    assert "every table reads without it" in page.locator("main").inner_text()
    assert page.get_by_text("Cm_alpha", exact=True).count() > 0
    context.close()
