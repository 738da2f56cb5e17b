// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Makes the report's page, one file that needs nothing else: node build.mjs OUT.html
//
// three.js and esbuild are looked for in node_modules/ beside this file: run `npm ci --ignore-scripts`
// in a copy of this folder first, then this file of the copy. esbuild needs none of its install scripts.
import { createHash } from "node:crypto";
import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2];
if (process.argv.length !== 3) {
  console.error("usage: node build.mjs OUT.html");
  process.exit(2);
}

const bundle = await build({
  absWorkingDir: here,
  entryPoints: ["src/main.js"],
  bundle: true,
  // A page opened from disk may not load modules.
  format: "iife",
  target: ["chrome100", "firefox113", "safari16.4"],
  minify: true,
  legalComments: "none",
  charset: "utf8",
  write: false,
});
const style = await build({
  absWorkingDir: here,
  entryPoints: ["style.css"],
  minify: true,
  legalComments: "none",
  write: false,
});

const notice = readFileSync(join(here, "node_modules/three/LICENSE"), "utf8").trim();
const inText = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");
const script = bundle.outputFiles[0].text.trim();
const parts = {
  STYLE: style.outputFiles[0].text.trim(),
  SCRIPT: script,
  // The page's policy lets this script run and no other, whatever else gets into the page.
  SCRIPT_HASH: `sha256-${createHash("sha256").update(script).digest("base64")}`,
  NOTICE: inText(notice),
};

let page = readFileSync(join(here, "page.html"), "utf8");
for (const [name, text] of Object.entries(parts)) {
  const pieces = page.split(`<!--${name}-->`);
  if (pieces.length !== 2) throw new Error(`page.html has no single <!--${name}-->`);
  page = pieces.join(text);
}
// The program puts a run's data where this text is.
if (page.split("__VIEWGAIN_DATA__").length !== 2) {
  throw new Error("the page must have one place for the data");
}
writeFileSync(`${out}.part`, page);
renameSync(`${out}.part`, out);
console.log(`${out}: ${Math.round(page.length / 1000)} kB`);
