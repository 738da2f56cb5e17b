# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import copy
import pickle

import numpy as np
import pytest

import viewgain


def test_the_paper_s_camera_can_be_written_out():
    camera = viewgain.PinholeCamera(176, 144, fx=220.0, fy=231.2, cx=87.5, cy=71.5)
    sensor = viewgain.Sensor(
        camera, min_range=0.2, max_range=5.0, working_distance=0.4, noise=viewgain.ShotNoise())
    preset = viewgain.sensor_preset("sr4000")
    assert sensor.camera == preset.camera and sensor.noise == preset.noise
    assert viewgain.default_prior_sigma(0.01, sensor) == pytest.approx(2 * sensor.sigmas(0.4)[0])
    assert repr(camera) == "PinholeCamera(176, 144, fx=220, fy=231.2, cx=87.5, cy=71.5)"


@pytest.mark.parametrize("noise", [
    viewgain.ShotNoise(), viewgain.StructuredLightNoise(), viewgain.StereoNoise(),
    viewgain.QuadraticNoise(), viewgain.ConstantNoise(sigma_axial=0.002)], ids=lambda n: type(n).__name__)
def test_noise_models_can_be_read_back(noise):
    again = eval(repr(noise), vars(viewgain))  # noqa: S307: our own text
    assert again == noise and noise != "noise" and noise != viewgain.ConstantNoise()
    camera = viewgain.PinholeCamera(64, 48, fx=60.0, fy=60.0, cx=31.5, cy=23.5)
    sensor = viewgain.Sensor(camera, min_range=0.3, max_range=2.0, working_distance=0.5, noise=noise)
    assert type(sensor.noise) is type(noise) and sensor.noise == noise
    assert sensor.T_flange_camera is None


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_plain_values_can_be_pickled_and_copied(protocol):
    camera = viewgain.PinholeCamera(
        64, 48, fx=60.0, fy=62.0, cx=30.0, cy=24.0, distortion=[0.1, -0.05, 1e-3, -1e-3, 0.01])
    values = [camera, viewgain.ShotNoise(min_amplitude=0.5), viewgain.StructuredLightNoise(vertex=0.7),
              viewgain.StereoNoise(focal=99.0), viewgain.QuadraticNoise(offset=0.1),
              viewgain.ConstantNoise(sigma_lateral=0.2)]
    for value in values:
        again = pickle.loads(pickle.dumps(value, protocol))
        assert type(again) is type(value) and again == value == copy.deepcopy(value)
    mounting = viewgain.look_at([1, 2, 3], [0, 0, 0])
    for T_flange_camera in (None, mounting):
        sensor = viewgain.Sensor(
            camera, min_range=0.2, max_range=2.0, working_distance=0.5, noise=values[1], name="mine",
            T_flange_camera=T_flange_camera)
        again = pickle.loads(pickle.dumps(sensor, protocol))
        assert (again.camera, again.noise, again.name) == (camera, values[1], "mine")
        assert (again.min_range, again.max_range, again.working_distance) == (0.2, 2.0, 0.5)
        assert np.array_equal(again.T_flange_camera, sensor.T_flange_camera)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_the_table_of_a_range_error(protocol):
    camera = viewgain.PinholeCamera(7, 5, fx=4.0, fy=5.0, cx=2.5, cy=2.25)
    settings = {"min_range": 0.2, "max_range": 5.0, "working_distance": 0.5,
                "noise": viewgain.ConstantNoise()}
    plain = viewgain.Sensor(camera, **settings)
    assert plain.range_calibration is None
    table = np.array([[1.0, 0.01], [2.0, 0.03], [4.0, -0.05]])
    sensor = pickle.loads(pickle.dumps(viewgain.Sensor(camera, **settings, range_calibration=table), protocol))
    assert np.array_equal(sensor.range_calibration, table)
    depth = np.linspace(0.4, 4, 35, dtype=np.float32).reshape(5, 7)
    depth[0, 0], depth[0, 1] = 0, np.inf
    assert np.array_equal(plain.corrected(depth), depth) and not np.array_equal(sensor.corrected(depth), depth)
    for wrong in (table[::-1], table[:, :1], [[1.0, 2.0]], [[1.0, np.nan]]):
        with pytest.raises(ValueError):
            viewgain.Sensor(camera, **settings, range_calibration=wrong)
    with pytest.raises(ValueError, match="7"):
        sensor.corrected(depth.T)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_poses_that_may_be_off(protocol, tmp_path):
    settings = {"min_range": 0.2, "max_range": 5.0, "working_distance": 0.5,
                "noise": viewgain.ConstantNoise(sigma_axial=0.003, sigma_lateral=0.004)}
    camera = viewgain.PinholeCamera(7, 5, fx=4.0, fy=5.0, cx=2.5, cy=2.25)
    exact = viewgain.Sensor(camera, **settings)
    assert exact.pose_sigma == (0, 0)
    assert exact.scale_sigma == 0
    assert viewgain.Sensor(camera, **settings, scale_sigma=0.005) != exact
    sensor = viewgain.Sensor(camera, **settings, pose_sigma=[0.004, 0.01], scale_sigma=0.005)
    assert sensor != exact
    sensor.save(tmp_path / "sensor.toml")
    for again in (pickle.loads(pickle.dumps(sensor, protocol)), viewgain.Sensor.load(tmp_path / "sensor.toml")):
        assert again.pose_sigma == sensor.pose_sigma == (0.004, 0.01)
        assert again.sigmas(0.5) == sensor.sigmas(0.5)
        assert again.scale_sigma == sensor.scale_sigma == 0.005
    for wrong in ([-1e-3, 0], [0, np.inf]):
        with pytest.raises(ValueError, match="pose_sigma"):
            viewgain.Sensor(camera, **settings, pose_sigma=wrong)
    with pytest.raises(ValueError, match="scale_sigma"):
        viewgain.Sensor(camera, **settings, scale_sigma=-1e-3)


