"""Next best views into a bin, frame by frame. Saves its state: stop it at any time and start it again."""
import pathlib
import sys

import viewgain



def drive_to(pose):
    """Stands for the robot: moves the camera to the pose and returns whether it arrived. Here it always does."""
    return True


if len(sys.argv) != 5:
    sys.exit("usage: bin_planner.py SENSOR.toml FRAMES STATE.vdb MOST_FRAMES")
sensor = viewgain.Sensor.load(sys.argv[1])
frames = viewgain.read_frames(sys.argv[2], sensor=sys.argv[1])
state, most = pathlib.Path(sys.argv[3]), int(sys.argv[4])
bin_cell = dict(
    voxel_size=0.005, workspace=[[-0.20, -0.15, 0.0], [0.20, 0.15, 0.20]],
    support_plane=0.0,  # the bin's floor
    boxes=[[[-0.22, -0.17, 0], [-0.20, 0.17, 0.2]], [[0.20, -0.17, 0], [0.22, 0.17, 0.2]],  # its walls
           [[-0.22, -0.17, 0], [0.22, -0.15, 0.2]], [[-0.22, 0.15, 0], [0.22, 0.17, 0.2]]],
    reach=viewgain.ReachRegion(shells=[[0.0, 0.0, 0.1, 0.40, 0.75]], half_spaces=[[0, 0, 1, 0.30]]),
    clearance=0.01)
if state.exists():
    planner = viewgain.ViewPlanner.load(state, sensor, **bin_cell)
else:
    planner = viewgain.ViewPlanner(sensor, **bin_cell)
planner.add_poses(viewgain.shell_poses(300, 0.45, 0.70, seed=1, center=[0.0, 0.0, 0.1]), name="shell")

first = len(planner.grid.views())
for i in range(first, min(len(frames), first + most)):
    depth, T_world_camera, amplitude = frames[i]
    view = planner.add(depth, T_world_camera, amplitude=amplitude)
    print(f"view {i}: {1e4 * view.new_area:.1f} cm2 of new surface, {view.entropy_removed:.0f} nat", end="")
    proposal = planner.propose()
    best = planner.rank(3, cost_per_metre=20)  # [nat/m]
    for index, pose, gain in zip(best.indices, best.T_world_camera, best.gain):
        x, y, z = pose[:3, 3]
        print(f"; of {len(proposal.T_world_camera)} views the best is {index} at ({x:.3f}, {y:.3f}, {z:.3f}) m, "
              f"{gain:.1f} nat", end="")
        reached = drive_to(pose)
        planner.tried(pose, reached)
        if reached:
            break  # otherwise try the next best
    print(f"; enough: {planner.should_stop()}" if planner.should_stop() else "")
    planner.save(state)
