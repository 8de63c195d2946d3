// The report of the demo, which compares three runs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { assertNear, closeBrowser, discRuns, download, fingerprint, open, painted, readHistory, report, settle } from "./support.mjs";

let runs, file, view;
before(async () => {
  runs = discRuns();
  file = report("disc", ...runs);
  view = await open(file);
});
after(closeBrowser);

const curves = (page, id) => page.evaluate((chart) => window.ricochet.charts.find((each) => each.id === chart).curves
  .map((curve) => ({ ...curve, times: Array.from(curve.times), values: Array.from(curve.values) })), id);
const time = (page) => page.evaluate(() => window.ricochet.store.time);
const setTime = async (page, to) => {
  await page.evaluate((t) => window.ricochet.store.setTime(t), to);
  await settle(page);
};

test("the page opens at the largest contact force of all runs", async () => {
  const step = 1e-4;
  const peaks = runs.map((directory) => {
    const { time: times, contact_force_x: x, contact_force_y: y } = readHistory(directory);
    const sizes = y.map((value, i) => Math.hypot(value, x[i]));
    const force = Math.max(...sizes);
    return { force, time: times[sizes.indexOf(force)] - (directory.endsWith("midpoint") ? 0.5 * step : 0) }; // its forces hold half a step earlier
  });
  assert.equal(new Set(peaks.map((peak) => peak.time)).size, 3, "otherwise the test is void");
  assertNear(await time(view.page), peaks.reduce((a, b) => (b.force > a.force ? b : a)).time, 1e-12);
});

test("every column of every run is in the page with the values of history.csv", async () => {
  for (const directory of runs) {
    const history = readHistory(directory);
    const name = directory.split("/").at(-1);
    const found = await view.page.evaluate((run) => {
      const { history } = window.ricochet.store.runs.find((each) => each.name === run);
      return Object.fromEntries([...history].map(([column, values]) => [column, Array.from(values)]));
    }, name);
    assert.deepEqual(found, history);
  }
});

test("curves have the values and the instants of the history", async () => {
  const step = 1e-4;
  for (const [chart, column] of [["energy", "total_energy"], ["force", "contact_force_y"], ["works", "contact_work"], ["counts", "active_contacts"]]) {
    const drawn = await curves(view.page, chart);
    assert.deepEqual(drawn.map((curve) => curve.run).sort(), ["klr-conserving", "midpoint", "newmark"]);
    for (const curve of drawn) {
      assert.equal(curve.column, column);
      const history = readHistory(runs.find((run) => run.endsWith(curve.run)));
      assert.deepEqual(curve.values, history[column]);
      // The source's instants: klr-conserving has energies half a step later, midpoint forces half a step earlier.
      const shift = column === "total_energy" && curve.run === "klr-conserving" ? 0.5 * step
        : column === "contact_force_y" && curve.run === "midpoint" ? -0.5 * step : 0;
      curve.times.forEach((t, i) => assertNear(t, history.time[i] + shift, 1e-15));
    }
  }
});

test("the numbers under a plot are those at the cursor", async () => {
  await setTime(view.page, 0.05);
  const text = await view.page.textContent("#chart-force .legend");
  for (const directory of runs) {
    const history = readHistory(directory);
    const name = directory.split("/").at(-1);
    const shown = Number(new RegExp(`${name} ([\\d.]+)`).exec(text)[1]);
    const row = history.time.findIndex((t) => Math.abs(t - 0.05) < 1e-9);
    const candidates = name === "midpoint" ? [row, row + 1] : [row];
    assert.ok(candidates.some((i) => Math.abs(shown - history.contact_force_y[i]) <= 1e-5 * Math.abs(shown)), `${name}: ${shown}`);
  }
});