@pytest.mark.parametrize("meaning", [None, "carve", "invalid"])
def test_what_out_of_range_says_is_kept(meaning, tmp_path):
    base = viewgain.sensor_preset("d435")
    names = ("min_range", "max_range", "working_distance", "noise", "name", "T_flange_camera", "body_size",
             "range_calibration", "pose_sigma", "scale_sigma")
    sensor = viewgain.Sensor(base.camera, **{name: getattr(base, name) for name in names}, out_of_range=meaning)
    assert sensor.out_of_range == meaning
    assert (sensor == base) == (meaning is None)
    sensor.save(tmp_path / "sensor.toml")
    for again in (copy.copy(sensor), copy.deepcopy(sensor), viewgain.Sensor.load(tmp_path / "sensor.toml"),
                  *(pickle.loads(pickle.dumps(sensor, k)) for k in range(pickle.HIGHEST_PROTOCOL + 1))):
        assert again == sensor and again.out_of_range == meaning
    with pytest.raises(ValueError, match='out_of_range is "far"'):
        viewgain.Sensor(base.camera, **{name: getattr(base, name) for name in names}, out_of_range="far")


def test_wrong_values_are_named():
    good = {"fx": 60.0, "fy": 60.0, "cx": 31.5, "cy": 23.5}
    for width, change, text in [(0, {}, "width"), (64, {"fx": -1.0}, "fx"), (64, {"cy": np.nan}, "cy")]:
        with pytest.raises(ValueError, match=text):
            viewgain.PinholeCamera(width, 48, **{**good, **change})
    with pytest.raises(TypeError):
        viewgain.PinholeCamera(64, 48, 60, 60, 31, 23)
    with pytest.raises(TypeError):
        viewgain.PinholeCamera(64, 48, **good, distortion=[0.0])
    camera = viewgain.PinholeCamera(64, 48, **good)
    with pytest.raises(AttributeError):
        camera.fx = 3.0
    settings = {"min_range": 0.2, "max_range": 2.0, "working_distance": 0.5,
                "noise": viewgain.ConstantNoise()}
    for change in ({"min_range": 3.0}, {"working_distance": 9.0},
                   {"noise": viewgain.ConstantNoise(sigma_axial=-1.0)},
                   {"T_flange_camera": np.zeros((4, 4))}):
        with pytest.raises(ValueError):
            viewgain.Sensor(camera, **{**settings, **change})
    with pytest.raises(TypeError):
        viewgain.Sensor(camera, **{**settings, "noise": "shot"})


def test_look_at():
    eyes = np.random.default_rng(1).normal(size=(3, 5, 3)) + 3
    target = np.array([0.5, 0.2, 0.1])
    poses = viewgain.look_at(eyes, target)
    assert poses.shape == (3, 5, 4, 4) and np.allclose(poses[..., :3, 3], eyes)
    assert viewgain.look_at([1, 0, 0], [0, 0, 0]).shape == (4, 4)
    assert np.array_equal(viewgain.look_at(eyes, np.broadcast_to(target, eyes.shape)), poses)
    for eye, goal, text in [([1, 0], target, r"\(2,\)"), (eyes, eyes[0], r"\(5, 3\)"),
                            (target, target, "target|eye"), ([np.inf, 0, 0], target, "finite")]:
        with pytest.raises(ValueError, match=text):
            viewgain.look_at(eye, goal)


def test_generators():
    center = np.array([0.1, -0.2, 0.3])
    sets = {
        "sphere": viewgain.sphere_poses(50, 0.6, center=center),
        "dome": viewgain.dome_poses(50, 0.6, center=center),
        "orbit": viewgain.orbit_poses(50, 0.6, 0.3, center=center),
        "shell": viewgain.shell_poses(50, 0.6, 0.6, seed=4, center=center),
    }
    for name, poses in sets.items():
        assert poses.shape == (50, 4, 4), name
        assert np.allclose(poses[:, :3, 3] + 0.6 * poses[:, :3, 2], center), name
    assert viewgain.literature_ring_poses(48, 0.5).shape == (48, 4, 4)
    assert viewgain.ring_poses(8, 0.5, 0.2, 0.4).shape == (8, 4, 4)
    for call in (lambda: viewgain.sphere_poses(0, 1.0), lambda: viewgain.sphere_poses(3, -1.0),
                 lambda: viewgain.literature_ring_poses(49, 1.0),
                 lambda: viewgain.dome_poses(3, 1.0, center=[0, 0])):
        with pytest.raises(ValueError):
            call()
