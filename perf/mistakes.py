#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""How often does the program notice common mistakes?

    mistakes.py VIEWGAIN MESH... [--folders N] [--right N] [--first N]

Simulates folders of frames with different objects, sensors, distances and seeds. It puts one
mistake into each folder and calls `integrate`. The table shows how many mistakes caused a
warning or an error, and how many folders without a mistake caused a false alarm.
"""
import argparse
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import zlib

SENSOR = """name = "probe"
min_range = {lo}
max_range = {hi}
working_distance = {wd}

[camera]
width = {w}
height = {h}
fx = {f}
fy = {f}
cx = {cx}
cy = {cy}

[noise]
model = "constant"
sigma_axial = {s}
sigma_lateral = {s}
"""
SENSORS = [dict(w=88, h=72, f=100, lo=0.1, hi=4, wd=0.4, s=0.003), dict(w=80, h=60, f=70, lo=0.15, hi=5, wd=0.5, s=0.002),
           dict(w=64, h=48, f=50, lo=0.1, hi=3, wd=0.6, s=0.001), dict(w=96, h=72, f=120, lo=0.2, hi=5, wd=0.7, s=0.005)]


def simulate(program, mesh, number, folder):
    s = dict(SENSORS[number % len(SENSORS)])
    s.update(cx=(s["w"] - 1) / 2 + number % 3 - 1, cy=(s["h"] - 1) / 2 - number % 2)
    sensor = folder.parent / "sensor.toml"
    sensor.write_text(SENSOR.format(**s))
    distance = [0.45, 0.55, 0.7, 0.9][number // 4 % 4]
    views = [6, 9, 14][number % 3]
    run(program, "simulate", mesh, "--poses", f"orbit:{views},{distance},{[20, 35, 50][number // 3 % 3]}", "--sensor", sensor,
        "--size", 0.3 + 0.05 * (number % 3), "--place", "center", "--noise", "on", "--seed", number, *(["--background", 0] if number % 5 == 4 else []), "--out", folder)
    return s


def run(program, *words):
    return subprocess.run([program, *map(str, words)], capture_output=True, text=True)


def pose_lines(folder):
    lines = [line.split() for line in (folder / "poses.txt").read_text().splitlines() if not line.startswith("#")]
    return [[float(word) for word in line] for line in lines]


def write_poses(folder, rows):
    (folder / "poses.txt").write_text("".join(" ".join(map(repr, row)) + "\n" for row in rows))


def rotated(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]]


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def each_pose(change):
    def apply(folder, _):
        write_poses(folder, [[row[0], *change(row[1:4], row[4:8])] for row in pose_lines(folder)])
    return apply


def inverse(t, q):
    back = [-q[0], -q[1], -q[2], q[3]]
    return [-c for c in rotated(back, t)] + back


def scale(folder, value):
    text = (folder / "frames.toml").read_text()
    text, count = re.subn(r"^depth_scale = .*$", f"depth_scale = {value}", text, flags=re.M)
    assert count == 1, text
    (folder / "frames.toml").write_text(text)


def scaled_intrinsics(factor):
    def apply(folder, _):
        text = (folder / "sensor.toml").read_text()
        for key in ("fx", "fy", "cx", "cy"):
            text = re.sub(rf"^{key} = (.*)$", lambda m: f"{key} = {float(m[1].split('#')[0]) * factor}", text, flags=re.M)
        (folder / "sensor.toml").write_text(text)
    return apply


def focal_length(factor, words):
    def apply(folder, _):
        text = (folder / "sensor.toml").read_text()
        text = re.sub(r"^(f[xy]) = ([\d.]+)", lambda m: f"{m[1]} = {float(m[2]) * factor}", text, flags=re.M)
        (folder / "sensor.toml").write_text(text)
    return apply, rf"focal length is {words} times"


def other_scale(factor, words):
    return lambda folder, s: scale(folder, 1e-4 * factor), rf"depth scale is {words}\b"


def along_ray(folder, s):
    for path in folder.glob("*.depth.png"):
        rows = read_png(path)
        for v, row in enumerate(rows):
            for u, z in enumerate(row):
                if z in (0, 65535):
                    continue
                x, y = (u - s["cx"]) / s["f"], (v - s["cy"]) / s["f"]
                row[u] = min(65534, round(z * (1 + x * x + y * y) ** 0.5))
        write_png(path, rows)


def read_png(path):
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        if kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, stride, rows, above = zlib.decompress(packed), 2 * width, [], bytearray(2 * width)
    for v in range(height):
        mode, line = raw[v * (stride + 1)], bytearray(raw[v * (stride + 1) + 1:(v + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (line[i - 2] if i > 1 else 0), above[i], (above[i - 2] if i > 1 else 0)
            p = a + b - c
            guess = [0, a, b, (a + b) // 2, min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]][mode]
            line[i] = line[i] + guess & 255
        rows.append(list(struct.unpack(f">{width}H", line)))
        above = line
    return rows


def write_png(path, rows):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    raw = b"".join(b"\0" + struct.pack(f">{len(row)}H", *row) for row in rows)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 16, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


MISTAKES = {
    "millimetres for metres": other_scale(1000, "1000 times smaller"),
    "scale 10 times too large": other_scale(10, "10 times smaller"),
    "5 times too large": other_scale(5, "5 times smaller"),
    "4 times too large": other_scale(4, "4 times smaller"),
    "2.5 times too large": other_scale(2.5, "2.5 times smaller"),
    "twice too large": other_scale(2, "2 times smaller"),
    "half of what it should be": other_scale(1 / 2, "2 times larger"),
    "a 2.5th": other_scale(1 / 2.5, "2.5 times larger"),
    "a quarter": other_scale(1 / 4, "4 times larger"),
    "a fifth": other_scale(1 / 5, "5 times larger"),
    "a tenth": other_scale(1 / 10, "10 times larger"),
    "quaternion w first": (each_pose(lambda t, q: [*t, q[3], q[0], q[1], q[2]]), "w first"),
    "world to camera": (each_pose(inverse), "world to camera"),
    "body frame": (each_pose(lambda t, q: [*t, *product(q, [0.5, -0.5, 0.5, 0.5])]), "body frame"),
    "half-resolution intrinsics": (scaled_intrinsics(1 / 2), "principal point"),
    "intrinsics of 424 pixels for 320": (scaled_intrinsics(424 / 320), "principal point"),
    "focal length twice too large": focal_length(2, "0.5"),
    "1.5 times": focal_length(1.5, "0.67"),
    "1.25 times": focal_length(1.25, "0.8"),
    "10 % too large": focal_length(1.1, "0.9"),
    "5 % too large (any factor)": focal_length(1.05, ".*"),
    "5 % too small (any factor)": focal_length(0.95, ".*"),
    "10 % too small": focal_length(0.9, "1.1"),
    "0.8 of what it should be": focal_length(0.8, "1.25"),
    "two thirds": focal_length(2 / 3, "1.5"),
    "half": focal_length(0.5, "2"),
    "depth along the ray": (along_ray, "along the ray"),
    "poses in millimetres": (each_pose(lambda t, q: [1000 * c for c in t] + q), "poses are in millimetres"),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="VIEWGAIN", help="the program viewgain")
    parser.add_argument("meshes", nargs="+", metavar="MESH", help="mesh files of objects")
    parser.add_argument("--folders", type=int, default=20, help="wrong folders per mistake (default: 20)")
    parser.add_argument("--right", type=int, default=200, help="right folders (default: 200)")
    parser.add_argument("--first", type=int, default=0, help="number of the first folder, which sets its seed and settings (default: 0)")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        said = {name: [0, 0] for name in MISTAKES}
        alarms = 0
        for number in range(options.first, options.first + max(options.folders, options.right)):
            right = root / "right"
            shutil.rmtree(right, ignore_errors=True)
            s = simulate(options.program, options.meshes[number % len(options.meshes)], number, right)
            call = ["integrate", "FOLDER", "--voxel", 0.02, "--workspace=-0.3,-0.3,-0.3,0.3,0.3,0.3", "--out", root / "map.vdb"]
            if number < options.first + options.right:
                result = run(options.program, call[0], right, *call[2:])
                if result.returncode or result.stderr:
                    alarms += 1
                    print("false alarm:", number, result.stderr.strip())
            if number >= options.first + options.folders:
                continue
            for name, (make, words) in MISTAKES.items():
                wrong = root / "wrong"
                shutil.rmtree(wrong, ignore_errors=True)
                shutil.copytree(right, wrong)
                make(wrong, s)
                result = run(options.program, call[0], wrong, *call[2:])
                noticed = re.search(words, result.stderr) is not None
                said[name][0] += noticed
                said[name][1] += noticed and result.returncode != 0
                if not noticed:
                    print("missed:", name, number, result.returncode, result.stderr.strip()[:200])
    print(f"\n| mistake | noticed of {options.folders} | refused |\n|---|---|---|")
    for name, (noticed, refused) in said.items():
        print(f"| {name} | {noticed} | {refused} |")
    print(f"| none, false alarms | {alarms} of {options.right} | |")


if __name__ == "__main__":
    main()
