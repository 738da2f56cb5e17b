// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Lines: boundary runs, rays, and the box of the workspace.
import {
  BufferAttribute, BufferGeometry, CanvasTexture, Color, Group, LineBasicMaterial, LineSegments, Points,
  PointsMaterial, Sprite, SpriteMaterial,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import { classColours, hitColours } from "../colours.js";

/** Segments some pixels wide; `colours`: of their ends, or null for one colour. */
export function wideLines(positions, colours, { colour = 0xffffff, width }) {
  const geometry = new LineSegmentsGeometry().setPositions(positions);
  if (colours) geometry.setColors(colours);
  const material = new LineMaterial({ color: colour, linewidth: width, vertexColors: colours !== null });
  return new LineSegments2(geometry, material);
}

/** The runs of a boundaries part, each in its class's colour. */
export function boundaryLines({ points, start, class: classes, closed }, width) {
  const positions = [];
  const colours = [];
  const all = points.length / 3;
  start.forEach((first, run) => {
    const end = run + 1 < start.length ? start[run + 1] : all;
    const colour = new Color(classColours[classes[run]] ?? hitColours.nothing).toArray();
    const segment = (a, b) => {
      positions.push(...points.subarray(3 * a, 3 * a + 3), ...points.subarray(3 * b, 3 * b + 3));
      colours.push(...colour, ...colour);
    };
    for (let i = first; i + 1 < end; ++i) segment(i, i + 1);
    if (closed[run] && end - first > 2) segment(end - 1, first);
  });
  return wideLines(new Float32Array(positions), new Float32Array(colours), { width });
}

const hitNames = ["nothing", "unknown", "occupied"];
// More rays than these hide each other.
const mostRays = 500;

function disc() {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const context = canvas.getContext("2d");
  context.fillStyle = "white";
  context.arc(16, 16, 15, 0, 2 * Math.PI);
  context.fill();
  return new CanvasTexture(canvas);
}

/** The rays of a view and what they meet. */
export function bundleOf({ ends, kind }, pose) {
  const group = new Group();
  const from = [pose[3], pose[7], pose[11]];
  const colourOf = hitNames.map((name) => new Color(hitColours[name]).toArray());
  const every = Math.max(1, Math.ceil(kind.length / mostRays));
  const rays = [];
  const rayColours = [];
  const hits = [];
  const hitColour = [];
  kind.forEach((k, i) => {
    const end = ends.subarray(3 * i, 3 * i + 3);
    if (k !== 0) {
      hits.push(...end);
      hitColour.push(...colourOf[k]);
    }
    if (i % every !== 0) return;
    rays.push(...from, ...end);
    const strength = k === 0 ? 0.2 : 1;
    for (let e = 0; e < 2; ++e) rayColours.push(...colourOf[k], strength);
  });
  const lineGeometry = new BufferGeometry();
  lineGeometry.setAttribute("position", new BufferAttribute(new Float32Array(rays), 3));
  lineGeometry.setAttribute("color", new BufferAttribute(new Float32Array(rayColours), 4));
  const lineMaterial = new LineBasicMaterial({
    vertexColors: true, transparent: true, opacity: 0.24, depthWrite: false,
  });
  group.add(new LineSegments(lineGeometry, lineMaterial));
  const pointGeometry = new BufferGeometry();
  pointGeometry.setAttribute("position", new BufferAttribute(new Float32Array(hits), 3));
  pointGeometry.setAttribute("color", new BufferAttribute(new Float32Array(hitColour), 3));
  const pixels = (kind.length > 800 ? 3.5 : 4.5) * Math.min(2, window.devicePixelRatio);
  const pointMaterial = new PointsMaterial({
    vertexColors: true, size: pixels, sizeAttenuation: false, map: disc(), alphaTest: 0.5,
  });
  group.add(new Points(pointGeometry, pointMaterial));
  return group;
}

// How far apart the lines of the floor are: a round length.
function floorSpacing(width) {
  const power = 10 ** Math.floor(Math.log10(width / 4));
  return [5, 2, 1].map((n) => n * power).find((spacing) => spacing <= width / 4);
}

/** The corners of the workspace and a floor of squares, in the grid's frame. */
export function workspaceLines([x0, y0, z0, x1, y1, z1], colour) {
  const spacing = floorSpacing(Math.max(x1 - x0, y1 - y0));
  const mark = 0.1 * Math.min(x1 - x0, y1 - y0, z1 - z0);
  const positions = [x0, y0, z0, x1, y0, z0, x1, y0, z0, x1, y1, z0, x1, y1, z0, x0, y1, z0, x0, y1, z0, x0, y0, z0];
  // Whole edges would run across what is inside.
  for (const [x, inX] of [[x0, mark], [x1, -mark]]) {
    for (const [y, inY] of [[y0, mark], [y1, -mark]]) {
      positions.push(x, y, z0, x, y, z0 + mark, x, y, z1, x, y, z1 - mark);
      positions.push(x, y, z1, x + inX, y, z1, x, y, z1, x, y + inY, z1);
    }
  }
  for (let x = x0 + spacing; x < x1 - 1e-9; x += spacing) positions.push(x, y0, z0, x, y1, z0);
  for (let y = y0 + spacing; y < y1 - 1e-9; y += spacing) positions.push(x0, y, z0, x1, y, z0);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color: colour }));
}

function letter(text, colour, size) {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d");
  Object.assign(pen, { font: "bold 52px sans-serif", textAlign: "center", textBaseline: "middle", fillStyle: colour });
  pen.fillText(text, 32, 32);
  const sprite = new Sprite(new SpriteMaterial({ map: new CanvasTexture(canvas) }));
  sprite.scale.setScalar(size);
  return sprite;
}

/** The world's axes, from a corner, with their names. */
export function axesAt(corner, length, colour) {
  const group = new Group();
  const ends = [0, 1, 2].map((axis) => corner.map((value, i) => value + (i === axis ? length : 0)));
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends.flatMap((end) => [...corner, ...end])), 3));
  group.add(new LineSegments(geometry, new LineBasicMaterial({ color: colour })));
  ends.forEach((end, axis) => {
    const name = letter("xyz"[axis], colour, 0.4 * length);
    name.position.set(...end.map((value, i) => value + (i === axis ? 0.2 * length : 0)));
    group.add(name);
  });
  return group;
}
