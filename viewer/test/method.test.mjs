// Changes of the energy by the method itself, the acting reactions, and restitutions made inexact by the method.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { closeBrowser, open, readHistory, report, simulate } from "./support.mjs";

const long = { "time.scheme": "reduced-kane", "time.step": 1e-3, "time.end": 0.06, "time.reaction_weight": "end", "output.fields_every": 0 };
let runs, view, cards;
before(async () => {
  runs = [
    simulate("cases/disc/disc.toml", "method/end", long),
    simulate("cases/disc/disc.toml", "method/friction", { ...long, "contact.0.friction": 0.3, "initial.velocity": "[0.1,-0.1]", "time.end": 0.05 }),
    simulate("cases/disc/disc.toml", "method/fine", { ...long, "time.step": 2e-4, "time.reaction_weight": "adaptive" }),
  ];
  // A disc with an exact restitution, and one whose restitution is an effect of the method.
  runs.push(...["fine", "coarse"].map((name) => simulate("cases/disc/disc.toml", `method/leaves-${name}`,
    { ...long, "load.gravity": "[0.0, 0.0]", "initial.displacement": "[0.0, 0.0]", "time.end": 0.1, "time.step": name === "fine" ? 2e-4 : 1e-2 })));
  view = await open(report("method", ...runs));
  cards = await view.page.$$eval(".card", (all) => all.map((card) => card.textContent));
});
after(closeBrowser);

const summary = (directory) => JSON.parse(readFileSync(join(directory, "summary.json"), "utf8"));
/** The loss as shown in the page, with two digits. */
const lost = (text) => Number(/(?:the method lost|conserved to within) ([\d.]+) %/.exec(text)[1]) / 100;

test("a card shows the loss by the method, without and with friction, and the acting reactions", () => {
  // Without friction it is a fraction of the initial energy, with friction of the largest one.
  const { total_energy: total } = readHistory(runs[0]);
  const parts = [(total[0] - Math.min(...total)) / total[0], summary(runs[1]).energy_budget.lost_by_method];
  parts.forEach((wanted, i) => {
    assert.ok(wanted > 1e-3, "otherwise the test is void");
    assert.ok(Math.abs(lost(cards[i]) - wanted) <= 0.06 * wanted, `${cards[i]}: not ${wanted}`);
    assert.match(cards[i], i === 0 ? /Energy[✓~]/ : /Energy in contact[✓~]/);
    assert.match(cards[i], /reduced-kane, equivalent mass; reactions: those at the end of the step/);
  });
  assert.match(cards[2], /reactions: mean, end weight 0(?! to).*conserved to rounding/s);
});

test("its tooltip has the loss as a fraction of the largest energy", async () => {
  const tips = await view.page.$$eval(".card .findings dd:first-of-type", (all) => all.map((each) => each.title));
  const found = /the method created at most 0 % and lost at most ([\d.]+) % of the largest energy/.exec(tips[0]);
  assert.ok(found, tips[0]);
  const { lost_by_method: wanted } = summary(runs[0]).energy_budget;
  assert.ok(Math.abs(Number(found[1]) / 100 - wanted) <= 0.06 * wanted, `${tips[0]}: not ${wanted}`);
});

test("a restitution made inexact by the method is marked", () => {
  assert.deepEqual(runs.slice(3).map((directory) => summary(directory).impacts[0].restitution_inexact), [false, true], "otherwise the test is void");
  for (const [i, directory] of runs.entries()) {
    const { restitution_inexact: inexact } = summary(directory).impacts[0];
    assert.equal(/inexact: the method lost [\d.]+ %, the body lost [\d.]+ %/.test(cards[i]), inexact, cards[i]);
  }
});

test("the table of sizes names the reactions, the list of results the loss by the method", async () => {
  const { page, complaints } = view;
  const row = await page.$$eval(".details th", (all) => all.find((each) => each.textContent === "acting reactions").parentElement.textContent);
  assert.match(row, /those at the end of the step.*mean, end weight 0/);
  const options = await page.$$eval("select option", (all) => all.map((each) => each.textContent));
  assert.ok(options.includes("energy lost by the method"), options.join("; "));
  assert.deepEqual(complaints, []);
});
