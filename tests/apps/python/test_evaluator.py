# SPDX-FileCopyrightText: 2026 The viewgain authors
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from conftest import box_mesh

import viewgain


def test_leading_shape_is_kept_and_a_batch_is_its_poses(evaluator, poses):
    gains = evaluator.evaluate(poses)
    assert gains.shape == (60,) and gains.dtype == np.float64
    assert np.array_equal(evaluator.evaluate(poses.reshape(5, 12, 4, 4)), gains.reshape(5, 12))
    assert evaluator.evaluate(poses[:0]).shape == (0,)
    assert evaluator.evaluate(poses.reshape(5, 12, 4, 4)[:0]).shape == (0, 12)
    singles = [evaluator.evaluate(pose) for pose in poses]
    assert all(isinstance(gain, np.float64) for gain in singles)
    assert np.array_equal(singles, gains)
    assert np.count_nonzero(gains > 0) == 60


def test_any_real_dtype_and_any_strides(evaluator, poses):
    gains = evaluator.evaluate(poses)
    assert np.array_equal(evaluator.evaluate(np.asfortranarray(poses)), gains)
    assert np.array_equal(evaluator.evaluate(poses[::-1])[::-1], gains)
    assert np.array_equal(evaluator.evaluate(poses.astype(">f8")), gains)
    assert np.array_equal(evaluator.evaluate(poses.tolist()), gains)
    single = poses.astype(np.float32)
    assert np.array_equal(evaluator.evaluate(single), evaluator.evaluate(single.astype(np.float64)))


@pytest.mark.parametrize("criterion", ["log_diagonal", "log_determinant", "trace"])
def test_choices_agree_with_the_gains(grid, sensor, poses, criterion):
    assert criterion in viewgain.criterion_names()
    evaluator = viewgain.GainEvaluator(
        viewgain.VoxelScene(grid), sensor, gain="paper", pixel_stride=4, criterion=criterion)
    gains = evaluator.evaluate(poses)
    order = np.argsort(-gains, kind="stable")
    best = evaluator.best(poses.reshape(2, 30, 4, 4), k=5)
    assert best.indices.dtype == np.int64 and np.array_equal(best.indices, order[:5])
    assert np.array_equal(best.gains["gain"], gains[best.indices]) and np.array_equal(best.worth, gains[best.indices])
    raced = evaluator.race(poses, k=2)
    assert raced.complete and np.array_equal(raced.gains["gain"], gains[raced.indices])
    late = evaluator.race(poses, k=2, deadline=1e6)
    assert np.array_equal(late.indices, raced.indices) and np.array_equal(late.gains["gain"], gains[raced.indices])
    assert late.estimated in (0, 60) and np.array_equal(late.scored_gains["gain"], gains[late.scored])
    none = evaluator.race(poses, deadline=0)
    assert none.indices.size == none.estimated == none.scored.size == 0 and not none.complete
    for tracer in ("embree", "sweep"):
        traced = viewgain.GainEvaluator(evaluator.scene, sensor, gain="paper", pixel_stride=4, criterion=criterion, tracer=tracer)
        assert np.array_equal(traced.evaluate(poses), gains)
    with pytest.raises(ValueError, match="valid values: automatic, embree, sweep"):
        viewgain.GainEvaluator(evaluator.scene, sensor, tracer="bvh")
    chosen = evaluator.best_set(poses, 3)
    assert chosen.indices[0] == order[0] and chosen.gains["gain"][0] == gains[order[0]]
    assert chosen.complete and np.isclose(chosen.gain, chosen.gains["gain"].sum(), rtol=1e-9)
    estimates = evaluator.approximate(poses, share=0.5)
    assert estimates.shape == (60,) and np.all(estimates["standard_error"] >= 0)
    whole = evaluator.approximate(poses, share=1)
    assert np.array_equal(whole["gain"], gains) and np.all(whole["standard_error"] == 0)
    assert np.all(whole["rays"] == evaluator.evaluate_detailed(poses)["rays"]) and np.all(estimates["rays"] < whole["rays"])


