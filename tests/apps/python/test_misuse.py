# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
"""Objects that were never initialised, images in other units, masks, empty lists, what is missing."""
import ast
import copy
import importlib
import inspect
import os
import pathlib
import subprocess
import sys

import numpy as np
import pytest
from conftest import box_mesh
from test_package import MODULES, stub_of

import viewgain

SOURCES = pathlib.Path(__file__).parents[3] / "apps" / "python"
WORKSPACE = np.array([[-0.2] * 3, [0.2] * 3])
UNINITIALISED = "has not been called on this object"


def nothing_for(function):
    """Arguments that the stub's method needs: None each, as the object is looked at first."""
    arguments = function.args
    positional = arguments.args[1:len(arguments.args) - len(arguments.defaults)]
    keywords = [argument.arg for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults)
                if default is None]
    return [None] * len(positional), dict.fromkeys(keywords)


def uses_of(owner, node):
    """What can be done with an object of a class, by name."""
    uses = {"repr": repr}
    for function in (part for part in node.body if isinstance(part, ast.FunctionDef)):
        decorated = {ast.unparse(decorator) for decorator in function.decorator_list}
        if function.name == "__init__" or "staticmethod" in decorated:
            continue
        if "property" in decorated:
            uses[function.name] = lambda one, name=function.name: getattr(one, name)
        else:
            positional, keywords = nothing_for(function)
            uses[function.name] = (lambda one, name=function.name, p=positional, k=keywords:
                                   getattr(one, name)(*p, **k))
    if "__eq__" in vars(owner):
        uses["=="] = lambda one: one == one
    return uses


@pytest.mark.parametrize("name", MODULES)
def test_what_was_never_initialised_raises_wherever_it_is_used(name):
    module = importlib.import_module(name)
    stubs = {node.name: node for node in stub_of(module).body if isinstance(node, ast.ClassDef)}
    classes = [one for one in vars(module).values()
               if inspect.isclass(one) and not issubclass(one, Exception)]
    tried = 0
    for one in classes:
        uses = uses_of(one, stubs[one.__name__])
        raw = one.__new__(one)
        for what, use in uses.items():
            with pytest.raises(TypeError, match=f"{one.__name__}.__init__ {UNINITIALISED}"):
                use(raw)
                pytest.fail(f"{one.__name__}: {what}")
            tried += 1
        with pytest.raises(TypeError):
            copy.copy(raw)

        class Early(one):
            def __init__(self, messages):
                for use in uses.values():
                    try:
                        use(self)
                    except TypeError as error:
                        messages.append(str(error))

        messages = []
        with pytest.raises(TypeError, match="__init__"):
            Early(messages)
        assert len(messages) == len(uses) and all(UNINITIALISED in text for text in messages)
    assert len(classes) == (19 if name == MODULES[0] else 2)
    assert tried >= (105 if name == MODULES[0] else 10)


@pytest.fixture(scope="module")
def frame(sensor):
    """A pose, the depth from there and the amplitude."""
    camera = viewgain.SimulatedSensor(*box_mesh([-0.1] * 3, [0.1] * 3), sensor, background_radius=1.5)
    pose = viewgain.look_at([0.45, 0.2, 0.25], [0, 0, 0])
    return pose, *camera.acquire(pose)


def hash_after(sensor, pose, depth, **amplitude):
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    viewgain.FrameIntegrator(sensor).integrate(grid, depth, pose, **amplitude)
    return grid.content_hash()


def hash_after_cloud(sensor, pose, points):
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    viewgain.CloudIntegrator(sensor).integrate(grid, points, pose)
    return grid.content_hash()


