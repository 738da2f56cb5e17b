// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Voxels as cubes.
import { BoxGeometry, Color, InstancedMesh, Matrix4, MeshLambertMaterial } from "three";

/** Cubes at the centres; `write` writes the linear colour of one. */
export function cubes(centres, side, write, opacity = 1) {
  const number = centres.length / 3;
  const material = new MeshLambertMaterial({
    transparent: opacity < 1, opacity, depthWrite: opacity === 1,
  });
  const mesh = new InstancedMesh(new BoxGeometry(side, side, side), material, number);
  const matrix = new Matrix4();
  const colour = [0, 0, 0];
  for (let i = 0; i < number; ++i) {
    mesh.setMatrixAt(i, matrix.makeTranslation(...centres.subarray(3 * i, 3 * i + 3)));
    write(i, colour);
    mesh.setColorAt(i, new Color().fromArray(colour));
  }
  return mesh;
}
