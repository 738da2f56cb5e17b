// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// What the first look shows: the chosen camera and the workspace, clear of what lies over the scene; and the
// panel beside it.
import { check } from "./checks.mjs";
import { boundsOf, colouredLike, differentFrom } from "./png.mjs";

/** The part of the scene that nothing lies over, in pixels of the scene. */
async function freePart({ page }) {
  return page.evaluate(() => {
    const box = (id) => document.getElementById(id).getBoundingClientRect();
    const stage = box("stage");
    const legend = box("legend");
    return { left: box("layers").right - stage.left, right: stage.width, top: 0,
      bottom: (legend.height > 0 ? legend.top : stage.bottom) - stage.top };
  });
}

const isWithin = (bounds, part) => bounds.left > part.left && bounds.right < part.right - 2 &&
  bounds.top > part.top + 2 && bounds.bottom < part.bottom;

export async function checkFraming(report, data) {
  const { page } = report;
  const theme = await page.evaluate(() => document.documentElement.dataset.theme);
  // Without what may have the same colours.
  const others = ["candidates", "contributions", "map", "surface"];
  const off = [];
  for (const id of others) {
    const box = page.locator(`[data-layer="${id}"]`);
    if ((await box.count()) && (await box.isChecked())) off.push(id);
  }
  const toggle = async () => {
    for (const id of off) await report.drawn(() => page.locator(`[data-layer="${id}"]`).click());
  };
  await toggle();
  const look = async (when) => {
    const picture = await report.viewer();
    const part = await freePart(report);
    // The camera and its rays, which end in the workspace.
    const toggleChosen = () => report.drawn(() => page.locator('[data-layer="chosen"]').click());
    await toggleChosen();
    const camera = boundsOf(picture, differentFrom(await report.viewer()));
    await toggleChosen();
    check(camera.number > 50 && isWithin(camera, part), `${when}, the chosen camera is in sight: ${JSON.stringify(camera)}`);
    const box = boundsOf(picture, colouredLike(theme === "dark" ? [0x3a, 0x45, 0x54] : [0xbc, 0xc5, 0xd0]));
    check(box.number > 100 && isWithin(box, part), `${when}, the workspace is in sight: ${JSON.stringify(box)}`);
  };
  await look("at first");
  await page.locator("#stage canvas").focus();
  for (let i = 0; i < 5; ++i) await page.keyboard.press("+");
  await page.keyboard.press("d");
  await page.keyboard.press("h");
  await report.settled();
  await look("from home");
  if (data.kind === "reconstruct") {
    await report.goTo((await report.shown()) + 1);
    await report.settled();
    await look("a step later");
    await report.goTo((await report.shown()) - 1);
  }
  await toggle();
}

/** A panel that is open is full enough, no unit is cut off, and no area is finer than the map tells. */
export async function checkSpace(report, data) {
  const { page } = report;
  if (data.kind === "score") {
    const [plot, table] = await page.evaluate(() => ["[data-plot]", "#panel-ranking tbody"].map((name) =>
      document.querySelector(name).getBoundingClientRect().height));
    check(plot > 100 && table > 200, `the ranking is under its plot: ${plot}, ${table}`);
  }
  const cut = await page.evaluate(() => [...document.querySelectorAll(".plot small, .plot .readout, #panel th")]
    .filter((part) => part.offsetParent !== null && part.scrollWidth > part.clientWidth + 1 && part.clientWidth > 0)
    .map((part) => part.textContent));
  check(cut.length === 0, `no unit is cut off: ${cut.join(", ")}`);
  const texts = await page.evaluate(() => document.body.innerText);
  const fine = texts.match(/0\.00\d+ (cm|mm|m)²/g) ?? [];
  check(fine.length === 0, `areas have digits that mean something: ${fine.join(", ")}`);
}
