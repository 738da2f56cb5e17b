// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// What the run was asked and what came out, as names and values.
import { byId, el } from "../dom.js";
import { none, percent, short, stopWords, unitOf, unitOfKey, withUnit, words } from "../format.js";

/** Nested objects as rows, their names one after the other; lists on one line. */
function rowsOf(report, object, asGiven, prefix = "") {
  return Object.entries(object ?? {}).flatMap(([key, value]) => {
    const unit = unitOfKey(prefix + key, report);
    const name = prefix.split(".").slice(0, -1).concat(key).map(words).join(", ");
    if (key === "stop_reason") return [[name, stopWords(value)]];
    if (Array.isArray(value)) {
      return [[name, value.map((part) => textOf(part, unit, asGiven, false)).join(", ") + (unit ? ` ${unitOf(unit).name}` : "")]];
    }
    if (value !== null && typeof value === "object") return rowsOf(report, value, asGiven, `${prefix}${key}.`);
    return [[name, textOf(value, unit, asGiven)]];
  });
}

/** Settings as they were given, to six figures; what came out with the figures that mean something. */
function textOf(value, unit, asGiven, named = true) {
  if (value === null || value === undefined) return none;
  if (typeof value === "number") {
    if (!asGiven && named) return withUnit(value, unit);
    const { name, factor } = unitOf(unit);
    const shown = Number((value * factor).toPrecision(6));
    const digits = shown.toLocaleString("en", { maximumSignificantDigits: 6 });
    return named && name ? `${digits} ${name}` : digits;
  }
  if (typeof value === "boolean") return value ? "yes" : "no";
  return typeof value === "string" ? value : JSON.stringify(value);
}

function list(report, title, object, asGiven = false) {
  const rows = rowsOf(report, object, asGiven);
  if (rows.length === 0) return null;
  const cells = rows.map(([name, value]) =>
    el("tr", {}, el("th", { scope: "row" }, name), el("td", {}, value)));
  return el("details", { class: "figures", open: true }, el("summary", {}, title),
    el("table", {}, el("tbody", {}, ...cells)));
}

/** Figures of the view shown, where it has them, and those of the whole. */
export function buildFigures(state, report) {
  const host = el("div", {});
  state.follow(["step"], ({ step }) => {
    const entries = Object.entries(report.summary ?? {});
    const now = report.isRun ? report.steps[step].figures : {};
    const isOfView = ([key]) => key in now;
    const ofView = entries.filter(isOfView).map(([key]) => [key, now[key]]);
    const lists = [
      list(report, `After view ${step}`, Object.fromEntries(ofView)),
      list(report, report.isRun ? "Of the whole run" : "Figures", Object.fromEntries(entries.filter((e) => !isOfView(e)))),
      list(report, "Settings", report.settings, true)];
    host.replaceChildren(...lists.filter(Boolean));
  });
  return host;
}

function runHeadline(report, step, other) {
  const s = report.summary ?? {};
  const f = report.steps[step].figures;
  const beside = other?.figures[step];
  const entries = [["visible surface covered", percent(f.coverage_visible), percent(beside?.coverage_visible)],
    ["RMS error", withUnit(f.rms_error, "m"), withUnit(beside?.rms_error, "m")],
    ["path length", withUnit(f.travelled, "m as it is"), withUnit(beside?.travelled, "m as it is")]];
  if (Number.isFinite(s.frames)) entries.unshift(["frames in the map", short(s.frames), none]);
  if (step === report.steps.length - 1 && s.stop_reason) entries.push([`ended: ${stopWords(s.stop_reason)}`, "", none]);
  return entries;
}

/** The few figures that say how it went: of a run those of the view shown. */
export function showHeadline(state, report) {
  const gain = report.isRun ? -1 : report.score.columns.indexOf("gain");
  const best = report.isRun ? null : report.score.rows[0];
  state.follow(["step", "other"], ({ step, other }) => {
    const entries = report.isRun ? runHeadline(report, step, other)
      : [["poses ranked", short(report.score.rows.length), none],
        ["best gain", best && gain >= 0 ? withUnit(best[gain], report.gain_unit) : none, none],
        ["poses/s", short(report.summary?.poses_per_second), none]];
    byId("headline").replaceChildren(...entries.filter(([, value]) => value !== none).map(([name, value, beside]) =>
      el("div", {}, el("dd", {}, value), beside === none ? null : el("dd", { class: "other" }, beside), el("dt", {}, name))));
  });
}
