// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Keys, mouse and touch.
import { check } from "./checks.mjs";
import { tabOfPlots } from "./panel_checks.mjs";
import { differing } from "./png.mjs";

const some = 25;

/** Whether the tab key gets to what can be operated, in order. */
async function checkFocusOrder({ page }, tab) {
  await page.locator("body").evaluate(() => document.activeElement.blur());
  await page.mouse.click(640, 20);
  const reached = [];
  for (let i = 0; i < 60; ++i) {
    await page.keyboard.press("Tab");
    reached.push(await page.evaluate(() => {
      const { id, tagName, dataset } = document.activeElement;
      return id || dataset.layer || tagName.toLowerCase();
    }));
  }
  const order = ["theme", "open-help", "canvas", "workspace", "play", "slider", `tab-${tab}`];
  const places = order.map((name) => reached.indexOf(name));
  const missed = order.filter((_, i) => places[i] < 0);
  check(missed.length === 0, `the tab key reaches all, not ${missed.join(", ")}`);
  check(places.every((place, i) => i === 0 || places[i - 1] < place), "the tab key goes in order");
}

export async function checkKeyboard(report, data) {
  const { page } = report;
  const press = (key) => report.drawn(() => page.keyboard.press(key));
  await report.goTo(0);
  await page.locator(`#tab-${tabOfPlots(data)}`).click();
  await checkFocusOrder(report, tabOfPlots(data));
  await page.locator("#stage canvas").focus();
  await press("ArrowRight");
  check((await report.shown()) === 1, "the right arrow goes to the next step");
  await press("ArrowLeft");
  check((await report.shown()) === 0, "the left arrow goes back");
  await press("End");
  const last = Number(await page.locator("#slider").getAttribute("max"));
  check((await report.shown()) === last, "End goes to the last step");
  await press("Home");
  check((await report.shown()) === 0, "Home goes to the first step");

  for (const key of ["a", "w", "+", "n", "h"]) {
    const before = await report.viewer();
    await page.keyboard.press(key);
    await report.settled();
    check(differing(before, await report.viewer()) > some, `the key ${key} moves the camera`);
  }
  const first = page.locator("[data-layer]").first();
  await press("1");
  check(!(await first.isChecked()), "the key 1 switches the first layer off");
  await press("1");
  check(await first.isChecked(), "the key 1 switches the first layer on");

  await press(" ");
  check((await report.shown()) === 1, "the space key plays");
  await page.keyboard.press(" ");
  const stopped = await report.shown();
  await page.waitForTimeout(1500);
  check((await report.shown()) - stopped <= 0, "the space key pauses");
  await report.goTo(0);

  await page.keyboard.press("?");
  check(await page.locator("#help").isVisible(), "? lists the keys");
  check((await page.locator("#keys dt").count()) >= 8, "the list of keys has the keys");
  await page.keyboard.press("Escape");
  check(!(await page.locator("#help").isVisible()), "Escape closes the list");

  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  const before = await theme();
  await press("t");
  check((await theme()) !== before, "t changes the theme");
  await press("t");
  check((await theme()) === before, "t changes the theme back");

  const tab = data.kind === "reconstruct" ? "views" : "ranking";
  await page.locator(`#tab-${tab}`).click();
  await page.locator(`#panel-${tab} tr[tabindex="0"]`).focus();
  await press("ArrowDown");
  check((await report.shown()) === 1, "the down arrow in the table goes to the next row");
  await report.goTo(0);
}

export async function checkMouseAndTouch(report) {
  const { page, context } = report;
  const box = await page.locator("#stage canvas").boundingBox();
  const [x, y] = [box.x + 0.6 * box.width, box.y + 0.7 * box.height];
  const changes = async (act, what) => {
    const before = await report.viewer();
    await act();
    await report.settled();
    check(differing(before, await report.viewer()) > some, what);
  };
  await changes(async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 90, y - 30, { steps: 4 });
    await page.mouse.up();
  }, "the mouse turns the scene");
  await changes(() => page.mouse.wheel(0, -300), "the wheel comes closer");
  const session = await context.newCDPSession(page);
  const touch = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points });
  await changes(async () => {
    await touch("touchStart", [{ x, y }]);
    for (let i = 1; i <= 5; ++i) await touch("touchMove", [{ x: x - 20 * i, y: y + 6 * i }]);
    await touch("touchEnd", []);
  }, "a finger turns the scene");
}
