// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// What the run was asked and what came out, as names and values.
import { byId, el } from "../dom.js";
import { none, percent, short, withUnit, words } from "../format.js";

/** Nested objects as rows with dotted names; lists on one line. */
function rowsOf(object, prefix = "") {
  return Object.entries(object ?? {}).flatMap(([key, value]) => {
    const name = prefix + key;
    if (Array.isArray(value)) return [[name, value.map(textOf).join(", ")]];
    if (value !== null && typeof value === "object") return rowsOf(value, `${name}.`);
    return [[name, textOf(value)]];
  });
}

function textOf(value) {
  if (value === null || value === undefined) return none;
  if (typeof value === "number") {
    const large = Number.isInteger(value) || Math.abs(value) >= 1000;
    return large ? value.toLocaleString("en", { maximumFractionDigits: 1 }) : String(Number(value.toPrecision(5)));
  }
  if (typeof value === "boolean") return value ? "yes" : "no";
  return typeof value === "string" ? value : JSON.stringify(value);
}

function list(title, object) {
  const rows = rowsOf(object);
  if (rows.length === 0) return null;
  const cells = rows.map(([name, value]) =>
    el("tr", {}, el("th", { scope: "row" }, words(name)), el("td", {}, value)));
  return el("details", { class: "figures", open: true }, el("summary", {}, title),
    el("table", {}, el("tbody", {}, ...cells)));
}

export function buildFigures(report) {
  return el("div", {}, list("Figures", report.summary), list("Settings", report.settings));
}

/** The few figures that say how it went. */
export function showHeadline(report) {
  const s = report.summary ?? {};
  const gain = report.isRun ? -1 : report.score.columns.indexOf("gain");
  const best = report.isRun ? null : report.score.rows[0];
  const entries = report.isRun
    ? [["views", short(report.steps.length)], ["of the visible covered", percent(s.coverage_visible)],
      ["RMS error", withUnit(s.rms_error, "m")], ["ended the run", s.stop_reason ? words(s.stop_reason) : none]]
    : [["poses ranked", short(report.score.rows.length)],
      ["best gain", best && gain >= 0 ? withUnit(best[gain], report.gain_unit) : none],
      ["poses/s", short(s.poses_per_second)]];
  const known = entries.filter(([, value]) => value !== none);
  byId("headline").append(...known.map(([name, value]) => el("div", {}, el("dd", {}, value), el("dt", {}, name))));
}
