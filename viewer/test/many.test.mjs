// A study of twelve runs: colours, a row for each run, results against the entries that vary.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertNear, closeBrowser, download, open, painted, readHistory, report, settle, simulate } from "./support.mjs";

const speeds = [0.05, 0.1, 0.15, 0.2, 0.25, 0.3];
const moduli = [5000, 20000];
const runs = [];
let view, page;
before(async () => {
  for (const mu of moduli)
    for (const speed of speeds)
      runs.push({ speed, mu, directory: simulate("cases/disc/disc.toml", `study/mu${mu}-v${speed}`, { "initial.velocity": `[0.0, -${speed}]`, "material.0.mu": mu,
        // With this weight the acting forces, from which impacts are computed, are those of the history.
        "time.reaction_weight": "end", "time.end": 0.02, "time.step": 2e-4, "output.fields_every": 50 }) });
  view = await open(report("study", ...runs.map(({ directory }) => directory)));
  ({ page } = view);
});
after(closeBrowser);

/** CIE Lab under D65, a formula independent of the one that chooses the colours. */
function lab(rgb) {
  const [r, g, b] = rgb.map((value) => value / 255).map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
  const f = (t) => (t > (6 / 29) ** 3 ? Math.cbrt(t) : (t * (29 / 6) ** 2) / 3 + 4 / 29);
  const x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505), y = f(0.2126 * r + 0.7152 * g + 0.0722 * b), z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return [116 * y - 16, 500 * (x - y), 200 * (y - z)];
}

test("the colours of all runs are distinct", async () => {
  for (const theme of ["light", "dark"]) {
    if (theme === "dark") await page.keyboard.press("t");
    await settle(page);
    const colours = await page.$$eval(".runs .toggle i", (all) => all.map((each) => getComputedStyle(each).backgroundColor.match(/\d+/g).map(Number)));
    assert.equal(colours.length, 12);
    const all = colours.map(lab);
    const nearest = Math.min(...all.flatMap((a, i) => all.slice(i + 1).map((b) => Math.hypot(...a.map((value, k) => value - b[k])))));
    assert.ok(nearest > 15, `${theme}: two colours are only ${nearest} apart`); // 2.3 is a just noticeable difference
  }
  await page.keyboard.press("t");
});

