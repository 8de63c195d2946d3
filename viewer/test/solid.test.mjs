// The inside of a solid, its contact zone, and colours for a few large values.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertNear, ballRun, closeBrowser, fingerprint, open, report, settle } from "./support.mjs";

const radius = 0.05;
const picture = ".bodies canvas";
let run, view, page;
before(async () => {
  run = ballRun();
  view = await open(report("ball", run));
  ({ page } = view);
  await page.evaluate(() => window.ricochet.store.setTime(0.0365));
  await page.$eval("#bodies", (element) => element.scrollIntoView());
  await settle(page);
});
after(closeBrowser);

/** Area, centre and visibility of the drawn section. */
const section = () => page.evaluate(() => {
  const { mesh } = window.ricochet.stage.panels[0].view.section;
  const at = mesh.geometry.attributes.position.array;
  let area = 0;
  const centre = [0, 0, 0];
  for (let i = 0; i < at.length; i += 9) {
    const side = (k) => [0, 1, 2].map((c) => at[i + 3 * k + c] - at[i + c]);
    const [u, v] = [side(1), side(2)];
    const part = 0.5 * Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    area += part;
    for (let c = 0; c < 3; ++c) centre[c] += (part * (at[i + c] + at[i + 3 + c] + at[i + 6 + c])) / 3;
  }
  return { area, centre: centre.map((value) => value / area), visible: mesh.visible };
});

test("a cut shows the whole section in its plane", async () => {
  const whole = await fingerprint(page, picture);
  await page.evaluate(() => window.ricochet.store.setTime(0));
  // A disc of radius sqrt(r² − d²); that of the polyhedron is slightly smaller.
  for (const axis of ["x", "y", "z"]) {
    await page.selectOption("#cut", axis);
    for (const part of [0.5, 0.25]) {
      await page.evaluate((at) => window.ricochet.store.set("cutAt", at, "body"), part);
      await settle(page);
      const found = await section();
      const distance = (2 * part - 1) * radius;
      const disc = Math.PI * (radius ** 2 - distance ** 2);
      assert.ok(found.visible && found.area < 1.001 * disc && found.area > 0.95 * disc, `${axis} ${part}: ${found.area} of ${disc}`);
      const place = found.centre[["x", "y", "z"].indexOf(axis)];
      assertNear(place, distance + (axis === "z" ? radius + 0.005 : 0), 5e-3 * radius, axis);
    }
  }
  assert.match(await page.textContent("#bodies .tools output"), /./);
  await page.evaluate(() => window.ricochet.store.setTime(0.0365));
  await settle(page);
  assert.notEqual(await fingerprint(page, picture), whole);
});

test("the section has the values of the cells it cuts, and shows them at the pointer", async () => {
  await page.selectOption("#cut", "y");
  await page.selectOption("#field", "von_mises");
  await page.evaluate(() => {
    const { store, stage } = window.ricochet;
    store.set("cutAt", 0.5, "body");
    stage.look("front");
  });
  await settle(page);
  const { differing, cells } = await page.evaluate(() => {
    const { run, section, frame } = window.ricochet.stage.panels[0].view;
    const { volume } = run.body;
    const field = volume.fields.find(({ name }) => name === "von_mises").values;
    const shown = section.mesh.geometry.attributes.values.array;
    let differing = 0;
    section.section.tetrahedra.forEach((t, i) => {
      const value = field.low + field.step * field.levels[frame * field.columns + volume.cells[t]];
      if (Math.abs(shown[9 * i] - value) > 1e-6 * Math.abs(value)) ++differing;
    });
    return { differing, cells: section.section.tetrahedra.length };
  });
  assert.ok(cells > 100, `${cells} cells are cut`);
  assert.equal(differing, 0);
  const box = await page.locator(picture).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await settle(page);
  const tip = await page.textContent(".body-area .tip");
  const place = /at \((.*), (.*), (.*)\)/.exec(tip).slice(1).map((text) => (/[·]10/.test(text) ? 0 : Number(text.replace("−", "-"))));
  assertNear(place[1], 0, 0.02 * radius, "the pointer is on the section, not on the removed surface in front of it");
  assert.ok(Math.hypot(place[0], place[2] - radius) < 0.6 * radius, tip);
});