test("cards show what each scheme does, and that the disc is too soft for small strain", async () => {
  assert.match(await view.page.textContent(".conclusion"), /^No recommendation: in all of these runs cells rotate by more than 0\.1 rad/);
  const cards = await view.page.$$eval(".card", (all) => all.map((card) => card.textContent));
  assert.match(cards[0], /midpoint.*created: up to \d+ times the initial energy.*rattles/s);
  // It explodes, so the speed at which it leaves is arbitrary; the others lose energy to vibrations and have no remark.
  assert.match(cards[0], /restitution \S+ ✗\((impossible|unreliable): midpoint creates energy; small strain does not hold\)/);
  for (const card of cards.slice(1)) assert.doesNotMatch(card, /above 1|impossible|unreliable/);
  const ratios = (directory) => JSON.parse(readFileSync(`${directory}/summary.json`)).impacts.filter((impact) => Number.isFinite(impact.restitution));
  assert.equal((await view.page.$$("#impacts .poor")).length, ratios(runs.find((each) => each.endsWith("midpoint"))).length);
  assert.match(cards[1], /klr-conserving.*conserved to rounding.*rattles/s);
  assert.match(cards[2], /newmark.*conserved to within 0\.03.*smooth.*none.*Rotation0?.*0\.4\d* rad: small strain does not hold/s);
  // The midpoint scheme's growth does not hide the others.
  const range = await view.page.evaluate(() => window.ricochet.charts.find((chart) => chart.id === "energy").range);
  assert.ok(range.high < 0.2 && range.high > 0.0377 && range.low <= 0, JSON.stringify(range));
  assert.match(await view.page.textContent("#chart-energy .outside"), /midpoint exceeds this scale and reaches/);
  await view.page.click("#chart-energy .outside button");
  const all = await view.page.evaluate(() => window.ricochet.charts.find((chart) => chart.id === "energy").range);
  assert.ok(all.high > 5);
  await view.page.selectOption("#chart-energy select", "most");
});

test("hovering over a plot moves body, maps and the other plots to that time", async () => {
  const { page } = view;
  const plot = await page.$("#chart-energy .u-over");
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
  await settle(page);
  assertNear(await time(page), 0.4 * 0.15, 0.15 / box.width + 1e-9, "time");
  const now = await time(page);
  const state = await page.evaluate(() => ({
    cursor: window.ricochet.charts.map((chart) => chart.plot.posToVal(chart.plot.cursor.left, "x")),
    frames: window.ricochet.stage.panels.map(({ view }) => view.run.body.times[view.frame]),
    captions: [...document.querySelectorAll(".body-foot .muted")].map((each) => each.textContent),
    map: [...document.querySelectorAll(".map .cursor")].map((each) => parseFloat(each.style.left)),
    areas: [...document.querySelectorAll(".map-area")].map((each) => each.clientWidth),
    profile: window.ricochet.profile.profiles.map((profile) => profile.time),
  }));
  for (const at of state.cursor) assertNear(at, now, 0.15 / 400, "cursor of a plot");
  for (const at of [...state.frames, ...state.profile]) assertNear(at, now, 2.6e-4, "frame");
  state.captions.forEach((text, i) => {
    const [, at, force] = /^t = ([\d.]+), contact force ([\d.]+)$/.exec(text);
    assertNear(Number(at), now, 3e-4, "caption");
    // The resultant at that time; its instants are shifted by half a step in the midpoint scheme.
    const history = readHistory(runs[i]);
    const row = history.time.findIndex((t) => Math.abs(t - Number(at)) < 1e-9);
    const candidates = [row, row + 1].map((k) => Math.hypot(history.contact_force_x[k], history.contact_force_y[k]));
    assert.ok(candidates.some((value) => Math.abs(value - Number(force)) <= 1e-3 * value), `${text}: ${candidates}`);
  });
  state.map.forEach((left, i) => assertNear((left - 66) / (state.areas[i] - 74), now / 0.15, 0.005, "cursor of a map"));
});

