// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Numbers and names as people read them.

export const none = "–";

/** About three figures; what is smaller than half of `finest` only as "under" it. */
export function short(value, finest = 0) {
  if (typeof value !== "number" || !Number.isFinite(value)) return none;
  const size = Math.abs(value);
  if (size > 0 && size < finest / 2) return `< ${finest}`;
  if (finest > 0 && size < 100 && !Number.isInteger(value)) {
    const digits = Math.min(Math.max(0, -Math.floor(Math.log10(finest) + 1e-9)), size >= 10 ? 1 : 2);
    return value.toFixed(digits);
  }
  if (size >= 100 || Number.isInteger(value)) return Math.round(value).toLocaleString("en");
  if (size >= 10) return value.toFixed(1);
  if (size >= 1) return value.toFixed(2);
  return size >= 0.001 ? String(Number(value.toPrecision(3))) : value.toExponential(1);
}

export const fixed = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : none);

export const percent = (share) => (Number.isFinite(share) ? `${(100 * share).toFixed(1)} %` : none);

const areas = {
  "mm²": { name: "mm²", factor: 1e6, finest: 0 },
  "cm²": { name: "cm²", factor: 1e4, finest: 0.1 },
  "m²": { name: "m²", factor: 1, finest: 0.01 },
};

/**
 * How a unit of the data is shown: its name, what values are multiplied by, and the finest step that means
 * something.
 */
export function unitOf(unit) {
  if (unit === "m^2") return areas["cm²"];
  if (unit === "m") return { name: "mm", factor: 1e3, finest: 0.01 };
  if (unit === "%") return { name: "%", factor: 100, finest: 0.1 };
  if (unit === "m as it is") return { name: "m", factor: 1, finest: 0.01 };
  return { name: unit ?? "", factor: 1, finest: unit ? 0.01 : 0 };
}

/** The same for values of which `most` is the largest: of voxels in mm², of rooms in m². */
export function unitFor(unit, most) {
  if (unit === "m^2") return most >= 1 ? areas["m²"] : most < 1e-4 ? areas["mm²"] : areas["cm²"];
  return { ...unitOf(unit), finest: most < 1 ? 0 : unitOf(unit).finest };
}

export const withUnit = (value, unit) => {
  const { name, factor, finest } = unit === "m^2" && value >= 1 ? areas["m²"] : unitOf(unit);
  return Number.isFinite(value) ? `${short(value * factor, finest)} ${name}`.trim() : none;
};

const meanings = {
  coverage: "surface covered", coverage_visible: "visible surface covered", coverage_2_5mm: "covered to 2.5 mm",
  coverage_points: "visible surface covered by points", coverage_triangles: "visible surface covered by triangles",
  rms_error: "RMS error of the surface", p95_error: "95 % of the surface's errors are under",
  rms_error_points: "RMS error of the points", p95_error_points: "95 % of the points' errors are under",
  consistency: "squared error over variance of the points: mean (ideal 1)",
  consistency_median: "squared error over variance: median (ideal 0.455)",
  consistency_above_9: "points more than 3 sigma off (ideal 0.3 %)",
  entropy_removed: "entropy removed", travelled: "path length",
  surface_area: "area of the surface", unknown_voxels: "voxels still unknown", gain_model: "gain",
  stop_reason: "why the run ended", final_candidates: "candidates at the end", voxel: "voxel size",
  size: "longest side of the object", max_views: "views at most", tolerance: "covered where the surface is nearer than",
  prior_sigma: "σ of an unknown voxel", stop_gain: "ends under a gain of", stop_area: "ends under a share of new surface of",
  reach_hazard: "views within reach", readings: "readings", readings_inside: "readings in the workspace", seconds: "time",
};

/** Keys and reasons of the program as words. */
export const words = (key) => meanings[key] ?? String(key).replace(/_/g, " ");

/** The unit of a figure or setting by its key; undefined: none, or not known. */
export function unitOfKey(key, report) {
  if (/^(rms|p95)_error|^(voxel|size|tolerance|prior_sigma|distance|region_depth|object_size|workspace)$/.test(key)) return "m";
  if (/^travelled$|^background$/.test(key)) return "m as it is";
  if (/^coverage|^consistency_above_9$/.test(key)) return "%";
  if (/_area$/.test(key)) return key === "stop_area" ? undefined : "m^2";
  if (key === "entropy_removed") return report.entropy_unit;
  if (/_gain$/.test(key)) return report.gain_unit;
  return key.startsWith("seconds.") ? "s" : undefined;
}

const stops = {
  gain: "the best view left promises too little", area: "the best view left promises too little new surface",
  cost: "no view is worth its path", no_candidates: "no candidate is left", unreachable: "no candidate can be reached",
  idle: "three views in a row brought nothing", promises: "views bring far less than they promised",
  max_views: "all allowed views are taken", coverage: "the coverage asked for is reached",
  no_frames: "all frames are in", interrupted: "it was interrupted",
};

/** Why a run ended. */
export const stopWords = (reason) => stops[reason] ?? words(reason);

export const count = (n, one, many) => `${n.toLocaleString("en")} ${n === 1 ? one : many}`;
