// Bundles the viewer into one HTML file, dist/viewer.html, into which `ricochet report` puts the data of runs.
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";

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
// A replacement is given as a function: "$&" in the script must stay what it is.
const page = (await readFile("src/index.html", "utf8"))
  .replace("/*STYLE*/", () => style)
  .replace("/*SCRIPT*/", () => script.replaceAll("</script", "<\\/script"))
  .replace("<!--LICENCES-->", () => `<!--\n${licences.join("\n").replaceAll("--", "- -")}-->`);
await mkdir("dist", { recursive: true });
await writeFile("dist/viewer.html", page);
console.log(`dist/viewer.html: ${(page.length / 1e3).toFixed(0)} kB`);
