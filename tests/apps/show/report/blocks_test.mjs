// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The page's decoder against blocks written by hand as apps/show/report/README.md says: node --test blocks_test.mjs
import assert from "node:assert/strict";
import { gzipSync } from "node:zlib";
import test from "node:test";
import { decodeBlock } from "../../../../apps/show/report/viewer/src/data/blocks.js";

const block = (type, columns, rows, bytes) =>
  ({ type, columns, rows, data: gzipSync(Uint8Array.from(bytes)).toString("base64") });

test("columns, planes, zigzag", async () => {
  // Rows (1, 258), (0, 2): differences +1, -1 and +258, -256; zigzag 2, 1 and 516, 511.
  const decoded = await decodeBlock(block("u16", 2, 2, [2, 1, 0, 0, 4, 255, 2, 1]));
  assert.deepEqual(Array.from(decoded), [1, 258, 0, 2]);
});

test("differences wrap", async () => {
  // -1, +1 and as far as half the numbers.
  assert.deepEqual(Array.from(await decodeBlock(block("u8", 1, 4, [0, 1, 2, 255]))), [0, 255, 0, 128]);
  const wide = await decodeBlock(block("u32", 1, 3, [1, 2, 255, 0, 0, 255, 0, 0, 255, 0, 0, 255]));
  assert.deepEqual(Array.from(wide), [4294967295, 0, 2147483648]);
});

test("steps give numbers and NaN", async () => {
  const decoded = await decodeBlock({ ...block("u8", 1, 3, [0, 1, 1]), min: [1], step: [0.5] });
  assert.deepEqual(Array.from(decoded), [1, NaN, 128]);
});

const values = Float32Array.of(1.5, -0.1, NaN, 3e38);
const floats = block("f32", 2, 2, new Uint8Array(values.buffer));

test("floats keep their bits", async () => {
  assert.deepEqual(await decodeBlock(floats), values);
});

test("blocks without rows are empty", async () => {
  assert.equal((await decodeBlock(block("u16", 3, 0, []))).length, 0);
});

test("wrong sizes and types are told", async () => {
  await assert.rejects(decodeBlock({ ...floats, rows: 3 }), /16 bytes, not 3 x 2 f32/);
  await assert.rejects(decodeBlock({ ...floats, type: "f64" }), /type f64/);
});
