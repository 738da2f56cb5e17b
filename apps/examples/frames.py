"""Depth frames into a map, and where to look next."""
import numpy as np

import viewgain

sensor = viewgain.sensor_preset("sr4000")
# A simulated camera in place of a real one: a 16 cm box in front of a wall.
corners = 0.08 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
camera = viewgain.SimulatedSensor(corners, np.array(triangles), sensor, background_radius=1.5)

scorer = viewgain.ViewScorer(sensor, voxel_size=0.01, workspace=[[-0.15] * 3, [0.15] * 3])
poses = viewgain.sphere_poses(500, 0.5)
T_world_camera = viewgain.look_at([0.5, 0.1, 0.2], [0, 0, 0])
for view in range(5):
    depth, amplitude = camera.acquire(T_world_camera, view)
    update = scorer.add(depth, T_world_camera, amplitude=amplitude)
    best = scorer.best(poses)
    print(f"view {view} showed {1e4 * update.new_area:.0f} cm2 of new surface; "
          f"the next one may show {1e4 * best.gains['area'][0]:.0f} cm2")
    T_world_camera = poses[best.indices[0]]
print(scorer.consistency().suspicion)  # None: the frames agree
scorer.save("frames_map.vdb")
