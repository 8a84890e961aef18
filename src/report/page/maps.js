// The hemisphere of reflected directions: measured, fitted and their difference, in Lambert's equal-area projection.

import { Delaunay } from "d3-delaunay";

import { report, floats, series, residuals, residualText, residualIsPart, quantile, roundedUp } from "./data.js";
import { choice, el, section, whenSeen } from "./dom.js";
import { channelChoice } from "./curves.js";
import { angle, incidence, number, percent, superscript } from "./format.js";
import { diverging, draw, ink, sequential } from "./plotting.js";
import { choose, onChoice, state } from "./state.js";

const { panels, available, note } = report.plots.maps;
const cells = 180; // a side of the raster
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
      if (x * x + y * y > 1) continue;
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
const rings = [
  circle(1, { color: ink.faint, width: 1.2 }),
  ...[30, 60].map((t) => circle(mapRadius(t), { color: "rgba(128,128,128,0.55)", width: 0.8, dash: "dot" })),
];

const hidden = { visible: false, range: [-1.1, 1.1], fixedrange: true };
const bar = (title, more) => ({
  orientation: "h", thickness: 10, len: 0.86, y: -0.02, yanchor: "top", outlinewidth: 0, ticks: "outside", ticklen: 3,
  tickfont: { size: 11 }, title: { text: title, side: "bottom", font: { size: 12 } }, ...more,
});

function marks(p) {
  const [mx, my] = mapPoint(panels[p].theta_i, 180);
  const mark = (x, y, symbol, name) => ({
    x: [x], y: [y], mode: "markers", showlegend: false, hoverinfo: "skip", name,
    marker: { symbol, size: 11, color: "rgba(0,0,0,0)", line: { color: "#fff", width: 3.2 } },
  });
  const over = (trace) => ({ ...trace, marker: { ...trace.marker, line: { color: "#000", width: 1.3 } } });
  const both = [mark(mx, my, "cross-thin", "mirror"), mark(-mx, my, "circle-open", "light")];
  return both.flatMap((trace) => [trace, over(trace)]);
}

function drawMap(node, p, z, colors, more = []) {
  return draw(
    node,
    [{ type: "heatmap", x: centres, y: centres, z, hoverinfo: "none", zsmooth: false, ...colors }, ...more, ...marks(p)],
    {
      xaxis: hidden,
      yaxis: { ...hidden, scaleanchor: "x" },
      shapes: rings,
      margin: { l: 4, r: 4, t: 4, b: 58 },
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
  if (!log) return { of: (f) => f, zmin: Math.min(0, quantile(values.measured, 0.01)), zmax: top, bar: bar("sr⁻¹", { nticks: 5 }) };
  const low = Math.max(quantile(all.filter((f) => f > 0), 0.02), top / 10 ** decades);
  const ticks = [];
  for (let e = Math.ceil(Math.log10(low)); e <= Math.log10(top); e++) ticks.push(e);
  const fine = ticks.length > 1;
  const values125 = [1, 2, 5].flatMap((m) => [-1, 0].map((d) => m * 10 ** (Math.floor(Math.log10(top)) + d)));
  const shown = fine ? ticks.map((e) => 10 ** e) : values125.filter((v) => v >= low && v <= top);
  return {
    of: (f) => Math.log10(Math.max(f, low)),
    zmin: Math.log10(low),
    zmax: Math.log10(top),
    bar: bar("sr⁻¹", {
      tickvals: shown.map(Math.log10),
      ticktext: shown.map((v, i) => (fine ? `10${superscript(ticks[i])}` : number(v, 1))),
    }),
  };
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
    const colors = { zmin: scale.zmin, zmax: scale.zmax, colorscale: sequential, colorbar: scale.bar };
    drawMap(measuredNode, p, raster(place.nearest, (i) => scale.of(values.measured[i])), colors);
    drawMap(fittedNode, p, raster(place.nearest, (i) => scale.of(values.fitted[i])), colors);
    const end = differenceScale(off);
    const below = place.points.filter((_, i) => off[i] < 0);
    drawMap(differenceNode, p, raster(place.nearest, (i) => Math.max(-end, Math.min(end, off[i]))), {
      zmin: -end, zmax: end, colorscale: diverging,
      colorbar: bar(residualIsPart ? "of the larger" : "in units of u", {
        tickvals: [-end, -end / 2, 0, end / 2, end],
        ticktext: [-end, -end / 2, 0, end / 2, end].map((v) => (v > 0 ? "+" : "") + (residualIsPart ? percent(v) : number(v, 2))),
      }),
    }, [{
      x: below.map((q) => q[0]), y: below.map((q) => q[1]), mode: "markers", hoverinfo: "skip", showlegend: false,
      marker: { size: below.length > 600 ? 1.6 : 2.4, color: "rgba(20,30,40,0.75)" },
    }]);
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
  const grid = el("div", { class: "maps" }, nodes);
  whenSeen(grid, () => {
    redraw();
    for (const node of [measuredNode, fittedNode, differenceNode]) node.on("plotly_hover", read);
    onChoice(redraw);
  });
  return section("maps", title, controls, grid, readout,
    el("p", { class: "caption" },
      "Seen from above, forward to the right, in Lambert’s equal-area projection; rings at θᵣ = 30° and 60°. ",
      "Each cell is one reading, white where the scan has none near. ✕ is the mirror direction, ○ the light’s. ",
      `Difference: ${residualText}; dots mark readings below the fit.`, note ? ` Shown: ${note}.` : ""));
}

/// A choice of the incidence angle, common to maps and lobes.
export function panelChoice(name, indices = panels.map((_, i) => i)) {
  if (indices.length < 2) return null;
  const node = choice("Incidence", name,
    indices.map((i) => ({ value: String(i), text: `θᵢ = ${incidence(panels[i])}` })),
    String(state.panel), (value) => choose({ panel: Number(value) }));
  onChoice((change) => "panel" in change && node.set(String(change.panel)));
  return node;
}
