// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Walls around a scene: a bin's sides, a shelf's back, a room's ceiling. From outside they hide what is inside.
import { Matrix4, Vector3 } from "three";

// A wall covers this share of the scene's section, and lies in the outer part of the scene.
const leastShare = 0.35;
const outerPart = 0.3;
const slices = 64;
// Faces of a wall point along an axis of the grid.
const leastCosine = 0.95;

/** Areas of faces along each axis by sign and slice, from the lowest coordinate. */
function slicesOf(faces, box) {
  const areas = [0, 1, 2].map(() => [new Float64Array(slices), new Float64Array(slices)]);
  for (const { at, normal, area } of faces) {
    for (let axis = 0; axis < 3; ++axis) {
      const cosine = normal[axis];
      if (Math.abs(cosine) < leastCosine) continue;
      const share = (at[axis] - box.low[axis]) / (box.high[axis] - box.low[axis]);
      areas[axis][cosine > 0 ? 1 : 0][Math.min(slices - 1, Math.max(0, Math.floor(share * slices)))] += area;
    }
  }
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

/**
 * Planes (n, d) such that what lies at n·p > d is a wall; n points outwards. None of a body that is closed
 * all around, unless cameras are in it. `faces`: at, normal, area, in the grid's frame; `cameras`: positions
 * there.
 */
export function wallPlanes(faces, cameras) {
  if (faces.length === 0) return [];
  const box = { low: [0, 1, 2].map(() => Infinity), high: [0, 1, 2].map(() => -Infinity) };
  for (const { corners } of faces) {
    for (const corner of corners) {
      for (let c = 0; c < 3; ++c) {
        box.low[c] = Math.min(box.low[c], corner[c]);
        box.high[c] = Math.max(box.high[c], corner[c]);
      }
    }
  }
  const extent = box.high.map((high, c) => high - box.low[c]);
  if (extent.some((side) => !(side > 0))) return [];
  const areas = slicesOf(faces, box);
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
      planes.push({ normal, offset: sign > 0 ? box.high[axis] - inside : -(box.low[axis] + inside) });
    }
  }
  const isInside = (p) => p.every((v, c) => v > box.low[c] && v < box.high[c]);
  const closed = planes.filter(({ normal }) => normal[2] >= 0).length === 5;
  return closed && !cameras.some(isInside) ? [] : planes;
}

/** The faces of a mesh, moved by `matrix`. */
export function facesOfMesh({ vertices, triangles }, matrix) {
  const at = (index) => new Vector3().fromArray(vertices, 3 * index).applyMatrix4(matrix);
  const faces = [];
  for (let t = 0; t + 2 < triangles.length; t += 3) {
    const [a, b, c] = [at(triangles[t]), at(triangles[t + 1]), at(triangles[t + 2])];
    const normal = b.clone().sub(a).cross(c.clone().sub(a));
    const twice = normal.length();
    if (!(twice > 0)) continue;
    const middle = a.clone().add(b).add(c).divideScalar(3);
    faces.push({ at: middle.toArray(), normal: normal.divideScalar(twice).toArray(), area: twice / 2,
      corners: [a, b, c].map((corner) => corner.toArray()) });
  }
  return faces;
}

/** Cubes have a face along each axis. */
export function facesOfCubes({ centers, size }, matrix) {
  const faces = [];
  for (let i = 0; i < centers.length; i += 3) {
    const at = new Vector3().fromArray(centers, i).applyMatrix4(matrix).toArray();
    for (let axis = 0; axis < 3; ++axis) {
      const normal = [0, 0, 0];
      normal[axis] = 1;
      faces.push({ at, normal, area: size * size, corners: [at] });
    }
  }
  return faces;
}

/** The walls of a report, as planes in the world. */
export async function wallsOf(report) {
  const toWorld = new Matrix4().set(...report.T_world_grid, 0, 0, 0, 1);
  const toGrid = toWorld.clone().invert();
  const last = report.steps[report.steps.length - 1];
  const faces = report.isRun ? facesOfMesh(await report.part(report.truth ?? last.surface), toGrid)
    : facesOfCubes(await report.part(report.score.map), toGrid);
  const cameras = report.steps.filter(({ pose }) => pose).map(({ pose }) =>
    new Vector3(pose[3], pose[7], pose[11]).applyMatrix4(toGrid).toArray());
  return wallPlanes(faces, cameras).map(({ normal, offset }) => {
    const n = new Vector3().fromArray(normal).transformDirection(toWorld);
    const point = new Vector3().fromArray(normal).multiplyScalar(offset).applyMatrix4(toWorld);
    return { normal: n, offset: n.dot(point) };
  });
}
