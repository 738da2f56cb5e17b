// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// MCAP by Foxglove's writer and CDR by its serialiser, of the events that make_recordings.py lists.
//   node make_recordings.mjs EVENTS.json OUT_FOLDER
import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import fs from "node:fs";
import path from "node:path";

// The packages lie where the script is called.
const require = createRequire(path.join(process.cwd(), "package.json"));
const { McapWriter, TempBuffer } = require("@mcap/core");
const { MessageWriter } = require("@foxglove/rosmsg2-serialization");
const { parse } = require("@foxglove/rosmsg");
const { ros2humble } = require("@foxglove/rosmsg-msgs-common");

const [events_file, out] = process.argv.slice(2);
const { recordings, cdr } = JSON.parse(fs.readFileSync(events_file, "utf8"));

// A type's definition and those that it uses, as one text.
function definition(type) {
  const texts = [], done = new Set([type]), todo = [type];
  while (todo.length > 0) {
    const name = todo.shift();
    const fields = ros2humble[name.replace("/msg/", "/")] ?? ros2humble[name];
    const text = fields.definitions
      .map((f) => {
        const array = f.isArray ? `[${f.arrayLength ?? ""}]` : "";
        if (f.isConstant) return `${f.type} ${f.name}=${f.valueText ?? f.value}`;
        if (f.isComplex && !done.has(f.type)) done.add(f.type), todo.push(f.type);
        return `${f.type}${array} ${f.name}`;
      })
      .join("\n");
    texts.push(texts.length === 0 ? text : `MSG: ${name}\n${text}`);
  }
  return texts.join("\n================================================================================\n");
}

const writers = new Map();
function serialised(type, message) {
  if (!writers.has(type)) writers.set(type, new MessageWriter(parse(definition(type), { ros2: true })));
  const fixed = structuredClone(message);
  if (typeof fixed.data === "string") fixed.data = Uint8Array.from(Buffer.from(fixed.data, "base64"));
  return writers.get(type).writeMessage(fixed);
}

const packed = {
  zstd: (bytes) => execFileSync("zstd", ["-c", "-q", "-19"], { input: bytes }),
  lz4: (bytes) => execFileSync("lz4", ["-c", "-q", "-9"], { input: bytes }),
};

for (const { file, packing, chunks, events } of recordings) {
  const buffer = new TempBuffer();
  const writer = new McapWriter({
    writable: buffer,
    useChunks: chunks,
    chunkSize: 30000,
    compressChunk: packing ? (bytes) => ({ compression: packing, compressedData: packed[packing](bytes) }) : undefined,
  });
  await writer.start({ profile: "ros2", library: "make_recordings" });
  const channels = new Map();
  let sequence = 0;
  for (const { topic, type, log_time, message } of events) {
    if (!channels.has(topic)) {
      const schemaId = await writer.registerSchema({
        name: type, encoding: "ros2msg", data: Buffer.from(definition(type)),
      });
      channels.set(topic, await writer.registerChannel({
        topic, schemaId, messageEncoding: "cdr", metadata: new Map(),
      }));
    }
    await writer.addMessage({
      channelId: channels.get(topic), sequence: sequence++, logTime: BigInt(log_time),
      publishTime: BigInt(log_time), data: serialised(type, message),
    });
  }
  await writer.end();
  fs.writeFileSync(path.join(out, file), buffer.get());
}

// For rosbag2's database, whose messages are the same.
const lines = cdr.map(({ type, message }) => Buffer.from(serialised(type, message)).toString("base64"));
fs.writeFileSync(path.join(out, "cdr.txt"), lines.join("\n") + "\n");
