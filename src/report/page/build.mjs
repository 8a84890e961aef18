// Makes the C++ file that holds the page: node build.mjs OUTPUT.cpp, in a folder with these sources and node_modules.

import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { build, transform } from "esbuild";

const bundle = await build({
  entryPoints: ["main.js"],
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  target: "es2020",
  charset: "utf8",
  legalComments: "inline",
  define: { global: "window", "define.amd": "false" },
  // Of maps with tiles, which this page has none of.
  loader: { ".css": "empty" },
  logLevel: "warning",
});
const script = bundle.outputFiles[0].text;
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
