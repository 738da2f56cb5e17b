// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The table of the candidates that the next view was chosen from, and why each was kept or dropped.
import { chosenColour, ramps } from "../colours.js";
import { el, swatch } from "../dom.js";
import { count, none, short, unitFor, words } from "../format.js";
import { gainRange } from "../layers/candidates.js";
import { Table } from "./table.js";
import { reasonsOf } from "./why.js";
import { classCell } from "./view_table.js";

function columnsOf(report, part, chosen, why) {
  const { low, high } = gainRange(part);
  const unit = unitFor(report.gain_unit, high);
  const areas = unitFor("m^2", part.area.reduce((most, area) => (area > most ? area : most), 0));
  const gainCell = ({ gain, exact }) => {
    if (Number.isNaN(gain)) return none;
    const mark = swatch(ramps.gain.css((gain - low) / (high - low)));
    return el("span", { class: "mark" }, `${exact ? "" : "≈ "}${short(gain * unit.factor, unit.finest)}`, mark);
  };
  const fate = ({ id, reason }) => {
    const [name, text] = [id === chosen ? "chosen" : reason === null ? "kept" : "dropped", why(id, reason)];
    const head = id === chosen ? el("span", { class: "mark strong" }, swatch(chosenColour), name) : name;
    return el("span", { title: text }, head, `: ${text}`);
  };
  const columns = [
    { name: "#", title: "Index of the candidate", number: true,
      value: (row) => row.id, cell: (row) => String(row.id) },
    { name: `Gain ${unit.name}`, title: "Gain by which it ranks; ≈: estimated from some of its rays", number: true,
      value: (row) => row.gain, cell: gainCell },
  ];
  if (report.gain_unit !== "m^2" && part.area.some(Number.isFinite)) {
    columns.push({ name: `Area ${areas.name}`, title: `New surface expected [${areas.name}]`, number: true,
      value: (row) => row.area,
      cell: (row) => (Number.isNaN(row.area) ? none : short(areas.factor * row.area, areas.finest)) });
  }
  columns.push(
    { name: "From", title: "What proposed it: a class of boundary, or a generator", long: true,
      value: (row) => `${row.class ?? ""} ${row.generator}`,
      cell: ({ class: boundary, generator }) =>
        boundary ? el("span", {}, classCell(boundary), ` ${words(generator)}`) : words(generator) },
    { name: "Why", title: "Why it was chosen, kept or dropped", long: true,
      value: (row) => (row.id === chosen ? "" : row.reason ?? "kept"), cell: fate });
  return columns;
}

function rowsOf(part) {
  const exact = new Set(part.exact);
  return part.reason.map((reason, id) => ({
    id,
    gain: part.gain[id],
    exact: exact.has(id),
    area: part.area[id],
    class: part.class[id] < 0 ? null : part.classes[part.class[id]],
    generator: part.generators[part.generator[id]] ?? none,
    reason: reason < 0 ? null : part.reasons[reason],
    muted: reason >= 0,
  }));
}

/** How many were kept, and how many were dropped for each reason. */
function totals(part) {
  const byReason = new Map();
  for (const r of part.reason) byReason.set(r, (byReason.get(r) ?? 0) + 1);
  const kept = byReason.get(-1) ?? 0;
  const dropped = [...byReason].filter(([r]) => r !== -1).sort((a, b) => b[1] - a[1]);
  const chips = dropped.map(([r, n]) =>
    el("span", { class: "chip" }, `${n.toLocaleString("en")} ${words(part.reasons[r])}`));
  return el("p", { class: "totals" }, el("b", {}, `${count(kept, "candidate", "candidates")} kept`),
    dropped.length > 0 ? " · dropped: " : "", ...chips);
}

/** Follows the step only while its tab is open: the candidates of a step may be thousands. */
export function buildCandidateTable(state, report) {
  const host = el("div", { class: "candidates" });
  let table = null;
  let shown = null;
  const choose = (candidate) => state.set({ candidate });
  const show = async ({ step, tab, candidate }) => {
    if (tab !== "candidates") return;
    if (shown !== step) {
      shown = step;
      const { candidates, chosen } = report.steps[step];
      const part = candidates ? await report.part(candidates) : null;
      const surface = (await report.part(report.steps[step].surface)).vertices;
      if (shown !== step) return;
      table = null;
      if (!part || part.reason.length === 0) {
        host.replaceChildren(el("p", { class: "totals" }, "No candidate was proposed after this view."));
        return;
      }
      const why = reasonsOf(report, report.steps[step], part, surface);
      table = new Table("Candidates for the next view", columnsOf(report, part, chosen, why), choose, 1);
      table.setRows(rowsOf(part));
      host.replaceChildren(totals(part), table.element);
    }
    table?.select(state.values.candidate ?? candidate);
  };
  state.follow(["step", "tab", "candidate"], show);
  return host;
}
