// Makes the C++ file that holds the page: node build.mjs OUTPUT.cpp, in a folder with these sources and node_modules.

import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build, transform } from "esbuild";

const bundle = await build({
  entryPoints: ["main.js"],
  bundle: true,
  minify: true,
  write: false,
  metafile: true,
  format: "iife",
  target: "es2020",
  charset: "utf8",
  legalComments: "none", // all licences follow below
  define: { global: "window", "define.amd": "false" },
  // Of maps with tiles, which this page has none of.
  loader: { ".css": "empty" },
  logLevel: "warning",
});
const script = bundle.outputFiles[0].text;
// What is in the bundle may be passed on with its licence alone.
function licences(inputs) {
  const folders = new Set(inputs.map((path) => path.match(/^(.*node_modules\/(?:@[^/]+\/)?[^/]+)\//)?.[1]).filter(Boolean));
  return [...folders].sort().map((folder) => {
    const { name, version, license } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
    const text = file ? readFileSync(`${folder}/${file}`, "utf8").trim() : `Licence: ${license}`;
    return `${name} ${version}\n\n${text.replaceAll("<", "‹").replaceAll(">", "›")}`;
  });
}
const [{ inputs }] = Object.values(bundle.metafile.outputs);
const within = ["node_modules/delaunator/", "node_modules/robust-predicates/"]; // d3-delaunay brings them in its own file
const parts = licences([...Object.keys(inputs).filter((path) => !path.endsWith(".css")), ...within]);

const style = (await transform(readFileSync("page.css", "utf8"), { loader: "css", minify: true })).code;

// Nothing is loaded from anywhere, and no script runs but this one.
const hash = createHash("sha256").update(script).digest("base64");
const policy = [
  "default-src 'none'",
  `script-src 'sha256-${hash}'`,
  "style-src 'unsafe-inline'",
  "img-src data: blob:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");

const [head, rest] = readFileSync("page.html", "utf8")
  .replace("@policy@", () => policy)
  .replace("@style@", () => style)
  .replace("@licences@", () => parts.join(`\n\n${"-".repeat(72)}\n\n`))
  .split("@title@");
const [middle, tail] = rest.split("@data@");

function literal(text) {
  const escaped = text
    .replaceAll("\\", "\\\\")
    .replaceAll('"', '\\"')
    .replaceAll("?", "\\?") // two of them would begin a trigraph
    .replaceAll("\r", "\\r")
    .replaceAll("\t", "\\t")
    .replaceAll("\n", '\\n"\n"')
    // Control characters in three octal digits, which no digit that follows can join.
    .replace(/[\u0000-\u0008\u000b\u000c\u000e-\u001f]/g, (c) => `\\${c.charCodeAt(0).toString(8).padStart(3, "0")}`);
  return `"${escaped}"`;
}

writeFileSync(
  process.argv[2],
  `// Made from src/report/page by build.mjs.
#include "report/page_template.h"

namespace goniofit {
namespace {
constexpr char head[] = ${literal(head)};
constexpr char middle[] = ${literal(middle)};
constexpr char tail[] = ${literal(tail.replace("@script@", () => script))};
}  // namespace
const PageTemplate page_template{{head, sizeof head - 1}, {middle, sizeof middle - 1}, {tail, sizeof tail - 1}};
}  // namespace goniofit
`,
);
