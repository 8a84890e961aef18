// The hemisphere of reflected directions: measured, fitted and their difference, in Lambert's equal-area projection.

import { Delaunay } from "d3-delaunay";

import { report, floats, series, residuals, residualText, residualIsPart, quantile, roundedUp } from "./data.js";
import { choice, el, section, whenSeen } from "./dom.js";
import { channelChoice } from "./curves.js";
import { angle, incidence, number, percent, residualTick, tick } from "./format.js";
import { diverging, draw, ink, sequential } from "./plotting.js";
import { choose, nearest, onChoice, state } from "./state.js";

const { panels, available, note } = report.plots.maps;
const cells = 220; // a side of the raster
const decades = 4; // of the logarithmic colour scale, at most

// The horizon lies at 1. Seen from above, forward to the right, azimuths counter-clockwise.
const mapRadius = (thetaDeg) => Math.SQRT2 * Math.sin((thetaDeg * Math.PI) / 360);
function mapPoint(thetaDeg, phiDeg) {
  const r = mapRadius(thetaDeg);
  return [-r * Math.cos((phiDeg * Math.PI) / 180), -r * Math.sin((phiDeg * Math.PI) / 180)];
}

const geometry = new Map();
/// Which reading each cell of the raster is nearest to; -1 beyond the horizon and where no reading is near.
function geometryOf(p) {
  if (geometry.has(p)) return geometry.get(p);
  const theta = floats(panels[p].theta_r);
  const phi = floats(panels[p].phi);
  const points = Array.from(theta, (t, i) => mapPoint(t, phi[i]));
  const delaunay = Delaunay.from(points);
  // Readings are apart by about the root of the area that each has; further off there is a gap in the scan.
  const reach = 1.6 * Math.sqrt(Math.PI / points.length);
  const nearest = new Int32Array(cells * cells).fill(-1);
  let at = 0;
  for (let row = 0; row < cells; row++) {
    for (let column = 0; column < cells; column++) {
      const x = (2 * (column + 0.5)) / cells - 1;
      const y = (2 * (row + 0.5)) / cells - 1;
      if (x * x + y * y > 1.03) continue;
      at = delaunay.find(x, y, at);
      if (Math.hypot(points[at][0] - x, points[at][1] - y) < reach) nearest[row * cells + column] = at;
    }
  }
  const result = { theta, phi, points, nearest };
  geometry.set(p, result);
  return result;
}

const raster = (nearest, value) =>
  Array.from({ length: cells }, (_, row) =>
    Array.from({ length: cells }, (_, column) => {
      const i = nearest[row * cells + column];
      return i < 0 ? null : value(i);
    }),
  );

const centres = Array.from({ length: cells }, (_, i) => (2 * (i + 0.5)) / cells - 1);

const circle = (r, line) => ({ type: "circle", x0: -r, x1: r, y0: -r, y1: r, line, layer: "above" });
// A ring of white hides the stairs that the raster makes of the horizon.
const path = (r) => Array.from({ length: 181 }, (_, i) => {
  const t = (i * Math.PI) / 90;
  return `${i ? "L" : "M"}${(r * Math.cos(t)).toFixed(4)},${(r * Math.sin(t)).toFixed(4)}`;
}).join("") + "Z";
const rings = [
  { type: "path", path: path(1) + path(1.04), fillcolor: "#fff", fillrule: "evenodd", line: { width: 0 }, layer: "above" },
  circle(1, { color: ink.faint, width: 1.2 }),
  ...[30, 60].map((t) => circle(mapRadius(t), { color: "rgba(128,128,128,0.55)", width: 0.8, dash: "dot" })),
];

const hidden = { visible: false, range: [-1.06, 1.06], fixedrange: true };

/// A colour scale with its ticks, each {at: 0 … 1, text}.
function scaleBar(title, colors, ticks) {
  const stops = colors.map(([at, color]) => `${color} ${100 * at}%`).join(", ");
  return [
    el("div", { class: "gradient", style: `background: linear-gradient(to right, ${stops})` }),
    el("div", { class: "ticks" }, ticks.map(({ at, text }) => el("span", { style: `left: ${(100 * at).toFixed(2)}%` }, text))),
    el("div", { class: "unit" }, title),
  ];
}