def test_bad_poses_are_nan_or_refused(evaluator, poses):
    bad = poses[:7].copy()
    bad[1, 0, 0] = np.nan
    bad[2, 3] = [0, 0, 1, 1]
    bad[3, :3, :3] *= 1.01
    bad[4, :3, 0] *= -1
    bad[5, 0, 3] = np.inf
    gains = evaluator.evaluate(bad)
    assert np.array_equal(np.isnan(gains), [False, True, True, True, True, True, False])
    views = evaluator.evaluate_detailed(bad)
    assert viewgain.VIEW_STATUS_NAMES[views["status"][1]] == "bad_pose"
    for index, what in [(1, "not finite"), (2, "last row"), (3, "orthonormal"), (4, "orthonormal"),
                        (5, "not finite")]:
        with pytest.raises(ValueError, match=rf"T_world_camera\[{index}\].*{what}"):
            evaluator.evaluate(bad[: index + 1][[0] * index + [index]], strict=True)
    with pytest.raises(ValueError, match=r"T_world_camera\[1, 0\]"):
        evaluator.evaluate_detailed(bad[[0, 6, 1, 0]].reshape(2, 2, 4, 4), strict=True)
    assert 1 not in evaluator.best(bad, k=2).indices


def test_wrong_shapes_and_dtypes_are_named(evaluator, poses):
    for wrong, text in [(np.zeros((4, 3)), r"\(4, 3\)"), (np.zeros((5, 3, 3)), r"\(5, 3, 3\)"),
                        (np.zeros(16), r"\(16,\)"), (np.float64(1), r"\(\)")]:
        for call in (evaluator.evaluate, evaluator.best, evaluator.race, evaluator.approximate,
                     evaluator.depth, evaluator.contributions, evaluator.trace):
            with pytest.raises(ValueError, match=text):
                call(wrong)
    with pytest.raises(ValueError, match="complex128"):
        evaluator.evaluate(poses.astype(complex))
    with pytest.raises(ValueError, match="<U"):
        evaluator.evaluate(poses.astype(str))
    with pytest.raises(ValueError, match=r"the shape \(4, 4\), \(3, 4\) or \(7,\) of one pose, not \(60, 4, 4\)"):
        evaluator.depth(poses)
    with pytest.raises(ValueError, match=r"the shape \(3,\), not \(2,\)"):
        viewgain.sphere_poses(3, 1.0, center=(0, 0))
    with pytest.raises(TypeError):
        evaluator.evaluate(poses, True)
    with pytest.raises(TypeError):
        evaluator.best(poses, k=-1)


def test_what_an_array_raises_passes_through(evaluator):
    class Source:
        def __init__(self, error):
            self.error = error

        def __array__(self, *arguments, **keywords):
            raise self.error("mine")

    for error in (KeyboardInterrupt, MemoryError, KeyError):
        with pytest.raises(error, match="mine"):
            evaluator.evaluate(Source(error))
        with pytest.raises(error, match="mine"):
            viewgain.BeliefGrid.from_labels(Source(error), voxel_size=0.1)
    for error in (TypeError, ValueError):
        with pytest.raises(ValueError, match="T_world_camera must be an array of numbers"):
            evaluator.evaluate(Source(error))
        with pytest.raises(ValueError, match="labels must be whole numbers"):
            viewgain.BeliefGrid.from_labels(Source(error), voxel_size=0.1)


def test_wrong_settings_are_named(grid, sensor, evaluator, poses):
    scene = viewgain.VoxelScene(grid)
    cases = [({"criterion": "entropy"}, "entropy"), ({"pixel_stride": 0}, "stride must be at least 1, not 0"),
             ({"prior_sigma": -1.0}, "prior sigma"), ({"min_range": 9.0}, "min_range"),
             ({"max_range": np.nan}, "max_range"), ({"num_threads": -2}, "-2"),
             ({"weights": [(np.zeros((2, 2)), 1)]}, r"\(2, 2\)"),
             ({"weights": [(1, 2, 3)]}, "pair"),
             ({"weights": [([[0, 0, 0], [1, 1, 1]], -1)]}, "weight must be at least 0 and finite, not -1")]
    for settings, text in cases:
        with pytest.raises(ValueError, match=text):
            viewgain.GainEvaluator(scene, sensor, **settings)
    for weight, text in [("x", "'x'"), (None, "None"), (np.zeros(3), "array")]:
        with pytest.raises(TypeError, match=f"weight must be a number, not.*{text}"):
            viewgain.GainEvaluator(scene, sensor, weights=[([[0, 0, 0], [1, 1, 1]], weight)])
    with pytest.raises(TypeError):
        viewgain.GainEvaluator(grid, sensor)
    with pytest.raises(TypeError):
        viewgain.GainEvaluator(None, "sr4000")
    with pytest.raises(TypeError, match="scene"):
        viewgain.GainEvaluator(None, sensor)
    with pytest.raises(ValueError, match="share"):
        evaluator.approximate(poses, share=7.0)


