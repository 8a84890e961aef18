// The first screen: what was fitted, how good it is, and what came out.

import { report } from "./data.js";
import { el, section, table } from "./dom.js";
import { meaning } from "./format.js";

const signs = { describes: "✓", systematic: "≈", fails: "✕" };

// What follows the words that the verdict has said already.
function sentence(finding) {
  const text = finding.slice(finding.indexOf(": ") + 1).trim();
  return text && `${text[0].toUpperCase()}${text.slice(1)}.`;
}

function warningLink() {
  const count = report.fit.warnings.length;
  return count ? [" ", el("a", { href: "#notes" }, count === 1 ? "One warning" : `${count} warnings`), "."] : null;
}

export function header() {
  const { verdict, sphere, subject } = report;
  return el(
    "header",
    { class: "top" },
    el("div", { class: "what" },
      el("p", { class: "eyebrow" }, report.fitted ? "Fit of a reflectance scan" : "Material beside a reflectance scan"),
      el("h1", {}, report.title || "(no name)"),
      verdict && el("p", { class: `verdict ${verdict.name}` },
        el("span", { class: "sign", "aria-hidden": "true" }, signs[verdict.name]), " ", el("strong", {}, verdict.words)),
      verdict && el("p", { class: "finding" }, sentence(verdict.finding), warningLink()),
      el("dl", { class: "subject" }, subject.map(([label, text]) => [el("dt", {}, label), el("dd", {}, text)]))),
    el("figure", { class: "sphere" },
      el("img", { src: sphere.png, alt: sphere.alt, width: sphere.size, height: sphere.size }),
      el("figcaption", {}, sphere.caption)));
}

const rows = report.fit.parameters.map((parameter, i) => ({ ...parameter, text: report.texts[i] }));

// All digits are in the attributes: what is shown is rounded to what the uncertainty supports.
function exact(row) {
  const full = (v) => (v === null ? null : String(v));
  return {
    "data-key": row.channel === null ? row.name : `${row.channel}.${row.name}`,
    "data-value": full(row.value) ?? "null",
    "data-u": full(row.standard_uncertainty),
    title: row.value === null ? null : String(row.value),
  };
}

const named = (name) => [el("span", { class: "name" }, name), meaning(name) && el("span", { class: "meaning" }, meaning(name))];

function sharedTable() {
  const shared = rows.filter((row) => row.channel === null);
  if (!shared.length) return null;
  return table(
    "Shape of the surface, shared by all channels",
    [
      { title: "parameter", align: "left" },
      { title: "value ± std. unc.", align: "middle", span: "2" },
      { align: "left" },
      { title: "95 %", align: "left" },
      { title: "unit", align: "left" },
      { title: "", align: "left" },
    ],
    shared.map((row) => [
      el("span", {}, named(row.name)),
      { text: row.text.value || "–", class: row.value === null ? "right open" : "right value", ...exact(row) },
      { text: row.text.u && `± ${row.text.u}`, class: "left u" },
      row.text.interval,
      row.text.unit,
      { text: row.text.remark, class: "remark" },
    ]),
    { class: "parameters" },
  );
}

// A row a channel, for each parameter its value and uncertainty, the interval beneath.
function channelTable() {
  const own = rows.filter((row) => row.channel !== null);
  if (!own.length) return null;
  const names = [...new Set(own.map((row) => row.name))];
  const find = (channel, name) => own.find((row) => row.channel === channel && row.name === name);
  const cells = (row) => {
    if (!row) return ["", ""];
    if (row.value === null) return [{ text: "–", class: "right open", ...exact(row) }, { text: "not determined", class: "left remark" }];
    const bound = row.text.u ? row.text.interval : row.text.interval || row.text.remark;
    return [
      { text: row.text.value, class: "right value", ...exact(row) },
      { text: el("span", {}, row.text.u && el("span", { class: "u" }, `± ${row.text.u}`), el("span", { class: "interval" }, bound)), class: "left" },
    ];
  };
  const columns = [{ title: "channel", align: "left" }];
  for (const name of names) columns.push({ title: el("span", {}, named(name)), align: "middle", span: "2" }, { align: "left" });
  columns.push({ title: el("span", {}, named("RMS"), el("span", { class: "meaning" }, "sr⁻¹")), align: "right" });
  return table("Coefficients of each channel", columns,
    report.fit.channels.map(({ name, rms }) => [
      name,
      ...names.flatMap((parameter) => cells(find(name, parameter))),
      { text: rms === null ? "" : rms.toPrecision(3), class: "right" },
    ]),
    { class: "parameters" });
}


export function parametersSection() {
  return section("parameters", "Parameters", el("div", { class: "tables" }, sharedTable(), channelTable()),
    report.sentences.length ? el("p", { class: "caption" }, report.sentences.map((text) => `${text[0].toUpperCase()}${text.slice(1)}.`).join(" ")) : null);
}

const list = (items) => el("ul", {}, items.map((item) => el("li", {}, item)));

export function notesSection() {
  const { warnings, notes } = report.fit;
  if (!warnings.length && !notes.length) return null;
  return section("notes", "Warnings and notes", warnings.length ? list(warnings) : null,
    warnings.length && notes.length ? el("h3", {}, "Notes") : null, notes.length ? list(notes) : null);
}
