// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Colours: perceptually even ramps, and the fixed colours of classes, hits and stages.

/** Björn Ottosson's Oklab, given as lightness, chroma and hue [degrees], as linear sRGB in 0..1. */
function linearOf([lightness, chroma, hue]) {
  const a = chroma * Math.cos((hue * Math.PI) / 180);
  const b = chroma * Math.sin((hue * Math.PI) / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map((v) => Math.min(1, Math.max(0, v)));
}

const encoded = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
const css = (linear) => `rgb(${linear.map((v) => Math.round(255 * encoded(v))).join(" ")})`;

const levels = 256;

/** A ramp through points [lightness, chroma, hue], evenly spaced. */
function ramp(points) {
  const table = new Float32Array(3 * levels);
  for (let i = 0; i < levels; ++i) {
    const at = (i / (levels - 1)) * (points.length - 1);
    const k = Math.min(points.length - 2, Math.floor(at));
    const t = at - k;
    table.set(linearOf(points[k].map((v, j) => v + t * (points[k + 1][j] - v))), 3 * i);
  }
  const index = (t) => 3 * Math.round((levels - 1) * Math.min(1, Math.max(0, t)));
  return {
    /** Writes the linear colour of t in 0..1 to target[at..at+2]; NaN is grey. */
    write(t, target, at) {
      if (Number.isNaN(t)) target.fill(0.2, at, at + 3);
      else for (let j = 0, from = index(t); j < 3; ++j) target[at + j] = table[from + j];
    },
    css: (t) => (Number.isFinite(t) ? css([...table.subarray(index(t), index(t) + 3)]) : "gray"),
  };
}

// Three families, none of which means two things: poses are green; voxels and rays orange where unknown and
// blue where occupied; boundaries violet. How far off a surface may be, or is, is red. The lightness runs one
// way along each ramp, so that they also read in grey.
export const ramps = {
  gain: ramp([[0.86, 0.05, 140], [0.75, 0.13, 145], [0.6, 0.14, 150], [0.42, 0.1, 155]]),
  sigma: ramp([[0.95, 0.02, 20], [0.8, 0.1, 20], [0.62, 0.19, 22], [0.45, 0.17, 25], [0.28, 0.1, 25]]),
  error: ramp([[0.95, 0.02, 20], [0.8, 0.1, 20], [0.62, 0.19, 22], [0.45, 0.17, 25], [0.28, 0.1, 25]]),
  unknown: ramp([[0.93, 0.05, 80], [0.78, 0.15, 62], [0.62, 0.17, 45]]),
  occupied: ramp([[0.92, 0.03, 245], [0.7, 0.12, 250], [0.48, 0.16, 262]]),
};

export const classColours = { left: "#5b2a9d", right: "#c77ff0", top: "#8e3fc9", bottom: "#d6409f" };
export const hitColours = { unknown: "#f08a24", occupied: "#3d7fe0", nothing: "#8a94a3" };
export const chosenColour = "#0c8a4f";
export const selectedColour = "#8fe388";
export const patchColour = "#b08ad9";
export const truthColour = "#a39a83";

export const stageColours = [
  "#4e79a7", "#e8963e", "#5ba3a0", "#d1605e", "#8f78b5", "#6aa557", "#c99a2e", "#b0768c", "#8d99a8",
];
