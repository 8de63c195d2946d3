// Other kinds of runs: a ball in space, friction, a run without fields, a damaged file.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { ballRun, closeBrowser, fingerprint, folder, frictionRun, open, painted, report, settle, simulate } from "./support.mjs";

after(closeBrowser);

test("a ball in space is turned, coloured, and asked for values", async () => {
  const view = await open(report("ball", ballRun()));
  const { page } = view;
  await page.evaluate(() => window.ricochet.store.setTime(0.0365));
  await page.$eval("#bodies", (element) => element.scrollIntoView());
  await settle(page);
  const picture = ".bodies canvas";
  const before = await fingerprint(page, picture);
  const box = await (await page.$(picture)).boundingBox();
  const middle = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...middle);
  await settle(page);
  assert.match(await page.textContent(".body-area .tip"), /^von Mises stress [\d.]+.* at \(−?[\d.·⁻⁰-⁹]+, .*, .*\)$/);
  await page.mouse.down();
  await page.mouse.move(middle[0] + 80, middle[1] - 20, { steps: 4 });
  await page.mouse.up();
  await settle(page);
  assert.notEqual(await fingerprint(page, picture), before, "turned");
  await page.click("text=below");
  await page.selectOption("#field", "contact_pressure");
  await settle(page);
  const pressures = await page.evaluate(() => {
    const { values, range } = window.ricochet.stage.panels[0].view;
    const there = Array.from(values.values).filter((value) => value === value);
    return { most: Math.max(...there), some: there.filter((value) => value > 0).length, all: values.values.length, range };
  });
  assert.ok(pressures.some > 5 && pressures.some < pressures.all / 4, JSON.stringify(pressures));
  assert.ok(pressures.most > 0 && pressures.range.high > 0);
  assert.equal(await page.$("#maps"), null, "there is no line to plot along");
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("stick and slip have colours of their own", async () => {
  const view = await open(report("friction", frictionRun()));
  const { page } = view;
  await page.selectOption("#quantity", "contact_status");
  await settle(page);
  const colours = await page.evaluate(() => {
    const canvas = document.querySelector(".map-area canvas");
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
    const counts = {};
    for (let i = 0; i < data.length; i += 4) {
      const colour = `rgb(${data[i]}, ${data[i + 1]}, ${data[i + 2]})`;
      counts[colour] = (counts[colour] ?? 0) + 1;
    }
    return Object.fromEntries([...document.querySelectorAll(".map .colour-names .item")]
      .map((item) => [item.textContent, counts[getComputedStyle(item.querySelector("i")).backgroundColor] ?? 0]));
  });
  assert.deepEqual(Object.keys(colours), ["open", "sticks", "slips"]);
  for (const [name, count] of Object.entries(colours)) assert.ok(count > 200, `${name}: ${count} pixels`);
  assert.match(await page.textContent(".findings"), /Energy/);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("a run without fields has its plots", async () => {
  const run = simulate("cases/disc/disc.toml", "plain", { "time.end": 0.01, "output.fields_every": 0 });
  const view = await open(report("plain", run));
  assert.match(await view.page.textContent("#moving"), /nothing to animate/);
  assert.ok((await painted(view.page, "#chart-energy canvas")) > 0.005);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("a file that was cut off says so", async () => {
  const whole = readFileSync(report("whole", simulate("cases/disc/disc.toml", "plain2", { "time.end": 0.01 })), "utf8");
  const file = join(folder, "cut.html");
  writeFileSync(file, whole.replace(/<script type="text\/plain" id="ricochet-blob-0">.*?<\/script>/s, ""));
  const { openBrowser } = await import("./support.mjs");
  const page = await (await openBrowser()).newPage();
  await page.goto(`file://${file}`);
  await page.waitForSelector(".warning");
  assert.match(await page.textContent(".warning"), /cannot be shown: this file is cut off/);
  await page.close();
});
