// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// A report in a real browser: node report_test.mjs REPORT.html KIND [FOLDER]
//
// KIND is reconstruct or score; screenshots are left in FOLDER if one is given. Needs the modules of
// package.json beside this file (`npm ci` in a copy of this folder) and Chromium; without them it ends
// with code 77.
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { join, resolve } from "node:path";
import { launch, OpenReport } from "./browser.mjs";
import { check, summary } from "./checks.mjs";
import { checkFraming, checkSpace } from "./framing_checks.mjs";
import { checkKeyboard, checkMouseAndTouch } from "./input_checks.mjs";
import { checkHostileNames, checkWithoutWebgl } from "./other_pages.mjs";
import { checkCandidates, checkPlots, checkRows } from "./panel_checks.mjs";
import { filledShare, meanShade } from "./png.mjs";
import { checkShownNumbers, checkSmallWindow, checkTwoRuns } from "./shown_checks.mjs";
import { checkColourings, checkLayers, checkSteps } from "./viewer_checks.mjs";

const [file, kind, folder] = process.argv.slice(2);
if (!file || !["reconstruct", "score"].includes(kind)) {
  console.error("usage: node report_test.mjs REPORT.html reconstruct|score [FOLDER]");
  process.exit(2);
}

const path = resolve(file);
const page = readFileSync(path, "utf8");
const [, text] = /<script type="application\/json" id="data">([^]*?)<\/script>/.exec(page) ?? [];
check(text !== undefined, "the page holds its data");
const data = JSON.parse(text);
check(data.kind === kind, `the report is of kind ${kind}, not ${data.kind}`);
check(statSync(path).size < 25e6, `the file is under 25 MB, not ${statSync(path).size / 1e6}`);

async function keepPicture(report, name) {
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  await report.page.screenshot({ path: join(folder, `${kind}_${name}.png`) });
}

async function checkLayout(report) {
  const { page } = report;
  const viewerBox = () => page.locator("#stage canvas").boundingBox();
  const box = await viewerBox();
  check(box.x >= 0 && box.y >= 0 && box.x + box.width <= 1280 && box.y + box.height <= 720,
    "the viewer lies inside the window");
  check(box.width * box.height > 0.4 * 1280 * 720, "the viewer has two fifths of the window");
  const tabs = await page.locator("[role=tab]").all();
  for (const tab of tabs) {
    await tab.click();
    await page.mouse.move(1100, 500);
    await page.mouse.wheel(0, 4000);
    await report.settled();
    const now = await viewerBox();
    check(JSON.stringify(now) === JSON.stringify(box), `the viewer stays with ${await tab.textContent()} open`);
    const scrolled = await page.evaluate(() => {
      const parts = [document.scrollingElement, document.body, document.querySelector("main")];
      return parts.some((part) => part.scrollTop || part.scrollLeft);
    });
    check(!scrolled, `nothing but the panel scrolls with ${await tab.textContent()} open`);
  }
  await tabs[0].click();
}

async function checkScheme(browser, scheme) {
  const report = await OpenReport.open(browser, path, { scheme });
  console.log(`${scheme}: open in ${report.seconds.toFixed(2)} s`);
  const first = await report.viewer();
  check(filledShare(first) > 0.02, `the first picture is not blank (${scheme})`);
  await keepPicture(report, scheme);
  await checkLayout(report);
  await checkFraming(report, data);
  await checkSpace(report, data);
  if (kind === "reconstruct") {
    await checkTwoRuns(report, data);
    await checkShownNumbers(report, data);
  }
  await checkSteps(report, data);
  await checkLayers(report);
  await checkColourings(report);
  await checkPlots(report, data);
  await checkRows(report, data);
  if (kind === "reconstruct") await checkCandidates(report, data);
  await keepPicture(report, `${scheme}_selected`);
  await checkKeyboard(report, data);
  await checkMouseAndTouch(report);
  check(report.errors.length === 0, `no error on the console: ${report.errors.join("; ")}`);
  check(report.requests.length === 0, `no request: ${report.requests.join(", ")}`);
  await report.close();
  await checkSmallWindow(browser, path, scheme);
  return meanShade(first);
}

const browser = await launch(true);
const light = await checkScheme(browser, "light");
const dark = await checkScheme(browser, "dark");
check(light > 150 && dark < 90, `light is light (${light}) and dark is dark (${dark})`);
await checkHostileNames(browser, page, data);
await browser.close();
await checkWithoutWebgl(path);
process.exitCode = summary() ? 0 : 1;
