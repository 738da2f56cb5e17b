// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// A report with hostile names, and a browser without WebGL.
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, OpenReport } from "./browser.mjs";
import { check } from "./checks.mjs";

const hostile = `"'&amp;</script><!--<script>window.hit=1</script><img src=x onerror="window.hit=1"><b>`;

/** The same report with markup in every name that comes from outside. */
function withHostileNames(data) {
  const copy = structuredClone(data);
  copy.title = hostile;
  copy.settings = { [hostile]: hostile, list: [hostile], nested: { [hostile]: hostile } };
  copy.summary = { ...copy.summary, stop_reason: hostile, [hostile]: hostile };
  for (const view of copy.views ?? []) {
    view.figures.generator = hostile;
    view.figures.class = null;
    view.figures.seconds = { ...view.figures.seconds, [hostile]: 1 };
    view.candidates.generators = view.candidates.generators.map(() => hostile);
    view.candidates.reasons = view.candidates.reasons.map(() => hostile);
  }
  if (copy.score) {
    copy.score.columns = [...copy.score.columns, hostile];
    copy.score.rows = copy.score.rows.map((row) => [...row, hostile]);
  }
  return copy;
}

export async function checkHostileNames(browser, page, data) {
  const folder = mkdtempSync(join(tmpdir(), "viewgain_report_"));
  try {
    const file = join(folder, "report.html");
    const text = JSON.stringify(withHostileNames(data)).replace(/</g, "\\u003c");
    const start = page.indexOf('id="data">') + 'id="data">'.length;
    writeFileSync(file, page.slice(0, start) + text + page.slice(page.indexOf("</script>", start)));
    const report = await OpenReport.open(browser, file);
    const words = hostile.replace(/_/g, " ");
    check((await report.page.locator("#title").textContent()) === hostile, "the title shows as it is");
    await report.goTo(0);
    for (const tab of await report.page.locator("[role=tab]").all()) {
      await tab.click();
      await report.settled();
    }
    check((await report.page.locator("#panel-run").textContent()).includes(words), "settings show as they are");
    const table = data.kind === "reconstruct" ? "#panel-candidates" : "#panel-ranking";
    check((await report.page.locator(table).textContent()).includes(words), "names in tables show as they are");
    const markup = await report.page.evaluate(() =>
      window.hit === undefined && !document.querySelector("img, b img, #panel script"));
    check(markup, "no name becomes markup");
    check(report.errors.length === 0, `hostile names make no error: ${report.errors.join("; ")}`);
    check(report.requests.length === 0, "hostile names make no request");
    // What would come of markup if a name became some: the page's policy lets no second script run.
    const second = await report.page.evaluate(() => {
      const script = document.createElement("script");
      script.textContent = "window.hit = 2";
      document.body.append(script);
      document.body.insertAdjacentHTML("beforeend", "<img src='data:,' onerror='window.hit = 3'>");
      return new Promise((resolve) => setTimeout(() => resolve(window.hit ?? null), 200));
    });
    check(second === null, "no other script runs");
    await report.close();
  } finally {
    rmSync(folder, { recursive: true });
  }
}

export async function checkWithoutWebgl(file) {
  const browser = await launch(false);
  const report = await OpenReport.open(browser, file);
  const { page } = report;
  check((await page.locator("#stage canvas").count()) === 0, "without WebGL there is no empty box");
  const step = await report.shown();
  await page.keyboard.press(step > 0 ? "ArrowLeft" : "ArrowRight");
  check((await report.shown()) === Math.abs(step - 1), "without WebGL the steps go on");
  check((await page.locator("#panel circle").count()) > 0, "without WebGL there are plots");
  check((await page.locator(".note").textContent()).includes("no WebGL"), "the page says that WebGL is missing");
  check(report.requests.length === 0, "without WebGL there is no request");
  await browser.close();
}
