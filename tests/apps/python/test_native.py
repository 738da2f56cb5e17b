# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What makes the package feel like Python: names, equality, pickles, codes with names, pictures."""
import copy
import importlib.util
import inspect
import os
import pickle
import runpy
import subprocess
import sys

import numpy as np
import pytest
from conftest import box_mesh

import viewgain


def test_all_is_of_the_package_that_users_import():
    modules = ["viewgain"] + ["viewgain.mesh"] * (importlib.util.find_spec("viewgain.mesh").submodule_search_locations is not None)
    checked = 0
    for name in modules:
        module = importlib.import_module(name)
        for public in dir(module):
            thing = getattr(module, public)
            if not public.startswith("_") and (inspect.isclass(thing) or inspect.isbuiltin(thing)):
                assert thing.__module__ == name, public
                checked += 1
    assert checked >= 40
    assert "_viewgain" not in viewgain.BeliefGrid.load.__doc__.splitlines()[0]


def test_sensors_are_equal_by_value(sensor):
    again = viewgain.sensor_preset("sr4000")
    assert sensor == again and hash(sensor) == hash(again) and sensor is not again
    others = [viewgain.sensor_preset(name) for name in viewgain.sensor_preset_names() if name != "sr4000"]
    keywords = dict(camera=sensor.camera, min_range=sensor.min_range, max_range=sensor.max_range,
                    working_distance=sensor.working_distance, noise=sensor.noise, name=sensor.name)
    assert viewgain.Sensor(**keywords, body_size=sensor.body_size) == sensor
    for key, value in (("min_range", 0.21), ("max_range", 4.0), ("working_distance", 0.5), ("name", "other"),
                       ("noise", viewgain.ConstantNoise()), ("camera", others[0].camera)):
        others.append(viewgain.Sensor(**{**keywords, key: value}, body_size=sensor.body_size))
    others += [viewgain.Sensor(**keywords, body_size=[0.1, 0.1, 0.2]),
               viewgain.Sensor(**keywords, body_size=sensor.body_size, T_flange_camera=np.eye(4)),
               viewgain.Sensor(**keywords, body_size=sensor.body_size, range_calibration=[[1.0, 0.01], [2.0, 0.02]])]
    for other in others:
        assert sensor != other
    assert sensor != "sr4000"
    assert len({sensor, again, *others}) == 14


def test_a_map_remembers_its_sensor(sensor, tmp_path):
    grid = viewgain.BeliefGrid(voxel_size=0.02, workspace=[[-0.2] * 3, [0.2] * 3], sensor=sensor)
    assert grid.sensor is None and grid.frames == []
    depth = np.full((sensor.camera.height, sensor.camera.width), 0.5, np.float32)
    pose = viewgain.look_at([0.5, 0, 0], [0, 0, 0])
    viewgain.FrameIntegrator(sensor).integrate(grid, depth, pose)
    grid.save(tmp_path / "map.vdb")
    for again in (grid, grid.clone(), copy.copy(grid), copy.deepcopy(grid), pickle.loads(pickle.dumps(grid)),
                  viewgain.BeliefGrid.from_bytes(grid.to_bytes()), viewgain.BeliefGrid.load(tmp_path / "map.vdb")):
        assert again.sensor == sensor
    # Of two sensors it is nobody's.
    again = grid.clone()
    other = viewgain.Sensor(sensor.camera, min_range=0.2, max_range=9.0, working_distance=0.4, noise=sensor.noise)
    viewgain.FrameIntegrator(other).integrate(again, depth, pose)
    assert again.sensor is None and grid.sensor == sensor


def test_a_grid_goes_through_bytes_and_pickles(grid, sensor):
    full = grid.clone()
    viewgain.FrameIntegrator(sensor).integrate(
        full, np.full((144, 176), 0.5, np.float32), viewgain.look_at([0.5, 0, 0], [0, 0, 0]))
    for one in (grid, full):
        again = viewgain.BeliefGrid.from_bytes(one.to_bytes())
        assert again.content_hash() == one.content_hash() and np.array_equal(again.views(), one.views())
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            assert pickle.loads(pickle.dumps(one, protocol)).content_hash() == one.content_hash()
        for copied in (copy.copy(one), copy.deepcopy(one), copy.deepcopy([one])[0]):
            before = one.content_hash()
            copied.set([[0, 0, 0]], [3.0])
            assert one.content_hash() == before != copied.content_hash()


