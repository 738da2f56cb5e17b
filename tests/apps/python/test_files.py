# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Files of sensors, regions, poses and frames: there and back, and what is refused."""
import copy
import warnings

import numpy as np
import pytest
from conftest import box_mesh, gray_png

import viewgain


@pytest.mark.parametrize("name", ["sr4000", "azure_kinect_nfov", "kinect_v1", "d435", "laser_line"])
def test_sensors(name, tmp_path):
    sensor = viewgain.Sensor.load(name)
    assert sensor.name == name and sensor.camera == viewgain.sensor_preset(name).camera
    for path in (tmp_path / "a.toml", str(tmp_path / "b.toml")):
        sensor.save(path)
        read = viewgain.Sensor.load(path)
        assert read.camera == sensor.camera and repr(read) == repr(sensor) and read.noise == sensor.noise
        assert read.body_size == sensor.body_size
        assert read.range_calibration is None


def test_sensors_refused(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.toml"):
        viewgain.Sensor.load(tmp_path / "none.toml")
    with pytest.raises(ValueError, match="sr4000"):
        viewgain.Sensor.load("sr5000")
    (tmp_path / "bad.toml").write_text("width = 3\n")
    with pytest.raises(viewgain.Error, match="bad.toml"):
        viewgain.Sensor.load(tmp_path / "bad.toml")
    with pytest.raises(OSError):
        viewgain.sensor_preset("d435").save(tmp_path / "none" / "a.toml")
    assert [p.name for p in tmp_path.iterdir()] == ["bad.toml"]


def test_regions(tmp_path):
    poses = viewgain.sphere_poses(6, 0.5)
    region = viewgain.ReachRegion(boxes=[[[-1, -1, -0.2], [1, 1, 0.3]]], shells=[[0, 0, 0, 0.3, 0.9]],
                                  half_spaces=[[0, 0, 1, -0.1]])
    listed = viewgain.ReachRegion(poses=poses, distance=0.03, angle=0.1)
    many = viewgain.sphere_poses(200, 0.5)
    for written in (region, listed, viewgain.ReachRegion()):
        written.save(tmp_path / "cell.toml")
        read = viewgain.ReachRegion.load(tmp_path / "cell.toml")
        assert repr(read) == repr(written)
        assert np.array_equal(read.contains(many), written.contains(many))
        assert np.array_equal(read.contains(poses), written.contains(poses))
    assert 0 < region.contains(many).sum() < 200
    with pytest.raises(ValueError, match="predicate"):
        viewgain.ReachRegion(predicate=lambda pose: True).save(tmp_path / "p.toml")
    with pytest.raises(FileNotFoundError):
        viewgain.ReachRegion.load(tmp_path / "none.toml")


def test_poses(tmp_path):
    poses = viewgain.sphere_poses(9, 0.5)
    path = tmp_path / "poses.txt"
    viewgain.write_poses(path, poses)
    read, times = viewgain.read_timed_poses(path)
    assert np.allclose(read, poses, atol=1e-14) and np.array_equal(times, np.arange(9))
    viewgain.write_poses(path, poses[:2], [0.25, 1e9 + 0.125])
    assert np.array_equal(viewgain.read_timed_poses(path)[1], [0.25, 1e9 + 0.125])
    assert viewgain.read_poses(path).shape == (2, 4, 4)
    bad = poses.copy()
    bad[3, 0, 0] = np.nan
    for wrong, error in ((lambda: viewgain.write_poses(path, bad), ValueError),
                         (lambda: viewgain.write_poses(path, poses[0]), ValueError),
                         (lambda: viewgain.write_poses(path, poses, [1.0]), ValueError),
                         (lambda: viewgain.write_poses(tmp_path / "none" / "p.txt", poses), FileNotFoundError),
                         (lambda: viewgain.read_poses(tmp_path / "none.txt"), FileNotFoundError)):
        with pytest.raises(error):
            wrong()
    assert viewgain.read_poses(path).shape == (2, 4, 4)  # as it was


def small_sensor():
    camera = viewgain.PinholeCamera(4, 3, fx=5.0, fy=5.0, cx=1.5, cy=1.0)
    preset = viewgain.sensor_preset("sr4000")
    return viewgain.Sensor(camera, min_range=0.1, max_range=5.0, working_distance=0.5, noise=preset.noise)


def test_frames(tmp_path):
    poses = viewgain.sphere_poses(2, 0.5)
    pixels = np.arange(12, dtype=np.uint16).reshape(3, 4) * 1000
    pixels[0, 1] = 65535
    small_sensor().save(tmp_path / "sensor.toml")
    viewgain.write_poses(tmp_path / "poses.txt", poses)
    for i in range(2):
        (tmp_path / f"frame-{i:06}.depth.png").write_bytes(gray_png(pixels))
    (tmp_path / "frame-000001.amplitude.png").write_bytes(gray_png(pixels))
    with pytest.warns(UserWarning, match="does not state depth_scale and out_of_range; assuming depth_scale = 1e-04.*If this is wrong, set the keys in frames.toml"):
        viewgain.read_frames(tmp_path)
    (tmp_path / "frames.toml").write_text('depth_scale = 1e-4\nout_of_range = "carve"\n')
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        frames = viewgain.read_frames(tmp_path)
    assert len(frames) == 2 and frames.depth_scale == 1e-4 and frames.sensor.camera == small_sensor().camera
    assert np.allclose(frames.poses, poses) and "2 frames" in repr(frames)
    seen = 0
    for (depth, pose, amplitude), wanted in zip(frames, poses):
        assert depth.dtype == np.float32 and depth.shape == (3, 4)
        assert depth[0, 0] == 0 and np.isinf(depth[0, 1]) and depth[2, 3] == np.float32(1.1)
        assert np.allclose(pose, wanted)
        assert amplitude is None if seen == 0 else np.allclose(amplitude[1:], pixels[1:] * 1e-3)
        seen += 1
    assert seen == 2
    grid = viewgain.BeliefGrid(voxel_size=0.02, workspace=[[-1] * 3, [1] * 3], sensor=frames.sensor)
    integrator = viewgain.FrameIntegrator(frames.sensor)
    for depth, pose, amplitude in frames:
        integrator.integrate(grid, depth, pose, amplitude=amplitude)
    assert len(grid.views()) == 2
    assert viewgain.read_frames(tmp_path, out_of_range="invalid")[-1][0][0, 1] == 0
    assert np.isclose(viewgain.read_frames(tmp_path, depth_scale=1e-3)[0][0][2, 3], 11.0)
    for index in (2, -3):
        with pytest.raises(IndexError):
            frames[index]
    with pytest.raises(TypeError):
        copy.copy(frames)


def test_frames_are_suspected():
    sensor = viewgain.sensor_preset("sr4000")
    poses = viewgain.orbit_poses(6, 0.6, 0.5)
    camera = viewgain.SimulatedSensor(*box_mesh([-0.1, -0.05, -0.15], [0.12, 0.1, 0.05]), sensor, background_radius=1.5)
    frames = [(camera.acquire(pose).depth, pose) for pose in poses]
    assert viewgain.suspect_frames(sensor, frames) == []
    for factor, words in ((4, "4 times smaller"), (1000, "1000 times smaller")):
        (suspicion,) = viewgain.suspect_frames(sensor, [(factor * depth, pose) for depth, pose in frames])
        assert suspicion.kind == "depth_scale" and words in suspicion.what
    (suspicion,) = viewgain.suspect_frames(sensor, [(depth, np.linalg.inv(pose)) for depth, pose in frames])
    assert suspicion.kind == "world_to_camera"
    assert viewgain.suspect_frames(sensor, [(depth, np.full((4, 4), np.nan)) for depth, _ in frames]) == []
    with pytest.raises(ValueError, match="T_world_camera"):
        viewgain.suspect_frames(sensor, [frames[0][:1]])


def test_recorded_frames(tmp_path):
    (tmp_path / "frame-000007.depth.png").write_bytes(gray_png(np.full((3, 4), 500)))
    np.savetxt(tmp_path / "frame-000007.pose.txt", np.eye(4))
    np.savetxt(tmp_path / "camera-intrinsics.txt", [[6, 0, 1.5], [0, 6, 1], [0, 0, 1]])
    small_sensor().save(tmp_path / "mine.toml")
    with pytest.raises(ValueError, match="sensor"):
        viewgain.read_frames(tmp_path)
    frames = viewgain.read_frames(tmp_path, sensor=tmp_path / "mine.toml")
    depth, pose, amplitude = frames[0]
    assert len(frames) == 1 and frames.sensor.camera.fx == 6 and np.allclose(depth, 0.5) and amplitude is None
    assert np.array_equal(pose, np.eye(4))
    for settings, error in (({"depth_scale": 0}, ValueError), ({"out_of_range": "far"}, ValueError),
                            ({"sensor": "none.toml"}, FileNotFoundError)):
        with pytest.raises(error):
            viewgain.read_frames(tmp_path, **{"sensor": tmp_path / "mine.toml", **settings})
    with pytest.raises(OSError, match="nowhere"):
        viewgain.read_frames(tmp_path / "nowhere", sensor="d435")
