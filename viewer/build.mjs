// Bundles the viewer into one HTML file, dist/viewer.html, in which `ricochet report` inserts the data of runs. The same
// sources and the same package-lock.json produce the same bytes on any machine.
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdir, readdir, readFile, writeFile } from "node:fs/promises";

const bundle = async (entry, loader) => {
  const result = await build({ entryPoints: [entry], bundle: true, minify: true, write: false, target: "es2022",
    format: "iife", legalComments: "none", loader });
  return result.outputFiles[0].text;
};

const script = await bundle("src/main.ts");
const style = await bundle("src/style.css");
const licences = await Promise.all(["three", "uplot"].map(async (name) => {
  const { version } = JSON.parse(await readFile(`node_modules/${name}/package.json`, "utf8"));
  return `${name} ${version}\n${await readFile(`node_modules/${name}/LICENSE`, "utf8")}`;
}));
/**
 * Checksum of the sources. With it a test without Node.js verifies that the committed page was built from them
 * (tests/end_to_end/report_test.py).
 */
const sources = async () => {
  const files = (await readdir("src", { recursive: true })).filter((name) => /\.\w+$/.test(name)).map((name) => `src/${name}`);
  const hash = createHash("sha256");
  for (const file of [...files, "build.mjs", "package-lock.json"].sort()) hash.update(`${file}\n`).update(await readFile(file));
  return hash.digest("hex");
};

// Replacements are functions, so that "$&" in the script is not interpreted.
const page = (await readFile("src/index.html", "utf8"))
  .replace("/*STYLE*/", () => style)
  .replace("/*SCRIPT*/", () => script.replaceAll("</script", "<\\/script"))
  .replace("SOURCES", await sources())
  .replace("<!--LICENCES-->", () => `<!--\n${licences.join("\n").replaceAll("--", "- -")}-->`);
await mkdir("dist", { recursive: true });
await writeFile("dist/viewer.html", page);
console.log(`dist/viewer.html: ${(page.length / 1e3).toFixed(0)} kB`);
