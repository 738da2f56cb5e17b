// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The table of a run's views.
import { classColours } from "../colours.js";
import { el, swatch } from "../dom.js";
import { fixed, none, short, unitFor, words } from "../format.js";
import { Table } from "./table.js";

const number = (name, title, value, text) => ({
  name, title, number: true, value: (row) => value(row.f), cell: (row) => text(value(row.f)),
});

const scaled = (key, factor) => (f) => (Number.isFinite(f[key]) ? factor * f[key] : NaN);

export function classCell(name) {
  return name ? el("span", { class: "mark" }, swatch(classColours[name] ?? "gray"), name) : none;
}

const secondsOf = ({ seconds = {} }) =>
  Object.entries(seconds).reduce((sum, [stage, value]) => (stage === "total" ? sum : sum + value), 0);

const columnsOf = (area) => [
  { name: "View", title: "Number of the view", number: true, value: (row) => row.id, cell: (row) => String(row.id) },
  { name: "From", title: "What proposed it: a class of boundary, or a generator", value: ({ f }) => f.class ?? f.generator,
    cell: ({ f }) => (f.class ? classCell(f.class) : words(f.generator ?? none)) },
  number("Cover %", "Coverage of the visible surface [%]", scaled("coverage_visible", 100), (v) => fixed(v, 1)),
  number("RMS mm", "RMS error of the surface [mm]", scaled("rms_error", 1e3), (v) => fixed(v, 2)),
  number(`New ${area.name}`, `New surface that the view showed [${area.name}]`, scaled("realised_area", area.factor),
    (v) => short(v, area.finest)),
  number(`Pred. ${area.name}`, `New surface that was predicted [${area.name}]`, scaled("predicted_area", area.factor),
    (v) => short(v, area.finest)),
  number("Cand.", "Candidates it was chosen from", (f) => f.candidates, short),
  number("s", "Time [s]", secondsOf, (v) => fixed(v, 1)),
];

export function buildViewTable(state, report, go) {
  const most = Math.max(0, ...report.steps.map(({ figures }) => figures.realised_area).filter(Number.isFinite));
  const table = new Table("Views", columnsOf(unitFor("m^2", most)), go);
  table.setRows(report.steps.map(({ figures }, id) => ({ id, f: figures })));
  state.follow(["step", "tab"], ({ step }) => table.select(step));
  return table.element;
}
