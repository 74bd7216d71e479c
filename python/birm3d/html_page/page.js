"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const colors = ["#0072B2", "#E69F00", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#000000", "#7F7F7F"];
const dashes = ["solid", "dash", "dashdot", "dot", "solid", "dash", "solid", "dash"];
// Earlier curves are wider: where a later one lies on them, they show.
const widths = [3, 2, 1.6, 1.8, 1.4, 1.4, 1.2, 1.2];
const config = { responsive: true, displayModeBar: false };
const narrow = globalThis.innerWidth < 600;
const font = { family: "system-ui, sans-serif", size: 12 };
const axis = { gridcolor: "#e6e6e6", zerolinecolor: "#bbbbbb" };

// Histories: one panel each; zooming one in time zooms all.
const panels = data.panels.map(() => {
  const div = document.createElement("div");
  div.className = "panel";
  document.getElementById("panels").appendChild(div);
  return div;
});
data.panels.forEach((panel, n) => {
  const div = panels[n];
  const curves = panel.curves.map((curve, i) => ({
    x: data.time,
    y: curve.y,
    name: curve.name,
    mode: "lines",
    visible: curve.name.endsWith("unfiltered") ? "legendonly" : true,
    line: {
      color: curve.color ?? colors[i % colors.length],
      dash: curve.dash ?? dashes[i % dashes.length],
      width: widths[i % widths.length],
    },
  }));
  Plotly.newPlot(div, curves, {
    title: { text: panel.cut ? `${panel.title} (${panel.cut})` : panel.title, font: { size: 14 } },
    font,
    margin: narrow ? { l: 50, r: 6, t: 32, b: 84 } : { l: 62, r: 12, t: 36, b: 76 },
    hovermode: "x unified",
    showlegend: true,
    legend: { orientation: "h", y: -0.26, font: { size: 11 } },
    xaxis: { ...axis, title: { text: "time [ms]", standoff: 4 }, range: [data.time[0], data.time.at(-1)] },
    yaxis: { ...axis, title: { text: `[${panel.unit}]` }, ...(panel.range && { range: panel.range }) },
  }, config);
});
let following = false;
for (const div of panels) {
  div.on("plotly_relayout", (change) => {
    const range = change["xaxis.autorange"] ? [data.time[0], data.time.at(-1)]
      : [change["xaxis.range[0]"], change["xaxis.range[1]"]];
    if (following || range[0] === undefined) return;
    following = true;
    Promise.all(panels.map((other) => Plotly.relayout(other, { "xaxis.range": range })))
      .finally(() => { following = false; });
  });
}

// Plan view: barrier, paths, outlines of the units at the time of the slider.
const plan = data.plan;
const plot = document.getElementById("plan");
const joined = (polygons, i) => polygons.flatMap((p) => [...p[i], null]);
const shapes = plan.barrier.map((faces) => ({
  x: joined(faces, 0), y: joined(faces, 1), name: "barrier", mode: "lines", fill: "toself",
  fillcolor: "#b9b4aa", line: { color: "#b9b4aa", width: 1 }, hoverinfo: "skip", showlegend: false,
}));
const paths = plan.paths.map((path, unit) => ({
  x: path[0], y: path[1], name: "path of the mass centre", mode: "lines",
  line: { color: "#000000", width: 1 }, showlegend: unit === 0,
}));
const first = plan.outlines[0].map((polygon, unit) => ({
  x: polygon[0], y: polygon[1], name: "at t = 0", mode: "lines", hoverinfo: "skip",
  line: { color: "#7F7F7F", width: 1, dash: "dot" }, showlegend: unit === 0,
}));
const outlines = plan.outlines[0].map((polygon, unit) => ({
  x: polygon[0], y: polygon[1], name: "vehicle", mode: "lines", fill: "toself",
  fillcolor: "rgba(0,114,178,0.25)", line: { color: "#0072B2", width: 2 }, showlegend: unit === 0,
}));
const centers = plan.paths.map((path, unit) => ({
  x: [path[0][0]], y: [path[1][0]], name: "mass centre", mode: "markers",
  marker: { color: "#D55E00", size: 8 }, showlegend: unit === 0,
}));
const still = shapes.length + paths.length + first.length;
Plotly.newPlot(plot, [...shapes, ...paths, ...first, ...outlines, ...centers], {
  font,
  margin: narrow ? { l: 50, r: 6, t: 8, b: 96 } : { l: 62, r: 12, t: 12, b: 80 },
  legend: { orientation: "h", y: -0.16 },
  xaxis: { ...axis, title: { text: plan.labels[0], standoff: 4 }, range: plan.range[0] },
  yaxis: { ...axis, title: { text: plan.labels[1] }, range: plan.range[1], scaleanchor: "x" },
}, config);

const replay = replayPanel(document.getElementById("replay"), data.replay);
const slider = document.getElementById("slider");
const now = document.getElementById("now");
slider.max = plan.time.length - 1;
function move() {
  const k = Number(slider.value);
  const t = plan.time[k];
  now.value = `${t.toFixed(1)} ms`;
  const x = [...plan.outlines[k].map((p) => p[0]), ...plan.paths.map((p) => [p[0][k]])];
  const y = [...plan.outlines[k].map((p) => p[1]), ...plan.paths.map((p) => [p[1][k]])];
  Plotly.restyle(plot, { x, y }, x.map((_, i) => still + i));
  const line = { type: "line", x0: t, x1: t, yref: "paper", y0: 0, y1: 1, line: { color: "#7F7F7F", width: 1 } };
  for (const div of panels) Plotly.relayout(div, { shapes: [line] });
  replay.show(t);
}
slider.addEventListener("input", move);
move();

const play = document.getElementById("play");
let timer = null;
play.addEventListener("click", () => {
  if (timer !== null) {
    clearInterval(timer);
    timer = null;
    play.textContent = "Play";
    return;
  }
  play.textContent = "Stop";
  timer = setInterval(() => {
    slider.value = (Number(slider.value) + 1) % plan.time.length;
    move();
  }, 100);
});