test("each run has a row with the entries that vary and with results", async () => {
  const head = await page.$$eval(".runs thead th", (all) => all.map((each) => each.textContent));
  assert.deepEqual(head.slice(0, 3), ["run", "initial.velocity y", "material.0.mu"]);
  const rows = await page.$$eval(".runs tbody tr", (all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
  rows.forEach((row, i) => {
    assert.equal(Number(row[1]), -runs[i].speed);
    assert.equal(Number(row[2]), runs[i].mu);
    const { contact_force_x: x, contact_force_y: y } = readHistory(runs[i].directory);
    const most = Math.max(...y.map((value, k) => Math.hypot(value, x[k])));
    assertNear(Number(row[head.indexOf("largest force")]), most, 6e-4 * most);
    const { impacts, peak_stress: peak } = JSON.parse(readFileSync(join(runs[i].directory, "summary.json"), "utf8"));
    assert.equal(row[head.indexOf("restitution")], impacts[0]?.restitution?.toFixed(3) ?? "–");
    const [, mantissa, powers = "⁰"] = /([\d.]+)(?:·10([⁰¹²³⁴-⁹]+))?$/.exec(row[head.indexOf("largest stress")]);
    const power = [...powers].reduce((sum, digit) => 10 * sum + "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(digit), 0);
    assertNear(Number(mantissa) * 10 ** power, peak.von_mises, 6e-4 * peak.von_mises);
  });
});

test("results fit the screen without scrolling", async () => {
  await page.setViewportSize({ width: 1300, height: 900 });
  await settle(page);
  const { right, ends } = await page.evaluate(() => {
    const heads = [...document.querySelectorAll(".runs thead th")].map((each) => [each.textContent, each.getBoundingClientRect().right]);
    return { right: document.querySelector(".runs").getBoundingClientRect().right, ends: Object.fromEntries(heads) };
  });
  for (const name of ["restitution", "largest force", "largest stress", "Rotation"]) assert.ok(ends[name] < right, `${name} ends at ${ends[name]} of ${right}`);
  await page.setViewportSize({ width: 1400, height: 900 });
  await settle(page);
});

test("results are drawn against one entry, with a line for each value of the others", async () => {
  const lines = () => page.evaluate(() => window.ricochet.results.lines.map(({ name, points }) => ({ name, points: points.map(({ run, x, y }) => [run.name, x, y]) })));
  const found = await lines();
  assert.deepEqual(found.map(({ name }) => name).sort(), ["material.0.mu = 20000", "material.0.mu = 5000"]);
  for (const { name, points } of found) {
    const mu = Number(name.split(" = ")[1]);
    assert.deepEqual(points.map(([, x]) => x), speeds.map((speed) => -speed).reverse());
    for (const [, x, y] of points) {
      const { directory } = runs.find((run) => run.mu === mu && run.speed === -x);
      const history = readHistory(directory);
      assertNear(y, Math.max(...history.contact_force_y.map((value, k) => Math.hypot(value, history.contact_force_x[k]))), 1e-9 * y);
    }
    // A faster disc pushes harder.
    points.slice(1).forEach(([, , y], i) => assert.ok(y < points[i][2], `${name}: ${y}`));
  }
  assert.ok((await painted(page, "#results canvas")) > 0.005);
  await page.selectOption("#against", "material.0.mu");
  await page.selectOption("#result", "last momentum_y");
  const turned = await lines();
  assert.equal(turned.length, speeds.length);
  for (const [name, , y] of turned.flatMap(({ points }) => points)) {
    const { directory } = runs.find((run) => run.directory.endsWith(name));
    assert.equal(y, readHistory(directory).momentum_y.at(-1));
  }
  const csv = await download(page, () => page.locator("#results button", { hasText: /^CSV$/ }).click());
  const rows = csv.content.toString().trimEnd().split("\n");
  assert.equal(rows[0], "run,initial.velocity y,material.0.mu,momentum y at the end");
  assert.equal(rows.length, 13);
  await page.selectOption("#against", "run");
  await settle(page);
  assert.ok((await painted(page, "#results canvas")) > 0.1, "bars");
});

test("pointing at a run fades the others, and the legend keeps its size", async () => {
  await page.hover(".runs tbody tr:nth-child(11) td:nth-child(2)");
  await settle(page);
  const alphas = () => page.evaluate(() => {
    const chart = window.ricochet.charts.find(({ id }) => id === "force");
    return Object.fromEntries(chart.series.map(({ run }, i) => [run.number, chart.plot.series[i + 1].alpha]));
  });
  const faint = await alphas();
  for (const [run, alpha] of Object.entries(faint)) assert.equal(alpha, run === "10" ? 1 : 0.15);
  await page.mouse.move(5, 5);
  await settle(page);
  assert.ok(Object.values(await alphas()).every((alpha) => alpha === 1));
  const legend = await page.$eval("#chart-force .legend", (element) => ({ items: element.children.length, height: element.clientHeight }));
  assert.equal(legend.items, 12);
  assert.ok(legend.height <= 90, `${legend.height} pixels`);
  await page.click(".runs tbody tr:nth-child(3) .toggle");
  await settle(page);
  assert.equal(await page.$$eval("#chart-force .legend .item", (all) => all.length), 11);
});

test("a phone shows the rows and the results", async () => {
  const phone = await open(report("study-phone", ...runs.map(({ directory }) => directory)), { width: 390, height: 844, touch: true });
  assert.equal(await phone.page.evaluate(() => document.scrollingElement.scrollWidth), 390);
  assert.ok((await painted(phone.page, "#results canvas")) > 0.003);
  assert.deepEqual(phone.complaints, []);
  await phone.close();
});

test("the console is empty", async () => {
  assert.deepEqual(view.complaints, []);
  await view.close();
});
