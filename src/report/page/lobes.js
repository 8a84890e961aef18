// The fitted lobe as a surface, as far from the centre as the BRDF is large, with the readings about it.

import { channelChoice } from "./curves.js";
import { report, floats, series } from "./data.js";
import { choice, el, section, whenSeen } from "./dom.js";
import { draw, ink, relayout, snapshot } from "./plotting.js";
import { panelChoice } from "./maps.js";
import { nearest, onChoice, state } from "./state.js";

const { lobes, panels: lobePanels, channels: lobeChannels } = report.plots.lobes;
const panels = report.plots.maps.panels;
const decades = 3; // below the highest, of the logarithmic radius

const rad = Math.PI / 180;
// x is forward, z the normal; phi = 180° is forward.
const direction = (theta, phi) => [
  -Math.sin(theta * rad) * Math.cos(phi * rad),
  -Math.sin(theta * rad) * Math.sin(phi * rad),
  Math.cos(theta * rad),
];

const radii = {
  linear: (f, top) => Math.max(f, 0) / top,
  cube: (f, top) => Math.cbrt(Math.max(f, 0) / top),
  log: (f, top) => Math.max(0, 1 + Math.log10(Math.max(f, 1e-300) / top) / decades),
};

function hasWebGL() {
  try {
    return Boolean(document.createElement("canvas").getContext("webgl"));
  } catch {
    return false;
  }
}

// The left half is the right one's mirror image unless the surface is anisotropic.
function azimuths(stored) {
  if (report.plots.anisotropic) return Array.from(stored, (phi, i) => ({ phi, i }));
  const right = Array.from(stored, (phi, i) => ({ phi, i }));
  return [...right, ...right.slice(0, -1).reverse().map(({ phi, i }) => ({ phi: 360 - phi, i }))];
}

function surfaceOf(lobe, values, radius, top) {
  const theta = floats(lobe.theta);
  const stored = floats(lobe.phi);
  const around = azimuths(stored).reverse(); // so that the outside is the lit one
  const grid = (component) =>
    Array.from(theta, (t, row) =>
      around.map(({ phi, i }) => radius(values[row * stored.length + i], top) * direction(t, phi)[component]));
  return {
    type: "surface", x: grid(0), y: grid(1), z: grid(2), showscale: false, hoverinfo: "skip", opacity: 1,
    surfacecolor: grid(2).map((row) => row.map(() => 0)),
    colorscale: [[0, "#7fa9c4"], [1, "#7fa9c4"]],
    lighting: { ambient: 0.5, diffuse: 0.75, specular: 0.12, roughness: 0.7, fresnel: 0.05 },
    lightposition: { x: -2000, y: -3000, z: 4000 },
    contours: { x: { highlight: false }, y: { highlight: false }, z: { highlight: false } },
  };
}

function pointsOf(panel, measured, radius, top) {
  const theta = floats(panel.theta_r);
  const phi = floats(panel.phi);
  const at = Array.from(measured, (f, i) => direction(theta[i], phi[i]).map((c) => c * radius(f, top)));
  return {
    type: "scatter3d", mode: "markers", x: at.map((p) => p[0]), y: at.map((p) => p[1]), z: at.map((p) => p[2]),
    customdata: at.map((_, i) => [theta[i], phi[i], measured[i]]),
    hovertemplate: "θᵣ %{customdata[0]:.4g}°, φᵣ − φᵢ %{customdata[1]:.4g}°<br>measured %{customdata[2]:.4g} sr⁻¹<extra></extra>",
    marker: { size: measured.length > 500 ? 1.8 : 2.6, color: "#b04a04", line: { width: 0 } }, showlegend: false,
  };
}

function line(points, color, dash, text) {
  return {
    type: "scatter3d", mode: text ? "lines+text" : "lines", hoverinfo: "skip", showlegend: false,
    x: points.map((p) => p[0]), y: points.map((p) => p[1]), z: points.map((p) => p[2]),
    text: text ? points.map((_, i) => (i === points.length - 1 ? text : "")) : undefined, textposition: "top center",
    textfont: { size: 12, color: ink.text }, line: { color, width: dash === "solid" ? 4 : 3, dash },
  };
}

