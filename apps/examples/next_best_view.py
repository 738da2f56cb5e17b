"""Next-best-view loop on a numpy occupancy grid; draws what each view found out. Usage: FILE.png"""
import sys

import matplotlib
import numpy as np

import viewgain

matplotlib.use("Agg")
import matplotlib.patches
import matplotlib.pyplot as plt

# The world to explore, which the planner does not see: a hollow box with a hole in its lid.
n, voxel = 64, 0.005
world = np.ones((n, n, n), np.uint8)  # 1: free, 2: occupied
world[16:48, 16:48, 16:48] = 2
world[20:44, 20:44, 20:44] = 1
world[26:38, 26:38, 44:48] = 1
center = np.full(3, n * voxel / 2)

sensor = viewgain.sensor_preset("sr4000")
truth = viewgain.GainEvaluator(
    viewgain.VoxelScene(viewgain.BeliefGrid.from_labels(world, voxel_size=voxel, sensor=sensor)), sensor)
known = viewgain.BeliefGrid(
    voxel_size=voxel, workspace=[np.zeros(3), np.full(3, n * voxel)], sensor=sensor)
integrator = viewgain.FrameIntegrator(sensor)
candidates = viewgain.sphere_poses(500, 0.5, center=center)

pose, unknown, gains = candidates[0], [], []
for view in range(8):
    integrator.integrate(known, truth.depth(pose), pose)  # here a real camera would measure
    unknown.append(known.statistics().unknown)
    evaluator = viewgain.GainEvaluator(viewgain.VoxelScene(known), sensor, pixel_stride=2)
    (best,), (gain,) = evaluator.best(candidates, return_gains=True)
    gains.append(gain["gain"])
    pose = candidates[best]
    print(f"view {view}: {unknown[-1]} voxels unknown, next: pose {best}, {gains[-1]:.0f} nat")

figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
section = left.imshow(known.states()[:, n // 2].T, origin="lower", cmap="viridis", vmin=0, vmax=2)
left.legend(handles=[matplotlib.patches.Patch(facecolor=section.cmap(section.norm(state)), edgecolor="black", label=name)
                     for state, name in enumerate(["unknown", "free", "occupied"])],
            loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=3)
left.set(title="a section through the map", xlabel="x [voxel]", ylabel="z [voxel]")
right.plot(unknown, "o-", color="tab:blue")
right.set(title="what the views found out", xlabel="view", ylim=0)
right.set_ylabel("unknown [voxel]", color="tab:blue")
of_gains = right.twinx()  # nats have an axis of their own
of_gains.plot(gains, "s-", color="tab:orange")
of_gains.set_ylim(0)
of_gains.set_ylabel("expected gain of the next view [nat]", color="tab:orange")
figure.savefig(sys.argv[1])
