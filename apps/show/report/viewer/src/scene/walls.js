// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Walls around a scene: a bin's sides, a shelf's back, a room's ceiling. From outside they hide what is inside.
import { BufferAttribute, Matrix4, Vector3 } from "three";

// A wall covers this share of the scene's section, and lies in the outer part of the scene.
const leastShare = 0.35;
const outerPart = 0.3;
const slices = 64;
// Faces of a wall point along an axis of the grid.
const leastCosine = 0.95;

/** Areas of faces along each axis by sign and slice, from the lowest coordinate. */
function slicesOf(forEachFace, low, extent) {
  const areas = [0, 1, 2].map(() => [new Float64Array(slices), new Float64Array(slices)]);
  forEachFace((at, normal, area) => {
    for (let axis = 0; axis < 3; ++axis) {
      if (Math.abs(normal[axis]) < leastCosine) continue;
      const slice = Math.floor(((at[axis] - low[axis]) / extent[axis]) * slices);
      areas[axis][normal[axis] > 0 ? 1 : 0][Math.min(slices - 1, Math.max(0, slice))] += area;
    }
  });
  return areas;
}

/** How far a wall reaches into the scene, in slices from its side; 0: there is none. */
function depthOf(shareAt) {
  const most = Math.floor(outerPart * slices);
  let first = 0;
  while (first < most && shareAt(first) < leastShare) ++first;
  if (first === most) return 0;
  // Both faces of a thick wall.
  let last = first;
  for (let i = first; i < Math.min(most, first + 5); ++i) if (shareAt(i) >= leastShare) last = i;
  return last + 1;
}

function boxOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = low.map((v) => -v);
  for (let i = 0; i < points.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  return { low, high };
}

/**
 * Planes (n, d) such that what lies at n·p > d is a wall; n points outwards. None of a body that is closed
 * all around, unless cameras are in it. All in the grid's frame: `points` (coordinates one after the other),
 * `forEachFace`, which calls back with a face's middle, normal and area, and `cameras`.
 */
export function wallPlanes(points, forEachFace, cameras) {
  const { low, high } = boxOf(points);
  const extent = high.map((v, c) => v - low[c]);
  if (!extent.every((side) => side > 0)) return [];
  const areas = slicesOf(forEachFace, low, extent);
  const planes = [];
  for (let axis = 0; axis < 3; ++axis) {
    const section = extent[(axis + 1) % 3] * extent[(axis + 2) % 3];
    for (const sign of [-1, 1]) {
      // Slices are counted from this side. A wall's two faces do not count twice.
      const shareAt = (i) => {
        const slice = sign > 0 ? slices - 1 - i : i;
        return Math.max(areas[axis][0][slice], areas[axis][1][slice]) / section;
      };
      const depth = depthOf(shareAt);
      if (depth === 0) continue;
      const inside = ((depth + 1) / slices) * extent[axis];
      const normal = [0, 0, 0];
      normal[axis] = sign;
      planes.push({ normal, offset: sign > 0 ? high[axis] - inside : -(low[axis] + inside) });
    }
  }
  const isInside = (p) => p.every((v, c) => v > low[c] && v < high[c]);
  const closed = planes.filter(({ normal }) => normal[2] >= 0).length === 5;
  return closed && !cameras.some(isInside) ? [] : planes;
}

const moved = (points, matrix) => new BufferAttribute(points.slice(), 3).applyMatrix4(matrix).array;

/** Calls back with each triangle. */
const facesOfMesh = (points, triangles) => (use) => {
  const corner = (index) => [points[3 * index], points[3 * index + 1], points[3 * index + 2]];
  for (let t = 0; t + 2 < triangles.length; t += 3) {
    const [a, b, c] = [corner(triangles[t]), corner(triangles[t + 1]), corner(triangles[t + 2])];
    const [u, v] = [b.map((x, i) => x - a[i]), c.map((x, i) => x - a[i])];
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const twice = Math.hypot(...cross);
    if (twice > 0) use(a.map((x, i) => (x + b[i] + c[i]) / 3), cross.map((x) => x / twice), twice / 2);
  }
};

/** Cubes have a face along each axis. */
const facesOfCubes = (centres, size) => (use) => {
  for (let i = 0; i < centres.length; i += 3) {
    const at = centres.subarray(i, i + 3);
    for (const normal of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) use(at, normal, size * size);
  }
};

/** The walls of a report, as planes in the world. */
export async function wallsOf(report) {
  const toWorld = new Matrix4().set(...report.T_world_grid, 0, 0, 0, 1);
  const toGrid = toWorld.clone().invert();
  const last = report.steps[report.steps.length - 1];
  const part = await report.part(report.isRun ? report.truth ?? last.surface : report.score.map);
  const points = moved(report.isRun ? part.vertices : part.centers, toGrid);
  const forEachFace = report.isRun ? facesOfMesh(points, part.triangles) : facesOfCubes(points, part.size);
  const cameras = report.steps.filter(({ pose }) => pose).map(({ pose }) =>
    new Vector3(pose[3], pose[7], pose[11]).applyMatrix4(toGrid).toArray());
  return wallPlanes(points, forEachFace, cameras).map(({ normal, offset }) => {
    const n = new Vector3().fromArray(normal).transformDirection(toWorld);
    const point = new Vector3().fromArray(normal).multiplyScalar(offset).applyMatrix4(toWorld);
    return { normal: n, offset: n.dot(point) };
  });
}