test("hovering over a map moves the plots, and shows the value of the map", async () => {
  const { page } = view;
  const canvas = (await page.$$(".map-area canvas"))[2];
  await canvas.scrollIntoViewIfNeeded();
  const box = await canvas.boundingBox();
  await page.mouse.move(box.x + 66 + (1 / 3) * (box.width - 74), box.y + 75);
  await settle(page);
  assertNear(await time(page), 0.05, 0.15 / 300, "time");
  const text = await page.textContent(".run-panel:nth-child(3) .map .tip");
  assert.match(text, /^contact pressure [\d.·⁰-⁹]+ at 0\.03/);
  assert.match(await page.textContent("#chart-energy .legend"), /newmark 0\.0376/);
});

test("the pressure is smooth with the equivalent mass, and a checkerboard under the conserving scheme", async () => {
  // Jumps from node to node and from frame to frame, relative to the pressures: small for a single hill, 2 for a checkerboard.
  const roughness = await view.page.evaluate(() => window.ricochet.store.runs.map((run) => {
    const { values } = run.contact.quantities.find(({ name }) => name === "contact_pressure");
    const at = (row, column) => values.low + values.step * values.levels[row * values.columns + column];
    let jumps = 0, sum = 0;
    for (let row = 1; row < values.rows; ++row)
      for (let column = 1; column < values.columns; ++column) {
        jumps += Math.abs(at(row, column) - at(row, column - 1)) + Math.abs(at(row, column) - at(row - 1, column));
        sum += 2 * at(row, column);
      }
    return jumps / sum;
  }));
  assert.ok(roughness[2] < 0.3, `newmark ${roughness[2]}`);
  assert.ok(roughness[1] > 1.2, `klr-conserving ${roughness[1]}`);
  for (const i of [1, 2]) assert.ok((await painted(view.page, `.maps .run-panel:nth-child(${i + 1}) canvas`)) > 0.1);
});

test("the animation advances, and stops", async () => {
  const { page } = view;
  await setTime(page, 0);
  await page.$eval("#bodies", (element) => element.scrollIntoView());
  const picture = ".bodies .run-panel:nth-child(3) canvas";
  const first = await fingerprint(page, picture);
  const pictures = await page.evaluate(() => window.ricochet.stage.pictures);
  await page.click(".play");
  await page.waitForFunction(() => window.ricochet.store.time > 0.02, null, { timeout: 20_000 });
  assert.equal(await page.getAttribute(".play", "aria-label"), "Pause");
  await page.click(".play");
  await settle(page);
  const stopped = await time(page);
  assert.notEqual(await fingerprint(page, picture), first);
  assert.ok((await page.evaluate(() => window.ricochet.stage.pictures)) > pictures + 5);
  await page.waitForTimeout(200);
  assert.equal(await time(page), stopped);
});

test("names and keys show and hide runs in all plots", async () => {
  const { page } = view;
  await page.click(".card:nth-child(1) .toggle");
  await settle(page);
  for (const chart of ["energy", "force", "momentum"])
    assert.deepEqual((await curves(page, chart)).map((curve) => curve.run).sort(), ["klr-conserving", "newmark"]);
  assert.equal(await page.isVisible(".bodies .run-panel:nth-child(1)"), false);
  assert.equal(await page.isVisible(".maps .run-panel:nth-child(1)"), false);
  assert.equal(await page.getAttribute(".card:nth-child(1) .toggle", "aria-pressed"), "false");
  assert.equal((await page.evaluate(() => window.ricochet.profile.profiles)).length, 2);
  await page.keyboard.press("1");
  await page.keyboard.press("2");
  await settle(page);
  assert.deepEqual((await curves(page, "energy")).map((curve) => curve.run).sort(), ["midpoint", "newmark"]);
  await page.keyboard.press("2");
  await settle(page);
});

