// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Which plots a report has.
import { stageColours } from "../colours.js";
import { el } from "../dom.js";
import { unitOf, words } from "../format.js";
import { buildPlot } from "./plots.js";

const blue = "var(--plot-1)";
const orange = "var(--plot-2)";

const figuresOf = (report, key, factor = 1) =>
  report.steps.map(({ figures }) => (Number.isFinite(figures[key]) ? factor * figures[key] : NaN));

// More stages than colours share the last one.
function stageSeries(report) {
  const totals = new Map();
  for (const { figures } of report.steps) {
    for (const [stage, seconds] of Object.entries(figures.seconds ?? {})) {
      if (stage !== "total" && seconds > 0) totals.set(stage, (totals.get(stage) ?? 0) + seconds);
    }
  }
  const stages = [...totals].sort((a, b) => b[1] - a[1]).map(([stage]) => stage);
  const most = stageColours.length - 1;
  const groups = stages.length > stageColours.length
    ? [...stages.slice(0, most).map((stage) => [stage, [stage]]), ["other", stages.slice(most)]]
    : stages.map((stage) => [stage, [stage]]);
  return groups.map(([name, members], i) => ({
    name: words(name),
    colour: stageColours[i],
    values: report.steps.map(({ figures }) =>
      members.reduce((sum, stage) => sum + (figures.seconds?.[stage] ?? 0), 0)),
  }));
}

function runPlots(report) {
  const area = unitOf("m^2");
  const length = unitOf("m");
  return [
    { id: "coverage", title: "Coverage", unit: "%", top: 100,
      series: [{ name: "coverage", colour: blue, values: figuresOf(report, "coverage_visible", 100) }] },
    { id: "error", title: "Error", unit: length.name, series: [
      { name: "RMS", colour: blue, values: figuresOf(report, "rms_error", length.factor) },
      { name: "95 %", colour: orange, dashed: true, values: figuresOf(report, "p95_error", length.factor) }] },
    { id: "area", title: "New surface", unit: area.name, series: [
      { name: "realised", colour: blue, values: figuresOf(report, "realised_area", area.factor) },
      { name: "predicted", colour: orange, dashed: true, values: figuresOf(report, "predicted_area", area.factor) }] },
    { id: "entropy", title: "Entropy removed", unit: report.entropy_unit,
      series: [{ name: "entropy", colour: blue, values: figuresOf(report, "entropy_removed") }] },
    { id: "seconds", title: "Time by stage", unit: "s", stacked: true, wide: true, series: stageSeries(report) },
  ];
}

function scorePlots(report) {
  const column = report.score.columns.indexOf("gain");
  const { name, factor } = unitOf(report.gain_unit);
  const values = report.score.rows.map((row) => (column >= 0 && row[column] !== null ? factor * row[column] : NaN));
  return [{ id: "gain", title: "Gain by rank", unit: name, wide: true,
    series: [{ name: "gain", colour: blue, values }] }];
}

export function buildPlots(state, report, go) {
  const plots = report.isRun ? runPlots(report) : scorePlots(report);
  const firstName = report.isRun ? 0 : 1;
  const shown = plots.filter(({ series }) => series.some(({ values }) => values.some(Number.isFinite)));
  return el("div", { class: "plots" }, ...shown.map((plot) => buildPlot(state, { ...plot, firstName }, go)));
}
