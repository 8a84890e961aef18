// Tables of what a reader looks up: misfit, correlations, the choice of the effects, where the page comes from.

import { report } from "./data.js";
import { el, section, table, whenSeen } from "./dom.js";
import { angle, number, percent } from "./format.js";
import { axis, diverging, draw, plotlyVersion } from "./plotting.js";

const fit = report.fit;
const how = "It needs the fit itself: goniofit fit … --report PAGE.html shows it.";

const regions = {
  mirror: "within 10° of the mirror direction",
  retro: "within 10° of the light",
  forward_grazing: "forward, θᵣ > 70°",
  elsewhere: "elsewhere",
};

function regionTable(diagnostics) {
  const entries = Object.entries(diagnostics.regions).filter(([, region]) => region.readings > 0);
  return table("Where the misfit is",
    [{ title: "directions", align: "left" }, { title: "readings", align: "right" }, { title: "of the signal", align: "right" },
     { title: "of the misfit", align: "right" }, { title: "typical", align: "right" }],
    entries.map(([name, region]) => [
      regions[name] ?? name, String(region.readings), percent(region.of_signal), percent(region.of_misfit),
      region.typical === null ? "–" : percent(region.typical),
    ]));
}

function channelMisfit(diagnostics) {
  return table("Misfit by channel",
    [{ title: "channel", align: "left" }, { title: "peak", align: "right" }, { title: "bulk", align: "right" },
     { title: "typical", align: "right" }, { title: "runs test p", align: "right" }],
    diagnostics.channels.map((c) => [
      c.name, percent(c.misfit.peak), percent(c.misfit.bulk),
      c.misfit.typical === null ? "–" : percent(c.misfit.typical), c.runs.p === null ? "–" : number(c.runs.p, 2),
    ]));
}

function outlierTable(diagnostics) {
  if (!diagnostics.outliers.length) return null;
  return table(`The worst of ${diagnostics.outlier_count} outliers`,
    ["θᵢ / °", "φᵢ / °", "θᵣ / °", "φᵣ / °"].map((title) => ({ title, align: "right" })).concat(
      [{ title: "channel", align: "left" }, { title: "measured", align: "right" }, { title: "fitted", align: "right" },
       { title: "std. dev.", align: "right" }]),
    diagnostics.outliers.map((o) => [
      ...o.angles.map(angle), o.channel, number(o.value, 4), number(o.fitted, 4), number(o.standard_deviations),
    ]));
}

export function misfitSection() {
  const d = fit.diagnostics;
  if (!d) return null;
  return section("misfit", "Misfit",
    el("ul", {}, d.findings.map((finding) => el("li", {}, finding))),
    el("div", { class: "tables" }, regionTable(d), d.channels.length > 1 ? channelMisfit(d) : null, outlierTable(d)),
    el("p", { class: "caption" },
      "Peak: root of the weighted squared residuals over that of the readings. Bulk: the same of their sizes. ",
      "Typical: half of the readings are off by more. A small p says that neighbouring residuals have the same sign too often for noise."));
}

export function reflectanceSection() {
  const all = fit.reflectance;
  if (!all.length) return null;
  const names = fit.channels.map((c) => c.name);
  const shown = names.map((_, i) => i).filter((i) => names.length <= 8 || i % Math.ceil(names.length / 8) === 0);
  return section("reflectance", "Directional-hemispherical reflectance",
    table("Of the fitted material, by incidence angle",
      [{ title: "θᵢ / °", align: "right" }, ...shown.map((i) => ({ title: names[i], align: "right" }))],
      all.map((row) => [angle(row.theta_i_deg), ...shown.map((i) => {
        const value = row.by_channel[i];
        return { text: value === null ? "–" : value.toFixed(4) + (value > 1 ? " > 1" : ""), class: value > 1 ? "right open" : "right" };
      })])));
}

// Lighter than the plots' scale, so that the numbers stay legible.
function shade(r) {
  const [red, green, blue] = r < 0 ? [106, 174, 214] : [249, 169, 91];
  return `background-color: rgba(${red}, ${green}, ${blue}, ${Math.abs(r).toFixed(2)})`;
}

function correlationTable({ names, matrix }) {
  return table("Correlation of the estimates",
    [{ title: "", align: "left" }, ...names.map((title) => ({ title, align: "right" }))],
    matrix.map((row, i) => [names[i], ...row.map((r, j) => (i === j ? { text: "1", class: "right diagonal" }
      : { text: (r < 0 ? "−" : "+") + Math.abs(r).toFixed(2), class: "right", style: shade(r) }))]),
    { class: "matrix" });
}

