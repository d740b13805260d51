"use strict";
/* Samples over time and round numbers, for alula_plot.js: a curve with an index of its extremes, its
   times, the ticks of an axis and numbers as text. */
const AlulaSeries = (() => {
  const BLOCK = 64;

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

  /* Times of samples, increasing. breaks: the samples before which there is a gap, so no line leads
     there; where they are not given, those after a step over three times the median. */
  class Times {
    static uniform(start, step, n) {
      const t = new Times();
      Object.assign(t, { start, step, n, array: null, breaks: [] });
      return t;
    }
    static of(array, breaks = null) {
      const t = new Times(), n = array.length, steps = [];
      const stride = Math.max(1, Math.floor(n / 1000));
      for (let i = 1; i < n; i += stride) steps.push(array[i] - array[i - 1]);
      steps.sort((a, b) => a - b);
      const step = steps[steps.length >> 1] || 1;
      if (!breaks) {
        breaks = [];
        for (let i = 1; i < n; i++) if (array[i] - array[i - 1] > 3.03 * step) breaks.push(i);
      }
      Object.assign(t, { start: array[0], step, n, array, breaks });
      return t;
    }
    /* Is there a gap between samples i and j > i? */
    broken(i, j) {
      let a = 0, b = this.breaks.length;
      while (a < b) {
        const k = (a + b) >> 1;
        if (this.breaks[k] <= i) a = k + 1; else b = k;
      }
      return a < this.breaks.length && this.breaks[a] <= j;
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

  /* Round numbers from low to high, `count` or somewhat fewer or more, at least two. */
  function ticks(low, high, count) {
    const rough = (high - low) / Math.max(count, 1);
    const ten = 10 ** Math.floor(Math.log10(rough));
    let step = [1, 2, 5, 10].map((m) => m * ten).find((s) => s >= rough * 0.75) || ten;
    while (Math.floor(high / step) - Math.ceil(low / step) < 1) step /= Math.round(step / 10 ** Math.floor(Math.log10(step) + 1e-9)) === 5 ? 2.5 : 2;
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

  return { Samples, Times, ticks, format, readable, superscript };
})();
