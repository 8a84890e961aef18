// The report's page as a reader meets it. Skipped (status 77) without a browser.

import assert from "node:assert/strict";
import { copyFileSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

if (!process.env.CHROMIUM || process.env.CHROMIUM.endsWith("NOTFOUND")) {
  console.log("skipped: there is no chromium");
  process.exit(77);
}
const { goniofit, launch, open, picture, scratch, show, source } = await import("./browser.mjs");

const scan = source("data/garnet_red_paint_13.csv");
let browser; // without WebGL, which few tests need
let spatial;

before(async () => {
  goniofit("fit", scan, "--n", "1.7", "--components", "auto", "--profile", "-o", "m.json", "--report", "fit.html");
  goniofit("report", "m.json", scan, "-o", "material.html");
  browser = await launch({ webgl: false });
  spatial = await launch({ webgl: true });
});

after(async () => {
  await browser?.close();
  await spatial?.close();
  rmSync(scratch, { recursive: true });
});

const plotOf = (page, section, index = 0) => page.locator(`#${section} .plot`).nth(index);
const layout = (page, section, index) => plotOf(page, section, index).evaluate((node) => JSON.parse(JSON.stringify(node.layout)));
const choose = (page, name, value) => page.locator(`label[for="${name}-${value}"]`).click();

test("opens at once, asks for nothing, complains of nothing", async () => {
  const { page, complaints, milliseconds } = await open(spatial, "fit.html");
  console.log(`opened in ${milliseconds.toFixed(0)} ms`);
  assert.ok(milliseconds < 6000, "three times what a machine of its own needs at most");
  await page.screenshot({ path: picture("first-screen.png") });
  for (const id of await page.$$eval("section", (all) => all.map((section) => section.id))) {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    await page.waitForTimeout(200);
    await page.locator(`#${id}`).screenshot({ path: picture(`${id}.png`) });
  }
  const waiting = await page.$$eval(".plot", (all) => all.filter((plot) => !plot.data).length);
  assert.equal(waiting, 0, "every plot is drawn once it was in view");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("shows every parameter of the material's file, all digits", async () => {
  const material = JSON.parse(readFileSync(join(scratch, "m.json"), "utf8"));
  const expected = new Map();
  for (const name of ["slope", "sigma_um", "tau_um"]) expected.set(name, material.surface[name]);
  for (const channel of material.channels) {
    for (const name of ["k_dd", "k_uds", "k_fs"]) expected.set(`${channel.name}.${name}`, channel[name]);
  }
  const u = material.fit.uncertainty;
  for (const file of ["fit.html", "material.html"]) {
    const { page, complaints } = await open(browser, file);
    const cells = await page.$$eval("[data-key]", (all) =>
      all.map(({ dataset, textContent }) => ({ ...dataset, text: textContent })));
    assert.deepEqual(new Set(cells.map((cell) => cell.key)), new Set(expected.keys()), file);
    for (const { key, value, u: shownU, text } of cells) {
      const exact = expected.get(key);
      assert.equal(JSON.parse(value), exact, `${key} of ${file}`);
      if (exact === null) continue;
      const [channel, name] = key.includes(".") ? key.split(".") : [null, key];
      const exactU = channel ? u[channel]?.[name] : u[name];
      assert.equal(shownU === undefined ? undefined : Number(shownU), exactU, `u of ${key}`);
      assert.ok(Math.abs(Number(text) - exact) <= (exactU ?? 1e-5), `${key} is shown as ${text}`);
    }
    assert.deepEqual(JSON.parse(await page.locator("#material-json").textContent()), material);
    assert.deepEqual(complaints, []);
    await page.close();
  }
});

test("the curves follow scale, channel and incidence", async () => {
  const { page, complaints } = await open(browser, "fit.html");
  await show(page, "curves");
  assert.equal((await layout(page, "curves")).yaxis.type, "log");
  await choose(page, "curves-scale", "linear");
  assert.equal((await layout(page, "curves")).yaxis.type, "linear");
  const reading = () => plotOf(page, "curves").evaluate((node) => node.data[1].y[8]);
  const red = await reading();
  await choose(page, "curves-channel", "1");
  assert.notEqual(await reading(), red);
  await page.selectOption("#curves-incidence", "3");
  const strong = await plotOf(page, "curves").evaluate((node) => node.data.filter((trace) => trace.opacity === 1).length);
  assert.equal(strong, 3, "line, readings and residuals of one angle");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the maps share a scale, follow the choices and read out", async () => {
  const { page, complaints } = await open(browser, "fit.html");
  await show(page, "maps");
  const heat = (index) => plotOf(page, "maps", index).evaluate(({ data: [{ zmin, zmax, z }] }) => ({ zmin, zmax, z: z.flat().filter((v) => v !== null) }));
  const [measured, fitted, difference] = [await heat(0), await heat(1), await heat(2)];
  assert.deepEqual([measured.zmin, measured.zmax], [fitted.zmin, fitted.zmax]);
  assert.equal(difference.zmin, -difference.zmax);
  assert.ok(measured.z.length > 30000, "a scan of the whole hemisphere leaves no gap");
  await page.selectOption("#maps-incidence", "7");
  assert.notDeepEqual((await heat(0)).zmax, measured.zmax);
  await choose(page, "maps-scale", "linear");
  assert.equal((await heat(0)).zmin, 0);
  const box = await plotOf(page, "maps").boundingBox();
  await page.mouse.move(box.x + 0.55 * box.width, box.y + 0.5 * box.height, { steps: 4 });
  await page.waitForFunction(() => document.querySelector(".readout").textContent.includes("measured"));
  assert.match(await page.locator(".readout").textContent(), /^θᵣ [\d.]+°, φᵣ − φᵢ .*: measured .*, fitted .* sr⁻¹, difference .* %$/);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the lobe turns, by buttons too, and its radius can be chosen", async () => {
  const { page, complaints } = await open(spatial, "fit.html");
  await show(page, "lobes");
  const highest = () => plotOf(page, "lobes").evaluate((node) => Math.max(...node.data[0].z.flat()));
  const [root, eye] = [await highest(), (await layout(page, "lobes")).scene.camera.eye];
  await choose(page, "lobes-scale", "linear");
  assert.notEqual(await highest(), root);
  await page.getByRole("button", { name: "turn left" }).press("Enter");
  const turned = (await layout(page, "lobes")).scene.camera.eye;
  assert.ok(Math.hypot(turned.x - eye.x, turned.y - eye.y) > 0.1);
  assert.ok(Math.abs(turned.z - eye.z) < 1e-6);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("the keyboard suffices", async () => {
  const { page } = await open(browser, "fit.html");
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Skip to the report");
  await page.keyboard.press("Enter");
  await show(page, "curves");
  await page.focus("#curves-channel-0");
  await page.keyboard.press("ArrowRight");
  assert.ok(await page.isChecked("#curves-channel-1"));
  assert.ok(await page.isChecked("#maps-channel-1"), "all plots show the channel chosen");
  const outline = await page.$eval('label[for="curves-channel-1"]', (label) => getComputedStyle(label).outlineStyle);
  assert.equal(outline, "solid", "the focus is visible");
  await page.close();
});

test("fits a phone", async () => {
  const { page, complaints } = await open(spatial, "fit.html", { width: 390, height: 844 });
  await page.screenshot({ path: picture("phone.png") });
  for (const id of ["curves", "maps", "lobes"]) {
    await show(page, id);
    await page.locator(`#${id}`).screenshot({ path: picture(`phone-${id}.png`) });
  }
  assert.ok(await page.evaluate(() => document.scrollingElement.scrollWidth <= innerWidth), "nothing sticks out");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("prints, without its controls and with plots that were never in view", async () => {
  const { page, complaints } = await open(spatial, "fit.html");
  const pdf = await page.pdf({ path: picture("paper.pdf"), format: "A4" });
  assert.ok(pdf.length > 50000);
  assert.ok(await plotOf(page, "maps").evaluate((node) => Boolean(node.data)), "drawn for the printer");
  await page.emulateMedia({ media: "print" });
  assert.equal(await page.locator(".controls").first().isVisible(), false);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("does without WebGL and says so", async () => {
  const { page, complaints } = await open(browser, "fit.html");
  assert.match(await page.locator("#lobes").textContent(), /WebGL is off/);
  await show(page, "maps");
  assert.deepEqual(complaints, []);
  await page.close();
});

test("names that are markup stay names", async () => {
  const evil = `</script><script>alert("1")</script><img src="x" onerror="alert(2)">`;
  const material = JSON.parse(readFileSync(join(scratch, "m.json"), "utf8"));
  writeFileSync(join(scratch, "evil.json"), JSON.stringify({ ...material, name: evil }));
  copyFileSync(scan, join(scratch, "<b>scan.csv"));
  goniofit("report", "evil.json", "<b>scan.csv", "-o", "evil.html");
  const { page, complaints } = await open(browser, "evil.html");
  assert.equal(await page.locator("h1").textContent(), evil);
  assert.match(await page.title(), /<\/script><script>alert/);
  await show(page, "curves");
  assert.match(await page.locator("#source").textContent(), /<b>scan\.csv/);
  assert.equal(await page.$$eval("#main b, h1 *, #source img", (all) => all.length), 0);
  assert.deepEqual(complaints, []);
  await page.close();
});

test("a scan in the plane has curves and no map; a material has no correlations", async () => {
  goniofit("report", source("fits/aluminium_coated_45.json"), source("data/aluminium_coated_45.csv"), "-o", "plane.html");
  const { page, complaints } = await open(browser, "plane.html");
  await show(page, "curves");
  assert.match(await page.locator("#maps").textContent(), /no hemisphere to map/);
  assert.match(await page.locator("#correlation").textContent(), /goniofit fit … --report/);
  await page.screenshot({ path: picture("plane.png") });
  assert.deepEqual(complaints, []);
  await page.close();
});
