// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Meshes: surface, patches, truth.
import {
  BufferAttribute, BufferGeometry, DoubleSide, FrontSide, Mesh, MeshPhongMaterial,
} from "three";

/** `colours`: three linear numbers a vertex, or null for one colour. */
export function meshOf(part, { colour, colours = null, opacity = 1 }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(part.vertices, 3));
  geometry.setIndex(new BufferAttribute(part.triangles, 1));
  geometry.computeVertexNormals();
  if (colours) geometry.setAttribute("color", new BufferAttribute(colours, 3));
  const material = new MeshPhongMaterial({
    color: colours ? 0xffffff : colour,
    vertexColors: colours !== null,
    specular: 0x1c1c1c,
    shininess: 24,
    side: opacity < 1 ? FrontSide : DoubleSide,
    transparent: opacity < 1,
    opacity,
    depthWrite: opacity === 1,
    // Lines along the surface lie in front of it.
    polygonOffset: true,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 2,
  });
  return new Mesh(geometry, material);
}

/** One linear colour a value. */
export function coloursOf(values, ramp, { low, high }) {
  const colours = new Float32Array(3 * values.length);
  for (let i = 0; i < values.length; ++i) ramp.write((values[i] - low) / (high - low), colours, 3 * i);
  return colours;
}
