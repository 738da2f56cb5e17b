// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The parts of a view (mesh, points, candidates, ...) from their blocks.
import { decodeBlock } from "./blocks.js";

/** Decodes every block that `raw` holds directly; other values stay as they are, null too. */
async function decodeFields(raw) {
  const entries = Object.entries(raw).map(async ([key, value]) => {
    const isBlock = value !== null && typeof value === "object" && typeof value.data === "string";
    return [key, isBlock ? await decodeBlock(value) : value];
  });
  return Object.fromEntries(await Promise.all(entries));
}

// How many parts stay decoded: those of some five views.
const kept = 40;

/** Decodes parts when they are first asked for and keeps the ones last used. */
export class PartCache {
  #parts = new Map();

  get(raw) {
    const part = this.#parts.get(raw) ?? decodeFields(raw);
    this.#parts.delete(raw);
    this.#parts.set(raw, part);
    if (this.#parts.size > kept) this.#parts.delete(this.#parts.keys().next().value);
    return part;
  }
}

/** The 12 numbers of a pose from a list of poses. */
export const poseAt = (poses, index) => Array.from(poses.subarray(12 * index, 12 * index + 12));

/** The value below which a share of the finite numbers lies; NaN where there is none. */
export function quantile(values, share) {
  const finite = Float32Array.from(values).filter(Number.isFinite).sort();
  return finite.length === 0 ? NaN : finite[Math.min(finite.length - 1, Math.floor(share * finite.length))];
}
