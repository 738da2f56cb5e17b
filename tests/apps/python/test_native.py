# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""What makes the package feel like Python: names, equality, pickles, codes with names, pictures."""
import copy
import importlib.util
import inspect
import multiprocessing
import os
import pickle
import runpy
import subprocess
import sys

import numpy as np
import pytest

import viewgain


def hash_of(grid):
    return grid.content_hash()


def test_all_is_of_the_package_that_users_import():
    modules = ["viewgain"] + ["viewgain.mesh"] * (importlib.util.find_spec("viewgain.mesh") is not None)
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
    assert len(others) == 13
    for other in others:
        assert sensor != other
    assert sensor != "sr4000"
    assert len({sensor, again, *others}) == 14


def test_a_grid_goes_through_bytes_and_pickles(grid, sensor):
    full = grid.clone()
    viewgain.FrameIntegrator(sensor).integrate(
        full, np.full((144, 176), 0.5, np.float32), viewgain.look_at([0.5, 0, 0], [0, 0, 0]))
    checked = 0
    for one in (grid, full):
        again = viewgain.BeliefGrid.from_bytes(one.to_bytes())
        assert again.content_hash() == one.content_hash() and np.array_equal(again.views(), one.views())
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            assert pickle.loads(pickle.dumps(one, protocol)).content_hash() == one.content_hash()
            checked += 1
        for copied in (copy.copy(one), copy.deepcopy(one), copy.deepcopy([one])[0]):
            before = one.content_hash()
            copied.set([[0, 0, 0]], [3.0])
            assert one.content_hash() == before != copied.content_hash()
    assert checked == 2 * (pickle.HIGHEST_PROTOCOL + 1)


def test_bytes_that_are_no_map_are_refused(grid, tmp_path, monkeypatch):
    data = grid.to_bytes()
    for bad in (b"", b"no map", data[:-1], data[: len(data) // 2], data[:100] + b"x" + data[101:]):
        with pytest.raises(viewgain.Error, match="no map that to_bytes"):
            viewgain.BeliefGrid.from_bytes(bad)
    with pytest.raises(TypeError):
        viewgain.BeliefGrid.from_bytes("text")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    assert viewgain.BeliefGrid.from_bytes(grid.to_bytes()).shape == grid.shape
    assert not list(tmp_path.iterdir())  # nothing is left


def test_a_subclass_of_the_grid_is_not_pickled_as_another_class():
    class Mine(viewgain.BeliefGrid):
        pass

    mine = Mine(voxel_size=0.1, workspace=[[0, 0, 0], [1, 1, 1]], prior_sigma=0.01)
    with pytest.raises(TypeError, match="cannot pickle 'Mine' object"):
        pickle.dumps(mine)


def test_a_pool_of_processes_gets_grids(grid):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(hash_of, [grid, grid.clone()]) == [grid.content_hash()] * 2


def test_codes_have_names(grid, evaluator, poses):
    states = grid.states()
    assert np.count_nonzero(states == viewgain.VoxelState.FREE) == grid.statistics()["free"]
    kinds = evaluator.trace(poses[0])["kind"]
    assert {viewgain.HitKind(int(kind)).name for kind in np.unique(kinds)} <= {"NONE", "UNKNOWN", "OCCUPIED"}
    assert evaluator.evaluate_detailed(poses[0])["status"] == viewgain.ViewStatus.OK
    assert viewgain.FeasibilityChecker(evaluator.scene).reasons(poses[0]) == viewgain.Infeasibility.NONE
    checked = 0
    for enumeration, names in ((viewgain.ViewStatus, viewgain.VIEW_STATUS_NAMES), (viewgain.HitKind, viewgain.HIT_KIND_NAMES),
                               (viewgain.Infeasibility, viewgain.INFEASIBILITY_NAMES)):
        assert [member.name.lower() for member in enumeration] == list(names)
        assert enumeration.__doc__ and pickle.loads(pickle.dumps(enumeration(0))) is enumeration(0)
        checked += 1
    assert checked == 3


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

    axes = viewgain.plot.coverage([0.2, 0.5, 0.7], label="a")
    assert viewgain.plot.coverage([0.1], label="b", axes=axes) is axes and len(axes.lines) == 2
    assert np.allclose(axes.lines[0].get_xydata(), [[1, 20], [2, 50], [3, 70]])
    assert len(plt.get_fignums()) == 4
    plt.close("all")


def test_pictures_of_what_cannot_be_drawn_say_why(evaluator, poses, sensor):
    pytest.importorskip("matplotlib").use("agg")
    surface = viewgain.GainEvaluator(evaluator.scene, sensor, gain="surface", pixel_stride=8)
    cases = [(lambda: viewgain.plot.gains(poses, [1.0]), "not one a pose"),
             (lambda: viewgain.plot.gains(poses[:2], [np.nan, np.nan]), "no value is a number"),
             (lambda: viewgain.plot.gains(poses[0], 1.0), "not one a pose"),
             (lambda: viewgain.plot.depth([1.0]), "two dimensions"),
             (lambda: viewgain.plot.coverage([[1.0]]), "one dimension"),
             (lambda: viewgain.plot.contributions(surface, poses[0]), "'surface'")]
    for call, message in cases:
        with pytest.raises(ValueError, match=message):
            call()
    assert len(cases) == 6


def test_the_tutorial_on_depth_images_runs(tmp_path, monkeypatch, capsys):
    pytest.importorskip("matplotlib").use("agg")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(os.path.join(os.path.dirname(os.environ["VIEWGAIN_EXAMPLE"]), "depth_images.py"))
    printed = capsys.readouterr().out
    assert "of 500 are possible" in printed and "of the workspace known" in printed
    for name in ("depth.png", "gains.png", "why.png", "known.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"
