// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Elements. Text always goes in as text, so that names from outside cannot become markup.

const svgSpace = "http://www.w3.org/2000/svg";

function fill(element, properties, children) {
  for (const [key, value] of Object.entries(properties)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (key in element && typeof value !== "string") element[key] = value;
    else if (value !== null && value !== undefined) element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null));
  return element;
}

export const el = (tag, properties = {}, ...children) =>
  fill(document.createElement(tag), properties, children);

export const svg = (tag, properties = {}, ...children) =>
  fill(document.createElementNS(svgSpace, tag), Object.fromEntries(
    Object.entries(properties).map(([key, v]) => [key, typeof v === "number" ? String(v) : v])), children);

export const byId = (id) => document.getElementById(id);

/** A little square of a colour. */
export function swatch(colour) {
  const mark = el("i", { class: "swatch", "aria-hidden": "true" });
  mark.style.background = colour;
  return mark;
}
