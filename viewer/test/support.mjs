// Shared by the tests in the browser: runs made by the program, their reports, and a page whose console must be empty.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const source = resolve(import.meta.dirname ?? new URL(".", import.meta.url).pathname, "../..");
const program = resolve(process.env.RICOCHET_PROGRAM ?? join(source, "build/ricochet"));

/** A folder that is removed at the end. */
export const folder = mkdtempSync(join(tmpdir(), "ricochet-viewer-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

export function ricochet(...parameters) {
  return execFileSync(program, parameters, { encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
}

/** Runs a case into a sub-folder; returns the folder. */
export function simulate(caseFile, name, settings = {}) {
  const output = join(folder, name);
  const set = Object.entries(settings).flatMap(([key, value]) => ["--set", `${key}=${value}`]);
  ricochet("run", join(source, caseFile), "-o", output, "--force", "--quiet", "--log-level", "error", ...set);
  return output;
}

/** The report of runs; returns the file. */
export function report(name, ...runs) {
  const file = join(folder, `${name}.html`);
  ricochet("report", ...runs, "-o", file);
  return file;
}

/** The three runs of the demo under the schemes of the source, with more frames than usual. */
export function discRuns() {
  return [["midpoint", "consistent"], ["klr-conserving", "consistent"], ["newmark", "equivalent"]].map(([scheme, mass]) =>
    simulate("cases/disc/disc.toml", `disc/${scheme}`, { "time.scheme": scheme, "mass.type": mass, "output.fields_every": 5,
      ...(scheme === "newmark" ? { "time.preset": "textbook-half" } : {}) }));
}

/** A disc thrown obliquely, whose nodes slip, stick and slip again. */
export const frictionRun = () => simulate("cases/oblique/oblique.toml", "oblique", { "output.fields_every": 2 });
/** A ball on a block, two bodies with the pressure on both. */
export const pairRun = () => simulate("cases/ball-block/ball-block.toml", "pair", { "output.fields_every": 6 });
export const ballRun = () => simulate("cases/ball/ball.toml", "ball", { "output.fields_every": 8 });

/** A puck of two stiffnesses that strikes a wall at six speeds. */
export const studyRuns = () => [3e7, 5e7].flatMap((young) => [0.5, 0.75, 1, 1.25, 1.5, 2].map((speed) =>
  simulate("cases/puck/puck.toml", `study/E${young / 1e6}-v${speed}`, { "material.0.young": young, "initial.velocity": `[1.5, -${speed}]`, "time.end": 0.0019,
    "output.fields_every": 100 })));

/** history.csv by columns. */
export function readHistory(directory) {
  const [header, ...rows] = readFileSync(join(directory, "history.csv"), "utf8").trimEnd().split("\n");
  const numbers = rows.map((row) => row.split(",").map(Number));
  return Object.fromEntries(header.split(",").map((name, k) => [name, numbers.map((row) => row[k])]));
}

let browser;
/** Opens Debian's Chromium, which draws pictures without a graphics card. */
export async function openBrowser() {
  browser ??= await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader"],
  });
  return browser;
}
export const closeBrowser = async () => browser?.close();

/** Opens a report and waits until it is ready; `complaints` lists all messages of the console and all requests. */
export async function open(file, { width = 1400, height = 900, colorScheme = "light", touch = false } = {}) {
  const context = await (await openBrowser()).newContext({ viewport: { width, height }, colorScheme, hasTouch: touch, acceptDownloads: true });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => {
    // Chromium reports this for every page with WebGL if it has no graphics card.
    if (/GL Driver Message .* GPU stall due to ReadPixels/.test(message.text())) return;
    complaints.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (problem) => complaints.push(`error: ${problem.message}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) complaints.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.ricochet?.ready, null, { timeout: 60_000 });
  await settle(page);
  return { page, complaints, close: () => context.close() };
}

/** Waits until all requested drawing is done. */
export async function settle(page) {
  await page.evaluate(() => new Promise((done) => {
    let left = 4;
    const next = () => (--left === 0 ? done() : requestAnimationFrame(next));
    requestAnimationFrame(next);
  }));
}

/** Fraction of the pixels of a 2D canvas that differ from its most frequent colour. */
export const painted = (page, selector) => page.evaluate((which) => {
  const canvas = document.querySelector(which);
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  const counts = new Map();
  for (let i = 0; i < data.length; i += 4) {
    const colour = (data[i] << 16) | (data[i + 1] << 8) | data[i + 2];
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  return 1 - Math.max(...counts.values()) / (data.length / 4);
}, selector);

/** Checksum of the picture of an element. */
export async function fingerprint(page, selector) {
  // Keep it clear of the bar at the foot.
  await page.locator(selector).first().evaluate((element) => element.scrollIntoView({ block: "center" }));
  return createHash("sha256").update(await page.locator(selector).first().screenshot()).digest("hex");
}

export function assertNear(found, wanted, tolerance, message) {
  assert.ok(Math.abs(found - wanted) <= tolerance, `${message ?? ""} ${found} is not ${wanted} ± ${tolerance}`);
}

export async function download(page, action) {
  const [file] = await Promise.all([page.waitForEvent("download"), action()]);
  return { name: file.suggestedFilename(), content: readFileSync(await file.path()) };
}
