// Draws the pictures of docs/report.md and the animation of docs/disc.md from reports in the browser, into docs/figures.
import { execFileSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { ballRun, closeBrowser, discRuns, folder, frictionRun, open, pairRun, report, settle, source, studyRuns } from "./support.mjs";

const figures = join(source, "docs/figures");
const frames = join(folder, "frames");
mkdirSync(frames);

async function picture(file, name, options, prepare) {
  const view = await open(file, options);
  await view.page.evaluate(prepare);
  await settle(view.page);
  await view.page.waitForTimeout(300);
  await view.page.screenshot({ path: join(folder, name) });
  await view.close();
}

const disc = report("disc", ...discRuns());
const friction = report("friction", frictionRun());
const ball = report("ball", ballRun());

await picture(disc, "report-disc.png", { width: 1300, height: 1660 }, () => window.ricochet.store.setTime(0.05));
await picture(friction, "report-friction-dark.png", { width: 1300, height: 1130, colorScheme: "dark" }, () => {
  const { store } = window.ricochet;
  store.setTime(0.01052);
  store.set("quantity", "contact_status", "contact");
  document.querySelector("#bodies").scrollIntoView();
});
await picture(ball, "report-ball.png", { width: 1300, height: 1290 }, () => {
  const { store, stage } = window.ricochet;
  store.set("showMesh", true, "body");
  stage.showPeak(store.runs[0]);
  stage.lenses.space.camera.zoom = 1.6;
  window.scrollTo(0, 0);
});
await picture(ball, "report-contact-zone.png", { width: 1300, height: 560 }, () => {
  const { store, stage } = window.ricochet;
  store.setTime(0.0365);
  store.set("field", "contact_pressure", "body");
  store.set("showMesh", true, "body");
  stage.look("contact");
  document.querySelector("#bodies").scrollIntoView();
});
await picture(report("pair", pairRun()), "report-pair.png", { width: 1300, height: 1235 }, () => {
  const { store, stage } = window.ricochet;
  store.setTime(6e-5);
  store.set("field", "velocity", "body");
  store.set("showMesh", true, "body");
  stage.look("front");
  window.scrollTo(0, 0);
});
await picture(report("study", ...studyRuns()), "report-study.png", { width: 1300, height: 1000 }, () => {
  const { results } = window.ricochet;
  results.show("restitution", "initial.velocity y");
  document.querySelector("#against").value = "initial.velocity y";
});
for (const colorScheme of ["light", "dark"])
  await picture(disc, `phone-${colorScheme}.png`, { width: 390, height: 844, touch: true, colorScheme }, `
    window.ricochet.store.setTime(0.05);
    if (${colorScheme === "dark"}) document.querySelector("#maps").scrollIntoView();`);

// The animation: the three bodies, without their surroundings.
const view = await open(disc, { width: 840, height: 900 });
const { page } = view;
await page.addStyleTag({ content: ".player, .body-foot, .bodies .colour-bar { display: none !important } .body-area { height: 230px !important } #bodies { scroll-margin: 0 }" });
await page.evaluate(() => window.scrollTo(0, document.querySelector(".bodies").offsetTop - 10));
await settle(page);
const box = await page.locator(".bodies").boundingBox();
const count = 46;
for (let i = 0; i < count; ++i) {
  await page.evaluate((time) => window.ricochet.store.setTime(time), 0.004 + (0.146 * i) / count);
  await settle(page);
  await page.screenshot({ path: join(frames, `${String(i).padStart(3, "0")}.png`), clip: box });
}
await view.close();
await closeBrowser();
execFileSync("/usr/bin/python3", ["-B", join(source, "viewer/test/pictures.py"), folder, figures], { stdio: "inherit" });