function correlationMap({ names, matrix }) {
  const node = el("div", { class: "plot square", role: "img", "aria-label": "Correlation matrix" });
  whenSeen(node, () => draw(node, [{
    type: "heatmap", x: names, y: names, z: matrix, zmin: -1, zmax: 1, colorscale: diverging, xgap: 1, ygap: 1,
    hovertemplate: "%{x}, %{y}: %{z:+.2f}<extra></extra>", colorbar: { thickness: 10, outlinewidth: 0 },
  }], {
    xaxis: axis({ showline: false, ticks: "", showgrid: false, tickfont: { size: 10 } }),
    yaxis: axis({ showline: false, ticks: "", showgrid: false, autorange: "reversed", tickfont: { size: 10 } }),
  }));
  return node;
}

export function correlationSection() {
  const correlation = fit.uncertainty.correlation;
  const title = "Correlations";
  if (!report.fitted) return section("correlation", title, el("p", {}, `A material does not hold them. ${how}`));
  if (correlation.names.length < 2) return null;
  return section("correlation", title,
    correlation.names.length <= 14 ? correlationTable(correlation) : correlationMap(correlation),
    el("p", { class: "caption" }, "Of the estimates of the free parameters, by the covariance that is stated."));
}

function selectionTable(selection) {
  const least = (key) => Math.min(...selection.sets.map((row) => row[key] ?? Infinity));
  const [aicc, bic] = [least("aicc"), least("bic")];
  return table("Sets of effects that were fitted, the chosen one first",
    [{ title: "components", align: "left" }, { title: "free", align: "right" }, { title: "χ²", align: "right" },
     { title: "ΔAICc", align: "right" }, { title: "ΔBIC", align: "right" }, { title: "left-out score", align: "right" },
     { title: "to the best", align: "left" }],
    selection.sets.map((row) => ({
      attributes: row.chosen ? { class: "chosen" } : {},
      cells: [
        (row.chosen ? "→ " : "") + row.components.join(" + "), String(row.free_parameters), number(row.chi2, 5),
        number(row.aicc - aicc, 4), number(row.bic - bic, 4),
        row.cross_validated === null ? "" : row.cross_validated.toFixed(4),
        row.difference === null ? "" : `+${row.difference.toFixed(4)} ± ${row.difference_error.toFixed(4)}`,
      ],
    })));
}

export function selectionSection() {
  const selection = fit.selection;
  if (!selection || !selection.sets.length) return null;
  return section("selection", "Choice of the effects", el("p", {}, selection.reason), selectionTable(selection),
    el("p", { class: "caption" }, "The score is of incidence angles left out of the fit: a perfect model has 1."));
}

function materialFile() {
  const text = `${JSON.stringify(report.material, null, 2)}\n`;
  const copied = el("span", { "aria-live": "polite" });
  const copy = el("button", { type: "button", onclick: async () => {
    await navigator.clipboard.writeText(text);
    copied.textContent = " copied";
  } }, "Copy");
  const save = el("button", { type: "button", onclick: () => {
    const link = el("a", { download: "material.json", href: URL.createObjectURL(new Blob([text], { type: "application/json" })) });
    link.click();
    URL.revokeObjectURL(link.href);
  } }, "Save");
  return el("details", {}, el("summary", {}, "The material’s file, all digits"),
    el("p", { class: "buttons" }, copy, save, copied), el("pre", { tabindex: "0", id: "material-json" }, text));
}

function licences() {
  return el("details", {}, el("summary", {}, "Licences of what this page is made of"),
    el("pre", { tabindex: "0" }, document.getElementById("licences").textContent));
}

export function sourceSection() {
  const { inputs, command, versions, random, metadata } = report.source;
  const entries = [
    ...inputs.map(({ role, file, sha256 }) => [role, [el("span", {}, file), el("code", { class: "hash" }, `SHA-256 ${sha256}`)]]),
    ["command", [el("code", {}, command)]],
    ["versions", [[...versions, ["Plotly", plotlyVersion]].map((pair) => pair.join(" ")).join(", ")]],
    ["random numbers", [random]],
    ...metadata.filter(([key]) => key !== "name").map(([key, value]) => [`scan: ${key}`, [value]]),
  ];
  return section("source", "Where this page comes from",
    el("dl", { class: "source" }, entries.filter(([, content]) => content[0]).map(([label, content]) =>
      [el("dt", {}, label), el("dd", {}, content)])),
    materialFile(), licences());
}
