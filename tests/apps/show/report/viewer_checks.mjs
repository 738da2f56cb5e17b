// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// What must change the picture of the scene: steps, layers, colours.
import { check } from "./checks.mjs";
import { filledShare, differing } from "./png.mjs";

// So many pixels are more than noise.
const some = 25;

/** At most `most` steps, spread over all. */
function spread(number, most) {
  if (number <= most) return Array.from({ length: number }, (_, i) => i);
  return Array.from({ length: most }, (_, i) => Math.round((i * (number - 1)) / (most - 1)));
}

export async function checkSteps(report, data) {
  const number = data.kind === "reconstruct" ? data.views.length : data.score.rows.length;
  check(Number(await report.page.locator("#slider").getAttribute("max")) === number - 1,
    "the slider goes over all steps");
  let before = null;
  for (const step of spread(number, 8)) {
    await report.goTo(step);
    check((await report.shown()) === step, `the slider shows step ${step}`);
    const picture = await report.viewer();
    check(filledShare(picture) > 0.02, `step ${step} is not blank`);
    if (before) check(differing(before, picture) > some, `step ${step} differs from the one before`);
    before = picture;
  }
  await report.goTo(0);
}

/** Switches a layer by its box; the picture after. */
async function toggled(report, id) {
  await report.drawn(() => report.page.locator(`[data-layer="${id}"]`).click());
  return report.viewer();
}

export async function checkLayers(report) {
  const { page } = report;
  const ids = await page.locator("[data-layer]").evaluateAll((boxes) => boxes.map((box) => box.dataset.layer));
  check(ids.length >= 5, `there are layers: ${ids.join(", ")}`);
  const last = Number(await page.locator("#slider").getAttribute("max"));
  // From far away all that the layers show is in sight.
  await page.locator("#stage canvas").focus();
  for (let i = 0; i < 8; ++i) await page.keyboard.press("-");
  await report.settled();
  for (const id of ids) {
    const row = page.locator(`.layer:has([data-layer="${id}"])`);
    const empty = () => row.evaluate((element) => element.classList.contains("empty"));
    let step = 0;
    await report.goTo(0);
    while (step < last && (await empty())) await report.goTo(++step);
    const before = await report.viewer();
    const changed = await toggled(report, id);
    check(differing(before, changed) > some, `the layer ${id} changes the picture of step ${step}`);
    const back = await toggled(report, id);
    check(differing(before, back) <= some, `the layer ${id} switched twice gives the same picture`);
  }
  await page.keyboard.press("h");
  await report.goTo(0);
}

export async function checkColourings(report) {
  const { page } = report;
  const choose = async (id, value) => {
    await report.drawn(() => page.locator(id).selectOption(value));
    return report.viewer();
  };
  if (await page.locator("#colouring").count()) {
    const plain = await report.viewer();
    const options = await page.locator("#colouring option").evaluateAll((all) => all.map((o) => o.value));
    for (const option of options.filter((value) => value !== "plain")) {
      check(differing(plain, await choose("#colouring", option)) > some, `the surface coloured by ${option}`);
      check((await page.locator("#legend .bar").count()) > 0, `a legend for ${option}`);
    }
    await choose("#colouring", "plain");
  }
  if (await page.locator("#sigmas").count()) {
    await report.drawn(() => page.locator('[data-layer="points"]').click());
    const three = await report.viewer();
    check(differing(three, await choose("#sigmas", "10")) > some, "larger ellipsoids for more sigmas");
    await choose("#sigmas", "3");
    await report.drawn(() => page.locator('[data-layer="points"]').click());
  }
}
