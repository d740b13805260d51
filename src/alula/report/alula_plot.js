"use strict";
/* Plots over time on canvas. Panels share one time axis; the plots of one Link zoom, pan and point
   together. Samples are drawn by the lowest and highest of every pixel column, found through an
   index of blocks, so a million samples zoom without a wait. No dependency, no WebGL.

   AlulaSeries.Times.uniform(start, step, n) | AlulaSeries.Times.of(Float64Array)
   new AlulaLink.Link()
   new AlulaPlot.Plot(host, {over, panels: [{label, small, lines: [{name, style, y}],
                                       bands: [{name, half, center}]}]}, times, link)
   `over` is "Hz" where the abscissa is frequency; otherwise time. `y`, `half` and `center` are Float32Arrays (center may be null); `host` holds a canvas. */
const AlulaPlot = (() => {
  const { Samples, ticks, format, readable, superscript } = AlulaSeries;
  const { soon, drawn } = AlulaLink;
  const LEFT = 54, RIGHT = 10, ROW = 16, FOOT = 34, GAP = 8;
  const FONT = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";

  class Plot {
    constructor(host, spec, times, link) {
      Object.assign(this, { host, times, link, inView: false, drag: null, fixed: null });
      this.canvas = host.querySelector("canvas");
      this.live = host.querySelector(".live");
      this.over = spec.over === "Hz" ? { sign: "f", unit: "Hz", words: "frequency, Hz" }
        : { sign: "t", unit: "s", words: "time in the log, s" };
      this.panels = spec.panels.map((p) => ({
        label: p.label,
        small: p.small,
        limit: p.limit || null,
        lines: p.lines.map((l) => ({ name: l.name, style: l.style, y: new Samples(l.y) })),
        bands: p.bands.map((b) => ({
          name: b.name,
          usual: median(b.half),
          low: new Samples(b.half.map((h, i) => (b.center ? b.center[i] : 0) - h)),
          high: new Samples(b.half.map((h, i) => (b.center ? b.center[i] : 0) + h)),
        })),
      }));
      link.add(this);
      AlulaLink.listen(this);
      new ResizeObserver(() => { if (!this.fixed) soon(this); }).observe(host);
      new IntersectionObserver((e) => { this.inView = e[e.length - 1].isIntersecting; }).observe(host);
    }

    soon() { soon(this); }
    get left() { return LEFT; }
    get right() { return this.width - RIGHT; }

    /* Draw at a fixed width and sharpness with panels of a share of their height (for paper), or
       by the page again with null. */
    fix(size) {
      this.fixed = size;
      this.draw();
    }

    draw() {
      drawn(this);
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
        // a curve alone in its panel is named by the label
        const lines = p.lines.length > 1 ? p.lines.map((l) => [l.style, l.name]) : [];
        p.entries = [...lines, ...p.bands.map((b) => ["band", b.name])];
        p.legend = p.entries.reduce((sum, [, name]) => sum + 32 + c.measureText(name).width, 0);
        p.rows = c.measureText(p.label).width + 50 + p.legend > width - RIGHT ? 2 : 1;
        p.head = y;
        p.top = y + ROW * p.rows + 2;
        p.bottom = p.top + (p.small ? 74 : 130) * (this.fixed ? this.fixed.height : 1);
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
      panel.clipped = panel.limit && this.link.high - this.link.low > 0.1 * (this.link.end - this.link.start);
      if (panel.clipped) return [-panel.limit, panel.limit];
      // A band may widen the axis to three times the curves' range, not flatten them; beside a
      // curve that hardly changes it is shown whole, and the axis keeps numbers that can be read;
      // what differs by less than 1e-9 is rounding, drawn as a level line.
      const least = Math.max(1e-5 * Math.max(Math.abs(low), Math.abs(high)), 1e-9);
      const usual = Math.max(0, ...panel.bands.map((b) => b.usual));
      const room = high - low > 1e-3 * usual ? Math.max(high - low, least) : 2 * usual;
      const short = Math.max(0, least - (high - low)) / 2;
      low -= short; high += short;
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
      const t = ticks(low, high, p.small ? 4 : 5);
      const size = Math.max(Math.abs(low), Math.abs(high));
      const e = size < 0.01 || size >= 1e5 ? 3 * Math.floor((Math.log10(size) + 1) / 3) : 0;
      c.lineWidth = 1;
      c.textBaseline = "middle";
      c.textAlign = "right";
      for (const v of t.values) {
        c.strokeStyle = Math.abs(v) < t.step * 1e-6 ? this.color.axis : this.color.grid;
        line(c, LEFT, crisp(y(v)), right, crisp(y(v)));
        c.fillStyle = this.color.muted;
        // a number at the upper edge would run into the label
        if (y(v) > p.top + 4) c.fillText(format(v / 10 ** e, t.step / 10 ** e), LEFT - 6, y(v));
      }
      c.strokeStyle = this.color.grid;
      for (const v of this.timeTicks().values) line(c, crisp(this.x(v)), p.top, crisp(this.x(v)), p.bottom);
      c.save();
      c.beginPath();
      c.rect(LEFT, p.top, right - LEFT, p.bottom - p.top);
      c.clip();
      for (const b of p.bands) this.drawBand(c, b, y, i, j);
      for (const l of p.lines) this.drawLine(c, l, y, i, j);
      if (p.clipped) this.drawBeyond(c, p, i, j);
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
      let last = -1; // the sample before, -1 where it is missing
      if (j - i <= 2 * (this.width - LEFT - RIGHT)) {
        for (let k = i; k < j; k++) {
          if (!Number.isNaN(lows.v[k])) {
            put(this.x(this.times.at(k)), lows.v[k], highs.v[k], last < 0 || this.times.broken(last, k));
            last = k;
          } else last = -1;
        }
        return;
      }
      for (let x = LEFT - 1, k = i; x <= this.width - RIGHT && k < j; x++) {
        const next = Math.min(j, this.times.index(this.time(x + 1)));
        if (next > k) {
          const a = lows.extremes(k, next)[0], b = highs.extremes(k, next)[1];
          if (a <= b) {
            put(x + 0.5, a, b, last < 0 || this.times.broken(last, k));
            last = next - 1;
          } else last = -1;
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

    /* A mark at the edge where a curve runs beyond the axis. */
    drawBeyond(c, p, i, j) {
      c.fillStyle = this.color.residual;
      for (const l of p.lines) {
        let up = -9, down = -9; // where the last mark stands
        this.walk(i, j, l.y, l.y, (x, a, b) => {
          if (b > p.limit && x - up > 5) triangle(c, up = x, p.top + 1, 5);
          if (a < -p.limit && x - down > 5) triangle(c, down = x, p.bottom - 1, -5);
        });
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
      const first = p === this.panels[0] ? [this.where(k)] : [];
      return [
        ...first,
        ...p.lines.map((l) => `${l.name} ${readable(l.y.v[k])}`),
        ...p.bands.map((b) => `${b.name} ${readable(b.low.v[k])} \u2026 ${readable(b.high.v[k])}`),
      ];
    }

    where(k) {
      const at = format(this.times.at(k), Math.min(0.01, this.times.step));
      return `${this.over.sign} = ${at} ${this.over.unit}`;
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
      for (const v of values) {
        const text = format(v, step), half = c.measureText(text).width / 2;
        c.fillText(text, Math.min(this.x(v), this.width - half - 1), bottom + 4);
      }
      c.textBaseline = "bottom";
      c.fillStyle = this.color.ink;
      c.fillText(this.over.words, (LEFT + this.width - RIGHT) / 2, height - 1);
    }
  }

  /* Half of the values (of a thousand of them) are larger. */
  function median(values) {
    const stride = Math.max(1, Math.floor(values.length / 1000));
    const some = values.filter((v, i) => i % stride === 0 && Number.isFinite(v)).sort();
    return some.length ? some[some.length >> 1] : 0;
  }
  function triangle(c, x, y, height) {
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(x - 3.5, y + height);
    c.lineTo(x + 3.5, y + height);
    c.fill();
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

  return { Plot, redraw: (plots) => plots.forEach(soon) };
})();
