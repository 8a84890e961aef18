// In-plane curves: readings as marks, the fit as lines, residuals beneath.

import { report, floats, series, residuals, residualText, residualIsPart, quantile, roundedUp } from "./data.js";
import { choice, el, section, whenSeen } from "./dom.js";
import { incidence, residualTick, superscript } from "./format.js";
import { axis, curveStyle, draw, ink } from "./plotting.js";
import { choose, nearest, onChoice, state } from "./state.js";

const curves = report.plots.curves;
const deepest = 1e7; // further below the highest nothing is measured

const decoded = new Map();
function decode(i) {
  if (!decoded.has(i)) {
    const one = curves.incidences[i];
    decoded.set(i, { theta: floats(one.theta_r), curveTheta: floats(one.curve_theta_r), channels: new Map() });
  }
  const entry = decoded.get(i);
  if (!entry.channels.has(state.channel)) {
    const one = curves.incidences[i];
    const values = series(one.channels[state.channel]);
    entry.channels.set(state.channel, {
      ...values,
      residuals: residuals(values),
      curve: floats(one.curve[state.channel]),
    });
  }
  return { ...entry, ...entry.channels.get(state.channel) };
}

/// Of the readings; a curve may rise above them (a mirror's spike between two readings) by a factor 20 and no more.
function valueRange(all, log) {
  const readings = all.flatMap((one) => [...one.measured]);
  const highest = readings.reduce((a, b) => Math.max(a, b), 0);
  const peak = all.reduce((most, one) => one.curve.reduce((a, b) => Math.max(a, b), most), 0);
  if (!log) {
    const top = 1.06 * Math.max(highest, Math.min(peak, 2 * highest));
    return [Math.min(0, 1.1 * quantile(readings, 0)), top || 1];
  }
  const positive = readings.filter((f) => f > 0);
  const low = Math.max(quantile(positive, 0.02) / 2, highest / deepest);
  return [Math.log10(low / 1.3), Math.log10(1.6 * Math.max(highest, Math.min(peak, 20 * highest)))];
}

function residualRange(all) {
  const sizes = all.flatMap((one) => Array.from(one.residuals, Math.abs));
  const end = roundedUp(quantile(sizes, 0.98) || 1);
  return residualIsPart ? Math.min(end, 1) : end;
}

// Those beyond the frame stand at its edge; parts of one become percent.
const percents = residualIsPart ? 100 : 1;
const clipped = (values, end) => Array.from(values, (v) => percents * Math.max(-end, Math.min(end, v)));

function traces(all, shown, end, log) {
  return all.flatMap((one, i) => {
    const { color, symbol, dash } = curveStyle(i);
    const own = shown === "all" || shown === String(i);
    const name = `θᵢ = ${incidence(curves.incidences[i])}`;
    const many = one.theta.length > 60;
    const marker = { color, symbol, size: many ? 4 : 6, line: { color, width: 1 } };
    const common = { legendgroup: name, name, opacity: own ? 1 : 0.12, hoverinfo: own ? undefined : "skip" };
    const template = own ? "%{y:.4g} sr⁻¹ at %{x:.4g}°" : undefined;
    return [
      {
        ...common, x: one.curveTheta, y: log ? one.curve.map((f) => Math.max(f, 1e-30)) : one.curve,
        mode: "lines", line: { color, width: 1.6, dash }, showlegend: false,
        hovertemplate: template && `fitted ${template}<extra>${name}</extra>`,
      },
      {
        ...common, x: one.theta, y: one.measured, mode: "markers", marker,
        hovertemplate: template && `measured ${template}<extra>${name}</extra>`,
      },
      {
        ...common, x: one.theta, y: clipped(one.residuals, end), yaxis: "y2", mode: "markers",
        marker: { ...marker, size: many ? 3 : 5 }, showlegend: false,
        hovertemplate: own ? `%{y:+.2~f}${residualIsPart ? " %" : " u"} at %{x:.4g}°<extra>${name}</extra>` : undefined,
      },
    ];
  });
}

