"""The plot module by itself: extremes, gaps and ticks, judged by brute force."""

from __future__ import annotations

from collections.abc import Callable
from importlib.resources import files
from typing import Any

import pytest

from report.conftest import Opened

MODULES = ("alula_series.js", "alula_link.js", "alula_plot.js")


@pytest.fixture
def module(visit: Callable[..., Opened]) -> Any:
    """A bare page with the plot module and one host of 600 pixels."""
    source = "\n".join(
        f"<script>{files('alula.report').joinpath(name).read_text()}</script>" for name in MODULES
    )
    colors = ";".join(
        f"--plot-{name}:{color}"
        for name, color in {
            "paper": "#ffffff", "ink": "#000000", "muted": "#808080", "grid": "#eeeeee",
            "axis": "#808080", "measured": "#00ff00", "model": "#0000ff", "residual": "#ff0000",
            "band": "#ffff00", "edge": "#ffff00", "select": "#00ffff",
        }.items()
    )  # fmt: skip
    host = f'<div id="host" style="width:600px;{colors}"><canvas></canvas></div>'
    opened = visit(f"<!DOCTYPE html><meta charset=utf-8><body>{host}{source}</body>")
    yield opened.page
    assert opened.complaints == []


# Draws y over t and tells, for every column of pixels of the panel, how many are red.
DRAW = """([t, y, low, high]) => {
  const host = document.getElementById('host'), link = new AlulaLink.Link();
  const values = Float32Array.from(y, v => v === null ? NaN : v);
  const times = Array.isArray(t) ? AlulaSeries.Times.of(Float64Array.from(t))
    : AlulaSeries.Times.uniform(0, t, y.length);
  const plot = new AlulaPlot.Plot(host, {panels: [{label: 'y', small: false, bands: [],
    lines: [{name: 'y', style: 'residual', y: values}]}]}, times, link);
  if (high !== null) { link.low = low; link.high = high; }
  plot.draw();
  const c = host.querySelector('canvas'), p = plot.panels[0];
  const d = c.getContext('2d').getImageData(0, p.top, c.width, p.bottom - p.top).data;
  const out = [];
  for (let x = 54; x < 590; x++) {
    let n = 0;
    for (let row = 0; row < p.bottom - p.top; row++) {
      const i = 4 * (row * c.width + x);
      if (d[i] > 200 && d[i + 1] < 170 && d[i + 2] < 170) n++;
    }
    out.push(n);
  }
  return out;
}"""


def test_one_spike_among_a_million_samples_is_drawn(module: Any) -> None:
    red = module.evaluate(
        f"() => {{ const y = new Array(1000000).fill(0); y[700001] = 1;"
        f" return ({DRAW})([0.01, y, null, null]) }}"
    )
    tall = [x for x, n in enumerate(red) if n > 90]
    assert tall
    assert all(abs(x - 0.7 * 536) <= 2 for x in tall)  # 536 columns hold 10 000 s


def test_no_line_is_drawn_across_missing_samples(module: Any) -> None:
    y: list[float | None] = [0.0] * 200
    y[80:120] = [None] * 40
    red = module.evaluate(DRAW, [0.1, y, None, None])
    hole = red[round(0.41 * 536) : round(0.59 * 536)]
    assert max(hole) == 0
    assert min(red[5:200]) > 0


def test_no_line_is_drawn_across_a_gap_in_time(module: Any) -> None:
    t = [0.1 * k for k in range(80)] + [0.1 * k for k in range(120, 200)]
    red = module.evaluate(DRAW, [t, [0.0] * 160, None, None])
    assert max(red[round(0.41 * 536) : round(0.59 * 536)]) == 0
    assert min(red[5:200]) > 0


def test_given_breaks_decide_and_not_the_steps(module: Any) -> None:
    """Of a thinned curve only the page's maker knows where time was lost."""
    t = [0.0, 0.1, 0.2, 0.3, 5.0, 5.1, 5.2, 5.3, 9.0, 9.1, 9.2, 10.0]
    draw = DRAW.replace("Float64Array.from(t))", "Float64Array.from(t), [8])")
    red = module.evaluate(draw, [t, [0.0] * len(t), None, None])
    assert min(red[round(0.05 * 536) : round(0.51 * 536)]) > 0, "no break was given at 5 s"
    assert max(red[round(0.55 * 536) : round(0.88 * 536)]) == 0, "one was given at 9 s"


def test_a_limit_holds_until_zoomed_in(module: Any) -> None:
    """One wild sample of a thousand at 0 s: the axis shows the others, and it after zooming."""
    heights = module.evaluate("""() => {
      const y = Float32Array.from({length: 1001}, (_, i) => i ? Math.sin(i) : 500);
      const link = new AlulaLink.Link(), host = document.getElementById('host');
      const plot = new AlulaPlot.Plot(host, {panels: [{label: 'y', small: true, limit: 4, bands: [],
        lines: [{name: 'y', style: 'residual', y}]}]},
        AlulaSeries.Times.uniform(0, 0.01, 1001), link);
      const scale = () => plot.scaleOf(plot.panels[0], ...plot.window());
      const all = scale();
      link.set(0, 0.5);
      const near = scale();
      link.set(5, 5.5);
      return [all, near, scale()];
    }""")
    assert heights[0] == [-4, 4]
    assert heights[1][1] > 500
    assert 1 < heights[2][1] < 1.5  # the sine with the usual margin


def test_extremes_agree_with_a_plain_search(module: Any) -> None:
    worst = module.evaluate("""() => {
      let seed = 1, worst = 0;
      const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
      const y = Float32Array.from({length: 5000}, () => random() < 0.2 ? NaN : random());
      const s = new AlulaSeries.Samples(y);
      for (let k = 0; k < 3000; k++) {
        const i = Math.floor(random() * 5000), j = i + Math.floor(random() * (5000 - i));
        const e = s.extremes(i, j), want = [Infinity, -Infinity];
        for (let m = i; m < j; m++) {
          if (y[m] < want[0]) want[0] = y[m];
          if (y[m] > want[1]) want[1] = y[m];
        }
        if (e[0] !== want[0] || e[1] !== want[1]) worst++;
      }
      return worst;
    }""")
    assert worst == 0


def test_axes_have_at_least_two_and_not_too_many_round_ticks(module: Any) -> None:
    counts = module.evaluate("""() => {
      const out = [];
      for (let e = -6; e < 6; e++) for (let m = 1; m < 10; m += 0.37) for (const n of [4, 5, 8]) {
        const low = -0.3 * m * 10 ** e, t = AlulaSeries.ticks(low, low + m * 10 ** e, n);
        out.push([n, t.values.length, Number((t.step / 10 ** Math.floor(Math.log10(t.step) + 1e-9))
          .toFixed(6))]);
      }
      return out;
    }""")
    for wanted, found, mantissa in counts:
        assert 2 <= found <= 2 * wanted
        assert mantissa in (1, 2, 5)
