// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The numbers are those of the view shown, two runs stand beside each other, and a small window is enough.
import { OpenReport } from "./browser.mjs";
import { check } from "./checks.mjs";

const percent = (share) => `${(100 * share).toFixed(1)} %`;

export async function checkShownNumbers(report, data) {
  const { page } = report;
  const head = () => page.locator("#headline").textContent();
  const isChoice = ({ candidates, chosen }) => chosen !== null && candidates.reason.filter((r) => r === -1).length > 1;
  check((await report.shown()) === data.views.findIndex(isChoice), "a run opens at the first view with a choice");
  await report.goTo(data.views.length - 1);
  check((await head()).includes("ended: all allowed views are taken"), "the head says in words why the run ended");
  check((await page.locator("#kind").textContent()).includes(`gain ${data.gain_model} [nat]`), "the head names the gain");
  await page.locator("#tab-run").click();
  for (const [step, { figures }] of data.views.entries()) {
    await report.goTo(step);
    const coverage = percent(figures.coverage_visible);
    check((await head()).includes(coverage), `the head has the coverage of view ${step}: ${coverage}`);
    const rows = await page.locator("#panel-run tr").evaluateAll((all) =>
      Object.fromEntries(all.map((row) => [row.cells[0].textContent, row.cells[1].textContent])));
    const [, error] = /^(\d+\.\d\d?) mm$/.exec(rows["RMS error of the surface"]) ?? [];
    check(Math.abs(error - 1e3 * figures.rms_error) < 0.051, `the figures have the error of view ${step}, not ${error} mm`);
    const [, covered] = /^(\d+(\.\d)?) %$/.exec(rows["visible surface covered"]) ?? [];
    check(Math.abs(covered - 100 * figures.coverage_visible) < 0.051, `the figures have the coverage of view ${step}`);
    check(Object.keys(rows).every((name) => !name.includes("_")), "figures have words, not keys");
    const readout = await page.locator('[data-plot="coverage"] .readout').textContent();
    check(readout.length > 0, `the plot tells the coverage of view ${step}`);
  }
  await page.locator("#tab-plots").click();
}

/** The run that the page came with; then another of one view more, half as good. */
export async function checkTwoRuns(report, data) {
  const { page } = report;
  const own = data.views.map(({ figures }) => figures);
  const figures = [...own, own[0]].map((f) => ({ ...f, coverage_visible: 0.5 * f.coverage_visible }));
  const other = { settings: { policy: "frontier", mesh: "folder/other.off" }, per_view: figures };
  const choose = (text) => page.locator("#compare").setInputFiles(
    { name: "run.json", mimeType: "application/json", buffer: Buffer.from(text) });
  const dots = page.locator('[data-plot="coverage"] circle[data-other]');
  check((await dots.count()) === data.beside.per_view.length, "the other run has its curve");
  check((await page.locator("#other").textContent()).endsWith(", policy random"), "and its name");
  await choose("no run");
  await page.waitForFunction(() => document.getElementById("other").textContent.includes("not shown"));
  await choose(JSON.stringify(other));
  await page.waitForFunction(() => document.getElementById("other").textContent === "other.off, policy frontier");
  check((await dots.count()) === figures.length, "the other run has its curve");
  const at = (selector) => page.locator(`[data-plot="coverage"] ${selector}`).evaluate((dot) => Number(dot.getAttribute("cy")));
  const base = await page.locator('[data-plot="coverage"] .grid').first().evaluate((line) => Number(line.getAttribute("y1")));
  const heights = [base - await at('circle[data-step="0"]'), base - await at('circle[data-other="0"]')];
  check(Math.abs(heights[0] - 2 * heights[1]) < 0.01, `half the coverage is half as high: ${heights}`);
  const last = await report.shown();
  const text = await page.locator("#headline .other").first().textContent();
  check(text === percent(figures[last].coverage_visible), `the head has both runs' coverage, not ${text}`);
  await page.locator("#compare").setInputFiles([]);
  await page.waitForFunction(() => document.getElementById("other").textContent === "");
  check((await dots.count()) === 0, "the other run is gone");
}

export async function checkSmallWindow(browser, path, scheme) {
  const report = await OpenReport.open(browser, path, { scheme, viewport: { width: 800, height: 600 } });
  const { page } = report;
  const clash = () => page.evaluate(() => {
    const boxes = ["#layers", "#legend", "#scale", "#camera-tools"].map((name) => [name, document.querySelector(name)])
      .filter(([, part]) => part.offsetParent !== null && !part.hidden)
      .map(([name, part]) => [name, part.getBoundingClientRect()]);
    const stage = document.getElementById("viewer").getBoundingClientRect();
    const found = boxes.filter(([, b]) => b.left < 0 || b.right > 800 || b.top < stage.top || b.bottom > stage.bottom);
    const pairs = boxes.flatMap(([a, p], i) => boxes.slice(i + 1).filter(([, q]) =>
      p.left < q.right && q.left < p.right && p.top < q.bottom && q.top < p.bottom).map(([b]) => `${a} ${b}`));
    return [...found.map(([name]) => name), ...pairs].join(", ");
  });
  check((await clash()) === "", `at 800x600 nothing lies over another (${scheme}): ${await clash()}`);
  await report.goTo(0);
  check((await clash()) === "", `at 800x600 nothing lies over another at the first step (${scheme}): ${await clash()}`);
  await page.locator("#layers summary").click();
  check((await clash()) === "", `at 800x600 the layers lie over nothing (${scheme}): ${await clash()}`);
  const panel = await page.locator("#panel").boundingBox();
  check(panel.height > 120 && panel.y + panel.height <= 600, `at 800x600 the panel is in sight, ${panel.height} px high`);
  const scale = await page.locator("#scale").textContent();
  check(/^[125]0* (mm|cm|m)$/.test(scale), `the scale bar has a round length: ${scale}`);
  check(report.errors.length === 0, `no error at 800x600: ${report.errors.join("; ")}`);
  await report.close();
}
