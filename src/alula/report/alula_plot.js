"use strict";
/* Plots over time on canvas. Panels share one time axis; the plots of one Link zoom, pan and point
   together. Samples are drawn by the lowest and highest of every pixel column, found through an
   index of blocks, so a million samples zoom without a wait. No dependency, no WebGL.

   AlulaPlot.Times.uniform(start, step, n) | AlulaPlot.Times.of(Float64Array)
   new AlulaPlot.Link()
   new AlulaPlot.Plot(host, {panels: [{label, small, lines: [{name, style, y}],
                                       bands: [{name, half, center}]}]}, times, link)
   `y`, `half` and `center` are Float32Arrays (center may be null); `host` holds a canvas. */
const AlulaPlot = (() => {
  const BLOCK = 64;
  const LEFT = 54, RIGHT = 10, ROW = 16, FOOT = 34, GAP = 8;
  const FONT = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";

  /* One curve with the extremes of its blocks. */
  class Samples {
    constructor(values) {
      this.v = values;
      const n = Math.ceil(values.length / BLOCK);
      this.low = new Float32Array(n).fill(NaN);
      this.high = new Float32Array(n).fill(NaN);
      for (let b = 0; b < n; b++) {
        const e = this.scan(b * BLOCK, Math.min((b + 1) * BLOCK, values.length), [Infinity, -Infinity]);
        if (e[0] <= e[1]) { this.low[b] = e[0]; this.high[b] = e[1]; }
      }
    }
    scan(i, j, e) {
      for (; i < j; i++) {
        const y = this.v[i];
        if (y < e[0]) e[0] = y;
        if (y > e[1]) e[1] = y;
      }
      return e;
    }
    /* [lowest, highest] of samples i to j - 1; [Infinity, -Infinity] where all are missing. */
    extremes(i, j) {
      const e = [Infinity, -Infinity];
      const first = Math.ceil(i / BLOCK), last = Math.floor(j / BLOCK);
      if (first >= last) return this.scan(i, j, e);
      this.scan(i, first * BLOCK, e);
      for (let b = first; b < last; b++) {
        if (this.low[b] < e[0]) e[0] = this.low[b];
        if (this.high[b] > e[1]) e[1] = this.high[b];
      }
      return this.scan(last * BLOCK, j, e);
    }
  }

  /* Times of samples, increasing. A step over three times the median is a gap: no line across. */
  class Times {
    static uniform(start, step, n) {
      const t = new Times();
      Object.assign(t, { start, step, n, array: null, gap: Infinity });
      return t;
    }
    static of(array) {
      const t = new Times(), n = array.length, steps = [];
      const stride = Math.max(1, Math.floor(n / 1000));
      for (let i = 1; i < n; i += stride) steps.push(array[i] - array[i - 1]);
      steps.sort((a, b) => a - b);
      const step = steps[steps.length >> 1] || 1;
      Object.assign(t, { start: array[0], step, n, array, gap: 3 * step });
      return t;
    }
    at(i) { return this.array ? this.array[i] : this.start + this.step * i; }
    get end() { return this.at(this.n - 1); }
    /* The first sample at or after time t. */
    index(t) {
      if (!this.array) {
        return Math.min(this.n, Math.max(0, Math.ceil((t - this.start) / this.step - 1e-9)));
      }
      let i = 0, j = this.n;
      while (i < j) {
        const k = (i + j) >> 1;
        if (this.array[k] < t) i = k + 1; else j = k;
      }
      return i;
    }
    nearest(t) {
      const i = this.index(t);
      if (i <= 0) return 0;
      if (i >= this.n) return this.n - 1;
      return t - this.at(i - 1) < this.at(i) - t ? i - 1 : i;
    }
  }

  /* The time window and the cursor that several plots share. */
  class Link {
    constructor() {
      Object.assign(this, { plots: [], start: Infinity, end: -Infinity, cursor: null, finest: 1e-6 });
    }
    add(plot) {
      this.plots.push(plot);
      this.start = this.low = Math.min(this.start, plot.times.start);
      this.end = this.high = Math.max(this.end, plot.times.end);
      this.finest = Math.max(1e-6, 4 * plot.times.step);
    }
    set(low, high) {
      const full = this.end - this.start;
      const width = Math.min(full, Math.max(Math.min(this.finest, full), high - low));
      const middle = (low + high) / 2;
      this.low = Math.min(Math.max(middle - width / 2, this.start), this.end - width);
      this.high = this.low + width;
      this.changed();
    }
    zoom(factor, at = (this.low + this.high) / 2) {
      this.set(at - (at - this.low) * factor, at + (this.high - at) * factor);
    }
    pan(share) {
      const by = share * (this.high - this.low);
      this.set(this.low + by, this.high + by);
    }
    reset() { this.set(this.start, this.end); }
    point(t) { this.cursor = t; this.changed(); }
    changed() { for (const plot of this.plots) soon(plot); }
  }

  /* Plots in view are drawn in the next frame, the others when there is time. */
  const waiting = new Set();
  let asked = false;
  function soon(plot) {
    waiting.add(plot);
    if (!asked) { asked = true; requestAnimationFrame(drawWaiting); }
  }
  function drawWaiting() {
    const until = performance.now() + 30;
    for (const plot of waiting) if (plot.inView) plot.draw();
    for (const plot of waiting) {
      if (performance.now() > until) break;
      plot.draw();
    }
    asked = waiting.size > 0;
    if (asked) requestAnimationFrame(drawWaiting);
  }

  /* About `count` round numbers from low to high. */
  function ticks(low, high, count) {
    const rough = (high - low) / Math.max(count, 1);
    const ten = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * ten).find((s) => s >= rough * 0.999) || ten;
    const out = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) out.push(k * step);
    return { step, values: out };
  }
  const minus = (text) => text.replace("-", "\u2212");
  function format(value, step) {
    const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
    return minus((Math.abs(value) < step * 1e-6 ? 0 : value).toFixed(decimals));
  }
  function readable(value) {
    if (!Number.isFinite(value)) return "\u2013";
    const size = Math.abs(value);
    return minus(size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(3)
      : String(Number(value.toPrecision(5))));
  }
  const superscript = (n) => [...String(n)].map((c) => "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c] || "\u207b").join("");

  class Plot {
    constructor(host, spec, times, link) {
      Object.assign(this, { host, times, link, inView: true, drag: null, fixed: null });
      this.canvas = host.querySelector("canvas");
      this.live = host.querySelector(".live");
      this.panels = spec.panels.map((p) => ({
        label: p.label,
        small: p.small,
        lines: p.lines.map((l) => ({ name: l.name, style: l.style, y: new Samples(l.y) })),
        bands: p.bands.map((b) => ({
          name: b.name,
          low: new Samples(b.half.map((h, i) => (b.center ? b.center[i] : 0) - h)),
          high: new Samples(b.half.map((h, i) => (b.center ? b.center[i] : 0) + h)),
        })),
      }));
      link.add(this);
      this.listen();
      new ResizeObserver(() => { if (!this.fixed) soon(this); }).observe(host);
      new IntersectionObserver((e) => { this.inView = e[e.length - 1].isIntersecting; }).observe(host);
    }

    /* Draw at a fixed width and sharpness (for paper), or by the page again with null. */
    fix(size) {
      this.fixed = size;
      this.draw();
    }

    draw() {
      waiting.delete(this);
      const width = this.fixed ? this.fixed.width : this.host.clientWidth;
      if (width < 80) return;
      const scale = this.fixed ? this.fixed.scale : window.devicePixelRatio || 1;
      const c = this.canvas.getContext("2d");
      c.font = FONT;
      const height = this.layOut(c, width);
      const w = Math.round(width * scale), h = Math.round(height * scale);
      if (this.canvas.width !== w) this.canvas.width = w;
      if (this.canvas.height !== h) this.canvas.height = h;
      this.canvas.style.height = `${height}px`;
      c.setTransform(scale, 0, 0, scale, 0, 0);
      c.font = FONT;
      this.color = palette(this.host);
      c.fillStyle = this.color.paper;
      c.fillRect(0, 0, width, height);
      for (const panel of this.panels) this.drawPanel(c, panel);
      this.drawTimes(c, height);
      this.host.dataset.drawn = `${this.link.low.toFixed(4)} ${this.link.high.toFixed(4)}`;
    }

    /* Place the panels; a legend that does not fit beside its label takes a row of its own. */
    layOut(c, width) {
      let y = 0;
      this.width = width;
      for (const p of this.panels) {
        p.entries = [...p.lines.map((l) => [l.style, l.name]), ...p.bands.map((b) => ["band", b.name])];
        p.legend = p.entries.reduce((sum, [, name]) => sum + 32 + c.measureText(name).width, 0);
        p.rows = c.measureText(p.label).width + 50 + p.legend > width - RIGHT ? 2 : 1;
        p.head = y;
        p.top = y + ROW * p.rows + 2;
        p.bottom = p.top + (p.small ? 74 : 130);
        y = p.bottom + GAP;
      }
      return y - GAP + FOOT;
    }

    x(t) {
      const { low, high } = this.link;
      return LEFT + ((t - low) / (high - low)) * (this.width - LEFT - RIGHT);
    }
    time(x) {
      const { low, high } = this.link;
      return low + ((x - LEFT) / (this.width - LEFT - RIGHT)) * (high - low);
    }

    /* The samples in the window, with one more on either side so that lines leave the panel. */
    window() {
      const i = Math.max(0, this.times.index(this.link.low) - 1);
      return [i, Math.min(this.times.n, this.times.index(this.link.high) + 1)];
    }

    scaleOf(panel, i, j) {
      let low = Infinity, high = -Infinity;
      for (const { y } of panel.lines) {
        const e = y.extremes(i, j);
        low = Math.min(low, e[0]); high = Math.max(high, e[1]);
      }
      if (low > high) { low = -1; high = 1; }
      // A band may widen the axis to three times the curves' range, not flatten them.
      const room = Math.max(high - low, 1e-9 * Math.max(Math.abs(low), Math.abs(high)), 1e-12);
      let bottom = low, top = high;
      for (const b of panel.bands) {
        bottom = Math.min(bottom, Math.max(b.low.extremes(i, j)[0], low - room));
        top = Math.max(top, Math.min(b.high.extremes(i, j)[1], high + room));
      }
      const pad = 0.06 * (top - bottom) || 0.05 * Math.abs(top) || 1;
      return [bottom - pad, top + pad];
    }

    drawPanel(c, p) {
      const [i, j] = this.window();
      const [low, high] = this.scaleOf(p, i, j);
      const right = this.width - RIGHT;
      const y = (v) => p.bottom - ((v - low) / (high - low)) * (p.bottom - p.top);
      const t = ticks(low, high, p.small ? 3 : 4);
      const size = Math.max(Math.abs(low), Math.abs(high));
      const e = size < 0.01 || size >= 1e5 ? 3 * Math.floor(Math.log10(size) / 3) : 0;
      c.lineWidth = 1;
      c.textBaseline = "middle";
      c.textAlign = "right";
      for (const v of t.values) {
        c.strokeStyle = Math.abs(v) < t.step * 1e-6 ? this.color.axis : this.color.grid;
        line(c, LEFT, crisp(y(v)), right, crisp(y(v)));
        c.fillStyle = this.color.muted;
        c.fillText(format(v / 10 ** e, t.step / 10 ** e), LEFT - 6, y(v));
      }
      c.strokeStyle = this.color.grid;
      for (const v of this.timeTicks().values) line(c, crisp(this.x(v)), p.top, crisp(this.x(v)), p.bottom);
      c.save();
      c.beginPath();
      c.rect(LEFT, p.top, right - LEFT, p.bottom - p.top);
      c.clip();
      for (const b of p.bands) this.drawBand(c, b, y, i, j);
      for (const l of p.lines) this.drawLine(c, l, y, i, j);
      c.restore();
      c.strokeStyle = this.color.axis;
      c.strokeRect(crisp(LEFT), crisp(p.top), right - LEFT, p.bottom - p.top);
      this.drawHead(c, p, e);
      this.drawCursor(c, p, y);
    }

    drawHead(c, p, e) {
      const middle = p.head + ROW / 2;
      c.textAlign = "left";
      c.textBaseline = "middle";
      c.fillStyle = this.color.ink;
      c.fillText(p.label + (e ? `  \u00d710${superscript(e)}` : ""), 4, middle);
      let x = p.rows === 1 ? this.width - RIGHT - p.legend + 8 : 4;
      const row = p.rows === 1 ? middle : middle + ROW;
      for (const [style, name] of p.entries) {
        if (style === "band") {
          c.fillStyle = this.color.band;
          c.fillRect(x, row - 5, 18, 10);
          this.pen(c, "edge");
          line(c, x, row - 5, x + 18, row - 5);
          line(c, x, row + 5, x + 18, row + 5);
        } else {
          this.pen(c, style);
          line(c, x, row, x + 18, row);
        }
        c.setLineDash([]);
        c.fillStyle = this.color.ink;
        c.fillText(name, x + 22, row);
        x += 32 + c.measureText(name).width;
      }
    }

    /* Curves differ in dash and width too, not in color alone. */
    pen(c, style) {
      const look = {
        measured: [this.color.measured, 1, []],
        model: [this.color.model, 1.8, [7, 3]],
        estimate: [this.color.model, 1.5, []],
        residual: [this.color.residual, 1, []],
        edge: [this.color.edge, 1, [2, 2]],
      }[style] || [this.color.ink, 1, []];
      c.strokeStyle = look[0];
      c.lineWidth = look[1];
      c.setLineDash(look[2]);
    }

    /* Calls back with (x, lowest, highest, after a gap?) per sample, or per pixel column if dense. */
    walk(i, j, lows, highs, put) {
      let last = -Infinity;
      if (j - i <= 2 * (this.width - LEFT - RIGHT)) {
        for (let k = i; k < j; k++) {
          const t = this.times.at(k);
          if (!Number.isNaN(lows.v[k])) {
            put(this.x(t), lows.v[k], highs.v[k], t - last > this.times.gap);
            last = t;
          } else last = -Infinity;
        }
        return;
      }
      for (let x = LEFT - 1, k = i; x <= this.width - RIGHT && k < j; x++) {
        const next = Math.min(j, this.times.index(this.time(x + 1)));
        if (next > k) {
          const a = lows.extremes(k, next)[0], b = highs.extremes(k, next)[1];
          if (a <= b) {
            put(x + 0.5, a, b, this.times.at(k) - last > this.times.gap || last === -Infinity);
            last = this.times.at(next - 1);
          } else last = -Infinity;
        }
        k = next;
      }
    }

    drawLine(c, l, y, i, j) {
      this.pen(c, l.style);
      c.lineJoin = "round";
      c.beginPath();
      this.walk(i, j, l.y, l.y, (x, a, b, broken) => {
        if (broken) c.moveTo(x, y(a)); else c.lineTo(x, y(a));
        if (b > a) c.lineTo(x, y(b));
      });
      c.stroke();
      c.setLineDash([]);
      if (l.style === "measured" && (j - i) * 7 < this.width) {
        c.fillStyle = this.color.measured;
        for (let k = i; k < j; k++) c.fillRect(this.x(this.times.at(k)) - 1.5, y(l.y.v[k]) - 1.5, 3, 3);
      }
    }

    drawBand(c, b, y, i, j) {
      let upper = [], lower = [];
      const put = () => {
        if (!upper.length) return;
        c.fillStyle = this.color.band;
        c.beginPath();
        for (const [x, v] of upper) c.lineTo(x, v);
        for (let k = lower.length; k--;) c.lineTo(lower[k][0], lower[k][1]);
        c.fill();
        this.pen(c, "edge");
        for (const edge of [upper, lower]) {
          c.beginPath();
          for (const [x, v] of edge) c.lineTo(x, v);
          c.stroke();
        }
        c.setLineDash([]);
        upper = []; lower = [];
      };
      const far = (v) => Math.max(-9999, Math.min(9999, v));
      this.walk(i, j, b.low, b.high, (x, low, high, broken) => {
        if (broken) put();
        lower.push([x, far(y(low))]);
        upper.push([x, far(y(high))]);
      });
      put();
    }

    drawCursor(c, p, y) {
      const t = this.link.cursor;
      if (this.drag && this.drag.kind === "zoom") {
        const a = Math.min(this.drag.from, this.drag.to), b = Math.max(this.drag.from, this.drag.to);
        c.fillStyle = this.color.select;
        c.fillRect(a, p.top, b - a, p.bottom - p.top);
      }
      if (t === null || t < this.link.low || t > this.link.high) return;
      const k = this.times.nearest(t), x = this.x(this.times.at(k));
      c.strokeStyle = this.color.ink;
      c.lineWidth = 1;
      line(c, crisp(x), p.top, crisp(x), p.bottom);
      const text = this.values(p, k);
      const wide = Math.max(...text.map((s) => c.measureText(s).width)) + 10;
      const left = x + 8 + wide > this.width - RIGHT ? x - 8 - wide : x + 8;
      c.fillStyle = this.color.paper;
      c.globalAlpha = 0.9;
      c.fillRect(left, p.top + 3, wide, 14 * text.length + 4);
      c.globalAlpha = 1;
      c.strokeStyle = this.color.axis;
      c.strokeRect(crisp(left), crisp(p.top + 3), Math.round(wide), 14 * text.length + 4);
      c.fillStyle = this.color.ink;
      c.textAlign = "left";
      c.textBaseline = "middle";
      text.forEach((s, n) => c.fillText(s, left + 5, p.top + 12 + 14 * n));
      for (const l of p.lines) {
        if (Number.isNaN(l.y.v[k])) continue;
        c.beginPath();
        c.arc(x, y(l.y.v[k]), 3, 0, 7);
        c.fillStyle = this.color.paper;
        c.fill();
        this.pen(c, l.style);
        c.setLineDash([]);
        c.stroke();
      }
    }

    values(p, k) {
      const first = p === this.panels[0] ? [`t = ${format(this.times.at(k), Math.min(0.01, this.times.step))} s`] : [];
      return [
        ...first,
        ...p.lines.map((l) => `${l.name} ${readable(l.y.v[k])}`),
        ...p.bands.map((b) => `${b.name} ${readable(b.low.v[k])} \u2026 ${readable(b.high.v[k])}`),
      ];
    }

    timeTicks() {
      return ticks(this.link.low, this.link.high, (this.width - LEFT - RIGHT) / 70);
    }

    drawTimes(c, height) {
      const bottom = this.panels[this.panels.length - 1].bottom;
      const { step, values } = this.timeTicks();
      c.textAlign = "center";
      c.textBaseline = "top";
      c.fillStyle = this.color.muted;
      for (const v of values) c.fillText(format(v, step), this.x(v), bottom + 4);
      c.textBaseline = "bottom";
      c.fillStyle = this.color.ink;
      c.fillText("time in the log, s", (LEFT + this.width - RIGHT) / 2, height - 1);
    }

    listen() {
      const h = this.host, link = this.link;
      const x = (e) => e.clientX - this.canvas.getBoundingClientRect().left;
      const inside = (v) => Math.min(Math.max(v, LEFT), this.width - RIGHT);
      h.addEventListener("pointerdown", (e) => {
        if (e.button > 1) return;
        const pan = e.pointerType === "touch" || e.shiftKey || e.button === 1;
        this.drag = { kind: pan ? "pan" : "zoom", from: inside(x(e)), to: inside(x(e)), at: this.time(x(e)) };
        h.setPointerCapture(e.pointerId);
        h.focus({ preventScroll: true });
        if (pan) e.preventDefault();
      });
      h.addEventListener("pointermove", (e) => {
        const at = inside(x(e));
        if (this.drag && this.drag.kind === "pan") {
          const by = this.drag.at - this.time(at);
          link.set(link.low + by, link.high + by);
        } else if (this.drag) this.drag.to = at;
        link.point(this.time(at));
      });
      h.addEventListener("pointerup", () => {
        const d = this.drag;
        this.drag = null;
        if (d && d.kind === "zoom" && Math.abs(d.to - d.from) > 4) {
          const a = this.time(d.from), b = this.time(d.to);
          link.set(Math.min(a, b), Math.max(a, b));
        } else soon(this);
      });
      h.addEventListener("pointercancel", () => { this.drag = null; soon(this); });
      h.addEventListener("pointerleave", () => { if (!this.drag) link.point(null); });
      h.addEventListener("dblclick", () => link.reset());
      // The wheel scrolls the page until the plot is chosen, so that nobody is caught in it.
      h.addEventListener("wheel", (e) => {
        if (!(e.ctrlKey || document.activeElement === h)) return;
        e.preventDefault();
        if (Math.abs(e.deltaX) > Math.abs(e.deltaY)) link.pan(e.deltaX / 1000);
        else link.zoom(Math.exp(Math.sign(e.deltaY) * Math.min(Math.abs(e.deltaY), 120) * 0.002), this.time(inside(x(e))));
      }, { passive: false });
      h.addEventListener("keydown", (e) => {
        if (e.ctrlKey || e.metaKey || e.altKey) return;
        const act = {
          ArrowLeft: () => link.pan(-0.1), ArrowRight: () => link.pan(0.1),
          "+": () => link.zoom(0.7), "=": () => link.zoom(0.7), "-": () => link.zoom(1 / 0.7),
          0: () => link.reset(), "[": () => this.step(-1), "]": () => this.step(1),
          Escape: () => link.point(null),
        }[e.key];
        if (!act) return;
        e.preventDefault();
        act();
      });
    }

    /* Move the cursor by samples and say aloud what it reads. */
    step(by) {
      const { low, high, cursor } = this.link;
      const from = cursor === null ? this.times.nearest((low + high) / 2) : this.times.nearest(cursor) + by;
      const k = Math.min(Math.max(from, 0), this.times.n - 1);
      this.link.point(this.times.at(k));
      if (this.live) {
        this.live.textContent = this.panels.map((p) => `${p.label}: ${this.values(p, k).join(", ")}`).join("; ");
      }
    }
  }

  const crisp = (v) => Math.round(v) + 0.5;
  function line(c, x0, y0, x1, y1) {
    c.beginPath();
    c.moveTo(x0, y0);
    c.lineTo(x1, y1);
    c.stroke();
  }
  function palette(host) {
    const style = getComputedStyle(host), out = {};
    for (const name of ["paper", "ink", "muted", "grid", "axis", "measured", "model", "residual", "band", "edge", "select"]) {
      out[name] = style.getPropertyValue(`--plot-${name}`).trim();
    }
    return out;
  }

  return { Times, Link, Plot, redraw: (plots) => plots.forEach(soon) };
})();