function frame(thetaI) {
  const horizon = Array.from({ length: 73 }, (_, i) => direction(90, 5 * i));
  const ray = (theta, phi) => [[0, 0, 0], direction(theta, phi).map((c) => 1.12 * c)];
  return [
    line(horizon, ink.faint, "solid"),
    line([[-1, 0, 0], [1, 0, 0]], ink.line, "solid", "forward"),
    line([[0, -1, 0], [0, 1, 0]], ink.line, "solid"),
    line(ray(thetaI, 0), "#000", "solid", "light"),
    line(ray(thetaI, 180), "#000", "dash", "mirror"),
  ];
}

const scene = () => {
  const none = { visible: false, range: [-1.2, 1.2] };
  return {
    xaxis: none, yaxis: none, zaxis: { ...none, range: [-0.05, 1.25] }, aspectmode: "manual",
    aspectratio: { x: 1.6, y: 1.6, z: 0.87 }, dragmode: "turntable",
  };
};

// Degrees about the normal, and above the horizon.
function camera(turn, height, distance = 1.75) {
  return {
    eye: {
      x: distance * Math.cos(height * rad) * Math.cos(turn * rad),
      y: distance * Math.cos(height * rad) * Math.sin(turn * rad),
      z: distance * Math.sin(height * rad),
    },
    center: { x: 0, y: 0, z: -0.16 },
    up: { x: 0, y: 0, z: 1 },
  };
}

export function lobesSection() {
  const title = "The lobe in space";
  if (!hasWebGL()) {
    return section("lobes", title, el("p", { class: "note" },
      "This browser draws no 3-D graphics (WebGL is off), so the lobe is left out; all the rest of the page is here."));
  }
  const plot = el("div", { class: "plot lobe", role: "img", "aria-label": "Fitted lobe as a surface, readings as points" });
  const still = el("img", { class: "still", alt: "Fitted lobe as a surface, readings as points" });
  let scale = "cube";
  let view = { turn: -65, height: 22 };

  const redraw = () => {
    const first = !plot.data;
    const l = nearest(lobePanels, state.panel);
    const c = nearest(lobeChannels, state.channel);
    const panel = panels[lobePanels[l]];
    const lobe = lobes[l];
    const values = floats(lobe.values[c]);
    const { measured } = series(panel.channels[lobeChannels[c]]);
    const top = [...values, ...measured].reduce((a, b) => Math.max(a, b), 0) || 1;
    draw(
      plot,
      [surfaceOf(lobe, values, radii[scale], top), pointsOf(panel, measured, radii[scale], top), ...frame(lobe.theta_i)],
      {
        scene: { ...scene(), ...(first ? { camera: camera(view.turn, view.height) } : {}) },
        uirevision: "camera",
        margin: { l: 0, r: 0, t: 0, b: 0 },
      },
    );
  };
  const turn = (by, up) => {
    const { eye } = plot.layout.scene.camera ?? camera(view.turn, view.height);
    view = {
      turn: Math.atan2(eye.y, eye.x) / rad + by,
      height: Math.max(0, Math.min(88, Math.atan2(eye.z, Math.hypot(eye.x, eye.y)) / rad + up)),
    };
    relayout(plot, { "scene.camera": camera(view.turn, view.height, Math.hypot(eye.x, eye.y, eye.z)) });
  };
  const button = (text, name, by, up) =>
    el("button", { type: "button", "aria-label": name, title: name, onclick: () => turn(by, up) }, text);

  const controls = el("div", { class: "controls" },
    channelChoice("lobes-channel", lobeChannels),
    panelChoice("lobes-incidence", lobePanels),
    choice("Radius", "lobes-scale", [
      { value: "linear", text: "Linear" },
      { value: "cube", text: "Cube root" },
      { value: "log", text: "Logarithmic" },
    ], scale, (value) => {
      scale = value;
      refresh();
    }),
    el("fieldset", { class: "choice" }, el("legend", {}, "Turn"),
      el("div", { class: "buttons turn" },
        button("←", "turn left", -15, 0), button("→", "turn right", 15, 0),
        button("↑", "look from higher up", 0, 12), button("↓", "look from lower down", 0, -12))));
  const refresh = whenSeen(plot, redraw);
  onChoice(refresh);
  // What printers get, who draw no WebGL; after the above has drawn.
  window.addEventListener("beforeprint", () => (still.src = snapshot(plot)));
  return section("lobes", title, controls, plot, still,
    el("p", { class: "caption" },
      "The surface is the fit, as far from the centre as its value is large; points are readings. Drag to turn, or use the buttons. ",
      `The logarithmic radius spans ${decades} decades.`));
}
