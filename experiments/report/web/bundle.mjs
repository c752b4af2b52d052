// node bundle.mjs: report.js and report.css beside this file, of everything that the pages' figures need.
import { build } from "esbuild-wasm";
import { readFileSync } from "node:fs";

const licences = ["uplot", "three"]
  .map((name) => `${name}\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim()}`)
  .join("\n\n");

await build({
  entryPoints: ["main.js"],
  outfile: "report.js",
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome100", "firefox100", "safari15"],
  legalComments: "none",
  banner: { js: `/*!\n${licences}\n*/` },
});
