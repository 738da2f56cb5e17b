// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Encodes blocks as apps/report/README.md describes them, to try the page's decoder against.
import { gzipSync } from "node:zlib";

const bitsOf = { u8: 8, u16: 16, u32: 32 };

/** @param {ArrayLike<number>} values row after row */
export function encodeIntegers(type, columns, values) {
  const bits = bitsOf[type];
  const size = 2 ** bits;
  const rows = values.length / columns;
  const bytes = new Uint8Array((values.length * bits) / 8);
  for (let c = 0; c < columns; ++c) {
    let before = 0;
    for (let r = 0; r < rows; ++r) {
      const value = values[r * columns + c];
      let difference = (((value - before) % size) + size) % size;
      if (difference >= size / 2) difference -= size;
      before = value;
      const code = difference >= 0 ? 2 * difference : -2 * difference - 1;
      for (let b = 0; b < bits / 8; ++b) {
        bytes[((c * bits) / 8 + b) * rows + r] = Math.floor(code / 256 ** b) % 256;
      }
    }
  }
  return { type, columns, rows, data: gzipSync(bytes).toString("base64") };
}

/** Numbers in steps between each column's least and greatest; NaN stays NaN. */
export function encodeSteps(type, columns, values) {
  const top = 2 ** bitsOf[type] - 1;
  const min = new Array(columns).fill(Infinity);
  const max = new Array(columns).fill(-Infinity);
  values.forEach((v, i) => {
    if (Number.isNaN(v)) return;
    min[i % columns] = Math.min(min[i % columns], v);
    max[i % columns] = Math.max(max[i % columns], v);
  });
  const step = min.map((low, c) => (max[c] - low) / (top - 1) || 0);
  const codes = Array.from(values, (v, i) => {
    const c = i % columns;
    if (Number.isNaN(v)) return top;
    return step[c] === 0 ? 0 : Math.round((v - min[c]) / step[c]);
  });
  const finite = min.map((v) => (Number.isFinite(v) ? v : 0));
  return { ...encodeIntegers(type, columns, codes), min: finite, step: step.map((v) => v || 0) };
}

export function encodeFloats(columns, values) {
  const floats = Float32Array.from(values);
  const data = gzipSync(new Uint8Array(floats.buffer)).toString("base64");
  return { type: "f32", columns, rows: values.length / columns, data };
}
