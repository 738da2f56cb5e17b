// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Which plots a report has.
import { stageColours } from "../colours.js";
import { dataOf, otherRun } from "../data/report.js";
import { el } from "../dom.js";
import { unitFor, unitOf, words } from "../format.js";
import { buildPlot } from "./plots.js";

const main = "var(--plot-1)";
const second = "var(--plot-2)";

const valuesOf = (figures, key, factor = 1) =>
  figures.map((f) => (Number.isFinite(f[key]) ? factor * f[key] : NaN));

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

function runPlots(report, other) {
  const figures = report.steps.map((step) => step.figures);
  const most = (key) => Math.max(0, ...valuesOf(figures, key).filter(Number.isFinite));
  // Series: name, key; the first of a plot is drawn of the other run, too.
  const plot = (id, title, { name, factor, finest }, [first, ...more]) => ({ id, title, unit: name, finest, series: [
    { name: first[0], colour: main, values: valuesOf(figures, first[1], factor) },
    ...more.map(([text, key]) => ({ name: text, colour: second, dashed: true, values: valuesOf(figures, key, factor) })),
    ...(other ? [{ name: other.name, colour: "var(--plot-other)", other: true,
      values: valuesOf(other.figures, first[1], factor) }] : []),
  ] });
  return [
    { ...plot("coverage", "Coverage", unitOf("%"), [["this run", "coverage_visible"]]), top: 100 },
    plot("error", "Error", unitOf("m"), [["RMS", "rms_error"], ["95 %", "p95_error"]]),
    plot("area", "New surface", unitFor("m^2", most("realised_area")), [["realised", "realised_area"], ["predicted", "predicted_area"]]),
    plot("entropy", "Entropy removed", unitOf(report.entropy_unit), [["this run", "entropy_removed"]]),
    { id: "seconds", title: "Time by stage", unit: "s", finest: 0.01, stacked: true, wide: true, series: stageSeries(report) },
  ];
}

function scorePlots(report) {
  const column = report.score.columns.indexOf("gain");
  const gains = report.score.rows.map((row) => (column >= 0 && row[column] !== null ? row[column] : NaN));
  const { name, factor, finest } = unitFor(report.gain_unit, Math.max(0, ...gains.filter(Number.isFinite)));
  const values = gains.map((gain) => factor * gain);
  return [{ id: "gain", title: "Gain by rank", unit: name, finest, wide: true,
    series: [{ name: "gain", colour: main, values }] }];
}

/** Chooses another run, whose curves the plots show over this one's. */
function comparison(state) {
  const name = el("b", { id: "other" }, state.values.other?.name ?? "");
  const open = async () => {
    try {
      const [file] = input.files;
      state.set({ other: file ? otherRun(file.name, dataOf(await file.text())) : null });
      name.textContent = state.values.other?.name ?? "";
    } catch (error) {
      name.textContent = `not shown: ${error.message}`;
    }
  };
  const input = el("input", { type: "file", id: "compare", accept: ".html,.json", onchange: open });
  const title = "The report.html or run.json of another run";
  return el("label", { class: "compare", title }, "Beside", input, name);
}

export function buildPlots(state, report, go) {
  const host = el("div", { class: "plots" });
  const axis = report.isRun ? { firstName: 0, stepName: "view" } : { firstName: 1, stepName: "rank" };
  state.follow(["other"], ({ other }) => {
    const plots = report.isRun ? runPlots(report, other) : scorePlots(report);
    const shown = plots.filter(({ series }) => series.some(({ values }) => values.some(Number.isFinite)));
    host.replaceChildren(...shown.map((plot) => buildPlot(state, { ...plot, ...axis }, go)));
  });
  return el("div", {}, report.isRun ? comparison(state) : null, host);
}