def test_images_of_a_view(evaluator, poses, sensor):
    hits = evaluator.trace(poses[20])
    depth = evaluator.depth(poses[20])
    assert hits.shape == depth.shape == (36, 44) and depth.dtype == np.float32
    rays = sensor.camera.rays()[::4, ::4]
    expected = hits["range"] / np.linalg.norm(rays, axis=-1)
    assert np.allclose(depth, expected, rtol=1e-5)
    seen = np.isfinite(depth)
    assert np.array_equal(seen, hits["kind"] != viewgain.HIT_KIND_NAMES.index("none"))
    assert 100 < np.count_nonzero(seen) < depth.size
    assert np.count_nonzero(np.isin(hits["kind"], (1, 2))) == evaluator.evaluate_detailed(
        poses[20])["hits"]
    rays = evaluator.outcomes(poses[20])
    assert isinstance(rays, viewgain.RayOutcomes) and rays.rays == depth.size == sum(rays) - rays.rays
    assert (rays.unknown, rays.known_surface) == tuple(
        np.count_nonzero(hits["kind"] == viewgain.HIT_KIND_NAMES.index(kind)) for kind in ("unknown", "occupied"))


def test_a_gain_of_ones_own(evaluator, poses):
    def unknown(T_world_camera, hits):
        assert T_world_camera.shape == (4, 4)
        assert np.allclose(np.linalg.norm(hits["direction"], axis=1), 1)
        return float(len(np.unique(hits["voxel"][hits["state"] == 0], axis=0)))

    batch = poses.copy()
    batch[5, 0, 0] = np.nan
    own = evaluator.evaluate_own(batch.reshape(3, 20, 4, 4), unknown)
    views = evaluator.evaluate_detailed(batch)
    assert own.shape == (3, 20) and np.isnan(own.ravel()[5])
    good = np.isfinite(own.ravel())
    assert np.array_equal(own.ravel()[good], views["unknown_voxels"][good])
    assert np.count_nonzero(good) == 59

    def broken(T_world_camera, hits):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        evaluator.evaluate_own(poses, broken)
    for answer, text in [("no number", "'no number'"), (None, "None"), (np.zeros(3), "array")]:
        with pytest.raises(TypeError, match=f"measure.*{text}"):
            evaluator.evaluate_own(poses, lambda pose, hits: answer)
    assert evaluator.evaluate_own(poses[0], lambda pose, hits: np.float32(2)) == 2
    with pytest.raises(TypeError):
        evaluator.evaluate_own(poses, 3)

    # Chosen by it: of few poses race, too, measures all by all of their rays.
    values = evaluator.evaluate_own(poses, unknown)
    costs = np.arange(60) * 2.0
    for chosen, worth in ((evaluator.best(poses, 5, measure=unknown), values),
                          (evaluator.best(poses, 5, measure=unknown, costs=costs), values - costs),
                          (evaluator.race(poses[:20], 5, measure=unknown), values[:20]),
                          (evaluator.best(poses, 5, costs=costs), evaluator.evaluate(poses) - costs)):
        assert np.array_equal(chosen.indices, np.argsort(-worth, kind="stable")[:5])
        assert np.array_equal(chosen.worth, worth[chosen.indices])
    with pytest.raises(KeyError, match="mine"):
        evaluator.race(poses, measure=broken)
    assert evaluator.best(poses, measure=unknown).gains.size == 0
    with pytest.raises(ValueError, match="costs"):
        evaluator.best(poses, costs=costs[:3])


def test_weights_ranges_and_prior(grid, sensor, poses):
    scene = viewgain.VoxelScene(grid)
    everything = [[-1, -1, -1], [1, 1, 1]]

    def gains(**settings):
        return viewgain.GainEvaluator(scene, sensor, gain="paper", pixel_stride=4, **settings).evaluate(poses)

    plain = gains()

    assert np.all(gains(weights=[(everything, 2.0), (everything, 0.0)]) == 0)
    assert np.all(gains(max_range=0.25) == 0)
    assert np.all(gains(prior_sigma=1.0) > plain)


