// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Points as the ellipsoids of their covariances.
import { Color, IcosahedronGeometry, InstancedMesh, Matrix4, MeshLambertMaterial } from "three";

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/**
 * Semi-axes (orthogonal vectors, their lengths sigmas) of a symmetric matrix xx, xy, xz, yy, yz, zz:
 * Jacobi's method, one-sided on the matrix itself, whose columns become the eigenvectors times the
 * eigenvalues.
 */
export function semiAxes(c, at) {
  const [xx, xy, xz, yy, yz, zz] = c.subarray(at, at + 6);
  const columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
  for (let sweep = 0; sweep < 8; ++sweep) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]]) {
      const [u, v] = [columns[p], columns[q]];
      const both = dot(u, v);
      if (Math.abs(both) <= 1e-6 * Math.sqrt(dot(u, u) * dot(v, v))) continue;
      const angle = 0.5 * Math.atan2(2 * both, dot(u, u) - dot(v, v));
      const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
      columns[p] = u.map((a, i) => cos * a + sin * v[i]);
      columns[q] = u.map((a, i) => cos * v[i] - sin * a);
    }
  }
  // A column is an eigenvector times its eigenvalue, so over the root of its length it has length sigma.
  return columns.map((column) => {
    const length = Math.sqrt(dot(column, column));
    return column.map((a) => (length > 0 ? a / Math.sqrt(length) : 0));
  });
}

/** The greatest sigma of each point. */
export function greatestSigmas({ covariances }) {
  const sigmas = new Float32Array(covariances.length / 6);
  for (let i = 0; i < sigmas.length; ++i) {
    sigmas[i] = Math.sqrt(Math.max(...semiAxes(covariances, 6 * i).map((axis) => dot(axis, axis))));
  }
  return sigmas;
}

export function ellipsoids({ positions, covariances }, sigmas, ramp, { low, high }) {
  const number = positions.length / 3;
  const sphere = new IcosahedronGeometry(1, number > 1000 ? 1 : 2);
  const mesh = new InstancedMesh(sphere, new MeshLambertMaterial(), number);
  const matrix = new Matrix4();
  const colour = [0, 0, 0];
  for (let i = 0; i < number; ++i) {
    const axes = semiAxes(covariances, 6 * i);
    const greatest = Math.sqrt(Math.max(...axes.map((axis) => dot(axis, axis))));
    const [a, b, c] = axes.map((axis) => axis.map((v) => sigmas * v));
    // A left-handed frame would turn the sphere inside out.
    const flip = dot([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], c) < 0 ? -1 : 1;
    const [x, y, z] = positions.subarray(3 * i, 3 * i + 3);
    matrix.set(a[0], b[0], flip * c[0], x, a[1], b[1], flip * c[1], y, a[2], b[2], flip * c[2], z, 0, 0, 0, 1);
    mesh.setMatrixAt(i, matrix);
    ramp.write((greatest - low) / (high - low), colour, 0);
    mesh.setColorAt(i, new Color().fromArray(colour));
  }
  return mesh;
}
