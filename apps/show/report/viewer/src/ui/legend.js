// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The legend of what is on the stage.
import { el, swatch } from "../dom.js";
import { short } from "../format.js";

function bar({ title, ramp, low, high, open }) {
  const stops = Array.from({ length: 9 }, (_, i) => ramp.css(i / 8));
  const strip = el("span", { class: "ramp", "aria-hidden": "true" });
  strip.style.background = `linear-gradient(to right, ${stops.join(",")})`;
  return el("div", { class: "bar" }, el("span", { class: "name" }, title),
    `${open && low > 0 ? "≤ " : ""}${short(low)}`, strip, `${open ? "≥ " : ""}${short(high)}`);
}

function marks({ title, marks: list }) {
  const items = list.map(([name, colour]) => el("span", { class: "mark" }, swatch(colour), name));
  return el("div", { class: "marks" }, el("span", { class: "name" }, title), ...items);
}

/** Entries with the same title share a line. */
function merged(legends) {
  const byTitle = new Map();
  for (const entry of legends) {
    const before = byTitle.get(entry.title);
    if (before?.marks) before.marks = [...before.marks, ...entry.marks];
    else byTitle.set(entry.title, { ...entry });
  }
  return [...byTitle.values()];
}

export function showLegend(host, legends) {
  const entries = merged(legends).map((entry) => (entry.ramp ? bar(entry) : marks(entry)));
  host.replaceChildren(...entries);
  host.hidden = entries.length === 0;
}

/** A bar of a round length, at the middle of what is looked at. */
export function showScale(host, pixelsPerMetre) {
  const power = 10 ** Math.floor(Math.log10(120 / pixelsPerMetre));
  const metres = [5, 2, 1].map((n) => n * power).find((length) => length * pixelsPerMetre <= 120) ?? power;
  const bar = el("i", {});
  bar.style.width = `${metres * pixelsPerMetre}px`;
  const text = metres >= 1 ? `${short(metres)} m` : metres >= 0.01 ? `${short(100 * metres)} cm` : `${short(1000 * metres)} mm`;
  host.replaceChildren(text, bar);
}
