// Bundles the page of the report into dist/, or into the folder given as the first argument.
// The stamp says what it was built from; a test compares it with the sources.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { join } from "node:path";
import { build } from "esbuild";

const here = fileURLToPath(new URL(".", import.meta.url));
const sources = ["build.mjs", "package-lock.json", "package.json"]
  .concat(readdirSync(join(here, "src")).map((name) => `src/${name}`))
  .sort();
const hash = createHash("sha256");
for (const name of sources) {
  hash.update(`${name}\0`).update(readFileSync(join(here, name))).update("\0");
}
const stamp = `/* built from ${hash.digest("hex")} by npm run build */`;

await build({
  absWorkingDir: here,
  entryPoints: { report: "src/main.js" },
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome100", "firefox100", "safari15"],
  legalComments: "inline",
  charset: "utf8",
  banner: { js: stamp, css: stamp },
  outdir: process.argv[2] ?? join(here, "dist"),
  logLevel: "warning",
});
