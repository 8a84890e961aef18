// Plotly with the traces that the page needs, and the looks that its plots share.

import Plotly from "plotly.js/lib/core";
import heatmap from "plotly.js/lib/heatmap";
import scatter3d from "plotly.js/lib/scatter3d";
import surface from "plotly.js/lib/surface";

Plotly.register([heatmap, scatter3d, surface]);

export const plotlyVersion = Plotly.version;

export const ink = { text: "#1f2a30", faint: "#5b6870", line: "#c9d1d6", grid: "#e6eaed", accent: "#0b5a86" };

// Okabe and Ito's colours, which people with any kind of colour vision tell apart, without the yellow that is lost on
// white; a mark and a dash of its own for each, so that print in grey shows them too.
const colors = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8B5A2B"];
const symbols = ["circle", "square", "triangle-up", "diamond", "triangle-down", "circle-open", "square-open", "diamond-open"];
const dashes = ["solid", "dash", "dashdot", "dot"];
export const curveStyle = (i) => ({
  color: colors[i % colors.length],
  symbol: symbols[i % symbols.length],
  dash: dashes[Math.floor(i / colors.length) % dashes.length],
});

// Cividis, resampled: lightness rises evenly, for any colour vision and in grey.
export const sequential = [
  [0, "#00204d"], [0.13, "#00336f"], [0.25, "#39486b"], [0.38, "#575c6d"], [0.5, "#707173"],
  [0.63, "#8a8779"], [0.75, "#a69d75"], [0.88, "#c7b76a"], [1, "#ffea46"],
];
// Blue where the reading is below the fit, orange where above.
export const diverging = [
  [0, "#08519c"], [0.25, "#6aaed6"], [0.5, "#fbfbfa"], [0.75, "#f9a95b"], [1, "#b04a04"],
];

const font = { family: 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif', size: 13, color: ink.text };

export const axis = ({ title, ...more } = {}) => ({
  title: title && { text: title, font: { size: 13 }, standoff: 8 },
  zeroline: false,
  showline: true,
  linecolor: ink.line,
  gridcolor: ink.grid,
  ticks: "outside",
  ticklen: 4,
  tickcolor: ink.line,
  automargin: true,
  exponentformat: "power",
  ...more,
});

export const layout = (more = {}) => ({
  font,
  paper_bgcolor: "rgba(0,0,0,0)",
  plot_bgcolor: "rgba(0,0,0,0)",
  margin: { l: 64, r: 16, t: 12, b: 48 },
  hoverlabel: { bgcolor: "#fff", bordercolor: ink.line, font },
  separators: ". ",
  ...more,
});

const config = {
  responsive: true,
  displaylogo: false,
  displayModeBar: false,
  doubleClick: "reset",
  scrollZoom: false,
};

const drawn = new Set();

/// Draws, or draws anew; the element's own place in the page gives its size.
export function draw(node, traces, plotLayout) {
  drawn.add(node);
  return Plotly.react(node, traces, { ...layout(), ...plotLayout }, config);
}

// On paper the page is as wide as paper, and its plots with it.
window.addEventListener("beforeprint", () => {
  document.documentElement.classList.add("paper");
  for (const node of drawn) {
    const { clientWidth: width, clientHeight: height } = node;
    if (width) Plotly.relayout(node, { width, height });
  }
});
window.addEventListener("afterprint", () => {
  document.documentElement.classList.remove("paper");
  for (const node of drawn) Plotly.relayout(node, { width: null, height: null, autosize: true });
});

export const relayout = (node, update) => Plotly.relayout(node, update);
/// A picture of a plot in space, as it stands, at once: Plotly.toImage comes too late for a printer.
export const snapshot = (node) => node._fullLayout.scene._scene.toImage("png");
