// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// By how much a pose misses what the robot and the camera allow.

/** Of a pose of 12 numbers. */
export const positionOf = (pose) => [pose[3], pose[7], pose[11]];

export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** The angle between two poses [degrees]. */
export function angleBetween(a, b) {
  let trace = 0;
  for (let row = 0; row < 3; ++row) for (let c = 0; c < 3; ++c) trace += a[4 * row + c] * b[4 * row + c];
  return (180 / Math.PI) * Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2)));
}

const outOfBox = (p, [min, max]) => Math.hypot(...p.map((v, c) => Math.max(0, min[c] - v, v - max[c])));

function outOfShell(p, [x, y, z, least, most]) {
  const r = distance(p, [x, y, z]);
  return Math.max(0, least - r, r - most);
}

function outOfHalfSpace(p, [x, y, z, offset]) {
  return Math.max(0, (offset - x * p[0] - y * p[1] - z * p[2]) / Math.hypot(x, y, z));
}

/** How far a position is out of reach [m]; 0: within the boxes, shells and half-spaces. */
export function outOfReach(p, { boxes = [], shells = [], half_spaces: halves = [] } = {}) {
  const nearest = (parts, out) => (parts.length > 0 ? Math.min(...parts.map((part) => out(p, part))) : 0);
  const ofHalves = halves.map((half) => outOfHalfSpace(p, half));
  return Math.max(nearest(boxes, outOfBox), nearest(shells, outOfShell), 0, ...ofHalves);
}

/** The distance to the nearest of points that lie one after the other; NaN where there is none. */
export function distanceToPoints(p, points) {
  let least = Infinity;
  for (let i = 0; i < points.length; i += 3) {
    const [x, y, z] = [points[i] - p[0], points[i + 1] - p[1], points[i + 2] - p[2]];
    const square = x * x + y * y + z * z;
    if (square < least) least = square;
  }
  return Number.isFinite(least) ? Math.sqrt(least) : NaN;
}
