// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Voxels as cubes: one mesh of the faces that no neighbour hides, which costs a small part of whole cubes.
import { BufferAttribute, BufferGeometry, Mesh, MeshLambertMaterial } from "three";

// Of a face: its normal, and its corners in the order that makes it look outwards.
const faces = [0, 1, 2].flatMap((axis) => [-1, 1].map((sign) => {
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
  const normal = [0, 0, 0];
  normal[axis] = sign;
  const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
    const corner = [0, 0, 0];
    corner[axis] = sign;
    corner[u] = sign * a;
    corner[v] = b;
    return corner;
  });
  return { normal, corners };
}));

/** Which cells hold a cube, by whole numbers from the first centre. */
function cellsOf(centres, pitch) {
  const at = (i) => [0, 1, 2].map((c) => Math.round((centres[3 * i + c] - centres[c]) / pitch));
  const key = ([x, y, z]) => x + 65536 * (y + 65536 * z);
  const number = centres.length / 3;
  const taken = new Set(Array.from({ length: number }, (_, i) => key(at(i))));
  const has = (cell, step) => taken.has(key(cell.map((c, k) => c + step[k])));
  return { at, has };
}

/** Cubes at the centres of cells of size `pitch`; `write` writes the linear colour of one. */
export function cubes(centres, pitch, write, { scale = 1 } = {}) {
  const cells = cellsOf(centres, pitch);
  const half = 0.5 * scale * pitch;
  const [positions, normals, colours, triangles] = [[], [], [], []];
  const colour = [0, 0, 0];
  for (let i = 0; i < centres.length / 3; ++i) {
    const cell = cells.at(i);
    write(i, colour);
    for (const { normal, corners } of faces) {
      if (cells.has(cell, normal)) continue;
      const first = positions.length / 3;
      for (const corner of corners) {
        for (let c = 0; c < 3; ++c) positions.push(centres[3 * i + c] + half * corner[c]);
        normals.push(...normal);
        colours.push(...colour);
      }
      triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("normal", new BufferAttribute(new Int8Array(normals), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 3));
  geometry.setIndex(new BufferAttribute(new Uint32Array(triangles), 1));
  return new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true }));
}
