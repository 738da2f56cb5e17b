// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Voxels as cubes.
import { BoxGeometry, Color, InstancedMesh, Matrix4, MeshLambertMaterial } from "three";

/** Cubes at those centres that `colourOf` gives a linear colour: it writes it and returns true. */
export function cubes(centres, side, colourOf, opacity = 1) {
  const shown = [];
  const colours = [];
  const colour = [0, 0, 0];
  for (let i = 0; i < centres.length / 3; ++i) {
    if (!colourOf(i, colour)) continue;
    shown.push(i);
    colours.push(...colour);
  }
  const material = new MeshLambertMaterial({
    transparent: opacity < 1, opacity, depthWrite: opacity === 1,
  });
  const mesh = new InstancedMesh(new BoxGeometry(side, side, side), material, shown.length);
  const matrix = new Matrix4();
  shown.forEach((index, i) => {
    mesh.setMatrixAt(i, matrix.makeTranslation(...centres.subarray(3 * index, 3 * index + 3)));
    mesh.setColorAt(i, new Color().fromArray(colours, 3 * i));
  });
  return mesh;
}