def test_an_evaluator_follows_a_map(grid, sensor, evaluator, poses):
    before, grown = evaluator.evaluate(poses), grid.clone()
    grown.set([[x, 28, z] for x in range(4, 28) for z in range(10, 28)], 3.0)
    scene = evaluator.scene.update(grown)
    following = evaluator.with_scene(scene)
    fresh = viewgain.GainEvaluator(viewgain.VoxelScene(grown), sensor, gain="paper", pixel_stride=4)
    assert following.scene is scene and following.pixel_stride == 4
    assert np.array_equal(following.evaluate(poses), fresh.evaluate(poses))
    assert np.array_equal(evaluator.evaluate(poses), before)
    assert not np.array_equal(following.evaluate(poses), before)
    with pytest.raises(TypeError, match="scene"):
        evaluator.with_scene(None)


def test_reprs_have_sizes(evaluator, grid, sensor):
    assert repr(grid).startswith("<BeliefGrid 32x32x32 voxels of 0.01 m: ")
    assert repr(evaluator.scene).startswith("<VoxelScene 32x32x32 voxels")
    assert "sr4000, 1584 rays per pose, 2 threads" in repr(evaluator)
    assert repr(sensor) == "<Sensor sr4000, 176x144 px, 0.2-5 m>"
    assert evaluator.criterion == "log_diagonal" and evaluator.pixel_stride == 4
    assert evaluator.prior_sigma == grid.prior_sigma
    assert evaluator.sensor.camera == sensor.camera


def test_the_surface_gain_is_an_area_and_follows_the_hazard(grid, labels, sensor, poses, tmp_path):
    def evaluator(gain, **scene):
        return viewgain.GainEvaluator(viewgain.VoxelScene(grid, **scene), sensor, gain=gain)

    assert viewgain.gain_model_names() == ["paper", "surface", "combined"]
    views = evaluator("surface").evaluate_detailed(poses)
    assert np.array_equal(views["gain"], views["area"])
    assert views["area"].max() > 0 and np.isnan(views["exploration"]).all()
    # What a model does not have is NaN, a count 0. Labels are not refined.
    for gain, parts in (("paper", {"exploration", "refinement", "unknown_voxels", "occupied_voxels"}), ("surface", {"area"}),
                        ("combined", {"area", "occupied_voxels"})):
        rows = evaluator(gain).evaluate_detailed(poses)
        assert {name for name in rows.dtype.names if (np.nan_to_num(rows[name]) != 0).any()} == {"gain", "rays", "hits"} | parts
    assert viewgain.GainEvaluator(viewgain.VoxelScene(grid), sensor).gain == viewgain.DEFAULT_GAIN == "combined"

    same = evaluator("surface", hazard=5.0).evaluate(poses)
    rates = np.full(labels.shape, 5.0)
    assert np.allclose(evaluator("surface", hazard=rates).evaluate(poses), same, rtol=0.02)
    for five in (np.float32(5), np.int64(5), np.array(5.0), 5):
        assert np.array_equal(evaluator("surface", hazard=five).evaluate(poses), same)
    with pytest.raises(ValueError, match="masked"):
        evaluator("surface", hazard=np.ma.masked_equal(rates, 5.0))
    with pytest.raises(ValueError, match="the grid's shape"):
        evaluator("surface", hazard=rates[1:])
    with pytest.raises(FileNotFoundError, match="none.vdb"):
        evaluator("surface", hazard="none.vdb")
    with pytest.raises(ValueError, match="object size"):
        evaluator("surface", hazard=1.0, object_size=0)
    for path in (tmp_path / "map.vdb", str(tmp_path / "map.vdb"), bytes(tmp_path / "map.vdb")):
        grid.save(tmp_path / "map.vdb")
        with pytest.raises(viewgain.Error, match="grids of floats"):
            evaluator("surface", hazard=path)
    with pytest.raises(ValueError, match="hazard"):
        evaluator("surface", hazard=-1.0)
    with pytest.raises(ValueError, match="combined"):
        evaluator("area")
    # What a gain has no use for is refused, not ignored.
    scene = viewgain.VoxelScene(grid)
    with pytest.raises(ValueError, match="refinement_weight"):
        viewgain.GainEvaluator(scene, sensor, gain="surface", refinement_weight=0.3)
    combined = viewgain.GainEvaluator(scene, sensor, gain="combined", refinement_weight=0.5)
    assert combined.gain == "combined" and "combined" in repr(combined)


