// What the controls choose, shared by all plots.

import { report } from "./data.js";

const listeners = [];
export const state = {
  channel: 0,
  panel: 0, // incidence angle of maps and lobes
  scale: report.plots.curves.log ? "log" : "linear",
};

export function choose(change) {
  Object.assign(state, change);
  for (const listener of listeners) listener(change);
}
export const onChoice = (listener) => listeners.push(listener);