test("cursors keep their time when runs are hidden, and rounding is no scale for the others", async () => {
  const { page } = view;
  await page.evaluate(() => window.scrollTo(0, 0));
  const box = await (await page.$("#chart-energy .u-over")).boundingBox();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 30);
  await settle(page);
  const now = await time(page);
  await page.keyboard.press("1");
  await page.click("text=change, %");
  await settle(page);
  const cursors = await page.evaluate(() => window.ricochet.charts.map((chart) => chart.plot.posToVal(chart.plot.cursor.left, "x")));
  for (const at of cursors) assertNear(at, now, 0.15 / 300, "cursor");
  const range = await page.evaluate(() => window.ricochet.charts[0].range);
  assert.ok(range.low < -0.03 && range.low > -0.1, JSON.stringify(range));
  assert.equal(await page.locator("#chart-energy .outside span").count(), 0);
  await page.click("text=change, %");
  await page.keyboard.press("1");
  await settle(page);
});

test("buttons at the foot of the page show and hide runs", async () => {
  const { page } = view;
  await page.locator(".chip").nth(2).click();
  await settle(page);
  assert.deepEqual((await curves(page, "energy")).map((curve) => curve.run).sort(), ["klr-conserving", "midpoint"]);
  assert.equal(await page.locator(".chip").nth(2).getAttribute("aria-pressed"), "false");
  await page.locator(".chip").nth(2).click();
  await settle(page);
  assert.equal((await curves(page, "energy")).length, 3);
});

test("the legend shows the pressure along the boundary at the pointer", async () => {
  const { page } = view;
  await setTime(page, 0.05);
  const over = page.locator("#profile .u-over");
  await over.evaluate((element) => element.scrollIntoView({ block: "center" }));
  const box = await over.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await settle(page);
  const wanted = await page.evaluate(() => window.ricochet.profile.profiles.map(({ run, position, values }) => {
    const middle = position.at(-1) / 2;
    const node = position.map((s) => Math.abs(s - middle)).reduce((best, d, i, all) => (d < all[best] ? i : best), 0);
    return [run.name, values[node], position[node]];
  }));
  const legend = await page.textContent("#profile .legend");
  for (const [name, value, place] of wanted) {
    const found = new RegExp(`${name} ([\\d.]+) at ([\\d.]+), t = 0\\.05`).exec(legend);
    assert.ok(found, `${name}: ${legend}`);
    assertNear(Number(found[1]), value, 1e-4 * value + 1e-9);
    assertNear(Number(found[2]), place, 1e-4);
  }
});

test("keys step, play, magnify, colour", async () => {
  const { page } = view;
  await page.evaluate(() => document.activeElement?.blur());
  await setTime(page, 0.05);
  await page.keyboard.press("ArrowRight");
  assertNear(await time(page), 0.0505, 1e-9);
  await page.keyboard.press("Shift+ArrowLeft");
  assertNear(await time(page), 0.0455, 1e-9);
  await page.keyboard.press("Home");
  assert.equal(await time(page), 0);
  await page.keyboard.press("End");
  assertNear(await time(page), 0.15, 1e-12);
  const picture = ".bodies .run-panel:nth-child(3) canvas";
  await setTime(page, 0.05);
  const plain = await fingerprint(page, picture);
  await page.keyboard.press("+");
  await settle(page);
  assert.notEqual(await fingerprint(page, picture), plain);
  assert.equal(await page.evaluate(() => window.ricochet.store.deformation), 2);
  await page.keyboard.press("-");
  await settle(page);
  assert.equal(await fingerprint(page, picture), plain);
  for (const key of ["m", "p", "f"]) {
    await page.keyboard.press(key);
    await settle(page);
    assert.notEqual(await fingerprint(page, picture), plain, key);
    if (key !== "f") await page.keyboard.press(key);
  }
  await page.selectOption("#field", "von_mises");
  await page.keyboard.press("?");
  assert.ok(await page.isVisible("dialog.help"));
  await page.keyboard.press("Escape");
});

test("the body has the position of the results, and its colours have their values", async () => {
  const { page } = view;
  await setTime(page, 0.05);
  const found = await page.evaluate(() => {
    const { view } = window.ricochet.stage.panels[2];
    const lowest = Array.from(view.positions).filter((_, i) => i % 3 === 1).reduce((a, b) => Math.min(a, b));
    const area = view.mesh.geometry.attributes.position.count / 3;
    return { lowest, area, most: Math.max(...view.values.values), high: view.range.high };
  });
  assertNear(found.lowest, 0, 2e-6, "pressed on the foundation");
  assert.equal(found.area, 780);
  assert.ok(found.most > 1000 && found.most < 1e4, String(found.most));
});