function powerTicks([low, high]) {
  const first = Math.ceil(low);
  const step = high - low > 6 ? 2 : 1;
  const values = [];
  for (let e = first; e <= high; e += step) values.push(e);
  return values.length < 2 ? {} : { tickvals: values.map((e) => 10 ** e), ticktext: values.map((e) => `10${superscript(e)}`) };
}

export function curvesSection() {
  if (!curves.incidences.length) return section("curves", "In the plane of incidence", el("p", {}, curves.note));
  const plot = el("div", { class: "plot curves", role: "img", "aria-label": "Measured and fitted BRDF against angle" });
  let shown = "all";
  let scale = state.scale;
  const redraw = () => {
    const all = curves.incidences.map((_, i) => decode(i));
    const log = scale === "log";
    const range = valueRange(all, log);
    const end = residualRange(all);
    const narrow = plot.clientWidth < 560;
    const [low, high] = curves.theta_r_range;
    draw(plot, traces(all, shown, end, log), {
      xaxis: axis({
        title: "θᵣ / °, forward to the right", anchor: "y2", range: curves.theta_r_range, dtick: high - low > 100 ? 30 : 15,
      }),
      yaxis: axis({
        title: "BRDF / sr⁻¹", domain: [0.33, 1], range, type: log ? "log" : "linear",
        ...(log ? powerTicks(range) : { rangemode: "normal" }),
      }),
      yaxis2: axis({
        title: "residual", domain: [0, 0.24], range: [-1.1 * percents * end, 1.1 * percents * end], zeroline: true,
        zerolinecolor: ink.faint, tickvals: [-1, -0.5, 0, 0.5, 1].map((part) => part * percents * end),
        ticktext: [-1, -0.5, 0, 0.5, 1].map((part) => residualTick(part * end)),
      }),
      legend: narrow
        ? { orientation: "h", y: 1.02, yanchor: "bottom", x: 0, itemclick: false, itemdoubleclick: false, tracegroupgap: 0 }
        : { x: 1.02, y: 1, itemclick: false, itemdoubleclick: false, tracegroupgap: 0 },
      margin: { l: 64, r: 16, t: narrow ? 56 : 12, b: 48 },
      hovermode: "closest",
    });
  };
  const channel = channelChoice("curves-channel");
  const controls = el(
    "div",
    { class: "controls" },
    channel,
    choice("Incidence", "curves-incidence", [
      { value: "all", text: "All angles" },
      ...curves.incidences.map((one, i) => ({ value: String(i), text: `θᵢ = ${incidence(one)}` })),
    ], "all", (value) => {
      shown = value;
      redraw();
    }),
    choice("BRDF axis", "curves-scale", [
      { value: "linear", text: "Linear" },
      { value: "log", text: "Logarithmic" },
    ], scale, (value) => {
      scale = value;
      redraw();
    }),
  );
  const refresh = whenSeen(plot, redraw);
  onChoice((change) => "channel" in change && refresh());
  return section(
    "curves",
    "In the plane of incidence",
    controls,
    plot,
    el(
      "p",
      { class: "caption" },
      `Marks are readings, lines the fit. Beneath: ${residualText}${residualIsPart ? ", at most ±100 %" : ""}; those beyond the frame stand at its edge. `,
      curves.note ? `Shown: ${curves.note}.` : "",
    ),
  );
}

/// A choice of the channel; all of them change together. Null where there is but one.
export function channelChoice(name, indices = report.plots.channels.map((_, i) => i)) {
  if (indices.length < 2) return null;
  const shown = () => String(indices[nearest(indices, state.channel)]);
  const node = choice(
    "Channel",
    name,
    indices.map((i) => ({ value: String(i), text: report.plots.channels[i] })),
    shown(),
    (value) => choose({ channel: Number(value) }),
  );
  onChoice((change) => "channel" in change && node.set(shown()));
  return node;
}