function marks(p) {
  const [mx, my] = mapPoint((panels[p].theta_i + panels[p].theta_i_high) / 2, 180);
  const mark = (x, y, symbol, color, width) => ({
    x: [x], y: [y], mode: "markers", showlegend: false, hoverinfo: "skip",
    marker: { symbol, size: 11, color, line: { color, width } },
  });
  // Black on white, to be seen on any colour.
  return [["#fff", 3.4], ["#000", 1.4]].flatMap(([color, width]) => [
    mark(mx, my, "x-thin", color, width), mark(-mx, my, "circle-open", color, width)]);
}

function drawMap(node, p, z, colors, more = []) {
  return draw(
    node,
    [{ type: "heatmap", x: centres, y: centres, z, hoverinfo: "none", ...colors }, ...more, ...marks(p)],
    {
      xaxis: hidden,
      yaxis: { ...hidden, scaleanchor: "x" },
      shapes: rings,
      margin: { l: 2, r: 2, t: 2, b: 2 },
      dragmode: false,
      annotations: [30, 60].map((t) => ({
        x: 0, y: mapRadius(t), text: `${t}°`, showarrow: false, yshift: 7, font: { size: 10, color: ink.text },
        bgcolor: "rgba(255,255,255,0.6)", borderpad: 1,
      })),
    },
  );
}

/// The common scale of measured and fitted.
function valueScale(values, log) {
  const all = [...values.measured, ...values.fitted];
  const top = all.reduce((a, b) => Math.max(a, b), 0) || 1;
  const of = log ? (f) => Math.log10(Math.max(f, low)) : (f) => f;
  const low = log
    ? Math.max(quantile(all.filter((f) => f > 0), 0.02), top / 10 ** decades)
    : Math.min(0, quantile(values.measured, 0.01));
  const [zmin, zmax] = [of(low), of(top)];
  return { of, zmin, zmax, ticks: valueTicks(low, top, log).map((v) => ({ at: (of(v) - zmin) / (zmax - zmin), text: tick(v) })) };
}

/// Round numbers between two values; of several decades powers of ten alone.
function valueTicks(low, top, log) {
  const first = Math.floor(Math.log10(Math.max(log ? low : top / 100, 1e-300)));
  const last = Math.ceil(Math.log10(top));
  if (!log) {
    const step = roundedUp(top / 5);
    return Array.from({ length: 6 }, (_, i) => i * step).filter((v) => v <= top);
  }
  const mantissas = last - first > 3 ? [1] : last - first > 2 ? [1, 3] : [1, 2, 5];
  const ticks = [];
  for (let e = first; e <= last; e++) ticks.push(...mantissas.map((m) => m * 10 ** e));
  return ticks.filter((v) => v >= low && v <= top);
}

function differenceScale(values) {
  const sizes = Array.from(values, Math.abs);
  const end = roundedUp(quantile(sizes, 0.98) || 1);
  return residualIsPart ? Math.min(end, 1) : end;
}

