// A run with 100,000 triangles and 300 frames is usable without a graphics card; prints the measured figures.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { closeBrowser, folder, open, report, ricochet, settle, source } from "./support.mjs";

after(closeBrowser);

test("the page of a large run is small enough, opens, and is animated", async (context) => {
  const geometry = readFileSync(join(source, "cases/disc/disc.geo"), "utf8").replace("size = 0.0020", "size = 0.000172");
  writeFileSync(join(folder, "large.geo"), geometry);
  execFileSync("gmsh", ["large.geo", "-2", "-format", "msh41", "-o", "large.msh"], { cwd: folder, stdio: "ignore" });
  const input = readFileSync(join(source, "cases/disc/disc.toml"), "utf8").split("[[expect]]")[0].replace("disc.msh", "large.msh");
  writeFileSync(join(folder, "large.toml"), input);
  const run = join(folder, "large");
  // Until the middle of the impact, with a frame for each step.
  ricochet("run", join(folder, "large.toml"), "-o", run, "--quiet", "--log-level", "error", "--threads", "2",
    "--set", "time.end=0.03", "--set", "output.fields_every=1", "--set", "output.fields_precision=single");
  const file = report("large", run);
  const size = statSync(file).size / 1e6;
  assert.ok(size < 20, `${size} MB`);
  const start = performance.now();
  const view = await open(file);
  const { page } = view;
  const opened = (performance.now() - start) / 1000;
  const triangles = await page.evaluate(() => window.ricochet.store.runs[0].body.triangles);
  const frames = await page.evaluate(() => window.ricochet.store.runs[0].body.times.length);
  assert.ok(triangles > 95_000, String(triangles));
  assert.ok(frames >= 100, `${frames} frames`);
  await page.$eval("#bodies", (element) => element.scrollIntoView());
  await settle(page);
  const pictures = () => page.evaluate(() => [window.ricochet.stage.pictures, performance.now()]);
  await page.click(".play");
  const [first, from] = await pictures();
  await page.waitForTimeout(4000);
  const [last, to] = await pictures();
  await page.click(".play");
  const rate = (1000 * (last - first)) / (to - from);
  context.diagnostic(`${triangles} triangles, ${frames} of 301 frames, ${size.toFixed(1)} MB, open after ${opened.toFixed(1)} s, ${rate.toFixed(1)} pictures per second in software`);
  // A coarse bound, because machines are shared. docs/report.md has measured figures.
  assert.ok(rate > 1.5, `${rate} pictures per second`);
  assert.deepEqual(view.complaints, []);
  await view.close();
});
