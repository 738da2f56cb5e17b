"""From numpy depth images to the next view, in cells (`# %%`). Run all of it, or cell by cell in an editor."""
# %% Depth images: here simulated, a ball in front of a wall. Yours come from your camera's driver.
import matplotlib.pyplot as plt
import numpy as np

import viewgain

camera = viewgain.PinholeCamera(160, 120, fx=140.0, fy=140.0, cx=79.5, cy=59.5)
sensor = viewgain.Sensor(camera, min_range=0.2, max_range=3.0, working_distance=0.6,
                         noise=viewgain.StereoNoise(subpixel=0.1, baseline=0.05))
noise = np.random.default_rng(1)


def see(T_world_camera, ball=0.1, wall=-0.5):
    """Depth along the optical axis [m] of a ball at the origin and the wall y = `wall`; inf: nothing."""
    rays = camera.rays() @ T_world_camera[:3, :3].T  # world, one metre along the axis
    eye = T_world_camera[:3, 3]
    a, b = np.sum(rays**2, axis=-1), rays @ eye
    root = b**2 - a * (eye @ eye - ball**2)
    to_ball = np.where(root > 0, (-b - np.sqrt(np.abs(root))) / a, np.inf)
    with np.errstate(divide="ignore"):
        to_wall = (wall - eye[1]) / rays[..., 1]
    depth = np.minimum(np.where(to_ball > 0, to_ball, np.inf), np.where(to_wall > 0, to_wall, np.inf))
    return depth + noise.normal(0, 0.001, depth.shape)  # new noise in each frame


start = viewgain.look_at([0.0, 0.6, 0.2], [0.0, 0.0, 0.0])
frame = see(start)
viewgain.plot.depth(frame).figure.savefig("depth.png")

# %% Map: everything is unknown at first.
scorer = viewgain.ViewScorer(sensor, voxel_size=0.005, workspace=[[-0.15, -0.15, -0.15], [0.15, 0.15, 0.15]], gain="surface")
print(scorer.add(frame, start))
print(scorer.grid)

# %% Candidates: 500 poses around the ball, without those that are out of reach or where the camera would collide.
sphere = viewgain.sphere_poses(500, 0.5)
reach = viewgain.ReachRegion(half_spaces=[[0, 1, 0, -0.35]])  # y >= -0.35 m: at least 15 cm from the wall
checker = viewgain.FeasibilityChecker(scorer.scene, reach=reach)   # default body: 6.5 x 6.5 x 7.6 cm
poses = sphere[checker.feasible(sphere)]
print(f"{len(poses)} of 500 are possible")

# %% Gains: how much new surface each view is expected to show.
gains = scorer.evaluate(poses)
viewgain.plot.gains(poses, gains, label="new surface [m²]").figure.savefig("gains.png")

# %% Why: what the best view sees, and where its gain comes from.
best = poses[np.nanargmax(gains)]  # np.argmax would choose the NaN of a bad pose
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.5), layout="constrained")
viewgain.plot.depth(scorer.evaluator.depth(best), axes=left)
viewgain.plot.contributions(viewgain.GainEvaluator(scorer.scene, sensor, gain="paper"), best, axes=right)
figure.savefig("why.png")

# %% Go there and repeat: four more views, and the known part of the workspace after each.
def share_known():
    grid = scorer.grid
    return 1 - grid.statistics().unknown / np.prod(grid.shape)


pose, taken, known = best, [start], [share_known()]
for _ in range(4):
    scorer.add(see(pose), pose)
    taken.append(pose)
    known.append(share_known())
    checker = viewgain.FeasibilityChecker(scorer.scene, reach=reach)  # possible poses change with the map
    poses = sphere[checker.feasible(sphere, taken)]
    pose = poses[scorer.best(poses).indices[0]]
plt.figure()
plt.plot(range(1, 6), 100 * np.array(known), "o-"), plt.ylim(0, 100), plt.xlabel("views"), plt.ylabel("known [%]")
plt.savefig("known.png")
print(f"{100 * known[-1]:.0f} % of the workspace known")
