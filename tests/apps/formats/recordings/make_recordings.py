#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Writes tests/data/recordings: a camera on an arm at 1 m/s, by the formats' own writers.

    make_recordings.py VIEWGAIN OUT_FOLDER

Needs python3-rosbag, python3-sensor-msgs, python3-tf2-msgs, zstd and lz4 of Debian, node, and in the
working folder npm's @mcap/core 2.2, @foxglove/rosmsg 5.0, @foxglove/rosmsg2-serialization 3.1 and
@foxglove/rosmsg-msgs-common 3.2. Tests read the committed files, so that they need none of these.

Images come each 0.25 s and transforms each 1/30 s at other moments: the nearest transform is 16 mm
off, and the images' log times are 80 ms late. The first and the last image have no transforms.
`frames` has the images with their true poses. `tiny` are for the tests of damaged bytes; the packed
ones lie in tests/fuzz/corpus.
"""
import base64
import json
import math
import pathlib
import shutil
import sqlite3
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

WIDTH, HEIGHT, FOCAL = 64, 48, 70.0
FRAMES, START = 12, 1_700_000_000
RADIUS, SPEED = 0.6, 1.0
SENSOR = f"""name = "arm_camera"
min_range = 0.2
max_range = 3.0
working_distance = 0.6
[camera]
width = {WIDTH}
height = {HEIGHT}
fx = {FOCAL}
fy = {FOCAL}
cx = 31.5
cy = 23.5
[noise]
model = "constant"
sigma_axial = 0.001
sigma_lateral = 0.001
"""
TOPIC, OPTICAL = "/camera/depth/image_rect_raw", "camera_depth_optical_frame"


def camera_pose(t):
    """T_world_camera at t [s], on a circle that rises, towards the origin."""
    a = SPEED * t / RADIUS
    eye = np.array([RADIUS * math.cos(a), RADIUS * math.sin(a), 0.2 + 0.03 * t])
    z = -eye / np.linalg.norm(eye)
    x = np.cross(z, [0, 0, 1])
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), eye
    return T


def quaternion(R):
    """x, y, z, w."""
    w = math.sqrt(max(0, 1 + R[0, 0] + R[1, 1] + R[2, 2])) / 2
    if w > 0.1:
        return [(R[2, 1] - R[1, 2]) / (4 * w), (R[0, 2] - R[2, 0]) / (4 * w), (R[1, 0] - R[0, 1]) / (4 * w), w]
    i = int(np.argmax(np.diag(R)))
    j, k = (i + 1) % 3, (i + 2) % 3
    s = math.sqrt(1 + R[i, i] - R[j, j] - R[k, k])
    q = [0.0, 0.0, 0.0, (R[k, j] - R[j, k]) / (2 * s)]
    q[i], q[j], q[k] = s / 2, (R[j, i] + R[i, j]) / (2 * s), (R[k, i] + R[i, k]) / (2 * s)
    return q


def transform(parent, child, t, T):
    t_x, t_y, t_z = (float(x) for x in T[:3, 3])
    x, y, z, w = (float(x) for x in quaternion(T[:3, :3]))
    return {"header": header(parent, t), "child_frame_id": child,
            "transform": {"translation": {"x": t_x, "y": t_y, "z": t_z}, "rotation": {"x": x, "y": y, "z": z, "w": w}}}


def header(frame, t):
    total = round((START + t) * 1e9)
    return {"stamp": {"sec": total // 10**9, "nanosec": total % 10**9}, "frame_id": frame}


def event(topic, type_name, t, message):
    return {"topic": topic, "type": type_name, "log_time": str(round((START + t) * 1e9)), "message": message}


def png(pixels):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in pixels)
    head = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 16, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def read_png(path):
    data = path.read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    at, packed = 8, b""
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if name == b"IDAT" else b""
        at += 12 + length
    raw = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + 2 * width).astype(int)
    rows = np.zeros((height, 2 * width), int)
    for v in range(height):
        for u in range(2 * width):  # the filters of PNG
            a = rows[v, u - 2] if u >= 2 else 0
            b = rows[v - 1, u] if v else 0
            c = rows[v - 1, u - 2] if v and u >= 2 else 0
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            rows[v, u] = (raw[v, 1 + u] + [0, a, b, (a + b) // 2, paeth][raw[v, 0]]) % 256
    return (rows[:, 0::2] * 256 + rows[:, 1::2]).astype(np.uint16)


def image_message(kind, t, mm):
    """mm: depths in mm, 0 without a reading."""
    head = header(OPTICAL, t)
    height, width = mm.shape
    if kind == "png":
        data = struct.pack("<iff", 0, 0, 0) + png(mm)
        return "sensor_msgs/msg/CompressedImage", {"header": head, "format": "16UC1; compressedDepth png",
                                                   "data": base64.b64encode(data).decode()}
    if kind == "float":  # REP 117, and rows that are longer than their pixels
        z = np.where(mm > 0, mm * 1e-3, np.nan).astype("<f4")
        z[0, :4] = [np.inf, -np.inf, np.nan, 0]
        rows, encoding, big = np.hstack([z, np.full((height, 3), 9, "<f4")]).tobytes(), "32FC1", 0
        step = 4 * (width + 3)
    else:
        rows, encoding, step = mm.astype(">u2" if kind == "big" else "<u2").tobytes(), "16UC1", 2 * width
        big = 1 if kind == "big" else 0
    return "sensor_msgs/msg/Image", {"header": head, "height": height, "width": width, "encoding": encoding,
                                     "is_bigendian": big, "step": step, "data": base64.b64encode(rows).decode()}


def camera_info(t, mm):
    p = [FOCAL, 0, 31.5, 0, 0, FOCAL, 23.5, 0, 0, 0, 1, 0]
    k = [71.5, 0, 30.0, 0, 71.0, 24.5, 0, 0, 1]  # of the raw images
    return {"header": header(OPTICAL, t), "height": mm.shape[0], "width": mm.shape[1], "distortion_model": "plumb_bob",
            "d": [0.05, -0.02, 0.001, 0, 0], "k": k, "r": [1, 0, 0, 0, 1, 0, 0, 0, 1], "p": p,
            "binning_x": 0, "binning_y": 0,
            "roi": {"x_offset": 0, "y_offset": 0, "height": 0, "width": 0, "do_rectify": False}}


def all_events(kind, images):
    """By their log times."""
    mount = np.eye(4)
    mount[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]
    mount[:3, 3] = [0.05, 0.01, 0.03]
    base = np.eye(4)
    base[:3, 3] = [0.4, -0.2, 0.1]
    flip = np.linalg.inv(base)
    static = {"transforms": [transform("world", "base", 0, base), transform("tool0", OPTICAL, 0, mount)]}
    events = [event("/tf_static", "tf2_msgs/msg/TFMessage", -0.6, static)]
    for i in range(int(FRAMES * 0.25 * 30) + 6):
        t = (i - 3) / 30
        tool = flip @ camera_pose(t) @ np.linalg.inv(mount)
        tf = {"transforms": [transform("base", "tool0", t, tool)]}
        events.append(event("/tf", "tf2_msgs/msg/TFMessage", t + 0.004, tf))
    topic = TOPIC + ("/compressedDepth" if kind == "png" else "")
    for t, mm in images:
        events.append(event("/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo", t + 0.079, camera_info(t, mm)))
        type_name, message = image_message(kind, t, mm)
        events.append(event(topic, type_name, t + 0.08, message))
    return sorted(events, key=lambda e: int(e["log_time"]))


def tiny_events(kind, images):
    """Two images of 8x6 px and what they need, for the tests of damaged bytes."""
    small = [(t, mm[20:26, 28:36]) for t, mm in images[1:3]]
    events = all_events(kind, small)
    near = {i for i, e in enumerate(events) if e["topic"] != "/tf" or any(
        abs(int(e["log_time"]) / 1e9 - START - t) < 0.03 for t, _ in small)}
    return [e for i, e in enumerate(events) if i in near]


def write_db3(path, events, cdr):
    path.unlink(missing_ok=True)
    db = sqlite3.connect(path)
    db.execute("PRAGMA page_size = 1024")
    db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
               "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL)")
    db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,timestamp INTEGER NOT NULL,"
               "data BLOB NOT NULL)")
    db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    ids = {}
    for e, data in zip(events, cdr):
        if e["topic"] not in ids:
            ids[e["topic"]] = len(ids) + 1
            db.execute("INSERT INTO topics VALUES (?,?,?,'cdr','')", (ids[e["topic"]], e["topic"], e["type"]))
        db.execute("INSERT INTO messages(topic_id,timestamp,data) VALUES (?,?,?)",
                   (ids[e["topic"]], int(e["log_time"]), base64.b64decode(data)))
    db.commit()
    db.execute("VACUUM")
    db.close()


def write_bag(path, events, packing):
    import genpy
    import rosbag
    import roslib.message

    names = {"d": "D", "k": "K", "r": "R", "p": "P"}

    def fill(message, values):
        for key, value in values.items():
            if key == "stamp":
                message.stamp = genpy.Time(value["sec"], value["nanosec"])
            elif key == "data":
                message.data = base64.b64decode(value)
            elif key == "transforms":
                transforms = [roslib.message.get_message_class("geometry_msgs/TransformStamped")() for _ in value]
                for one, of in zip(transforms, value):
                    fill(one, of)
                message.transforms = transforms
            elif isinstance(value, dict):
                fill(getattr(message, key), value)
            else:
                setattr(message, names.get(key, key), value)
        return message

    with rosbag.Bag(path, "w", compression=packing, chunk_threshold=30000) as bag:
        for e in events:
            message = fill(roslib.message.get_message_class(e["type"].replace("/msg/", "/"))(), e["message"])
            bag.write(e["topic"], message, genpy.Time(*divmod(int(e["log_time"]), 10**9)))


def write_frames(viewgain, out, times):
    """The images [mm] by the simulated camera, and the folder of the true frames."""
    mesh = pathlib.Path(__file__).resolve().parents[2] / "program/cube.off"
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        lines = []
        for i, t in enumerate(times):
            T = camera_pose(t)
            lines.append(" ".join(map(repr, [float(i), *T[:3, 3].tolist(), *quaternion(T[:3, :3])])))
        (work / "poses.txt").write_text("\n".join(lines) + "\n")
        (work / "sensor.toml").write_text(SENSOR)
        subprocess.run([viewgain, "simulate", mesh, "--size", "0.4", "--place", "center", "--poses", work / "poses.txt", "--background", "1",
                        "--sensor", work / "sensor.toml", "--out", work / "frames"], check=True)
        units = [read_png(work / f"frames/frame-{i:06d}.depth.png").astype(int) for i in range(len(times))]
    images = [np.where(z == 65535, 0, (z + 5) // 10).astype(np.uint16) for z in units]
    frames = out / "frames"
    frames.mkdir()
    (frames / "sensor.toml").write_text(SENSOR)
    (frames / "frames.toml").write_text('depth_scale = 0.001\nout_of_range = "invalid"\nposes = "frame-NNNNNN.pose.txt"\n')
    for i, (t, mm) in enumerate(list(zip(times, images))[1:-1], 1):
        (frames / f"frame-{i:06d}.depth.png").write_bytes(png(mm))
        np.savetxt(frames / f"frame-{i:06d}.pose.txt", camera_pose(t), fmt="%.17g")
    return list(zip(times, images))


def main():
    viewgain, out = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    times = [-0.5] + [0.25 * i + 0.5 / 30 for i in range(FRAMES)] + [FRAMES * 0.25 + 0.6]
    images = write_frames(viewgain, out, times)
    (out / "split").mkdir()
    compressed = all_events("png", images)
    half = len(compressed) // 2
    events = all_events("little", images)
    recordings = [
        {"file": "arm_zstd.mcap", "packing": "zstd", "chunks": True, "events": events},
        {"file": "arm_lz4.mcap", "packing": "lz4", "chunks": True, "events": all_events("float", images)},
        {"file": "split/arm_9.mcap", "packing": None, "chunks": True, "events": compressed[:half]},
        {"file": "split/arm_10.mcap", "packing": None, "chunks": False, "events": compressed[half:]},
    ]
    for name, packing, chunks in (("plain", None, False), ("zstd", "zstd", True), ("lz4", "lz4", True)):
        kind = {"plain": "png", "zstd": "float", "lz4": "big"}[name]
        recordings.append({"file": f"tiny_{name}.mcap", "packing": packing, "chunks": chunks,
                           "events": tiny_events(kind, images)})
    tiny = tiny_events("little", images)
    with tempfile.TemporaryDirectory() as work:
        listed = pathlib.Path(work) / "events.json"
        listed.write_text(json.dumps({"recordings": recordings, "cdr": events + tiny}))
        subprocess.run(["node", pathlib.Path(__file__).with_suffix(".mjs"), listed, out], check=True)
    cdr = (out / "cdr.txt").read_text().split()
    (out / "cdr.txt").unlink()
    write_db3(out / "arm.db3", events, cdr[:len(events)])
    write_db3(out / "tiny.db3", tiny, cdr[len(events):])
    for packing in ("bz2", "lz4"):
        write_bag(out / f"arm_{packing}.bag", all_events("big", images), packing)
    for packing in ("none", "bz2", "lz4"):
        write_bag(out / f"tiny_{packing}.bag", tiny, packing)
    corpus = pathlib.Path(__file__).resolve().parents[3] / "fuzz/corpus"
    for ending in ("mcap", "bag"):
        (corpus / ending).mkdir(exist_ok=True)
        for packed in [*out.glob(f"tiny_[bz]*.{ending}"), *out.glob(f"tiny_lz4.{ending}")]:
            shutil.move(packed, corpus / ending / packed.name)


if __name__ == "__main__":
    main()
