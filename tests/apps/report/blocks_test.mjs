// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// The page's decoder against blocks written as apps/report/README.md says: node --test blocks_test.mjs
import assert from "node:assert/strict";
import test from "node:test";
import { decodeBlock } from "../../../apps/report/viewer/src/data/blocks.js";
import { encodeFloats, encodeIntegers, encodeSteps } from "./encode_block.mjs";

test("integers of every width come back, also where differences wrap", async () => {
  const samples = {
    u8: [0, 255, 255, 0, 128, 127, 1, 254],
    u16: [0, 65535, 65535, 0, 32768, 32767, 256, 255],
    u32: [0, 4294967295, 4294967295, 0, 2147483648, 2147483647, 65536, 16777215],
  };
  for (const [type, values] of Object.entries(samples)) {
    for (const columns of [1, 2, 4]) {
      const decoded = await decodeBlock(encodeIntegers(type, columns, values));
      assert.deepEqual(Array.from(decoded), values, `${type} in ${columns} columns`);
    }
  }
});

test("bytes written by hand: columns, planes, zigzag", async () => {
  // Rows (1, 258), (0, 2): differences +1, -1 and +258, -256; zigzag 2, 1 and 516, 511.
  const bytes = [2, 1, 0, 0, 4, 255, 2, 1];
  const { gzipSync } = await import("node:zlib");
  const data = gzipSync(Uint8Array.from(bytes)).toString("base64");
  const decoded = await decodeBlock({ type: "u16", columns: 2, rows: 2, data });
  assert.deepEqual(Array.from(decoded), [1, 258, 0, 2]);
});

test("steps give numbers and NaN", async () => {
  const values = [0, -1, 0.25, NaN, 1, 1];
  const decoded = await decodeBlock(encodeSteps("u16", 2, values));
  values.forEach((value, i) => {
    if (Number.isNaN(value)) assert.ok(Number.isNaN(decoded[i]));
    else assert.ok(Math.abs(decoded[i] - value) < 4e-5, `${decoded[i]} for ${value}`);
  });
});

test("floats keep their bits", async () => {
  const values = [1.5, -0.1, NaN, 3e38];
  const decoded = await decodeBlock(encodeFloats(2, values));
  assert.deepEqual(Array.from(decoded), Array.from(Float32Array.from(values)));
});

test("blocks without rows are empty", async () => {
  assert.equal((await decodeBlock(encodeIntegers("u16", 3, []))).length, 0);
  assert.equal((await decodeBlock(encodeFloats(12, []))).length, 0);
});

test("wrong sizes and types are told", async () => {
  await assert.rejects(decodeBlock({ ...encodeFloats(1, [1, 2]), rows: 3 }), /8 bytes, not 3 x 1 f32/);
  await assert.rejects(decodeBlock({ ...encodeFloats(1, [1]), type: "f64" }), /type f64/);
});
