"""A custom gain as a policy of a study; in its spec: {name = "near", command = "python3 own_policy.py"}. It takes the arguments
of `viewgain reconstruct`, and writes the run to the folder of --out."""
import json, pathlib, subprocess, sys, tempfile
import numpy as np, viewgain

def near_unknown(pose, hits):  # distinct unknown voxels in view, weighted by 1 / range²
    unknown = hits[hits["state"] == viewgain.VoxelState.UNKNOWN]
    _, first = np.unique(unknown["voxel"], axis=0, return_index=True)
    return float(np.sum(1 / unknown["range"][first] ** 2))

given = dict(word.lstrip("-").split("=", 1) for word in sys.argv[1:] if "=" in word)
flags = [word for word in sys.argv[1:sys.argv.index("--")] if not word.startswith(("--max-views=", "--out="))]
mesh, poses, own = sys.argv[-1], np.empty((0, 4, 4)), []
with tempfile.TemporaryDirectory() as work:
    for views in range(1, int(given["max-views"]) + 1):  # start, camera, noise and truth of the study, but our views
        last = views == int(given["max-views"])
        out = given["out"] if last else f"{work}/run"
        subprocess.run(["viewgain", "reconstruct", *flags, "--policy=sequence", f"--max-views={views}", f"--out={out}", *own, "--", mesh],
                       check=True, stdout=subprocess.DEVNULL)
        if last:
            break
        run = json.loads(pathlib.Path(out, "run.json").read_text())
        scorer = viewgain.ViewScorer.load(f"{out}/map.vdb", viewgain.Sensor.load(given["sensor"]))
        sphere = viewgain.sphere_poses(200, run["settings"]["distance"])
        best = scorer.evaluate(sphere, measure=near_unknown).argmax()
        poses = np.concatenate([poses, sphere[best:best + 1]])
        viewgain.write_poses(f"{work}/own.txt", poses)
        own = [f"--poses={work}/own.txt"]
