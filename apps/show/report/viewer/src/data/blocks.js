// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Blocks: the arrays of the report's data (../../README.md says how they are written).

const integerArrays = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array };

function bytesOfBase64(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

function unzipped(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

// The arrays wrap by themselves, which is the "modulo 2^bits" of the format.
function integersOf(bytes, columns, rows, ArrayType) {
  const values = new ArrayType(columns * rows);
  const width = ArrayType.BYTES_PER_ELEMENT;
  for (let c = 0; c < columns; ++c) {
    let value = 0;
    for (let r = 0; r < rows; ++r) {
      let code = 0;
      for (let b = 0; b < width; ++b) code |= bytes[(c * width + b) * rows + r] << (8 * b);
      value = (value + ((code >>> 1) ^ -(code & 1))) | 0;
      values[r * columns + c] = value;
    }
  }
  return values;
}

function numbersOf(integers, { columns, min, step }) {
  const none = 2 ** (8 * integers.BYTES_PER_ELEMENT) - 1;
  const numbers = new Float32Array(integers.length);
  for (let i = 0; i < numbers.length; ++i) {
    const c = i % columns;
    numbers[i] = integers[i] === none ? NaN : min[c] + step[c] * integers[i];
  }
  return numbers;
}

/** The block's numbers, row after row. */
export async function decodeBlock(block) {
  const { type, columns, rows } = block;
  const buffer = await unzipped(bytesOfBase64(block.data));
  const ArrayType = type === "f32" ? Float32Array : integerArrays[type];
  if (!ArrayType) throw new Error(`a block of type ${type}`);
  if (buffer.byteLength !== columns * rows * ArrayType.BYTES_PER_ELEMENT) {
    throw new Error(`a block of ${buffer.byteLength} bytes, not ${rows} x ${columns} ${type}`);
  }
  if (type === "f32") return new Float32Array(buffer);
  const integers = integersOf(new Uint8Array(buffer), columns, rows, ArrayType);
  return block.min ? numbersOf(integers, block) : integers;
}