def test_bytes_that_are_no_map_are_refused(grid, tmp_path, monkeypatch):
    data = grid.to_bytes()
    for bad in (b"", b"no map", data[:-1], data[: len(data) // 2], data[:100] + b"x" + data[101:]):
        with pytest.raises(viewgain.Error, match="not a map from to_bytes"):
            viewgain.BeliefGrid.from_bytes(bad)
    with pytest.raises(TypeError):
        viewgain.BeliefGrid.from_bytes("text")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    assert viewgain.BeliefGrid.from_bytes(grid.to_bytes()).shape == grid.shape
    assert not list(tmp_path.iterdir())  # nothing is left


def test_codes_have_names(grid, evaluator, poses):
    states = grid.states()
    assert np.count_nonzero(states == viewgain.VoxelState.FREE) == grid.statistics()["free"]
    kinds = evaluator.trace(poses[0])["kind"]
    assert {viewgain.HitKind(int(kind)).name for kind in np.unique(kinds)} <= {"NONE", "UNKNOWN", "OCCUPIED"}
    assert evaluator.evaluate_detailed(poses[0])["status"] == viewgain.ViewStatus.OK
    assert viewgain.FeasibilityChecker(evaluator.scene).reasons(poses[0]) == viewgain.Infeasibility.NONE
    for enumeration, names in ((viewgain.ViewStatus, viewgain.VIEW_STATUS_NAMES), (viewgain.HitKind, viewgain.HIT_KIND_NAMES),
                               (viewgain.Infeasibility, viewgain.INFEASIBILITY_NAMES)):
        assert [member.name.lower() for member in enumeration] == list(names)
        assert enumeration.__doc__ and pickle.loads(pickle.dumps(enumeration(0))) is enumeration(0)


def test_results_of_several_things_are_named_tuples(grid, sensor, evaluator, poses, tmp_path):
    frames = viewgain.FrameIntegrator(sensor).integrate(grid.clone(), np.full((144, 176), 0.5), poses[0])
    clouds = viewgain.CloudIntegrator(sensor).integrate(grid.clone(), [[0.0, 0.0, 0.5]], poses[0])
    viewgain.write_poses(tmp_path / "poses.txt", poses[:2], [0.5, 1.5])
    (tmp_path / "cloud.ply").write_text("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                        "property float z\nend_header\n1 2 3\n")
    planner = viewgain.ViewPlanner(sensor, voxel_size=0.02, workspace=[[-0.16] * 3, [0.16] * 3])
    planner.add_poses(poses)
    results = [frames, clouds, grid.statistics(), sensor.sigmas(1.0), evaluator.best(poses, 2),
               evaluator.best_set(poses, 2), evaluator.plan_tour(poses, max_stops=2), viewgain.load_cloud(tmp_path / "cloud.ply"),
               viewgain.read_timed_poses(tmp_path / "poses.txt"),
               viewgain.SimulatedSensor(*box_mesh([-0.1] * 3, [0.1] * 3), sensor).acquire(poses[0]),
               planner.add(np.full((144, 176), 0.5), poses[0]), planner.propose(), planner.rank(2), evaluator.outcomes(poses[0])]
    fields = 0
    for result in results:
        kind = type(result)
        assert getattr(viewgain, kind.__name__) is kind and kind.__module__ == "viewgain" and kind.__doc__
        assert repr(result).startswith(f"{kind.__name__}({kind._fields[0]}=")
        assert repr(pickle.loads(pickle.dumps(result))) == repr(result)
        for name, value in zip(kind._fields, result):
            assert getattr(result, name) is value is result[name] and len(getattr(kind, name).__doc__) > 3
            assert not getattr(kind, name).__doc__.startswith("Alias")
            fields += 1
        assert "Annotated" not in str(inspect.signature(kind))
        with pytest.raises(KeyError):
            result["count_of_nothing"]
        assert result[0] is next(iter(result)) and len(result[:1]) == 1
    assert len(results) == 14 and fields == 2 * 7 + 5 + 2 + 7 + 4 + 4 + 2 + 2 + 2 + 14 + 3 + 6 + 7
    assert frames.readings + frames.out_of_range + frames.invalid + frames.plane_readings == 144 * 176
    assert clouds.readings == 1 and results[8].timestamps.tolist() == [0.5, 1.5]


def test_grids_and_regions_are_equal_by_value(grid, poses):
    other = grid.clone()
    assert grid == other and not grid != other and grid != "grid"
    other.set([[0, 0, 0]], [3.0])
    assert grid != other
    with pytest.raises(TypeError, match="unhashable"):
        hash(grid)
    parts = dict(boxes=[[[0, 0, 0], [1, 1, 1]]], shells=[[0, 0, 0, 0.1, 1]], half_spaces=[[0, 0, 1, 0.1]], poses=poses[:2])
    region = viewgain.ReachRegion(**parts)
    assert region == viewgain.ReachRegion(**parts) and viewgain.ReachRegion() == viewgain.ReachRegion()
    changes = dict(boxes=[[[0, 0, 0], [1, 1, 2]]], shells=[[0, 0, 0, 0.1, 2]], half_spaces=[[0, 1, 1, 0.1]], poses=poses[:1],
                   distance=0.5, angle=0.5, predicate=lambda pose: True)
    for name, value in changes.items():
        changed = viewgain.ReachRegion(**{**parts, name: value})
        assert changed == changed and changed != region, name


class OtherArray:
    """What another library's array shows of itself: DLPack alone."""

    def __init__(self, array, device=1):
        self.array, self.device, self.exports = np.array(array), device, 0

    def __dlpack__(self, **_):
        self.exports += 1
        return self.array.__dlpack__()

    def __dlpack_device__(self):
        return self.device, 0


def test_arrays_of_other_libraries_come_in_by_dlpack(grid, labels, sensor, evaluator, poses):
    depth, points = np.full((144, 176), 0.5, np.float32), np.array([[0.0, 0.0, 0.5], [0.1, 0.0, 0.6]])

    def frame(image, pose):
        copied = grid.clone()
        viewgain.FrameIntegrator(sensor).integrate(copied, image, pose)
        return copied.content_hash()

    def cloud(where, pose):
        copied = grid.clone()
        viewgain.CloudIntegrator(sensor).integrate(copied, where, pose)
        return copied.content_hash()

    calls = [(evaluator.evaluate, [poses]), (evaluator.evaluate, [poses.astype(np.float32)]), (frame, [depth, poses[0]]),
             (frame, [depth.astype(float), poses[0]]), (cloud, [points, poses[0]]), (grid.index_of, [points]),
             (sensor.camera.project, [points]), (lambda x: viewgain.look_at(x, [0, 0, 0]), [points]),
             (lambda x: viewgain.BeliefGrid.from_labels(x, voxel_size=0.01, sensor=sensor).content_hash(), [labels])]
    for call, arrays in calls:
        others = [OtherArray(array) for array in arrays]
        assert np.array_equal(call(*others), call(*arrays))
        assert all(other.exports > 0 for other in others)
    for device in (2, 8, 10):  # CUDA, Metal, ROCm
        with pytest.raises(ValueError, match="T_world_camera must be .* in the memory of the CPU"):
            evaluator.evaluate(OtherArray(poses, device))
    with pytest.raises(ValueError, match=r"depth must be floating point in metres .*astype\(numpy.float32\) / 1000\), not dtype uint16"):
        frame(OtherArray(depth.astype(np.uint16)), poses[0])
    with pytest.raises(ValueError, match=r"shape \(..., 4, 4\), .* not \(2, 3\)"):
        evaluator.evaluate(OtherArray(points))


def test_matplotlib_is_imported_when_something_is_drawn():
    program = "import sys, viewgain; viewgain.plot; assert 'matplotlib' not in sys.modules"
    subprocess.run([sys.executable, "-c", program], check=True)


def test_pictures_show_what_they_are_given(evaluator, poses):
    pytest.importorskip("matplotlib").use("agg")
    import matplotlib.pyplot as plt

    values = evaluator.evaluate(poses)
    axes = viewgain.plot.gains(poses, values)
    azimuth, elevation = axes.collections[0].get_offsets().T
    assert len(azimuth) == len(poses) and np.allclose(axes.collections[0].get_array(), values)
    best = int(np.argmax(values))
    assert np.allclose(np.concatenate(axes.lines[0].get_xydata()), [azimuth[best], elevation[best]])
    assert np.isclose(elevation[best], np.degrees(np.arcsin(poses[best, 2, 3] / 0.6)))

    seen = evaluator.depth(poses[0])
    drawn = viewgain.plot.depth(seen).images[0].get_array()
    assert np.array_equal(drawn.mask, ~np.isfinite(seen)) and np.allclose(drawn.compressed(), seen[np.isfinite(seen)])

    drawn = viewgain.plot.contributions(evaluator, poses[0]).images[0].get_array()
    assert np.isclose(drawn.sum(), evaluator.evaluate(poses[0])) and drawn.count() > 0

    assert len(plt.get_fignums()) == 3
    plt.close("all")


def test_pictures_of_what_cannot_be_drawn_say_why(evaluator, poses, sensor):
    pytest.importorskip("matplotlib").use("agg")
    surface = viewgain.GainEvaluator(evaluator.scene, sensor, gain="surface", pixel_stride=8)
    cases = [(lambda: viewgain.plot.gains(poses, [1.0]), "one value per pose"),
             (lambda: viewgain.plot.gains(poses[:2], [np.nan, np.nan]), "none of the values is finite"),
             (lambda: viewgain.plot.gains(poses[0], 1.0), "one value per pose"),
             (lambda: viewgain.plot.depth([1.0]), "two dimensions"),
             (lambda: viewgain.plot.contributions(surface, poses[0]), "'surface'")]
    for call, message in cases:
        with pytest.raises(ValueError, match=message):
            call()


def test_the_tutorial_on_depth_images_runs(tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.path.join(os.environ["VIEWGAIN_EXAMPLES"], "depth_images.py"))
    printed = capsys.readouterr().out
    assert "of 500 are possible" in printed and "of the workspace known" in printed
    for name in ("depth.png", "gains.png", "why.png", "known.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"
