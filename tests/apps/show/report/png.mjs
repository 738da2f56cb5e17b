// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
// Pixels of the PNG files that the browser's screenshots are: 8 bits, RGB or RGBA, not interlaced.
import { inflateSync } from "node:zlib";

function paeth(a, b, c) {
  const p = a + b - c;
  const [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
  if (pa <= pb && pa <= pc) return a;
  return pb <= pc ? b : c;
}

/** { width, height, channels, data } with `channels` bytes a pixel. */
export function decodePng(file) {
  const width = file.readUInt32BE(16);
  const height = file.readUInt32BE(20);
  const [depth, type] = [file[24], file[25]];
  if (depth !== 8 || (type !== 2 && type !== 6)) throw new Error(`PNG of depth ${depth}, type ${type}`);
  const channels = type === 6 ? 4 : 3;
  const parts = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    const name = file.toString("latin1", at + 4, at + 8);
    if (name === "IDAT") parts.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
  }
  const raw = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  const data = Buffer.alloc(height * stride);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (stride + 1)];
    const line = raw.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1));
    for (let x = 0; x < stride; ++x) {
      const left = x >= channels ? data[y * stride + x - channels] : 0;
      const up = y > 0 ? data[(y - 1) * stride + x] : 0;
      const corner = y > 0 && x >= channels ? data[(y - 1) * stride + x - channels] : 0;
      const guess = [0, left, up, (left + up) >> 1, paeth(left, up, corner)][filter];
      data[y * stride + x] = line[x] + guess;
    }
  }
  return { width, height, channels, data };
}

/** How many pixels differ by more than a shade. */
export function differing(a, b) {
  if (a.width !== b.width || a.height !== b.height) return a.width * a.height;
  let number = 0;
  for (let i = 0; i < a.width * a.height; ++i) {
    for (let c = 0; c < 3; ++c) {
      if (Math.abs(a.data[i * a.channels + c] - b.data[i * b.channels + c]) > 12) {
        ++number;
        break;
      }
    }
  }
  return number;
}

/** The share of the pixels that do not have the most frequent colour. */
export function filledShare({ data, channels }) {
  const counts = new Map();
  for (let i = 0; i < data.length; i += channels) {
    const colour = data.readUIntBE(i, 3);
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  return 1 - Math.max(...counts.values()) / (data.length / channels);
}

export function meanShade({ data, channels }) {
  let sum = 0;
  for (let i = 0; i < data.length; i += channels) sum += data[i] + data[i + 1] + data[i + 2];
  return sum / (3 * (data.length / channels));
}

export const colouredLike = (colour) => (picture, at) =>
  colour.every((value, c) => Math.abs(picture.data[at + c] - value) <= 6);

export const differentFrom = (other) => (picture, at) =>
  [0, 1, 2].some((c) => Math.abs(picture.data[at + c] - other.data[at + c]) > 12);

/** The part of a picture that has some property: its edges and how many pixels there are. */
export function boundsOf(picture, has) {
  const { data, channels, width } = picture;
  const bounds = { number: 0, left: Infinity, right: -Infinity, top: Infinity, bottom: -Infinity };
  for (let i = 0; i < data.length / channels; ++i) {
    if (!has(picture, i * channels)) continue;
    const [x, y] = [i % width, Math.floor(i / width)];
    bounds.number += 1;
    bounds.left = Math.min(bounds.left, x);
    bounds.right = Math.max(bounds.right, x);
    bounds.top = Math.min(bounds.top, y);
    bounds.bottom = Math.max(bounds.bottom, y);
  }
  return bounds;
}
