// A browser without a network, and pages of the program in it.

import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { GONIOFIT_PROGRAM, GONIOFIT_SOURCE_DIR, CHROMIUM, SCREENSHOTS } = process.env;

export const scratch = mkdtempSync(join(tmpdir(), "goniofit-page-"));
export const source = (path) => join(GONIOFIT_SOURCE_DIR, path);
mkdirSync(SCREENSHOTS, { recursive: true });
export const picture = (name) => join(SCREENSHOTS, name);

/// Standard output; a fit that fails to describe its scan (status 1) is none that failed to run.
export function goniofit(...words) {
  return execFileSync(GONIOFIT_PROGRAM, words, { cwd: scratch, encoding: "utf8" });
}

const quiet = ["--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic"];
const flat = ["--disable-gpu", "--disable-3d-apis"];
// Drawn by the processor, which is all that a machine of tests has, and slow.
const spatial = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];

export const launch = ({ webgl }) =>
  chromium.launch({ executablePath: CHROMIUM, args: ["--no-sandbox", ...quiet, ...(webgl ? spatial : flat)] });

/// Opens the page of a file of `scratch`; `complaints` gathers errors, refused and other requests as they come.
export async function open(browser, file, viewport = { width: 1280, height: 900 }) {
  const url = pathToFileURL(join(scratch, file)).href;
  const page = await browser.newPage({ viewport });
  const complaints = [];
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("dialog", (dialog) => {
    complaints.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => {
    const own = request.url() === url || /^(data|blob):/.test(request.url());
    if (!own) complaints.push(`request: ${request.url()}`);
  });
  const start = performance.now();
  await page.goto(url);
  await page.waitForSelector("html[data-ready=yes]");
  return { page, complaints, milliseconds: performance.now() - start };
}

/// Brings a section into view and waits for its plots.
export async function show(page, id) {
  await page.locator(`#${id}`).scrollIntoViewIfNeeded();
  await page.waitForFunction((section) => {
    const plots = [...document.querySelectorAll(`#${section} .plot`)];
    return plots.length > 0 && plots.every((plot) => plot.data);
  }, id);
}
