#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What the program can do, each by a call that shows it: none may get lost when commands and flags change.

    capabilities_test.py VIEWGAIN WORK_FOLDER

An entry names the capability, the call and what must hold of its JSON. Ends with 1 if one fails.
"""
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import threading
import time
import zlib

CUBE = """OFF
8 6 0
-1 -1 -1
1 -1 -1
1 1 -1
-1 1 -1
-1 -1 1
1 -1 1
1 1 1
-1 1 1
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""
WALL = "OFF\n4 1 0\n0.4 -1 -1\n0.4 1 -1\n0.4 1 1\n0.4 -1 1\n4 0 1 2 3\n"
CLOUD = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 1\n0.01 0 1\n"
REACH = "[[shell]]\ncenter = [0, 0, 0]\nmin_radius = 0.3\nmax_radius = 1.5\n"
BOX = "-0.2,-0.2,-0.2,0.2,0.2,0.2"
MAP = f"--voxel 0.0125 --workspace={BOX}"
RUN = "reconstruct cube.off --size 0.2 --sensor sr4000 --voxel 0.0125 --max-views 2 --pictures off"
MODEL = f"model frames {MAP} --pictures off"
SPHERE = "--poses sphere:30,0.6"
CLASSIC = ("occlusion_aware unobserved_voxel average_entropy rear_side_voxel rear_side_entropy proximity_count area_factor "
           "unknown_volume unknown_count surface_frontier_count").split()

