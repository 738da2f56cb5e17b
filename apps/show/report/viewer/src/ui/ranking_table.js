// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The ranking of scored poses.
import { ramps } from "../colours.js";
import { el, swatch } from "../dom.js";
import { none, short, unitFor, words } from "../format.js";
import { Table } from "./table.js";

/** A column's name with its unit, where the name tells it. */
function scaleOf(report, name, at) {
  const most = Math.max(0, ...report.score.rows.map((row) => row[at]).filter(Number.isFinite));
  if (name === "gain" || name === "worth") return unitFor(report.gain_unit, most);
  return unitFor(name === "area" ? "m^2" : "", most);
}

export function buildRankingTable(state, report, go) {
  const { columns: names, rows } = report.score;
  const gainAt = names.indexOf("gain");
  const gains = rows.map((row) => row[gainAt]).filter(Number.isFinite);
  const [low, high] = [Math.min(...gains), Math.max(...gains)];
  const scales = names.map((name, i) => scaleOf(report, name, i));
  const cellOf = (value, index) => {
    if (value === null || value === undefined) return none;
    if (typeof value !== "number") return words(value);
    const text = short(value * scales[index].factor, scales[index].finest);
    if (index !== gainAt) return text;
    return el("span", { class: "mark" }, text, swatch(ramps.gain.css((value - low) / (high - low || 1))));
  };
  const isNumber = names.map((_, i) => rows.some((row) => typeof row[i] === "number"));
  const columns = names.map((name, i) => {
    const unit = scales[i].name;
    return {
      name: `${words(name)}${unit ? ` ${unit}` : ""}`,
      title: words(name),
      number: isNumber[i],
      value: ({ row }) => row[i],
      cell: ({ row }) => cellOf(row[i], i),
    };
  });
  const rank = { name: "rank", title: "Rank", number: true, value: ({ id }) => id, cell: ({ id }) => String(id + 1) };
  const table = new Table("Ranking", [rank, ...columns], go);
  table.setRows(rows.map((row, id) => ({ id, row })));
  state.follow(["step", "tab"], ({ step }) => table.select(step));
  return table.element;
}