def test_frames_say_what_the_hazard_is(sensor):
    camera = viewgain.SimulatedSensor(*box_mesh([-0.1] * 3, [0.1] * 3), sensor, background_radius=1.5)
    grid = viewgain.BeliefGrid(voxel_size=0.01, workspace=[[-0.2] * 3, [0.2] * 3], sensor=sensor)
    integrator = viewgain.FrameIntegrator(sensor)
    assert (grid.hazard_factors == np.ones(8)).all()
    for azimuth in (0, 1, 2):
        pose = viewgain.look_at((0.5 * np.cos(azimuth), 0.5 * np.sin(azimuth), 0.3), (0, 0, 0))
        depth, amplitude = camera.acquire(pose)
        before = grid.hazard_factors
        integrator.calibrate_hazard(grid, viewgain.VoxelScene(grid), depth, pose)
        # While no surface is known nothing is to be learnt.
        assert (grid.hazard_factors == before).all() == (azimuth == 0)
        integrator.integrate(grid, depth, pose, amplitude=amplitude)
    with pytest.raises(ValueError, match="depth"):
        integrator.calibrate_hazard(grid, viewgain.VoxelScene(grid), depth[1:], pose)


def test_a_tour_weighs_the_way_and_keeps_to_its_budget(evaluator, poses):
    chosen, marginal = evaluator.best_set(poses, 3)[:2]
    free = evaluator.plan_tour(poses, max_stops=3)
    assert np.array_equal(free.indices, chosen) and free.way == 0
    assert np.array_equal(free.gains["gain"], marginal["gain"]) and np.array_equal(free.worth, marginal["gain"])

    eyes, asked = poses[:, :3, 3], []
    def way(i, j):
        asked.append((i, j))
        if j == chosen[0]:
            return np.inf  # vetoed
        return float(np.linalg.norm(eyes[j] - (eyes[i] if i >= 0 else eyes[0])))
    tour = evaluator.plan_tour(poses, way, max_stops=4, cost_per_way=marginal["gain"][0])
    assert chosen[0] not in tour.indices and 1 <= len(tour.indices) <= 4
    assert tour.way > 0 and np.all(tour.worth <= tour.gains["gain"]) and {i for i, _ in asked} >= {-1}
    assert 0 < evaluator.plan_tour(poses, way, budget=0.8, per_way=True).way <= 0.8
    table = np.array([[way(i, j) for j in range(len(poses))] for i in (*range(len(poses)), -1)])
    same = evaluator.plan_tour(poses, table, max_stops=4, cost_per_way=marginal["gain"][0])
    assert np.array_equal(same.indices, tour.indices) and same.way == tour.way
    given = evaluator.plan_tour(poses, table, max_stops=2, first=int(tour.indices[-1]))
    assert tour.indices[-1] in given.indices
    with pytest.raises(ValueError, match="way must have the shape"):
        evaluator.plan_tour(poses, np.ones((3, 3)))
    with pytest.raises(ValueError, match="way must have one stop per pose; poses: .*, stops: 2"):
        evaluator.plan_tour(poses, np.ones((3, 2)))
    with pytest.raises(KeyError, match="arm"):
        evaluator.plan_tour(poses, lambda i, j: {}["arm"])


def test_stops_are_ordered():
    stops, cost = viewgain.order_stops([[0, 9, 2], [1, 0, 9], [9, 9, 0], [9, 3, 9]])  # from the start to 1, then 0, then 2
    assert stops.tolist() == [1, 0, 2] and cost == 6
    stops, cost = viewgain.order_stops(np.full((3, 2), np.inf))
    assert len(stops) == 0 and cost == np.inf
    assert len(viewgain.order_stops(np.empty((1, 0)))[0]) == 0
    with pytest.raises(ValueError, match=r"\(k \+ 1, k\), not \(2, 2\)"):
        viewgain.order_stops(np.ones((2, 2)))
    with pytest.raises(ValueError, match="from the start to 1 is -1"):
        viewgain.order_stops([[1, 1], [1, 1], [1, -1]])