def test_images_in_millimetres_are_refused(sensor, frame):
    pose, depth, amplitude = frame
    millimetres = 1000 * depth
    integrator = viewgain.FrameIntegrator(sensor)
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    before = grid.content_hash()
    few_near = millimetres.copy()  # as resizing makes them at the rim of a hole
    few_near[::16, ::16] = 3.8
    cases = [(millimetres.astype(dtype), f"depth must be floating point.*/ 1000.*{np.dtype(dtype)}")
             for dtype in (np.uint16, np.int32, np.uint8, bool)]
    cases += [(millimetres, "depth must be in metres: its nearest reading is at [345]..*max_range of 5 m"),
              (np.where(millimetres < 600, millimetres, np.inf), "depth must be in metres"),
              (np.where(millimetres < 600, millimetres, np.nan).tolist(), "depth must be in metres"),
              (few_near, "depth must be in metres: [0-9]* of its [0-9]* readings are beyond 10 times")]
    for image, text in cases:
        with pytest.raises(ValueError, match=text):
            integrator.integrate(grid, image, pose)
        with pytest.raises(ValueError, match=text):
            viewgain.reading_bounds(sensor, image, pose)
    with pytest.raises(ValueError, match=r"amplitude must be floating point \[1/m\*\*2\], not dtype uint16"):
        integrator.integrate(grid, depth, pose, amplitude=amplitude.astype(np.uint16))
    assert grid.content_hash() == before


def test_clouds_in_millimetres_are_refused(sensor, frame):
    pose, depth, _ = frame
    points = (sensor.camera.rays() * depth[..., None]).reshape(-1, 3)
    for call in (lambda: hash_after_cloud(sensor, pose, 1000 * points),
                 lambda: viewgain.cloud_bounds(sensor, 1000 * points, pose)):
        with pytest.raises(ValueError, match="points must be in metres"):
            call()
    points[::2] *= 1000
    assert viewgain.cloud_bounds(sensor, points, pose) is not None


def test_masked_pixels_and_points_say_nothing(sensor, frame):
    pose, depth, amplitude = frame
    mask = np.zeros(depth.shape, bool)
    mask[60:90, 70:110] = True
    masked, gaps = np.ma.array(depth, mask=mask), np.where(mask, np.nan, depth)
    whole = hash_after(sensor, pose, depth)
    assert hash_after(sensor, pose, masked) == hash_after(sensor, pose, gaps) != whole
    assert hash_after(sensor, pose, np.ma.array(depth)) == whole
    of_masked = hash_after(sensor, pose, depth, amplitude=np.ma.array(amplitude, mask=mask))
    assert of_masked == hash_after(sensor, pose, depth, amplitude=np.where(mask, np.nan, amplitude))
    assert of_masked != hash_after(sensor, pose, depth, amplitude=amplitude)
    inside = np.ma.array(depth, mask=~mask)
    assert np.array_equal(viewgain.reading_bounds(sensor, inside, pose),
                          viewgain.reading_bounds(sensor, np.where(mask, depth, 0), pose))

    points = (sensor.camera.rays() * depth[..., None]).reshape(-1, 3)
    rows = np.repeat(mask.reshape(-1, 1), 3, axis=1)
    of_masked = hash_after_cloud(sensor, pose, np.ma.array(points, mask=rows))
    assert of_masked == hash_after_cloud(sensor, pose, points[~mask.ravel()])
    assert of_masked != hash_after_cloud(sensor, pose, points)


def test_masks_elsewhere(labels, sensor, evaluator, poses):
    mask = np.zeros(labels.shape, bool)
    mask[5:9] = True
    grid = viewgain.BeliefGrid.from_labels(
        np.ma.array(labels, mask=mask), voxel_size=0.01, sensor=sensor)
    assert np.array_equal(grid.states(), np.where(mask, 0, labels))
    assert np.array_equal(evaluator.evaluate(np.ma.array(poses)), evaluator.evaluate(poses))
    hidden = np.ma.array(poses, mask=np.zeros(poses.shape, bool))
    hidden[3] = np.ma.masked
    for call in (evaluator.evaluate, evaluator.best, viewgain.ReachRegion().contains,
                 lambda masked: viewgain.ReachRegion(poses=masked)):
        with pytest.raises(ValueError, match="masked entries"):
            call(hidden)


