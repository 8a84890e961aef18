// The numbers that the program wrote into the page.

export const report = JSON.parse(document.getElementById("report-data").textContent);

/// 32-bit floats, little-endian, in base64.
export function floats(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const view = new DataView(bytes.buffer);
  return Float32Array.from({ length: bytes.length / 4 }, (_, i) => view.getFloat32(4 * i, true));
}

/// Measured, fitted and u of a channel's readings.
export function series(channel) {
  return {
    measured: floats(channel.measured),
    fitted: floats(channel.fitted),
    u: channel.u ? floats(channel.u) : null,
  };
}

const { by_u: byU, floor } = report.plots.residual;

export const residualText = byU
  ? "(measured − fitted) / u"
  : "(measured − fitted) / the larger of the two";
export const residualIsPart = !byU;

/// In units of u where the scan states it, else a part of the larger of the two.
export function residuals({ measured, fitted, u }) {
  return Float32Array.from(measured, (m, i) => (m - fitted[i]) / (byU ? u[i] : Math.max(Math.abs(m), fitted[i], floor)));
}

/// The value below which a part of `values` lies.
export function quantile(values, part) {
  const sorted = Float64Array.from(values).sort();
  return sorted.length ? sorted[Math.round(part * (sorted.length - 1))] : NaN;
}

/// 1, 2 or 5 times a power of ten, at least `size`.
export function roundedUp(size) {
  const power = 10 ** Math.floor(Math.log10(Math.max(size, 1e-9)));
  return [1, 2, 5, 10].map((step) => step * power).find((end) => size <= end * (1 + 1e-9));
}
