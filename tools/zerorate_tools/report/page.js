"use strict";
(() => {
  const root = document.documentElement;
  const screenIsWide = matchMedia("(min-width: 760px)");
  const onPaper = () => root.dataset.paper !== undefined;
  const wide = () => onPaper() || screenIsWide.matches;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const touch = matchMedia("(pointer: coarse)").matches;
  const plots = JSON.parse(document.getElementById("plots").textContent);
  const css = (name) => getComputedStyle(root).getPropertyValue(name).trim();
  const colour = (role) => css("--role-" + role);

  const suffix = (panel) => (panel ? String(panel + 1) : "");

  function look(series, faded) {
    const own = colour(series.role);
    const mode = { line: "lines", points: "markers", both: "lines+markers" }[series.mark];
    if (series.mark === "bars") return { type: "bar", width: series.width, textposition: "none", marker: { color: own } };
    return {
      type: "scatter", mode, connectgaps: false,
      line: { color: own, width: 1.8, dash: series.dash },
      marker: {
        color: own, size: series.size, symbol: series.symbol, opacity: faded ? 0.55 : 0.9,
        line: series.symbol === "line-ns" ? { color: own, width: 3 } : { width: 0 },
      },
    };
  }

  function trace(plot, series, state) {
    const panel = plot.panels[series.panel];
    const unit = panel.y_unit ? " " + panel.y_unit : "";
    const hidden = state.hidden.has(series.name);
    const shown = !series.views.length || series.views.includes(state.view);
    const values = panel.y_names.length ? "%{x:.3~f} " + panel.x_label : "%{y:.4~g}" + unit + "<br>%{x:.4~g} · " + panel.x_label;
    return {
      ...look(series, series.x.length > 60), x: series.x, y: series.y, name: series.name,
      xaxis: "x" + suffix(series.panel), yaxis: "y" + suffix(series.panel),
      visible: shown && !hidden, showlegend: false, text: series.words,
      hovertemplate: series.name + "<br>" + (series.words ? "%{text}<br>" : "") + values + "<extra></extra>",
    };
  }

  // Where each panel stands, in shares of the drawing: rows, or columns where there is room.
  function places(plot, width, height) {
    const rows = plot.stacked || !wide();
    const gap = rows ? (plot.stacked ? 26 : 62) : 58;
    const room = (rows ? height : width) - gap * (plot.panels.length - 1);
    const whole = plot.panels.reduce((sum, panel) => sum + (plot.stacked ? panel.share : 1), 0);
    const out = [];
    let at = 0;
    for (const panel of plot.panels) {
      const size = (room * (plot.stacked ? panel.share : 1)) / whole;
      const from = at / (rows ? height : width);
      const to = (at + size) / (rows ? height : width);
      out.push(rows ? { x: [0, 1], y: [Math.max(0, 1 - to), 1 - from] } : { x: [from, Math.min(1, to)], y: [0, 1] });
      at += size + gap;
    }
    return out;
  }

  // Labels of a logarithmic axis: every decade, or some of each where there are hardly two.
  function marks(plot, number, letter) {
    const drawn = plot.series.filter((s) => s.panel === number).flatMap((s) => s[letter]);
    const across = plot.panels[number].lines.filter((line) => line.axis === letter).map((line) => line.value);
    const values = [...drawn, ...across].filter((v) => v > 0);
    const least = Math.min(...values), times = Math.max(...values) / least;
    if (times > 40) return { dtick: 1 };
    const close = [1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.5, 2.8, 3.2, 3.6, 4, 4.5, 5, 5.5, 6, 7, 8, 9];
    const of = times > 6 ? [1, 2, 5] : times > 2.5 ? [1, 1.5, 2, 3, 5, 7] : close;
    const first = Math.floor(Math.log10(least)) - 1;
    const at = [...Array(5).keys()].flatMap((k) => of.map((n) => Number(n + "e" + (first + k))));
    return { tickvals: at, ticktext: at.map(String) };
  }

  function axes(plot, panel, number, place, layout) {
    const last = number === plot.panels.length - 1;
    const named = panel.y_names.length > 0;
    const common = {
      gridcolor: css("--rule"), zeroline: false, automargin: false, type: panel.log ? "log" : "linear",
      tickfont: { size: 11, color: css("--muted") }, nticks: panel.log ? undefined : 6, ticks: "",
    };
    layout["xaxis" + suffix(number)] = {
      ...common, ...(panel.log ? marks(plot, number, "x") : {}), domain: place.x, anchor: "y" + suffix(number), range: panel.x_range || undefined,
      matches: plot.stacked && number ? "x" : undefined, showticklabels: !plot.stacked || last,
      title: (plot.stacked || !wide()) && !last ? undefined : { text: wide() ? panel.x_label : panel.x_narrow, font: { size: 12, color: css("--muted") }, standoff: 6 },
    };
    layout["yaxis" + suffix(number)] = {
      ...common, ...(panel.log ? marks(plot, number, "y") : {}), domain: place.y, anchor: "x" + suffix(number), range: panel.y_range || undefined, nticks: panel.log ? undefined : 5,
      ...(named ? { tickvals: panel.y_names.map((_, i) => -i), ticktext: panel.y_names, showgrid: false, range: [0.6 - panel.y_names.length, 0.5] } : {}),
    };
    layout.annotations.push({
      text: panel.title, xref: "paper", yref: "paper", x: place.x[0], y: place.y[1], xanchor: "left", yanchor: "bottom",
      showarrow: false, font: { size: 12, color: css("--text") },
    });
  }

  const LETTER_PX = 8; // of the names of lines, with the room between two of them

  function across(line, number, panel, layout) {
    const own = { color: colour(line.role), width: line.text ? 1.6 : 1, dash: line.dash };
    const x = "x" + suffix(number), y = "y" + suffix(number);
    const flat = line.axis === "y";
    layout.shapes.push({
      type: "line", layer: line.text ? "above" : "below", line: own,
      xref: flat ? x + " domain" : x, yref: flat ? y : y + " domain",
      x0: flat ? 0 : line.value, x1: flat ? 1 : line.value, y0: flat ? line.value : 0, y1: flat ? line.value : 1,
    });
    if (!line.text) return;
    // upright where the lines are closer than their names are long
    const named = panel.lines.filter((one) => one.text && one.axis !== "y").length;
    const fits = (named + 1) * line.text.length * LETTER_PX < layout.width;
    layout.annotations.push({
      text: line.text, showarrow: false, font: { size: 11, color: own.color },
      textangle: flat || fits ? 0 : -90,
      xref: flat ? x + " domain" : x, yref: flat ? y : y + " domain", xanchor: flat ? "right" : "left", yanchor: flat ? "bottom" : "top",
      x: flat ? 1 : line.value, y: flat ? (panel.log ? Math.log10(line.value) : line.value) : 1,
    });
  }

  function layoutOf(plot, box) {
    const margin = { l: plot.panels[0].y_names.length ? 64 : 46, r: 14, t: plot.panels[0].title ? 28 : 8, b: 44 };
    const layout = {
      margin, annotations: [], shapes: [], showlegend: false, uirevision: "kept", bargap: 0,
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", hovermode: "closest",
      dragmode: touch ? false : "zoom", width: box.clientWidth, height: box.clientHeight,
      font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: css("--text") },
      hoverlabel: { bgcolor: css("--panel"), bordercolor: css("--rule"), font: { color: css("--text"), size: 12 }, align: "left" },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: css("--muted"), activecolor: css("--text") },
    };
    const where = places(plot, box.clientWidth - margin.l - margin.r, box.clientHeight - margin.t - margin.b);
    plot.panels.forEach((panel, number) => {
      axes(plot, panel, number, where[number], layout);
      panel.lines.forEach((line) => across(line, number, panel, layout));
    });
    return layout;
  }

  const config = (plot) => ({
    displaylogo: false, displayModeBar: plot.panels[0].y_names.length ? false : touch ? true : "hover", doubleClickDelay: 400,
    modeBarButtons: [["zoom2d", "pan2d", "resetScale2d", "toImage"]],
    toImageButtonOptions: { filename: "zerorate-" + plot.key, scale: 2 },
  });

  function ready(plot) {
    const figure = document.getElementById("figure-" + plot.key);
    const box = document.getElementById("plot-" + plot.key);
    const state = { hidden: new Set(), view: plot.views[0] };
    const draw = () => Plotly.react(box, plot.series.map((s) => trace(plot, s, state)), layoutOf(plot, box), config(plot));
    figure.querySelectorAll("[data-name]").forEach((button, at) => button.addEventListener("click", () => {
      const name = names(plot)[at];
      state.hidden.has(name) ? state.hidden.delete(name) : state.hidden.add(name);
      button.setAttribute("aria-pressed", String(!state.hidden.has(name)));
      draw();
    }));
    const views = figure.querySelectorAll("[data-view]");
    views.forEach((button, at) => button.addEventListener("click", () => {
      state.view = plot.views[at];
      views.forEach((other) => other.setAttribute("aria-pressed", String(other === button)));
      draw();
    }));
    slide(plot, figure, draw);
    return draw;
  }

  const names = (plot) => [...new Set(plot.series.map((s) => s.name))];

  function slide(plot, figure, draw) {
    const input = figure.querySelector("input[type=range]");
    if (!input) return;
    const said = figure.querySelector("output bdi");
    input.addEventListener("input", () => {
      const [label, values] = plot.frames[Number(input.value)];
      said.textContent = label;
      for (const [at, own] of Object.entries(values)) Object.assign(plot.series[at], own);
      draw();
    });
  }

  const drawn = plots.map(ready);
  const all = () => drawn.forEach((draw) => draw());

  const button = document.getElementById("theme");
  const isDark = () => (root.dataset.theme || (dark.matches ? "dark" : "light")) === "dark";
  const say = () => {
    button.textContent = isDark() ? "Light" : "Dark";
    button.setAttribute("aria-pressed", String(isDark()));
  };
  button.hidden = false;
  say();
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    say();
    all();
  });
  dark.addEventListener("change", () => { say(); all(); });

  // A page that is printed has the paper's width and is light; afterwards it is what it was.
  let theme;
  const toPaper = () => {
    if (onPaper()) return;
    theme = root.dataset.theme;
    root.dataset.theme = "light";
    root.dataset.paper = "";
    all();
  };
  const toScreen = () => {
    if (!onPaper()) return;
    delete root.dataset.paper;
    delete root.dataset.theme;
    if (theme) root.dataset.theme = theme;
    all();
  };
  addEventListener("beforeprint", toPaper);
  addEventListener("afterprint", toScreen);
  matchMedia("print").addEventListener("change", (print) => (print.matches ? toPaper() : toScreen()));

  let waiting = 0;
  let width = innerWidth;
  addEventListener("resize", () => {
    if (innerWidth === width) return;
    width = innerWidth;
    clearTimeout(waiting);
    waiting = setTimeout(all, 120);
  });

  // One at a time, so that the text can be read and scrolled while they are drawn.
  (async () => {
    for (const draw of drawn) {
      await new Promise((next) => setTimeout(next));
      await draw();
    }
    root.dataset.drawn = "all";
  })();
})();
