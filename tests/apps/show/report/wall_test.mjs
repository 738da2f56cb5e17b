// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Walls that stand between the viewer and the scene can be seen through: node wall_test.mjs BIN.html OBJECT.html
//
// BIN.html is the report of a run in an open bin within a reach, OBJECT.html that of a run round an object.
import { resolve } from "node:path";
import { launch, OpenReport } from "./browser.mjs";
import { check, summary } from "./checks.mjs";
import { differing } from "./png.mjs";

const [bin, object] = process.argv.slice(2).map((path) => resolve(path));
const browser = await launch(true);

const inBin = await OpenReport.open(browser, bin);
const { page } = inBin;
const clear = await inBin.viewer();
check(await page.locator("#walls").isChecked(), "walls of a bin can be seen through at first");
await page.locator("#walls").click();
await inBin.settled();
const walled = await inBin.viewer();
check(differing(clear, walled) > 2000, "walls that are not seen through hide a part of the picture");
await page.locator("#walls").click();
await inBin.settled();
check(differing(clear, await inBin.viewer()) <= 25, "a second click gives the first picture");
await page.locator("#tab-candidates").click();
await page.locator("#panel-candidates tbody tr").first().waitFor();
const more = page.locator("#panel-candidates .more");
if (await more.isVisible()) await more.click();
const whys = await page.locator("#panel-candidates td:last-child").allTextContents();
check(whys.some((why) => /^dropped: \d[\d,.]* m?m outside the reach$/.test(why)), "the table tells how far a candidate is out of reach");
check(inBin.errors.length === 0, `no error on the console: ${inBin.errors.join("; ")}`);
await inBin.close();

const round = await OpenReport.open(browser, object);
check((await round.page.locator("#walls").count()) === 0, "a single object has no walls");
const whole = await round.viewer();
await round.page.locator("#front").fill("60");
await round.settled();
check(differing(whole, await round.viewer()) > 500, "the front of an object can be cut");
await round.page.locator("#front").fill("0");
await round.settled();
check(differing(whole, await round.viewer()) <= 25, "without a cut the picture is the first one");
await round.close();

await browser.close();
process.exitCode = summary() ? 0 : 1;
