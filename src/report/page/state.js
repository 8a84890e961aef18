// What the controls choose, shared by all plots.

import { report } from "./data.js";

const listeners = [];
// At some 45° lobes stand clear of the normal and of the horizon.
function telling() {
  const off = report.plots.maps.panels.map((panel) => Math.abs(panel.theta_i - 45));
  return Math.max(0, off.indexOf(Math.min(...off)));
}

export const state = {
  // Of a spectrum the middle.
  channel: report.plots.channels.length > 4 ? Math.floor(report.plots.channels.length / 2) : 0,
  panel: telling(), // incidence angle of maps and lobes
  scale: report.plots.curves.log ? "log" : "linear",
};

/// Where `indices` come nearest to the one wanted: plots that hold fewer channels or angles than others show that.
export const nearest = (indices, wanted) =>
  indices.reduce((best, i, k) => (Math.abs(i - wanted) < Math.abs(indices[best] - wanted) ? k : best), 0);

export function choose(change) {
  Object.assign(state, change);
  for (const listener of listeners) listener(change);
}
export const onChoice = (listener) => listeners.push(listener);