def test_empty_lists_are_empty(grid, sensor, evaluator, poses):
    scene, checker = evaluator.scene, viewgain.FeasibilityChecker(evaluator.scene)
    results = [evaluator.evaluate([]), evaluator.evaluate_detailed([]), evaluator.approximate([]),
               evaluator.evaluate_own([], lambda pose, hits: 1.0), evaluator.best([], k=2).indices,
               evaluator.race([]).indices, evaluator.best_set([], 3).indices, checker.feasible([]), checker.reasons([]),
               viewgain.ReachRegion().contains([])]
    for result in results:
        assert result.shape == (0,)
    assert viewgain.look_at([], [0, 0, 0]).shape == (0, 4, 4)
    assert sensor.camera.project([]).shape == (0, 2)
    assert np.array_equal(checker.reasons(poses, taken=[]), checker.reasons(poses))
    region = viewgain.ReachRegion(boxes=[], shells=[], half_spaces=[], poses=[])
    assert repr(region) == "<ReachRegion 0 boxes, 0 shells, 0 half-spaces, 0 poses>"
    assert region.contains(poses).all()
    bare = viewgain.VoxelScene(grid, boxes=[], meshes=[])
    gains = viewgain.GainEvaluator(bare, sensor, gain="paper", pixel_stride=4, weights=[]).evaluate(poses)
    assert np.array_equal(gains, evaluator.evaluate(poses))
    assert bare.primitive_count == scene.primitive_count
    map_of_nothing = viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, sensor=sensor)
    report = viewgain.CloudIntegrator(sensor).integrate(map_of_nothing, [], poses[0])
    assert set(report) == {0}
    assert viewgain.cloud_bounds(sensor, [], poses[0]) is None
    for call in (lambda: evaluator.depth([]), lambda: viewgain.VoxelScene(grid, boxes=[[]]),
                 lambda: viewgain.sphere_poses(3, 1.0, center=[])):
        with pytest.raises(ValueError, match="shape"):
            call()