# (capability, call, what must hold of the JSON)
CALLS = [
    ("simulated camera", "simulate cube.off --size 0.2 --place center --sensor sr4000 --poses orbit:6,0.6,27 --out frames",
     lambda j: j["frames"] == 6 and j["readings"] > 1000),
    ("all its noise", "simulate cube.off --size 0.2 --sensor sr4000 --poses orbit:2,0.6,27 --noise on,scale=0.01,pose=0.002/0.2 "
     "--out noisy", lambda j: j["noise"] and j["flying_pixels"] and j["scale_error"] == 0.01 and j["pose_noise"] == [0.002, 0.2]),
    ("a table and a room", "simulate cube.off --size 0.2 --place center,0,0,0.1 --sensor sr4000 --poses dome:2,0.6 "
     "--support-plane 0 --background 2 --out on_table", lambda j: j["support_plane"] == 0),
    ("frames into a map", f"integrate frames {MAP} --out map.vdb", lambda j: j["frames"] == 6 and j["occupied"] > 100),
    ("recordings of messages", "import arm_zstd.mcap --sensor arm.toml --out imported",
     lambda j: j["frames"] == 12 and j["bad"] == {"no_pose": 2} and j["world"] == "world"),
    ("a map goes on", "integrate frames --map map.vdb --out map.vdb", lambda j: j["skipped"] == 6),
    ("point clouds", "integrate --cloud cloud.ply --origin 0,0,0 --voxel 0.001 --sensor sr4000 --out cloud.vdb",
     lambda j: j["clouds"] == 1 and j["occupied"] == 2),
    ("recorded frames", f"{MODEL} --out model", lambda j: j["frames"] == 6 and len(j["next"]) > 0 and j["triangles"] > 100),
    ("registration of all frames", f"{MODEL} --register on --out registered", lambda j: j["registration"]["registered"] > 0),
    ("registration of one frame", f"integrate frames {MAP} --register 0.002,0.2 --out one.vdb",
     lambda j: j["registration"]["registered"] > 0),
    ("masks", f"{MODEL} --mask masks --out masked", lambda j: j["masked_pixels"] > 0),
    ("confidence", f"{MODEL} --confidence sure,2 --out sure_run", lambda j: j["masked_pixels"] > 0),
    ("costs", "next model --poses poses.txt --costs costs.txt --gain paper", lambda j: j["next"][0]["worth"] < j["next"][0]["gain"]),
    ("cost per metre from the current position", "next model --cost-per-metre 1 --from 9,0,0",
     lambda j: j["next"][0]["gain"] - j["next"][0]["worth"] > 7),
    ("obstacles: a box and a mesh", "next model --obstacle 0.3,-1,-1,0.4,1,1 --obstacle wall.off",
     lambda j: sum(j["dropped"].values()) > 0),
    ("support plane", "next model --support-plane=-0.1", lambda j: j["dropped"].get("plane", 0) > 0),
    ("reach", "next model --reach reach.toml --generator sphere", lambda j: len(j["next"]) > 0),
    ("body", "next model --body 0.3,0.3,0.3 --generator sphere --distance 0.25", lambda j: j["dropped"].get("collision", 0) > 0),
    ("coarsest and finest scale, fine boxes", f"{MODEL} --scales 2,1 --fine 0,0,0,0.1,0.1,0.1 --out scales",
     lambda j: j["settings"]["coarsest"] == 2 and j["settings"]["finest"] == 1),
    ("weights of selected parts", f"score model {SPHERE} --gain paper --weight=-1,-1,-1,1,1,1,0", lambda j: j["best"][0]["gain"] == 0),
    *[(f"gain {gain}", f"score model {SPHERE} --gain {gain}", lambda j: j["best"][0]["gain"] > 0) for gain in ("paper", "surface", "combined")],
    *[(f"gain {gain}", f"score model {SPHERE} --gain {gain}", lambda j, gain=gain: any(v[gain] > 0 for v in j["best"])) for gain in CLASSIC],
    *[(f"criterion {name}", f"score model {SPHERE} --gain paper --criterion {name}", lambda j, name=name: j["criterion"] == name)
      for name in ("log_diagonal", "log_determinant", "trace")],
    ("race", f"score model {SPHERE} --race --top 2", lambda j: len(j["best"]) == 2),
    ("deadline", f"score model {SPHERE} --race --deadline 60", lambda j: len(j["best"]) > 0),
    ("approximate", f"score model {SPHERE} --approximate 0.2", lambda j: "standard_error" in j["best"][0]),
    ("sets", f"score model {SPHERE} --set 3", lambda j: len(j["best"]) == 3 and j["set_gain"] > 0),
    ("plans and tours", "next model --plan 3,2", lambda j: len(j["next"]) == 2 and j["plan_metres"] > 0),
    ("explain", "next model --explain", lambda j: j["next"][0]["rays"]["unknown"] > 0),
    ("all candidates, dropped ones with reasons", "next model --top all --generator sphere,boundary --distance 0.25 --body 0.3,0.3,0.3",
     lambda j: len(j["next"]) == j["candidates"] and j["per_dropped"][0]["reason"] in j["dropped"] and j["runs"]),
    ("feasibility", "score model --poses sphere:30,0.35 --feasible on --body 0.4,0.4,0.4 --reach reach.toml", lambda j: sum(j["dropped"].values()) > 0),
    ("hazard given", f"score model {SPHERE} --hazard size=0.2,5", lambda j: j["best"][0]["gain"] > 0),
    ("hazard learnt", "info model", lambda j: j["hazard_factors"] is not None),
    ("the loop", f"{RUN} --report on --save-maps on --out run", lambda j: j["views"] == 2),
    ("resume", f"{RUN.replace('views 2', 'views 9')} --stop area=0,idle=0,promises=0 --resume --out run2", lambda j: j["views"] > 2),
    ("policies", f"{RUN} --policy kriegel --out kriegel", lambda j: j["views"] == 2),
    ("stopping rules", f"{RUN.replace('views 2', 'views 8')} --stop area=0.9,idle=0,promises=0 --out stopped", lambda j: j["stop_reason"] == "area"),
    ("pictures", "reconstruct cube.off --size 0.2 --sensor sr4000 --voxel 0.025 --max-views 1 --out drawn", lambda j: j["views"] == 1),
    ("a picture of a map", "render model sigma --viewer 10,20,320 --out sigma.png", lambda j: j["width"] == 320),
    ("a report of scores", f"score model {SPHERE} --report scores.html --picture best.png --out scores.csv", lambda j: j["poses"] == 30),
    ("OctoMap out", "convert model map.ot", lambda j: j["occupied"] > 100),
    ("OctoMap in", "next map.ot --sensor sr4000", lambda j: len(j["next"]) > 0),
    ("surface and points, held against a mesh", "surface model --out s.ply --points p.ply --truth cube.off --size 0.2 --place center",
     lambda j: j["points"] > 100),
    ("calibration of noise", "calibrate static --noise --sensor sr4000 --out measured.toml", lambda j: 0.003 < j["steps"][0]["sigma_axial"] < 0.006),
    ("a wall", "simulate wall.off --poses wall_poses.txt --background 0 --sensor sr4000 --out walls", lambda j: j["frames"] == 8),
    ("calibration of ranges", "calibrate --range walls --out ranges.toml",
     lambda j: j["distances"] == 8 and j["rms_after"] < 0.001),
    ("presets", "sensors", lambda j: len(j) == 5),
]
NEEDS_REPORT = {"the loop", "a report of scores"}  # npm, when the program was built


