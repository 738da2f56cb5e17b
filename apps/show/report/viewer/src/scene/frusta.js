// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Cameras: small pyramids, many at once, and frusta of lines.
import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, InstancedMesh, Matrix4, MeshLambertMaterial,
} from "three";
import { poseAt } from "../data/parts.js";
import { wideLines } from "./lines.js";

export function matrixOf(pose) {
  return new Matrix4().set(...pose, 0, 0, 0, 1);
}

// The pyramid's tip is the camera, its base the image at depth 1.
function pyramid(frustum) {
  const corners = frustum.map(([x, y]) => [x, y, 1]);
  const tip = [0, 0, 0];
  const triangles = corners.map((corner, i) => [tip, corner, corners[(i + 1) % 4]]);
  triangles.push([corners[0], corners[2], corners[1]], [corners[0], corners[3], corners[2]]);
  const geometry = new BufferGeometry();
  const positions = new Float32Array(triangles.flat(2));
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** Pyramids of depth `size` at the poses of `indices`; `colourOf` writes the linear colour of an index. */
export function pyramids(poses, indices, frustum, size, colourOf, opacity = 1) {
  const material = new MeshLambertMaterial({
    side: DoubleSide, transparent: opacity < 1, opacity, depthWrite: opacity === 1,
  });
  const mesh = new InstancedMesh(pyramid(frustum), material, indices.length);
  const scale = new Matrix4().makeScale(size, size, size);
  const colours = new Float32Array(3 * indices.length);
  indices.forEach((index, i) => {
    mesh.setMatrixAt(i, matrixOf(poseAt(poses, index)).multiply(scale));
    colourOf(index, colours, 3 * i);
  });
  for (let i = 0; i < indices.length; ++i) mesh.setColorAt(i, new Color().fromArray(colours, 3 * i));
  mesh.userData.indices = indices;
  return mesh;
}

/** A frustum of lines, with a mark that shows where up is, and a line of sight of length `sight`. */
export function frustumLines(pose, frustum, depth, colour, width, sight = 0) {
  const corners = frustum.map(([x, y]) => [x * depth, y * depth, depth]);
  const segments = [];
  corners.forEach((corner, i) => segments.push([0, 0, 0], corner, corner, corners[(i + 1) % 4]));
  const half = Math.max(...frustum.map(([x]) => x)) * depth;
  const top = Math.min(...frustum.map(([, y]) => y)) * depth;
  const roof = [[-0.35 * half, 1.06 * top, depth], [0, 1.4 * top, depth], [0.35 * half, 1.06 * top, depth]];
  segments.push(roof[0], roof[1], roof[1], roof[2], roof[2], roof[0]);
  if (sight > 0) segments.push([0, 0, depth], [0, 0, sight]);
  const lines = wideLines(new Float32Array(segments.flat()), null, { colour, width });
  lines.applyMatrix4(matrixOf(pose));
  return lines;
}