test("the other side, the slider and the key move the cut", async () => {
  const before = await fingerprint(page, picture);
  await page.click("text=other side");
  await settle(page);
  assert.notEqual(await fingerprint(page, picture), before);
  await page.click("text=other side");
  await page.evaluate(() => document.activeElement.blur());
  for (const [key, axis] of [["x", "z"], ["x", ""], ["x", "x"]]) {
    await page.keyboard.press(key);
    await settle(page);
    assert.equal(await page.inputValue("#cut"), axis);
  }
  await page.selectOption("#cut", "");
});

test("the contact zone is seen from behind the obstacle, and followed", async () => {
  await page.click("text=contact zone");
  const look = () => page.evaluate(() => {
    const { lenses, panels } = window.ricochet.stage;
    const { content, positions, zone, body, frame, size } = panels[0].view;
    const middle = content.position.toArray().map((value) => -value / content.scale.x);
    const touching = zone.nodesAt(body.times[frame]);
    return { eye: lenses.space.camera.position.toArray(), middle, lowest: Math.min(...touching.map((node) => positions[3 * node + 2])),
      seen: 1 / content.scale.x, size, touching: touching.length };
  });
  await settle(page);
  const at = await look();
  assert.ok(at.eye[2] < -0.5 * Math.hypot(...at.eye), `from below: ${at.eye}`);
  assertNear(at.middle[0], 0, 0.1 * radius);
  assertNear(at.middle[2], 0, 0.02 * radius, "on the plane");
  assertNear(at.lowest, 0, 1e-4 * radius, "nodes in contact lie on the plane");
  assert.ok(at.touching > 5 && at.seen < 0.6 * at.size, JSON.stringify(at));
  // In flight the view follows the nodes of the last contact, up with the ball.
  await page.evaluate(() => window.ricochet.store.setTime(0.07));
  await settle(page);
  const later = await look();
  assert.ok(later.middle[2] > 0.04 * radius, JSON.stringify(later));
  await page.click("text=contact, from the side");
  await settle(page);
  const side = await look();
  assert.ok(Math.abs(side.eye[2]) < 0.3 * Math.hypot(...side.eye), `along the plane: ${side.eye}`);
  await page.click("text=front");
  await settle(page);
  assert.ok((await look()).seen > 0.9 * at.size);
});

test("colours reach the largest value, in a scale that also shows the others", async () => {
  const range = () => page.evaluate(() => {
    const { view } = window.ricochet.stage.panels[0];
    const levels = [view.body, view.body.volume].map((part) => part.fields.find(({ name }) => name === "von_mises").values);
    // It was larger between frames.
    const most = Math.max(...levels.map(({ low, step, none }) => low + step * (none - 1)), view.run.summary.peak_stress.von_mises);
    return { ...view.range, most };
  });
  await page.selectOption("#field", "von_mises");
  for (const [scale, logarithmic] of [["all", false], ["logarithmic", true]]) {
    await page.selectOption("#scale", scale);
    await settle(page);
    const found = await range();
    assertNear(found.high, found.most, 1e-3 * found.most, scale);
    assert.equal(found.logarithmic, logarithmic);
    assert.ok(logarithmic ? found.low > 0 && found.low <= found.high / 100 : found.low === 0);
  }
  assert.match(await page.textContent(".bodies .colour-bar"), /≤ .* logarithmic/);
  await page.selectOption("#scale", "most");
  await settle(page);
  const found = await range();
  assert.ok(found.high < 0.9 * found.most && found.clipped);
  assert.match(await page.textContent(".bodies .colour-bar"), /≥ [\d.·⁰-⁹]+, up to [\d.·⁰-⁹]+/);
  await page.selectOption("#scale", "automatic");
});

