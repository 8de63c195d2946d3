// Two bodies in contact: both are named, have their own colours, and show the pressure between them.
import assert from "node:assert/strict";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, folder, open, report, ricochet, settle } from "./support.mjs";

after(closeBrowser);

/** A square of 4 × 4 cells, as a .msh file. */
function square() {
  const nodes = [];
  const cells = [];
  for (let i = 0; i <= 4; ++i) for (let j = 0; j <= 4; ++j) nodes.push(`${nodes.length + 1} ${i / 4} ${j / 4} 0`);
  for (let i = 0; i < 4; ++i) for (let j = 0; j < 4; ++j) cells.push([3, 3, [5 * i + j + 1, 5 * i + j + 6, 5 * i + j + 7, 5 * i + j + 2]]);
  for (let j = 0; j < 4; ++j) cells.push([1, 1, [j + 1, j + 2]], [1, 2, [j + 21, j + 22]]);
  const elements = cells.map(([kind, group, corners], i) => `${i + 1} ${kind} 2 ${group} ${group} ${corners.join(" ")}`);
  return ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '1 1 "left"', '1 2 "right"', '2 3 "body"', "$EndPhysicalNames",
    "$Nodes", nodes.length, ...nodes, "$EndNodes", "$Elements", elements.length, ...elements, "$EndElements", ""].join("\n");
}

test("two bodies in contact are distinguished, and both show the pressure", async () => {
  const place = join(folder, "squares");
  mkdirSync(place);
  writeFileSync(join(place, "square.msh"), square());
  const material = (part) => `[[material]]\ngroup = "${part}.body"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.2\n`;
  writeFileSync(join(place, "squares.toml"), `[part.one]\nfile = "square.msh"\nvelocity = [1.0, 0.0]\n`
    + `[part.two]\nfile = "square.msh"\nmove = [1.02, 0.1]\n${material("one")}${material("two")}`
    + `[[contact]]\ngroup = "one.right"\nagainst = "two.left"\n[time]\nstep = 0.005\nend = 0.4\n[output]\nfields_every = 2\n`);
  ricochet("run", join(place, "squares.toml"), "-o", join(place, "out"), "--quiet", "--log-level", "error");
  const view = await open(report("squares", join(place, "out")), { height: 1400 });
  const { page } = view;
  assert.match(await page.textContent("#impacts"), /body "two".*body "one"/s);
  assert.match(await page.getAttribute("dd.outcome", "title"), /^body "one" and body "two", from/);
  assert.match(await page.textContent("#force, .panel"), /between one\.right and two\.left, x/, "forces are named after the two groups");
  const found = await page.evaluate(() => {
    const { store, stage } = window.ricochet;
    const [run] = store.runs;
    const largest = Math.max(...run.resultant);
    const { contact } = run;
    return { force: run.data.judgement.force, largest, judged: run.data.judgement.force_largest, bodies: [...new Set(stage.panels[0].view.bodies)], nodes: contact.nodes.length };
  });
  assert.equal(found.force, "pair_force.0_x");
  assert.ok(found.largest > 0 && Math.abs(found.largest - found.judged) < 1e-9 * found.judged);
  assert.deepEqual(found.bodies, [0, 1]);
  const pressed = await page.evaluate(() => {
    const { store, stage } = window.ricochet;
    const [run] = store.runs;
    const { view: drawn } = stage.panels[0];
    const bodyOf = new Map();
    drawn.bodies.forEach((body, t) => [0, 1, 2].forEach((k) => bodyOf.set(run.body.corners[3 * t + k], body)));
    const { levels, columns, none } = run.contact.quantities.find(({ name }) => name === "contact_pressure").values;
    const nodes = [new Set(), new Set()];
    levels.forEach((level, at) => { if (level > 0 && level !== none) nodes[bodyOf.get(run.contact.nodes[at % columns])].add(at % columns); });
    return nodes.map((each) => each.size);
  });
  assert.ok(pressed[0] >= 4 && pressed[1] >= 4, `pressed nodes of the two: ${pressed}`);
  await page.selectOption("#field", "");
  await settle(page);
  const picture = (await page.locator(".bodies canvas").first().screenshot()).toString("base64");
  const shades = await page.evaluate(async (encoded) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${encoded}`)).blob());
    const copy = new OffscreenCanvas(image.width, image.height).getContext("2d");
    copy.drawImage(image, 0, 0);
    const { data } = copy.getImageData(0, 0, image.width, image.height);
    const counts = new Map();
    for (let i = 0; i < data.length; i += 4) {
      const colour = `${data[i]} ${data[i + 1]} ${data[i + 2]}`;
      counts.set(colour, (counts.get(colour) ?? 0) + 1);
    }
    return [...counts.values()].filter((count) => count > 0.02 * (data.length / 4)).length;
  }, picture);
  assert.ok(shades >= 3, `the panel and two bodies: ${shades} colours`);
  if (process.env.RICOCHET_PICTURE) await page.screenshot({ path: process.env.RICOCHET_PICTURE });
  assert.deepEqual(view.complaints, []);
  await view.close();
});