def test_endings_say_the_format_or_are_refused(tmp_path, grid, sensor, poses):
    writers = [(grid.save, ["m.h5", "m"], ".vdb or .ot"),
               (sensor.save, ["s.yaml", "s"], ".toml"), (viewgain.ReachRegion().save, ["r.json"], ".toml"),
               (lambda path: viewgain.write_poses(path, poses), ["p.csv", "p"], ".txt, .tum or .npy")]
    for write, names, text in writers:
        for name in names:
            with pytest.raises(ValueError, match=f"{name}.*must have the ending {text}"):
                write(tmp_path / name)
    with pytest.raises(ValueError, match="m.bt: .bt files can only be read; write a .ot file"):
        grid.save(tmp_path / "m.bt")
    assert os.listdir(tmp_path) == []
    for name in ("p.npy", "p.txt", "p.tum"):
        viewgain.write_poses(tmp_path / name, poses, np.arange(len(poses)) + 0.5)
        again, times = viewgain.read_timed_poses(tmp_path / name)
        assert np.allclose(again, poses, atol=1e-12) and times[1] == 1.5, name
    assert set(np.load(tmp_path / "p.npy").dtype.names) == {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"}
    for dtype in (np.float32, np.float64):
        for order in "CF":
            np.save(tmp_path / "m.npy", np.asarray(poses, dtype=dtype, order=order))
            assert np.allclose(viewgain.read_poses(tmp_path / "m.npy"), poses, atol=1e-6), (dtype, order)


def test_readers_of_maps_name_one_another(tmp_path, grid):
    grid.save(tmp_path / "map.ot")
    (tmp_path / "map.ot").rename(tmp_path / "map.bt")
    (tmp_path / "map.bt").rename(tmp_path / "map.vdb")
    with pytest.raises(viewgain.Error, match="map.vdb.*OctoMap.*end in .ot or .bt"):
        viewgain.BeliefGrid.load(tmp_path / "map.vdb")
    grid.save(tmp_path / "map.vdb")
    for given in ({"prior_sigma": 0.01}, {"workspace": WORKSPACE}, {"occupied_from": 0.5}):
        with pytest.raises(ValueError, match=r"map.vdb: workspace, prior_sigma and occupied_from "
                                             r"require an OctoMap file \(.ot or .bt\); a .vdb file defines them"):
            viewgain.BeliefGrid.load(tmp_path / "map.vdb", **given)
    (tmp_path / "map.vdb").rename(tmp_path / "map.ot")
    with pytest.raises(viewgain.Error, match="map.ot"):
        viewgain.BeliefGrid.load(tmp_path / "map.ot", prior_sigma=0.01)


def test_the_prior_is_never_guessed(tmp_path, labels, grid, sensor):
    path = tmp_path / "map.ot"
    grid.save(path)
    makers = [lambda **prior: viewgain.BeliefGrid.from_labels(labels, voxel_size=0.01, **prior),
              lambda **prior: viewgain.BeliefGrid(voxel_size=0.01, workspace=WORKSPACE, **prior),
              lambda **prior: viewgain.BeliefGrid.load(path, **prior)]
    for make in makers:
        with pytest.raises(ValueError, match="sensor.*prior_sigma"):
            make()
        assert make(prior_sigma=0.0125).prior_sigma == 0.0125
        assert make(sensor=sensor).prior_sigma == viewgain.default_prior_sigma(0.01, sensor)
        assert make(prior_sigma=0.0125, sensor=sensor).prior_sigma == 0.0125


def test_a_python_without_numpy_is_told_so():
    program = """
import sys
sys.modules["numpy"] = None  # as if it were not there
try:
    import viewgain
except ImportError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0 and done.stderr == ""
    assert done.stdout.startswith("viewgain needs numpy")


def test_the_mesh_part_says_when_it_was_not_built(tmp_path):
    built = os.path.dirname(viewgain.__file__)
    import_it = [sys.executable, "-c", "import viewgain; print(viewgain.__version__); import viewgain.mesh"]
    # Without its folder, with an empty one, with one that lacks the extension alone.
    for case, names in [("none", None), ("empty", []), ("python", ["__init__.py", "results.py"])]:
        package = tmp_path / case / "viewgain"
        package.mkdir(parents=True)
        for entry in os.listdir(built):
            if entry not in ("mesh", "__pycache__"):
                (package / entry).symlink_to(os.path.join(built, entry))
        if names is not None:
            (package / "mesh").mkdir()
            for name in names:
                (package / "mesh" / name).symlink_to(SOURCES / "viewgain" / "mesh" / name)
        done = subprocess.run(import_it, env={**os.environ, "PYTHONPATH": str(tmp_path / case)}, capture_output=True, text=True)
        assert done.returncode != 0 and done.stdout.strip() == viewgain.__version__, case
        assert "ImportError: viewgain.mesh was not built" in done.stderr, done.stderr
        assert "VIEWGAIN_BUILD_MESH=ON" in done.stderr and "libcgal-dev" in done.stderr, case


def test_a_wrong_call_is_told_in_a_line(sensor, evaluator, poses):
    scorer = viewgain.ViewScorer
    cases = [(lambda: scorer(sensor, voxelsize=0.01), r"^ViewScorer\(\): unknown argument 'voxelsize'; did you mean 'voxel_size'\?$"),
             (lambda: scorer.load("m.vdb", sensor, stride=2), r"^ViewScorer\(\): unknown argument 'stride'; did you mean 'pixel_stride'\?$"),
             (lambda: evaluator.evaluate(pose=poses), r"^GainEvaluator.evaluate\(\): unknown argument 'pose'; did you mean"),
             (lambda: evaluator.best(poses, n=2), "unknown argument 'n'"),
             (lambda: evaluator.best(), r"^GainEvaluator.best\(\): the argument 'T_world_camera' is missing$"),
             (lambda: evaluator.evaluate(poses, True), "2 positional arguments are too many; at most 1, and others by keyword"),
             (lambda: evaluator.best(poses, "2"), r"^GainEvaluator.best\(\): k must be int, not str$"),
             (lambda: evaluator.best(poses, k=-1), r"^GainEvaluator.best\(\): k must be at least 0, not -1$"),
             (lambda: evaluator.race(poses, deadline="soon"), "deadline must be float, not str"),
             (lambda: viewgain.sphere_poses(10, radius=None), r"^sphere_poses\(\): radius must be float, not NoneType$"),
             (lambda: viewgain.BeliefGrid.load("m.vdb", prior=1), "BeliefGrid.load.*did you mean 'prior_sigma'"),
             (lambda: viewgain.mesh.reconstruct_surface(poses, toward=poses), "^reconstruct_surface.*did you mean 'toward_free'")]
    for call, text in cases:
        with pytest.raises(TypeError, match=text) as error:
            call()
        assert "\n" not in str(error.value) and len(str(error.value)) < 160
    assert len(cases) == 12
    with pytest.raises(TypeError, match="incompatible"):  # pybind11's own words
        evaluator.best(poses, k=poses)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_poses_in_every_form(evaluator, poses, dtype):
    poses = poses.astype(dtype)
    wanted = evaluator.evaluate(poses)
    assert wanted.shape == (60,) and wanted.max() > 0
    assert np.array_equal(evaluator.evaluate(poses[:, :3]), wanted)
    assert np.array_equal(evaluator.evaluate(np.asfortranarray(poses)), wanted)
    assert np.array_equal(evaluator.evaluate(poses[::-1])[::-1], wanted)
    assert np.array_equal(evaluator.evaluate(poses.reshape(3, 4, 5, 4, 4)), wanted.reshape(3, 4, 5))
    assert evaluator.evaluate(poses[0, :3]) == wanted[0]


def test_poses_as_quaternions(tmp_path, evaluator, poses):
    viewgain.write_poses(tmp_path / "p.npy", poses)
    table = np.load(tmp_path / "p.npy")
    rows = np.stack([table[name] for name in ("tx", "ty", "tz", "qx", "qy", "qz", "qw")], axis=-1)
    assert np.array_equal(evaluator.evaluate(rows), evaluator.evaluate(viewgain.read_poses(tmp_path / "p.npy")))
    assert evaluator.evaluate(rows[3]) == evaluator.evaluate(rows)[3]
    assert evaluator.evaluate(rows.reshape(2, 30, 7)).shape == (2, 30)
    opposite = np.hstack([rows[:, :3], -rows[:, 3:]])  # the same rotations
    assert np.array_equal(evaluator.evaluate(opposite), evaluator.evaluate(rows))
    scaled = rows.copy()
    scaled[1, 3:] *= 1.02
    scaled[2, 3:] = 0
    assert np.flatnonzero(np.isnan(evaluator.evaluate(scaled))).tolist() == [1, 2]
    with pytest.raises(ValueError, match=r"T_world_camera\[1\] has a quaternion of norm 1.02, not 1"):
        evaluator.evaluate(scaled, strict=True)
    for wrong in (rows[:, :6], np.zeros((2, 5, 4)), 1.0):
        with pytest.raises(ValueError, match=r"must have the shape \(..., 4, 4\), \(..., 3, 4\) or \(..., 7\)"):
            evaluator.evaluate(wrong)
    with pytest.raises(ValueError, match=r"of one pose, not \(2, 7\)"):
        evaluator.trace(rows[:2])
    assert evaluator.trace(rows[0]).shape == evaluator.trace(poses[0]).shape
