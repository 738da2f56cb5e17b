// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and names as people read them.

export const none = "–";

/** About three figures. */
export function short(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) return none;
  const size = Math.abs(value);
  if (size >= 100 || Number.isInteger(value)) return Math.round(value).toLocaleString("en");
  if (size >= 10) return value.toFixed(1);
  if (size >= 1) return value.toFixed(2);
  return size >= 0.001 ? String(Number(value.toPrecision(3))) : value.toExponential(1);
}

export const fixed = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : none);

export const percent = (share) => (Number.isFinite(share) ? `${(100 * share).toFixed(1)} %` : none);

/** How a unit of the data is shown: its name and what values are multiplied by. */
export function unitOf(unit) {
  if (unit === "m^2") return { name: "cm²", factor: 1e4 };
  if (unit === "m") return { name: "mm", factor: 1e3 };
  return { name: unit ?? "", factor: 1 };
}

export const withUnit = (value, unit) => {
  const { name, factor } = unitOf(unit);
  return Number.isFinite(value) ? `${short(value * factor)} ${name}`.trim() : none;
};

/** Keys and reasons of the program as words. */
export const words = (key) => String(key).replace(/_/g, " ");

export const count = (n, one, many) => `${n.toLocaleString("en")} ${n === 1 ? one : many}`;