test("dragging over a plot zooms into an interval of time", async () => {
  const { page } = view;
  const plot = await page.$("#chart-energy .u-over");
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 30);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 40, { steps: 5 });
  await page.mouse.up();
  await settle(page);
  const zoom = await page.evaluate(() => ({ zoom: window.ricochet.store.zoom, force: window.ricochet.charts[1].plot.scales.x.min }));
  assertNear(zoom.zoom[0], 0.03, 1e-3);
  assertNear(zoom.zoom[1], 0.09, 1e-3);
  assertNear(zoom.force, zoom.zoom[0], 1e-12, "all plots");
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + 30);
  await settle(page);
  assert.equal(await page.evaluate(() => window.ricochet.store.zoom), null);
});

test("plots, maps and bodies are saved as pictures and numbers", async () => {
  const { page } = view;
  const buttons = (selector, name) => page.locator(`${selector} button`, { hasText: new RegExp(`^${name}$`) }).first();
  const csv = await download(page, () => buttons("#chart-force", "CSV").click());
  assert.equal(csv.name, "contact-force.csv");
  const [header, ...rows] = csv.content.toString().trimEnd().split("\n").map((line) => line.split(","));
  const column = header.indexOf("newmark: contact_force_y");
  assert.deepEqual(rows.map((row) => Number(row[column])), readHistory(runs[2]).contact_force_y);
  for (const [selector, name] of [["#chart-energy", "energy.png"], [".bodies .run-panel:nth-child(3)", "newmark-body.png"], [".maps .run-panel:nth-child(3)", "newmark-contact-pressure.png"], ["#profile", "contact-pressure-along-the-boundary.png"]]) {
    const png = await download(page, () => buttons(selector, "PNG").click());
    assert.equal(png.name, name);
    assert.equal(png.content.subarray(1, 4).toString(), "PNG");
    assert.ok(png.content.length > 3000, `${name} has ${png.content.length} bytes`);
  }
  const map = await download(page, () => buttons(".maps .run-panel:nth-child(3)", "CSV").click());
  assert.equal(map.content.toString().trimEnd().split("\n").length, 302);
});

test("differing inputs, warnings, sizes and timings are shown", async () => {
  const text = await view.page.textContent(".details");
  for (const part of ["time.scheme", "klr-conserving", "small strain no longer holds", "degrees of freedom", "846", "factorization", "account of momentum"])
    assert.ok(text.includes(part), part);
});

test("dark and light", async () => {
  const { page } = view;
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.keyboard.press("t");
  await settle(page);
  assert.notEqual(await background(), light);
  await page.keyboard.press("t");
  assert.equal(await background(), light);
  const dark = await open(file, { colorScheme: "dark" });
  assert.notEqual(await dark.page.evaluate(() => getComputedStyle(document.body).backgroundColor), light);
  assert.deepEqual(dark.complaints, []);
  await dark.close();
});

test("a phone shows the whole page, and touch moves the time", async () => {
  const phone = await open(file, { width: 390, height: 844, touch: true });
  const { page } = phone;
  const wide = await page.evaluate(() => [...document.querySelectorAll("#page *")].filter((each) => each.getBoundingClientRect().right > innerWidth + 1 && !each.closest(".table")).map((each) => each.className));
  assert.deepEqual(wide, []);
  assert.equal(await page.evaluate(() => document.scrollingElement.scrollWidth), 390);
  const over = page.locator("#chart-force .u-over");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  await page.touchscreen.tap(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await settle(page);
  assertNear(await time(page), 0.075, 0.002);
  assert.deepEqual(phone.complaints, []);
  await phone.close();
});

test("the console is empty, and the network was not used", () => assert.deepEqual(view.complaints, []));
