// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The side panel: plots and tables, linked with the viewer.
import { check } from "./checks.mjs";
import { differing } from "./png.mjs";

const finite = (values) => values.filter((value) => Number.isFinite(value)).length;

/** Scored poses have their plot above the ranking. */
export const tabOfPlots = (data) => (data.kind === "score" ? "ranking" : "plots");

/** How many points each plot must have, by its id. */
function expectedPoints(data) {
  if (data.kind === "score") {
    const gain = data.score.columns.indexOf("gain");
    return { gain: gain < 0 ? 0 : finite(data.score.rows.map((row) => row[gain])) };
  }
  const number = (...keys) =>
    keys.reduce((sum, key) => sum + finite(data.views.map(({ figures }) => figures[key])), 0);
  return {
    coverage: number("coverage_visible"),
    error: number("rms_error", "p95_error"),
    area: number("realised_area", "predicted_area"),
    entropy: number("entropy_removed"),
  };
}

export async function checkPlots(report, data) {
  const { page } = report;
  await page.locator(`#tab-${tabOfPlots(data)}`).click();
  for (const [id, points] of Object.entries(expectedPoints(data))) {
    const found = await page.locator(`[data-plot="${id}"] circle`).count();
    check(found === points, `the plot ${id} has ${points} points, not ${found}`);
  }
  if (data.kind === "reconstruct") {
    const steps = await page.locator('[data-plot="seconds"] rect[data-step]').evaluateAll((bars) =>
      new Set(bars.map((bar) => bar.dataset.step)).size);
    check(steps === data.views.length, `the plot of times has ${data.views.length} bars, not ${steps}`);
  }
  const plot = data.kind === "reconstruct" ? "entropy" : "gain";
  const last = Number(await page.locator("#slider").getAttribute("max"));
  for (const step of [last, Math.floor(last / 2)]) {
    const box = await page.locator(`[data-plot="${plot}"] circle[data-step="${step}"]`).boundingBox();
    await report.drawn(() => page.mouse.click(box.x + box.width / 2, box.y + box.height / 2));
    // Among a thousand ranks a pixel is a few of them.
    const off = Math.abs((await report.shown()) - step);
    check(off <= last / 150, `a click on the point of step ${step} selects it`);
    const marked = await page.locator(`[data-plot="${plot}"] .now`).getAttribute("data-step");
    check(Number(marked) === (await report.shown()), "the plot marks the step shown");
  }
  await report.goTo(0);
}

export async function checkRows(report, data) {
  const { page } = report;
  const tab = data.kind === "reconstruct" ? "views" : "ranking";
  await page.locator(`#tab-${tab}`).click();
  const panel = page.locator(`#panel-${tab}`);
  const last = Number(await page.locator("#slider").getAttribute("max"));
  const before = await report.viewer();
  const step = Math.min(last, 2);
  await report.drawn(() => panel.locator(`tr[data-id="${step}"]`).click());
  check((await report.shown()) === step, `the row ${step} selects its step`);
  check((await panel.locator('tr[aria-selected="true"]').getAttribute("data-id")) === String(step),
    "the row of the step is marked");
  check(differing(before, await report.viewer()) > 25, "the row changes the scene");

  // Sorted by its second number column, downwards first.
  const head = panel.locator("th.number").nth(1);
  const column = await head.evaluate((th) => th.cellIndex);
  const values = () => panel.locator(`tbody tr td:nth-child(${column + 1})`).evaluateAll((cells) =>
    cells.map((cell) => Number(cell.textContent.replace(/,/g, ""))).filter(Number.isFinite));
  await head.locator("button").click();
  check((await head.getAttribute("aria-sort")) === "descending", "a click on a column sorts by it");
  const down = await values();
  check(down.every((v, i) => i === 0 || down[i - 1] >= v), "the rows are sorted downwards");
  await head.locator("button").click();
  const up = await values();
  check(up.every((v, i) => i === 0 || up[i - 1] <= v), "a second click sorts upwards");
  await head.locator("button").click();
  await report.goTo(0);
}

export async function checkCandidates(report, data) {
  const { page } = report;
  const { candidates, chosen } = data.views[0];
  const number = candidates.reason.length;
  await page.locator("#tab-candidates").click();
  const panel = page.locator("#panel-candidates");
  await panel.locator("tbody tr").first().waitFor();
  const more = panel.locator(".more");
  if (await more.isVisible()) await more.click();
  const rows = await panel.locator("tbody tr").count();
  check(rows === number, `the table has all ${number} candidates, not ${rows}`);
  const fate = (index) => panel.locator(`tr[data-id="${index}"] td`).last().textContent();
  if (chosen !== null) {
    const why = (await fate(chosen)).trim();
    check(/^chosen: (largest )?gain:? [\d.,]+ nat, [\d.]+ % (above the next|below the largest)$/.test(why),
      `the table tells why one was chosen: ${why}`);
  }
  const dropped = candidates.reason.findIndex((reason) => reason >= 0);
  if (dropped >= 0) {
    const reason = candidates.reasons[candidates.reason[dropped]];
    const why = await fate(dropped);
    const words = { too_near: /rays end within the least range, \d+ mm; surface at \d+ mm/,
      collision: /body touches unknown or occupied space/, taken: /like view \d+/, unreachable: /\d+ mm outside the reach/ };
    check(why.startsWith("dropped: ") && words[reason]?.test(why), `the table tells why a candidate was dropped (${reason}): ${why}`);
  }
  const other = candidates.reason.findIndex((reason, i) => reason === -1 && i !== chosen);
  check(/^kept: gain (≈ )?[\d.]+ % (below|above) the chosen$/.test((await fate(other)).trim()), "the table compares with the chosen one");
  const before = await report.viewer();
  const row = panel.locator(`tr[data-id="${other}"]`);
  await report.drawn(() => row.click());
  check((await row.getAttribute("aria-selected")) === "true", "a candidate's row is marked when selected");
  check(differing(before, await report.viewer()) > 25, "a candidate's row shows it in the scene");
}
