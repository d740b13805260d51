"use strict";
/* Brings the report's page to life: plots, light and dark, paper. */
(() => {
  const root = document.documentElement;
  const data = JSON.parse(document.getElementById("alula-plots").textContent);
  const bytes = (id) => Uint8Array.from(atob(data.arrays[id]), (c) => c.charCodeAt(0)).buffer;
  const decoded = new Map();
  /* float32 by name; [lowest, step, name] of whole numbers of 16 bits, 65535 where there is none. */
  const values = (id) => {
    if (id === undefined) return null;
    const key = String(id);
    if (!decoded.has(key)) {
      decoded.set(key, Array.isArray(id)
        ? Float32Array.from(new Uint16Array(bytes(id[2])), (k) => k === 65535 ? NaN : id[0] + id[1] * k)
        : new Float32Array(bytes(id)));
    }
    return decoded.get(key);
  };
  /* What was kept of even times, by the steps from sample to sample. */
  const kept = (t) => {
    let k = 0;
    return Float64Array.from(new Uint16Array(bytes(t.jumps)), (jump) => t.start + t.step * (k += jump));
  };
  const times = (t) => "jumps" in t ? AlulaSeries.Times.of(kept(t), t.breaks)
    : "y" in t ? AlulaSeries.Times.of(new Float64Array(bytes(t.y)), t.breaks)
    : AlulaSeries.Times.uniform(t.start, t.step, t.n);
  const links = new Map();
  const link = (group) => {
    if (!links.has(group)) links.set(group, new AlulaLink.Link());
    return links.get(group);
  };

  const plots = [...document.querySelectorAll("[data-plot]")].map((host) => {
    const figure = data.figures[Number(host.dataset.plot)];
    const panels = figure.panels.map((p) => ({
      ...p,
      lines: p.lines.map((l) => ({ ...l, y: values(l.y) })),
      bands: (p.bands || []).map((b) => ({ ...b, half: values(b.half), center: values(b.center) })),
    }));
    return new AlulaPlot.Plot(host, { over: figure.over, panels }, times(figure.t), link(figure.group));
  });
  for (const l of links.values()) l.changed();

  const dark = matchMedia("(prefers-color-scheme: dark)");
  const button = document.getElementById("theme");
  const isDark = () => root.dataset.theme ? root.dataset.theme === "dark" : dark.matches;
  const show = () => {
    button.textContent = isDark() ? "Light page" : "Dark page";
    AlulaPlot.redraw(plots);
  };
  button.hidden = false;
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    show();
  });
  dark.addEventListener("change", show);
  show();

  // On paper: light, sharp, and as zoomed as they are now.
  let before = null;
  addEventListener("beforeprint", () => {
    before = root.dataset.theme || "";
    root.dataset.theme = "light";
    for (const d of document.querySelectorAll("details:not([open])")) {
      d.open = true;
      d.dataset.shut = "";
    }
    for (const plot of plots) plot.fix({ width: 350, scale: 3, height: 0.8 });
  });
  addEventListener("afterprint", () => {
    if (before) root.dataset.theme = before; else delete root.dataset.theme;
    for (const d of document.querySelectorAll("details[data-shut]")) {
      d.open = false;
      delete d.dataset.shut;
    }
    for (const plot of plots) plot.fix(null);
  });
})();
