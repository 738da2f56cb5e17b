"""A gain of one's own beside those of a study: own_gain_study.py SPEC.toml STUDY adds its runs to STUDY/results.json."""
import itertools, json, pathlib, subprocess, sys, tempfile, tomllib
import numpy as np, viewgain

def near_unknown(pose, hits):  # distinct unknown voxels in view, by how near they are
    unknown = hits[hits["state"] == viewgain.VoxelState.UNKNOWN]
    _, first = np.unique(unknown["voxel"], axis=0, return_index=True)
    return float(np.sum(1 / unknown["range"][first] ** 2))

spec, results = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2], "results.json")
keys, rows, work = tomllib.loads(spec.read_text()), json.loads(results.read_text()), pathlib.Path(tempfile.mkdtemp())
tolerance = keys.get("tolerance", max(0.005, *keys["voxels"]))
settings = [keys["objects"], keys["seeds"], keys["sensors"], keys["voxels"], keys.get("sizes", [None])]
for file, seed, sensor, voxel, size in itertools.product(*settings):
    poses, more = np.empty((0, 4, 4)), keys.get("flags", []) + [f"--size={size}"] * (size is not None)
    for views in range(1, keys["max_views"] + 1):  # the study's start, camera, noise and truth, views of our choice
        subprocess.run(["viewgain", "reconstruct", spec.parent / file, f"--seed={seed}", f"--sensor={sensor}", f"--voxel={voxel}",
                        f"--tolerance={tolerance}", f"--max-views={views}", "--policy=sequence", "--stop=idle=0", "--stop=promises=0",
                        "--pictures=off", "--quiet", f"--out={work}/run", *more], check=True, stdout=subprocess.DEVNULL)
        run = json.loads((work / "run/run.json").read_text())
        scorer = viewgain.ViewScorer.load(work / "run/map.vdb", viewgain.Sensor.load(sensor))
        sphere = viewgain.sphere_poses(200, run["settings"]["distance"])
        best = scorer.evaluate(sphere, measure=near_unknown).argmax()
        poses = np.concatenate([poses, sphere[best:best + 1]])
        viewgain.write_poses(work / "own.txt", poses)
        more += [f"--poses={work}/own.txt"] * (views == 1)
    covered = [view["coverage_visible"] for view in run["per_view"]]
    rows.append({**{key: run.get(key) for key in rows[0]}, "object": pathlib.Path(file).stem, "policy": "own", "seed": seed, "sensor": sensor,
                 "voxel": voxel, "size": size, "coverage_by_view": covered, "auc": np.mean(covered), "seconds": run["seconds"]["total"]})
results.write_text(json.dumps(rows, indent=2) + "\n")