test("the card lists the impacts, and its links go to them", async () => {
  const { impacts, peak_stress: peak } = JSON.parse(readFileSync(join(run, "summary.json"), "utf8"));
  assert.equal(impacts.length, 2);
  const card = await page.textContent(".card");
  for (const { restitution, restitution_inexact: inexact, normal_impulse, largest_force } of impacts) {
    const remark = restitution > 1.001 ? "above 1: fed by loads, sliding, spin or vibration"
      : inexact ? "inexact: the method lost [\\d.]+ %, the body lost [\\d.]+ %" : null;
    const words = new RegExp(`restitution ${restitution.toFixed(3)}${remark ? ` ~\\(${remark}\\)` : ""}, duration [\\d.]+, normal impulse ([\\d.]+), largest force ([\\d.]+)`).exec(card);
    assert.ok(words, card);
    assertNear(Number(words[1]), normal_impulse, 2e-3 * normal_impulse);
    assertNear(Number(words[2]), largest_force, 2e-3 * largest_force);
  }
  const rows = await page.$$eval("#impacts tbody tr", (all) => all.map((row) => [...row.children].map((cell) => cell.textContent)));
  assert.deepEqual(rows.map((row) => Number(row[5].replace("~", ""))), impacts.map(({ restitution }) => Number(restitution.toPrecision(4))));
  await page.locator(".outcome .link").nth(1).click();
  assertNear(await page.evaluate(() => window.ricochet.store.time), impacts[1].largest_force_time, 1e-12);
  assert.match(card, /Largest stress/);
  assertNear(peak.von_mises, 6e5, 1e5); // 0.6 of Hertz' pressure under 92.5 N, which is 1.0e6
});

test("the largest stress is marked at its position, and colours reach it", async () => {
  const { peak_stress: peak } = JSON.parse(readFileSync(join(run, "summary.json"), "utf8"));
  await page.locator(".outcome .link").last().click();
  await settle(page);
  const found = await page.evaluate(() => {
    const { store, stage } = window.ricochet;
    const { view } = stage.panels[0];
    const { volume } = view.body;
    const field = volume.fields.find(({ name }) => name === "von_mises").values;
    const values = Array.from(volume.cells, (cell) => field.low + field.step * field.levels[view.frame * field.columns + cell]);
    const most = Math.max(...values);
    const corners = volume.corners.subarray(4 * values.indexOf(most), 4 * values.indexOf(most) + 4);
    const centre = [0, 1, 2].map((k) => corners.reduce((sum, node) => sum + view.section.positions[3 * node + k] / 4, 0));
    const { sprite } = view.peak;
    return { time: store.time, field: store.field, cut: store.cut, most, centre, visible: sprite.visible, opacity: sprite.material.opacity,
      place: view.content.worldToLocal(sprite.position.clone()).toArray(), high: view.range.high };
  });
  assertNear(found.time, peak.time, 1e-12);
  assert.deepEqual([found.field, found.cut, found.visible, found.opacity], ["von_mises", "y", true, 1]);
  // The frame is close to the peak in time, and its largest stress is in the same cell or an adjacent one.
  assert.ok(found.most <= 1.001 * peak.von_mises && found.most > 0.9 * peak.von_mises, JSON.stringify([found.most, peak]));
  assert.ok(Math.hypot(...found.place.map((x, k) => x - found.centre[k])) < 0.2 * radius, JSON.stringify(found));
  assert.ok(found.high >= peak.von_mises);
  const hidden = await fingerprint(page, picture);
  await page.selectOption("#field", "contact_pressure");
  await settle(page);
  assert.equal(await page.evaluate(() => window.ricochet.stage.panels[0].view.peak.sprite.visible), false);
  await page.selectOption("#field", "von_mises");
  await settle(page);
  assert.equal(await fingerprint(page, picture), hidden);
});

test("the console is empty", async () => {
  assert.deepEqual(view.complaints, []);
  await view.close();
});
