// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// A table that sorts by its columns and whose rows can be selected, by mouse and keys.
import { el } from "../dom.js";

// Longer tables start with as many rows.
const firstRows = 150;

const missing = (v) => v === null || v === undefined || Number.isNaN(v);

/** What is missing comes last whatever the sign. */
function order(a, b, sign) {
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  const numbers = typeof a === "number" && typeof b === "number";
  return sign * (numbers ? a - b : String(a).localeCompare(String(b)));
}

export class Table {
  #rows = [];
  #sorted = [];
  #limit = firstRows;
  #column = null;
  #down = false;
  #selected = null;
  #elements = new Map();

  /** columns: name, title, number, long (its text wraps), value(row), cell(row) -> text or node; rows have an `id`; sortBy: a column to start with. */
  constructor(label, columns, choose, sortBy = null) {
    this.columns = columns;
    this.choose = choose;
    this.heads = columns.map((column, i) => {
      const sort = () => this.#sortBy(i);
      const button = el("button", { type: "button", title: column.title, onclick: sort }, column.name);
      return el("th", { scope: "col", class: column.number ? "number" : null }, button);
    });
    this.body = el("tbody", { onkeydown: (event) => this.#key(event) });
    this.more = el("button", { type: "button", class: "more", onclick: () => this.#showAll() });
    const head = el("thead", {}, el("tr", {}, ...this.heads));
    const table = el("table", { role: "grid", "aria-label": label }, head, this.body);
    if (sortBy !== null) this.#sortBy(sortBy);
    this.element = el("div", { class: "table" }, table, this.more);
  }

  setRows(rows) {
    this.#rows = rows;
    this.#limit = firstRows;
    this.#draw();
  }

  select(id) {
    this.#selected = id;
    if (!this.#elements.has(id) && this.#rows.some((row) => row.id === id)) {
      this.#limit = Infinity;
      this.#draw();
    }
    this.#mark();
    this.#elements.get(id)?.scrollIntoView({ block: "nearest" });
  }

  #sortBy(index) {
    // First down for numbers, up for names; then the other way; then as it was.
    const firstDown = Boolean(this.columns[index].number);
    if (this.#column !== index) [this.#column, this.#down] = [index, firstDown];
    else if (this.#down === firstDown) this.#down = !firstDown;
    else this.#column = null;
    this.heads.forEach((head, i) => {
      if (i === this.#column) head.setAttribute("aria-sort", this.#down ? "descending" : "ascending");
      else head.removeAttribute("aria-sort");
    });
    this.#draw();
  }

  #draw() {
    this.#sorted = [...this.#rows];
    if (this.#column !== null) {
      const { value } = this.columns[this.#column];
      const sign = this.#down ? -1 : 1;
      this.#sorted.sort((a, b) => order(value(a), value(b), sign));
    }
    this.#elements.clear();
    const rows = this.#sorted.slice(0, this.#limit).map((row) => this.#row(row));
    this.body.replaceChildren(...rows);
    const hidden = this.#sorted.length - rows.length;
    this.more.hidden = hidden <= 0;
    this.more.textContent = `Show all ${this.#sorted.length.toLocaleString("en")} rows`;
    this.#mark();
  }

  #row(row) {
    const cells = this.columns.map(({ cell, number, long }) =>
      el("td", { class: number ? "number" : long ? "long" : null }, cell(row)));
    const element = el("tr", { "data-id": String(row.id), class: row.muted ? "muted" : null,
      onclick: () => this.choose(row.id) }, ...cells);
    element.tabIndex = -1;
    this.#elements.set(row.id, element);
    return element;
  }

  #showAll() {
    this.#limit = Infinity;
    this.#draw();
  }

  #mark() {
    for (const [id, element] of this.#elements) {
      const selected = id === this.#selected;
      element.setAttribute("aria-selected", selected);
      element.tabIndex = selected ? 0 : -1;
    }
    // Some row must be in the order of the tab key.
    if (!this.#elements.has(this.#selected) && this.body.firstChild) this.body.firstChild.tabIndex = 0;
  }

  #key(event) {
    const rows = [...this.body.children];
    const at = rows.indexOf(event.target);
    if (at < 0) return;
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: rows.length - 1, Enter: at, " ": at }[event.key];
    if (to === undefined || to < 0 || to >= rows.length) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(this.#sorted[to].id);
    this.#elements.get(this.#sorted[to].id)?.focus();
  }
}
