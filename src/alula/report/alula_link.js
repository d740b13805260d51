"use strict";
/* What plots share and how a hand moves them: the time window, the cursor, pointer and keys;
   and the queue in which changed plots are drawn. */
const AlulaLink = (() => {
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
  function drawn(plot) { waiting.delete(plot); }

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
    changed() { for (const plot of this.plots) plot.soon(); }
  }

  /* Pointer, wheel and keys of one plot. */
  function listen(plot) {
    const h = plot.host, link = plot.link;
    const x = (e) => e.clientX - plot.canvas.getBoundingClientRect().left;
    const inside = (v) => Math.min(Math.max(v, plot.left), plot.right);
    h.addEventListener("pointerdown", (e) => {
      if (e.button > 1) return;
      const pan = e.pointerType === "touch" || e.shiftKey || e.button === 1;
      plot.drag = { kind: pan ? "pan" : "zoom", from: inside(x(e)), to: inside(x(e)), at: plot.time(x(e)) };
      h.setPointerCapture(e.pointerId);
      h.focus({ preventScroll: true });
      if (pan) e.preventDefault();
    });
    h.addEventListener("pointermove", (e) => {
      const at = inside(x(e));
      if (plot.drag && plot.drag.kind === "pan") {
        const by = plot.drag.at - plot.time(at);
        link.set(link.low + by, link.high + by);
      } else if (plot.drag) plot.drag.to = at;
      link.point(plot.time(at));
    });
    h.addEventListener("pointerup", () => {
      const d = plot.drag;
      plot.drag = null;
      if (d && d.kind === "zoom" && Math.abs(d.to - d.from) > 4) {
        const a = plot.time(d.from), b = plot.time(d.to);
        link.set(Math.min(a, b), Math.max(a, b));
      } else plot.soon();
    });
    h.addEventListener("pointercancel", () => { plot.drag = null; plot.soon(); });
    h.addEventListener("pointerleave", () => { if (!plot.drag) link.point(null); });
    h.addEventListener("dblclick", () => link.reset());
    // The wheel scrolls the page until the plot is chosen, so that nobody is caught in it.
    h.addEventListener("wheel", (e) => {
      if (!(e.ctrlKey || document.activeElement === h)) return;
      e.preventDefault();
      if (Math.abs(e.deltaX) > Math.abs(e.deltaY)) link.pan(e.deltaX / 1000);
      else link.zoom(Math.exp(Math.sign(e.deltaY) * Math.min(Math.abs(e.deltaY), 120) * 0.002), plot.time(inside(x(e))));
    }, { passive: false });
    h.addEventListener("keydown", (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      const act = {
        ArrowLeft: () => link.pan(-0.1), ArrowRight: () => link.pan(0.1),
        "+": () => link.zoom(0.7), "=": () => link.zoom(0.7), "-": () => link.zoom(1 / 0.7),
        0: () => link.reset(), "[": () => step(plot, -1), "]": () => step(plot, 1),
        Escape: () => link.point(null),
      }[e.key];
      if (!act) return;
      e.preventDefault();
      act();
    });
  }

  /* Move the cursor by samples and say aloud what it reads. */
  function step(plot, by) {
    const { low, high, cursor } = plot.link;
    const from = cursor === null ? plot.times.nearest((low + high) / 2) : plot.times.nearest(cursor) + by;
    const k = Math.min(Math.max(from, 0), plot.times.n - 1);
    plot.link.point(plot.times.at(k));
    if (plot.live) {
      plot.live.textContent = plot.panels.map((p) => `${p.label}: ${plot.values(p, k).join(", ")}`).join("; ");
    }
  }

  return { Link, listen, soon, drawn };
})();
