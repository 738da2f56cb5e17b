// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Prints an open bin with two blocks in it, 0.4 x 0.3 x 0.15 [m], as OFF: node make_bin.mjs >bin.off
const [w, d, h, t] = [0.2, 0.15, 0.15, 0.012];
const boxes = [
  [[-w, -d, -t], [w, d, 0]], [[-w, -d, 0], [-w + t, d, h]], [[w - t, -d, 0], [w, d, h]],
  [[-w + t, -d, 0], [w - t, -d + t, h]], [[-w + t, d - t, 0], [w - t, d, h]],
  [[-0.1, -0.05, 0.001], [-0.03, 0.03, 0.09]], [[0.05, -0.02, 0.001], [0.11, 0.08, 0.06]],
];
const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const corners = boxes.flatMap((box) => Array.from({ length: 8 }, (_, i) =>
  [box[i & 1][0], box[(i >> 1) & 1][1], box[(i >> 2) & 1][2]].join(" ")));
const triangles = boxes.flatMap((_, k) => quads.flatMap(([a, b, c, e]) =>
  [[a, b, c], [a, c, e]].map((triangle) => `3 ${triangle.map((i) => 8 * k + i).join(" ")}`)));
console.log(["OFF", `${corners.length} ${triangles.length} 0`, ...corners, ...triangles].join("\n"));
