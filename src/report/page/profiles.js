// Profile likelihoods: the root of the statistic against the value, a V of straight lines where value ± k u says it all.

import { report } from "./data.js";
import { el, section, whenSeen } from "./dom.js";
import { axis, draw, ink } from "./plotting.js";

const unit = { um: "µm", deg: "°" };

function drawProfile(node, profile) {
  const points = profile.points.filter((p) => p.delta !== null);
  const x = points.map((p) => p.value);
  const y = points.map((p) => Math.sqrt(p.delta));
  const top = Math.max(2.4, Math.min(4, Math.max(...y)));
  const u = profile.standard_uncertainty;
  const straight = u && profile.value !== null
    ? [{ x: [-top, 0, top].map((k) => profile.value + k * u), y: [top, 0, top], mode: "lines", hoverinfo: "skip",
         line: { color: ink.faint, width: 1.2, dash: "dot" } }]
    : [];
  const level = (height) => ({ type: "line", xref: "paper", x0: 0, x1: 1, y0: height, y1: height, line: { color: ink.line, width: 1 } });
  const limits = (profile.interval_95 ?? []).filter((v) => v !== null).map((v) => ({
    type: "line", yref: "paper", y0: 0, y1: 1, x0: v, x1: v, line: { color: ink.accent, width: 1, dash: "dash" } }));
  return draw(node, [
    ...straight,
    { x, y, mode: "lines+markers", line: { color: ink.accent, width: 1.8 }, marker: { size: 4, color: ink.accent },
      hovertemplate: "%{x:.5g}: √Δ = %{y:.2f}<extra></extra>" },
  ], {
    xaxis: axis({ nticks: 5, range: [Math.min(...x), Math.max(...x)] }),
    yaxis: axis({ range: [0, top], nticks: 4, title: "√Δ" }),
    shapes: [level(1), level(profile.coverage_factor), ...limits],
    showlegend: false,
    margin: { l: 44, r: 10, t: 6, b: 34 },
  });
}

export function profilesSection() {
  const profiles = report.fit.profiles ?? [];
  const title = "Profile likelihoods";
  if (!profiles.length) {
    return section("profiles", title, el("p", {},
      "Not asked for: goniofit fit … --profile --report PAGE.html draws them."));
  }
  const figures = profiles.map((profile) => {
    const name = profile.channel === null ? profile.name : `${profile.channel}.${profile.name}`;
    const plot = el("div", { class: "plot", role: "img", "aria-label": `Profile of ${name}` });
    if (profile.points.length > 2) whenSeen(plot, () => drawProfile(plot, profile));
    else plot.append("no profile");
    const label = unit[profile.unit] ? `${name} / ${unit[profile.unit]}` : name;
    return el("figure", {}, el("figcaption", {}, label, profile.remark && el("span", { class: "remark" }, ` ${profile.remark}`)), plot);
  });
  return section("profiles", title, el("div", { class: "profiles" }, figures),
    el("p", { class: "caption" },
      "Likelihood with all other parameters fitted again. Dotted: what value ± k u gives. Grey levels: 68 and 95 %; dashed: the limits of 95 %."));
}