export function mapsSection() {
  const title = "Over the hemisphere";
  if (!available) {
    return section("maps", title, el("p", {},
      "The scan lies in or near the plane of incidence, so there is no hemisphere to map: the curves above show all of it."));
  }
  const nodes = ["Measured", "Fitted", "Difference"].map((name) =>
    el("figure", { class: "map" }, el("figcaption", {}, name),
      el("div", { class: "plot", role: "img", "aria-label": `${name}, map of the hemisphere` })));
  const [measuredNode, fittedNode, differenceNode] = nodes.map((node) => node.lastChild);
  const commonBar = el("div", { class: "bar common" });
  const differenceBar = el("div", { class: "bar" });
  const readout = el("p", { class: "readout", "aria-live": "polite" }, "Point at a map to read it.");
  let log = state.scale === "log";
  let current = null;

  const redraw = () => {
    const p = state.panel;
    const values = series(panels[p].channels[state.channel]);
    const off = residuals(values);
    const place = geometryOf(p);
    current = { ...place, ...values, off };
    const scale = valueScale(values, log);
    const colors = { zmin: scale.zmin, zmax: scale.zmax, colorscale: sequential, showscale: false };
    drawMap(measuredNode, p, raster(place.nearest, (i) => scale.of(values.measured[i])), colors);
    drawMap(fittedNode, p, raster(place.nearest, (i) => scale.of(values.fitted[i])), colors);
    commonBar.replaceChildren(...scaleBar("BRDF / sr⁻¹, measured and fitted alike", sequential, scale.ticks));
    const end = differenceScale(off);
    const below = place.points.filter((_, i) => off[i] < 0);
    drawMap(differenceNode, p, raster(place.nearest, (i) => Math.max(-end, Math.min(end, off[i]))),
      { zmin: -end, zmax: end, colorscale: diverging, showscale: false },
      [{
        x: below.map((q) => q[0]), y: below.map((q) => q[1]), mode: "markers", hoverinfo: "skip", showlegend: false,
        marker: { size: below.length > 600 ? 1.6 : 2.4, color: "rgba(20,30,40,0.75)" },
      }]);
    differenceBar.replaceChildren(...scaleBar(residualText, diverging, [-1, -0.5, 0, 0.5, 1].map((part) => ({
      at: (part + 1) / 2,
      text: residualTick(part * end),
    }))));
  };

  const read = (event) => {
    const at = event.points?.[0];
    if (!at || at.x === undefined || !current) return;
    const column = Math.floor(((at.x + 1) / 2) * cells);
    const row = Math.floor(((at.y + 1) / 2) * cells);
    const i = current.nearest[row * cells + column];
    if (!(i >= 0)) return;
    const off = residualIsPart ? percent(current.off[i]) : `${number(current.off[i], 2)} u`;
    readout.textContent =
      `θᵣ ${angle(current.theta[i])}°, φᵣ − φᵢ ${angle(current.phi[i])}°: measured ${number(current.measured[i])}, ` +
      `fitted ${number(current.fitted[i])} sr⁻¹, difference ${off}`;
  };

  const incidenceNode = panelChoice("maps-incidence");
  const controls = el("div", { class: "controls" }, channelChoice("maps-channel"), incidenceNode,
    choice("Colours", "maps-scale", [{ value: "linear", text: "Linear" }, { value: "log", text: "Logarithmic" }],
      log ? "log" : "linear", (value) => {
        log = value === "log";
        redraw();
      }));
  const grid = el("div", { class: "maps" }, nodes[0], nodes[1], commonBar, nodes[2], differenceBar);
  const refresh = whenSeen(grid, () => {
    const first = current === null;
    redraw();
    if (first) for (const node of [measuredNode, fittedNode, differenceNode]) node.on("plotly_hover", read);
  });
  onChoice(refresh);
  return section("maps", title, controls, grid, readout,
    el("p", { class: "caption" },
      "Seen from above, forward to the right, in Lambert’s equal-area projection; rings at θᵣ = 30° and 60°. ",
      "Each cell is one reading, white where the scan has none near. ✕ is the mirror direction, ○ the light’s. ",
      "Dots mark readings below the fit.", note ? ` Shown: ${note}.` : ""));
}

/// A choice of the incidence angle, common to maps and lobes.
export function panelChoice(name, indices = panels.map((_, i) => i)) {
  if (indices.length < 2) return null;
  const shown = () => String(indices[nearest(indices, state.panel)]);
  const node = choice("Incidence", name,
    indices.map((i) => ({ value: String(i), text: `θᵢ = ${incidence(panels[i])}` })),
    shown(), (value) => choose({ panel: Number(value) }));
  onChoice((change) => "panel" in change && node.set(shown()));
  return node;
}