def write_png(path, width, height, halves):
    """Grey, 8 bit: the left half of one value, the right one of another."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    row = b"\0" + bytes([halves[0]]) * (width // 2) + bytes([halves[1]]) * (width - width // 2)
    path.parent.mkdir()
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
                     chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


def wall_poses():
    """Eight distances from the wall, turned by 12 degrees to either side."""
    lines = []
    for i in range(8):
        s, c = math.sin((-1) ** i * math.radians(6)), math.cos(math.radians(6))
        lines.append(f"{i} {0.4 - 0.5 * 1.18 ** i} 0 0 {(-c - s) / 2} {(c - s) / 2} {(s - c) / 2} {(c + s) / 2}\n")
    return "".join(lines)


def main():
    viewgain, work = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    for name, text in {"cube.off": CUBE, "wall.off": WALL, "cloud.ply": CLOUD, "reach.toml": REACH, "costs.txt": "1\n2\n3\n",
                       "poses.txt": "".join(f"{i} {x} {y} 0 {q}\n" for i, (x, y, q) in enumerate(
                           [(-0.6, 0, "-0.5 0.5 -0.5 0.5"), (0.6, 0, "0.5 0.5 -0.5 -0.5"), (0, -0.6, "-0.7071068 0 0 0.7071068")])),
                       "wall_poses.txt": wall_poses()}.items():
        (work / name).write_text(text, encoding="utf-8")
    recordings = pathlib.Path(__file__).resolve().parents[2] / "data/recordings"
    shutil.copy(recordings / "arm_zstd.mcap", work)
    shutil.copy(recordings / "frames/sensor.toml", work / "arm.toml")

    def call(words):
        done = subprocess.run([viewgain, *words.split(), "--json", "--quiet"], cwd=work, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"exit code {done.returncode}: {done.stderr.strip()}")
        return json.loads(done.stdout)

    failures, has_report = [], True
    for name, words, holds in CALLS:
        try:
            if name == "masks":
                write_png(work / "masks/frame-000000.depth.png", 176, 144, (255, 0))
                write_png(work / "sure/frame-000000.depth.png", 176, 144, (1, 255))
            if name == "resume":  # what was killed goes on
                process = subprocess.Popen([viewgain, *words.split(), "--quiet"], cwd=work, stdout=subprocess.DEVNULL)
                while not list(work.glob(".run2.tmp-*/checkpoint.json")):
                    time.sleep(0.005)
                process.kill()
                process.wait()
                assert list(work.glob(".run2.tmp-*")), "nothing is left to go on with"
            if name == "calibration of noise":
                call("simulate cube.off --size 0.2 --sensor sr4000 --poses orbit:1,0.6,27 --noise on --frames-per-view 30 --out static")
            result = call(words)
            if not holds(result):
                failures.append(f"{name}: not in the JSON of: {words}")
        except (RuntimeError, KeyError, IndexError, TypeError) as error:
            if name in NEEDS_REPORT and "npm" in str(error):
                has_report = False
                continue
            failures.append(f"{name}: {words}: {error!r}")

    # Frames that arrive while the program watches.
    live = work / "live"
    live.mkdir()
    for name in ("sensor.toml", "frames.toml", "poses.txt"):
        shutil.copy(work / "frames" / name, live)

    def feed():
        for image in sorted((work / "frames").glob("*.depth.png")):
            amplitude = image.with_name(image.name.replace("depth", "amplitude"))
            shutil.copy(amplitude, live)
            shutil.copy(image, live)
            time.sleep(0.05)
        (live / "done").touch()

    feeder = threading.Thread(target=feed)
    feeder.start()
    try:
        watched = call(f"model live --watch {MAP} --out watched")
        if watched["frames"] != 6 or watched["ended_by"] != "done":
            failures.append(f"live frames: {watched}")
    except RuntimeError as error:
        failures.append(f"live frames: {error}")
    feeder.join()

    print(f"{len(CALLS) + 1} capabilities, {len(failures)} missing{'' if has_report else '; reports were not built'}")
    print("\n".join(failures))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
