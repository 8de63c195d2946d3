// Other kinds of runs: a ball in space, friction, a run without fields, a damaged file.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { assertNear, ballRun, closeBrowser, fingerprint, folder, frictionRun, open, painted, report, ricochet, settle, simulate, source } from "./support.mjs";

after(closeBrowser);

test("a ball in space can be rotated and coloured, and shows values at the pointer", async () => {
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
  assert.notEqual(await fingerprint(page, picture), before, "rotated");
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
  assert.equal(await page.$("#maps"), null, "no line for a map");
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("a plane in space is drawn over the extent of the body", async () => {
  const view = await open(report("ball", ballRun()));
  const { low, high, box } = await view.page.evaluate(() => {
    const own = window.ricochet.stage.panels[0].view;
    own.update();
    const places = own.obstacles.sheets[0].faces.geometry.attributes.position.array;
    const along = (k) => Array.from(places).filter((_, i) => i % 3 === k);
    return { low: [0, 1, 2].map((k) => Math.min(...along(k))), high: [0, 1, 2].map((k) => Math.max(...along(k))), box: own.box };
  });
  const size = Math.hypot(...box.high.map((value, k) => value - box.low[k]));
  for (const k of [0, 1]) {
    assert.ok(low[k] < box.low[k] && low[k] > box.low[k] - 0.3 * size, `${low[k]} beside ${box.low[k]}`);
    assert.ok(high[k] > box.high[k] && high[k] < box.high[k] + 0.3 * size, `${high[k]} beside ${box.high[k]}`);
  }
  assert.deepEqual([low[2], high[2]], [0, 0], "it lies in its plane");
  await view.close();
});

test("an axisymmetric body is shown whole, or as its section", async () => {
  const run = simulate("cases/ball-axisymmetric/ball-axisymmetric.toml", "axisymmetric", { "time.end": 5e-4, "output.fields_every": 5 });
  const view = await open(report("axisymmetric", run));
  /** Numbers of pixels above the plane that are not background, in each half of the picture, and that differ between the halves. */
  const halves = () => view.page.evaluate(() => {
    const { stage } = window.ricochet;
    stage.draw();
    const canvas = document.querySelector(".bodies canvas");
    const [width, height] = [canvas.width, Math.round(canvas.height / 2)];
    const copy = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
    copy.drawImage(canvas, 0, 0);
    const { data } = copy.getImageData(0, 0, width, height);
    const at = (x, y) => data.slice(4 * (y * width + x), 4 * (y * width + x) + 3).join();
    const ground = at(2, 2);
    const counts = { left: 0, right: 0, unlike: 0 };
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < Math.floor(width / 2) - 2; ++x) {
        const [left, right] = [at(x, y), at(width - 1 - x, y)];
        counts.left += left !== ground;
        counts.right += right !== ground;
        counts.unlike += left !== right;
      }
    }
    return counts;
  });
  const whole = await halves();
  assert.ok(whole.left > 1000 && whole.unlike < 0.05 * whole.left, JSON.stringify(whole));
  await view.page.click("text=whole");
  await settle(view.page);
  const section = await halves();
  assert.ok(section.left === 0 && section.right > 0.95 * whole.right, JSON.stringify(section));
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

test("the card shows the impulse without and with friction, and a restitution above 1 that is possible", async () => {
  const run = simulate("cases/oblique/oblique.toml", "coarse", { "time.scheme": "newmark", "time.preset": "trapezoidal", "time.step": 5e-4, "mass.type": "consistent" });
  const [impact] = JSON.parse(readFileSync(join(run, "summary.json"), "utf8")).impacts;
  assert.ok(impact.restitution > 1.001);
  const view = await open(report("coarse", run));
  const card = await view.page.textContent(".card");
  const [, normal, whole] = /normal impulse ([\d.]+) \(with friction ([\d.]+)\)/.exec(card);
  assertNear(Number(normal), impact.normal_impulse, 5e-3 * impact.normal_impulse);
  assertNear(Number(whole), Math.hypot(...impact.impulse), 5e-3 * Math.hypot(...impact.impulse));
  // Friction extracts energy from the motion along the plane, which is as fast as that towards it.
  assert.match(card, /restitution 1\.00\d ~\(above 1: fed by sliding, spin or vibration, or newmark creates energy\)/);
  await view.close();
});

test("the card states why there is no restitution, and that a contact zone is too coarse", async () => {
  const run = simulate("cases/disc/disc.toml", "grazing", { "initial.velocity": "[200.0, -0.02]", "load.gravity": "[0.0, 0.0]", "time.end": 0.15, "output.fields_every": 0 });
  const [impact] = JSON.parse(readFileSync(join(run, "summary.json"), "utf8")).impacts;
  assert.equal(impact.restitution, null);
  assert.equal(impact.coarse, true);
  const view = await open(report("grazing", run));
  const card = await view.page.textContent(".card");
  assert.ok(card.includes(`no restitution (${impact.why_no_restitution})`), card);
  assert.ok(card.includes(`(at most ${impact.contact_points} of ${impact.all_contact_points} contact points at once: too coarse)`), card);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("a moving obstacle may return a body faster", async () => {
  const run = simulate("cases/disc/disc.toml", "driven", { "time.scheme": "midpoint", "mass.type": "consistent", "obstacle.foundation.velocity": "[0.0, 0.02]", "output.fields_every": 0 });
  const [impact] = JSON.parse(readFileSync(join(run, "summary.json"), "utf8")).impacts;
  assert.ok(impact.restitution > 1.001);
  const view = await open(report("driven", run));
  const card = await view.page.textContent(".card");
  assert.match(card, /~\(above 1: driven\)/);
  assert.doesNotMatch(card, /impossible/);
  await view.close();
});

test("a run without fields has plots", async () => {
  const run = simulate("cases/disc/disc.toml", "plain", { "time.end": 0.01, "output.fields_every": 0 });
  const view = await open(report("plain", run));
  assert.match(await view.page.textContent("#moving"), /nothing to animate/);
  assert.ok((await painted(view.page, "#chart-energy canvas")) > 0.005);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

const shortDisc = (name, settings = {}) => simulate("cases/disc/disc.toml", name, { "time.end": 0.01, "output.fields_every": 20, ...settings });

test("plots of all kinds of runs support logarithmic and relative scales and all curves", async () => {
  for (const run of [ballRun(), shortDisc("short"), frictionRun()]) {
    const view = await open(report("log", run));
    const { page } = view;
    for (const select of await page.$$("select[data-chart]")) await select.selectOption("logarithmic");
    await settle(page);
    for (const button of await page.$$(".choice")) await button.click();
    await settle(page);
    await page.click("text=change, %");
    for (const select of await page.$$("select[data-chart]")) await select.selectOption("all");
    await settle(page);
    for (const field of await page.$$eval("#field option", (all) => all.map((each) => each.value))) {
      await page.selectOption("#field", field);
      await settle(page);
    }
    assert.deepEqual(view.complaints, []);
    await view.close();
  }
});

test("runs in the plane and in space, of different sizes and durations, are shown side by side", async () => {
  const runs = [shortDisc("small"), ballRun(), simulate("cases/rod/rod.toml", "rod")];
  const view = await open(report("mixed", ...runs));
  const { page } = view;
  for (const field of await page.$$eval("#field option", (all) => all.map((each) => each.value))) {
    await page.selectOption("#field", field);
    await settle(page);
  }
  await page.selectOption("#field", "von_mises");
  await page.evaluate(() => window.ricochet.store.setTime(0.05));
  await settle(page);
  // Each body fits its panel: the camera sees the corners of its box.
  const extents = await page.evaluate(() => window.ricochet.stage.panels.map(({ view }) => {
    const { low, high } = view.box;
    return [low, high].map((corner) => corner.map((x, k) => Math.abs(x / view.content.scale.x ** -1 + view.content.position.getComponent(k))));
  }));
  for (const corner of extents.flat(2)) assert.ok(corner < 0.7, String(corner));
  // Forces of all runs are drawn, though their probes have different names; a run has no value after its end.
  const drawn = await page.evaluate(() => window.ricochet.charts.find((chart) => chart.id === "force").curves.map((curve) => curve.values.length));
  assert.equal(drawn.length, 3);
  assert.ok(drawn.every((rows) => rows > 50));
  assert.match(await page.textContent("#chart-energy .legend"), /small –/);
  assert.equal(await page.locator(".conclusion").count(), 0, "the runs solve different problems");
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("more runs than a browser can draw", async () => {
  const runs = Array.from({ length: 14 }, (_, i) => shortDisc(`many/${i}`));
  const view = await open(report("many", ...runs));
  const { page } = view;
  const drawn = () => page.evaluate(() => window.ricochet.stage.panels.filter(({ renderer }) => renderer).length);
  assert.equal(await drawn(), 12);
  await page.locator(".top button", { hasText: "all runs" }).click();
  await settle(page);
  assert.equal(await drawn(), 12);
  assert.equal(await page.locator(".body-area .note:visible").count(), 2);
  await page.click(".card:nth-child(14) .toggle", { modifiers: ["Shift"] });
  await settle(page);
  assert.equal(await drawn(), 1);
  assert.equal(await page.locator(".body-area .note:visible").count(), 0);
  assert.deepEqual(view.complaints.filter((each) => !/context/i.test(each)), []);
  await view.close();
});

test("runs that failed or without contact are not recommended", async () => {
  const bad = join(folder, "failed");
  try {
    ricochet("run", join(source, "cases/disc/disc.toml"), "-o", bad, "--quiet", "--set", "time.scheme=midpoint", "--set", "mass.type=consistent",
      "--set", "check.on_failure=stop", "--set", "check.energy_residual=1e-18", "--set", "time.end=0.01");
  } catch { /* status 3 */ }
  const view = await open(report("bad", shortDisc("good"), bad));
  assert.equal(await view.page.locator(".conclusion").count(), 0);
  assert.match(await view.page.textContent(".card:nth-child(2)"), /failed/);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("an infinite depth is reported, not shown as none", async () => {
  const run = shortDisc("infinite");
  const file = join(run, "summary.json");
  const summary = JSON.parse(readFileSync(file, "utf8"));
  const found = { obstacle: "floor", bodies: ["body 0"], depth: "inf", relative_depth: "inf", time: 0.005, place: [0, 0], first_time: 0.005, groups: [], contact: null, passed_through: false, through_groups: [] };
  summary.unwatched_penetration = { ...summary.unwatched_penetration, depth: "inf", relative_depth: "inf", found: [found] };
  writeFileSync(file, JSON.stringify(summary));
  const view = await open(report("infinite", run));
  const words = await view.page.$$eval(".findings dt", (all) => Object.fromEntries(all.map((dt) => [dt.textContent, dt.nextElementSibling])
    .map(([what, dd]) => [what, `${dd.className}: ${dd.textContent} (${dd.title})`])));
  assert.match(words.Interpenetration, /^poor: .*infinitely deep \(body 0 in "floor", where no contact prevents it; infinite or NaN\)/);
  assert.match(words["Contact force"], /up to/);
  assert.deepEqual(view.complaints, []);
  await view.close();
});

test("a force is in doubt where frozen steps have left gaps", async () => {
  for (const [share, grade] of [[0.43, "poor"], [0.005, ""]]) {
    const run = shortDisc(`doubt${share}`);
    const file = join(run, "summary.json");
    const summary = JSON.parse(readFileSync(file, "utf8"));
    summary.unsettled_contacts = [0.001, share].map((part, contact) => (
      { contact, share_of_force: part, steps: 7, first_time: 0.002, time: 0.003, gap: -0.0001, place: [0, 0] }));
    writeFileSync(file, JSON.stringify(summary));
    const view = await open(report(`doubt${share}`, run));
    const force = await view.page.$$eval(".findings dt", (all) => all.filter((dt) => dt.textContent === "Contact force")
      .map((dt) => `${dt.nextElementSibling.className}: ${dt.nextElementSibling.textContent}`)[0]);
    if (grade) assert.match(force, /^poor: .*in doubt: up to 43 % of the force of contact 1 is at stake where frozen steps have left gaps/);
    else assert.doesNotMatch(force, /in doubt/);
    assert.deepEqual(view.complaints, []);
    await view.close();
  }
});

test("large corrections of velocities are no good energy balance", async () => {
  for (const steps of [3, 0]) {
    const run = shortDisc(`corrected${steps}`);
    const file = join(run, "summary.json");
    const summary = JSON.parse(readFileSync(file, "utf8"));
    summary.velocity_corrections = { steps, first_time: steps ? 0.002 : null, largest: 0.0025, time: 0.003 };
    writeFileSync(file, JSON.stringify(summary));
    const view = await open(report(`corrected${steps}`, run));
    const energy = await view.page.$$eval(".findings dt", (all) => all.filter((dt) => dt.textContent.startsWith("Energy"))
      .map((dt) => `${dt.nextElementSibling.className}: ${dt.nextElementSibling.textContent} (${dt.nextElementSibling.title})`)[0]);
    assert.equal(/corrections of velocities to close the balance changed up to 0.25 % of the energy in a step, and too much in 3 of/.test(energy), steps > 0, energy);
    if (steps) assert.doesNotMatch(energy, /^good/);
    assert.deepEqual(view.complaints, []);
    await view.close();
  }
});

test("unchecked penetration has no good mark", async () => {
  const run = shortDisc("unwatched");
  const file = join(run, "summary.json");
  const summary = JSON.parse(readFileSync(file, "utf8"));
  const words = async (name, changes) => {
    writeFileSync(file, JSON.stringify({ ...summary, unwatched_penetration: { ...summary.unwatched_penetration, ...changes } }));
    const view = await open(report(name, run));
    const dd = await view.page.$$eval(".findings dt", (all) => all.filter((dt) => dt.textContent === "Interpenetration")
      .map((dt) => `${dt.nextElementSibling.className}: ${dt.nextElementSibling.textContent}`));
    assert.deepEqual(view.complaints, []);
    await view.close();
    return dd[0];
  };
  assert.match(await words("watched", {}), /^good: .?none$/);
  assert.match(await words("unwatched", { not_watched: ["bodies against themselves"] }),
    /^none: .?none where checked; not checked: bodies against themselves$/);
  const found = { obstacle: null, bodies: ["the body"], depth: 0.01, relative_depth: 0.125, time: 0.005, place: [0, 0], first_time: 0.005, groups: [], contact: null, passed_through: false, through_groups: [] };
  assert.match(await words("itself", { depth: 0.01, relative_depth: 0.125, found: [found] }), /^poor: .?12.5 % of the body's size/);
});

test("a truncated file is reported", async () => {
  const whole = readFileSync(report("whole", simulate("cases/disc/disc.toml", "plain2", { "time.end": 0.01 })), "utf8");
  const file = join(folder, "cut.html");
  writeFileSync(file, whole.replace(/<script type="text\/plain" id="ricochet-blob-0">.*?<\/script>/s, ""));
  const { openBrowser } = await import("./support.mjs");
  const page = await (await openBrowser()).newPage();
  await page.goto(`file://${file}`);
  await page.waitForSelector(".warning");
  assert.match(await page.textContent(".warning"), /cannot be shown: this file is truncated/);
  await page.close();
});
