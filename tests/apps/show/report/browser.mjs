// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// A report in a real browser: Debian's Chromium, drawn by software.
import { accessSync, constants } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { decodePng } from "./png.mjs";

const names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
const common = ["--headless", "--no-sandbox", "--disable-dev-shm-usage"];
const software = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"];
const without3d = ["--disable-gpu", "--disable-3d-apis", "--disable-software-rasterizer"];

/** Ends the test as skipped. */
function skip(what) {
  console.log(`skipped: ${what} is missing`);
  process.exit(77);
}

function findBrowser() {
  for (const folder of (process.env.PATH ?? "").split(":")) {
    for (const name of names) {
      const path = join(folder, name);
      try {
        accessSync(path, constants.X_OK);
        return path;
      } catch {
        // Looked for in the next folder.
      }
    }
  }
  return skip(`a browser (${names.slice(0, 2).join(" or ")})`);
}

export async function launch(webgl) {
  const playwright = await import("playwright-core").catch(() => skip("the node module playwright-core"));
  const args = [...common, ...(webgl ? software : without3d)];
  return playwright.chromium.launch({ executablePath: findBrowser(), args });
}

/** An open report, with what it did wrong so far. */
export class OpenReport {
  errors = [];
  requests = [];

  static async open(browser, file, { scheme = "light", viewport = { width: 1280, height: 720 } } = {}) {
    const report = new OpenReport();
    const context = await browser.newContext({
      viewport, colorScheme: scheme, offline: true,
    });
    const page = await context.newPage();
    const url = pathToFileURL(file).href;
    page.on("console", (line) => {
      if (line.type() === "error") report.errors.push(line.text());
    });
    page.on("pageerror", (error) => report.errors.push(error.message));
    page.on("request", (request) => {
      const own = request.url() === url || /^(data|blob):/.test(request.url());
      if (!own) report.requests.push(request.url());
    });
    const start = Date.now();
    await page.goto(url);
    await page.waitForSelector("#viewer[data-shown]", { timeout: 20000 });
    report.seconds = (Date.now() - start) / 1000;
    return Object.assign(report, { page, context });
  }

  /** The scene alone, without what lies over it, which would show any click and the focus too. */
  async viewer() {
    const style = `#layers, #legend, #camera-tools { opacity: 0 !important; }
      #stage canvas { outline: none !important; }`;
    return decodePng(await this.page.locator("#stage").screenshot({ style }));
  }

  shown() {
    return this.page.locator("#viewer").getAttribute("data-shown").then(Number);
  }

  /** Does something that draws the scene anew, and waits until it is drawn. */
  async drawn(act) {
    const before = await this.page.locator("#viewer").getAttribute("data-drawn");
    await act();
    await this.page.waitForFunction(
      (old) => document.getElementById("viewer").dataset.drawn !== old, before, { timeout: 20000 });
    await this.settled();
  }

  /** Two frames, after which what was asked for is on the screen. */
  settled() {
    return this.page.evaluate(() =>
      new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  async goTo(step) {
    if ((await this.shown()) === step) return;
    await this.drawn(() => this.page.locator("#slider").evaluate((slider, value) => {
      slider.value = String(value);
      slider.dispatchEvent(new Event("input"));
    }, step));
  }

  close() {
    return this.context.close();
  }
}
