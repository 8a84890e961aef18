// Numbers and names as a reader wants them.

import { residualIsPart } from "./data.js";

const plain = new Map([
  ["slope", "RMS slope σ/τ"],
  ["slope_y", "RMS slope across"],
  ["sigma_um", "RMS height σ"],
  ["tau_um", "correlation length τ"],
  ["tau_y_um", "correlation length across"],
  ["tail", "tail γ of the slopes"],
  ["facet_slope_deg", "slope of facets"],
  ["k_dd", "surface, directional"],
  ["k_udf", "surface, uniform"],
  ["k_uds", "below the surface"],
  ["k_fs", "forward scattering"],
  ["rho", "albedo of grooves"],
  ["n", "refractive index"],
  ["f0", "normal reflectance"],
]);

/// What a parameter is, in a few words; empty for a peer's.
export const meaning = (name) => plain.get(name) ?? "";

/// `digits` significant ones, no exponent where a person needs none.
export function number(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa.replace("-", "−")}·10${superscript(Number(exponent))}`;
  }
  const text = size >= 10 ** digits ? value.toFixed(0) : value.toPrecision(digits);
  return text.replace("-", "−");
}

/// The same without trailing zeros, for the ticks of a scale.
export const tick = (value, digits = 3) => number(Number(value.toPrecision(digits)), digits).replace(/(\.\d*?)0+(?=·|$)/, "$1").replace(/\.(?=·|$)/, "");

export const percent = (part, digits = 2) => `${number(100 * part, digits)} %`;

export function superscript(integer) {
  return [...String(integer)].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
}

/// A residual with its sign, as percent where it is a part of a value.
export const residualTick = (value) =>
  (value > 0 ? "+" : "") + (residualIsPart ? `${tick(100 * value, 2)} %` : tick(value, 2));

export const angle = (degrees) => String(Math.round(10 * degrees) / 10).replace("-", "−");

/// "45°", or "30–44°" of a class.
export function incidence(panel) {
  const low = angle(panel.theta_i);
  const high = angle(panel.theta_i_high ?? panel.theta_i);
  return low === high ? `${low}°` : `${low}–${high}°`;
}
