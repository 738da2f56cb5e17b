// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Where a camera of a given direction must stand so that points fill the free part of the picture.
import { Box3, Matrix4, Vector3 } from "three";

/**
 * The nearest position from which all points are in the picture. `towards` points from the scene to the
 * camera; `tangents` are those of the half angles of the free part: aside (left and right), top, bottom.
 */
export function fittingPosition(points, towards, { aside, top, bottom }) {
  const axes = new Matrix4().lookAt(towards, new Vector3(), new Vector3(0, 0, 1));
  const [right, up, back] = [new Vector3(), new Vector3(), new Vector3()];
  axes.extractBasis(right, up, back);
  // In these axes, a point at (x, y, z) is seen from (a, b, c) if |x - a| <= aside (c - z), and so on.
  const seen = points.map((p) => [p.dot(right), p.dot(up), p.dot(back)]);
  const most = (f) => Math.max(...seen.map(f));
  const [r, l] = [most(([x, , z]) => x + aside * z), most(([x, , z]) => -x + aside * z)];
  const [t, b] = [most(([, y, z]) => y + top * z), most(([, y, z]) => -y + bottom * z)];
  const c = Math.max((r + l) / (2 * aside), (t + b) / (top + bottom));
  // In the middle of what is left to choose.
  const a = (r - l) / 2;
  const low = t - top * c;
  const high = bottom * c - b;
  return new Vector3().addScaledVector(right, a).addScaledVector(up, (low + high) / 2).addScaledVector(back, c);
}

/** Of the axes, as a share of the scene's radius. */
export const axesLength = 0.2;

/** The tip and the corners of a camera's pyramid of depth `size`. */
export function cameraPoints(pose, frustum, size) {
  const matrix = new Matrix4().set(...pose, 0, 0, 0, 1);
  const corners = frustum.map(([x, y]) => new Vector3(x * size, y * size, size));
  return [new Vector3(), ...corners].map((point) => point.applyMatrix4(matrix));
}

/** The lowest corner of points that is seen before the rest from `direction`: the axes' place. */
export function nearCorner(points, { x, y }) {
  const { min, max } = new Box3().setFromPoints(points);
  return new Vector3(x > 0 ? max.x : min.x, y > 0 ? max.y : min.y, min.z);
}

/** The corners of the workspace in the world. */
export function workspacePoints([x0, y0, z0, x1, y1, z1], T_world_grid) {
  const matrix = new Matrix4().set(...T_world_grid, 0, 0, 0, 1);
  return [x0, x1].flatMap((x) => [y0, y1].flatMap((y) => [z0, z1].map((z) => new Vector3(x, y, z).applyMatrix4(matrix))));
}
