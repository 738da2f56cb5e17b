// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Scenes of many primitives and of many cells. Rays and gains against the oracle under each
// instruction set, also where cells are few in nodes of 128³ voxels and where they are many.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "oracle/gain.hpp"
#include "oracle_tally.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

/// Of cubes, as many as are in use at least, or at most.
constexpr std::size_t kManyCubes = 4096;

/// A map of free voxels and, in every cube of `cube` voxels an edge, some specks. Those of many
/// cells are slabs of four voxels with a border of cells in their middle.
struct Layout {
  const char* name;
  int coarse;  ///< voxels an edge of cubes of which few are in use; of half of that, many are
  Index3 min, dims;
  int cube;
  int specks;
};
#ifndef VIEWGAIN_SLOW_BUILD
constexpr std::size_t kPoses = 6;
constexpr std::array kLayouts{Layout{"Cells32", 32, {-37, 5, -70}, {150, 141, 139}, 8, 1},
                              Layout{"Cells64", 64, {-750, -750, -2}, {1500, 1500, 4}, 32, 2},
                              Layout{"Cells128", 128, {-1472, -1472, -2}, {2944, 2944, 4}, 64, 8}};
#else
constexpr std::size_t kPoses = 2;
constexpr std::array kLayouts{Layout{"Cells32", 32, {-37, 5, -70}, {150, 141, 139}, 8, 1},
                              Layout{"Cells64", 64, {-750, -750, -1}, {1500, 1500, 2}, 32, 2}};
#endif
constexpr double kVoxel = 0.02;  // [m]

/// Calls visit(low, high) for the cubes of the lattice, as far as they lie in the workspace.
template <typename Visit>
void for_each_cube(const Layout& layout, Visit&& visit) {
  const std::array<int, 3> min{layout.min.x, layout.min.y, layout.min.z};
  const std::array<int, 3> dims{layout.dims.x, layout.dims.y, layout.dims.z};
  const auto below = [&](int v) { return v & ~(layout.cube - 1); };
  std::array<int, 3> at{};
  for (at[0] = below(min[0]); at[0] < min[0] + dims[0]; at[0] += layout.cube) {
    for (at[1] = below(min[1]); at[1] < min[1] + dims[1]; at[1] += layout.cube) {
      for (at[2] = below(min[2]); at[2] < min[2] + dims[2]; at[2] += layout.cube) {
        std::array<int, 3> low{}, high{};
        for (std::size_t k = 0; k < 3; ++k) {
          low[k] = std::max(at[k], min[k]);
          high[k] = std::min(at[k] + layout.cube, min[k] + dims[k]);
        }
        visit(low, high);
      }
    }
  }
}

BeliefGrid map_of(const Layout& layout, test::Random& random) {
  const auto face = [](int i) { return kVoxel * i; };
  const Index3 &min = layout.min, &dims = layout.dims;
  const GridConfig config{
      .voxel_size = kVoxel,
      .workspace = {{face(min.x), face(min.y), face(min.z)},
                    {face(min.x + dims.x), face(min.y + dims.y), face(min.z + dims.z)}},
      .T_world_grid = test::random_rigid(random, 3),
      .prior_sigma = 0.012};
  std::vector<std::uint8_t> states(static_cast<std::size_t>(dims.x) *
                                       static_cast<std::size_t>(dims.y) *
                                       static_cast<std::size_t>(dims.z),
                                   1);
  for_each_cube(layout, [&](const std::array<int, 3>& low, const std::array<int, 3>& high) {
    for (int i = 0; i < layout.specks; ++i) {
      std::array<std::size_t, 3> at{};
      const std::array<int, 3> origin{min.x, min.y, min.z};
      for (std::size_t k = 0; k < 3; ++k) {
        at[k] =
            static_cast<std::size_t>(test::uniform_int(random, low[k], high[k] - 1) - origin[k]);
      }
      states[(at[0] * static_cast<std::size_t>(dims.y) + at[1]) * static_cast<std::size_t>(dims.z) +
             at[2]] = test::uniform_int(random, 0, 1) == 0 ? 0 : 2;
    }
  });
  return BeliefGrid::from_states(config, states);
}

/// Cubes of the lattice, this many voxels an edge, that have voxels that are not free.
std::size_t cubes_in_use(const GridSnapshot& snapshot, int edge) {
  std::set<std::tuple<int, int, int>> cubes;
  const auto cube = [&](int v) { return (v & ~(edge - 1)) / edge; };
  for (const GridSnapshot::Leaf& leaf : snapshot.leaves) {
    cubes.emplace(cube(leaf.origin.x), cube(leaf.origin.y), cube(leaf.origin.z));
  }
  return cubes.size();
}

/// Rays within some degrees of the grid's x-y plane in a slab, wider ones else.
Sensor sensor_of(const Layout& layout) {
  Sensor sensor = test::lattice_sensor(45, 33);
  sensor.camera.fx = 40;
  sensor.camera.fy = layout.dims.z < 10 ? 2000 : 40;
  sensor.min_range = 1.5 * kVoxel;
  sensor.max_range = kVoxel * (layout.dims.x + layout.dims.y);
  sensor.noise = ConstantNoise{.sigma_axial = 0.01, .sigma_lateral = 0.004};
  return sensor;
}

/// Poses in turn inside the workspace and a little outside, looking across it, image up along z.
std::vector<Pose> poses_of(const BeliefGrid& grid, std::size_t count, test::Random& random) {
  const Pose& T = grid.T_world_grid();
  const Box box = grid.workspace();
  const auto point = [&](double margin) {
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double extent = box.max[i] - box.min[i];
      p[k] = test::uniform(random, box.min[i] - margin * extent, box.max[i] + margin * extent);
    }
    return p;
  };
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d eye = point(0);
    if (i % 2 == 1) eye.x() = box.max[0] + 0.3;
    poses.push_back(look_at(T * eye, T * point(0), T.rotation().col(2)));
  }
  return poses;
}

class CellsOracle : public testing::TestWithParam<Layout> {};

TEST_P(CellsOracle, AgreesUnderEachInstructionSet) {
  const Layout& layout = GetParam();
  test::Random random(31);
  const BeliefGrid grid = map_of(layout, random);
  const GridSnapshot snapshot = grid.snapshot();
  ASSERT_GT(snapshot.leaves.size(), kManyCubes);
  if (layout.coarse > 32) {
    ASSERT_GT(cubes_in_use(snapshot, layout.coarse / 2), kManyCubes);
  }
  ASSERT_LE(cubes_in_use(snapshot, layout.coarse), kManyCubes);

  const oracle::DenseMap map(grid);
  const Sensor sensor = sensor_of(layout);
  const std::vector<Pose> poses = poses_of(grid, kPoses, random);
  // Single precision knows places in the workspace to half an ulp of its extent.
  const double tolerance = std::max(1e-4, 0x1.0p-21 * std::max(layout.dims.x, layout.dims.y));
  const std::vector<std::string> isas = available_isas();
  std::vector<test::OracleTally> tallies(isas.size());
  std::size_t gains = 0;
  for (const Pose& pose : poses) {
    const std::vector<RayHit> expected = oracle::trace(map, sensor, {}, pose);
    for (std::size_t i = 0; i < isas.size(); ++i) {
      SCOPED_TRACE(isas[i]);
      const test::ScopedIsa scoped(isas[i]);
      const auto scene = VoxelScene::build(snapshot, {}, {.num_threads = 1});
      ASSERT_EQ(scene->isa(), isas[i]);
      ASSERT_GT(scene->primitive_count(), kManyCubes);
      const GainEvaluator evaluator(scene, sensor, test::kPaper, {.num_threads = 1});
      const std::vector<RayHit> own = evaluator.trace(pose);
      tallies[i].add(map, sensor, pose, expected, own, tolerance);
      const GainEvaluator by_embree(scene, sensor, test::kPaper, {1, ExecConfig::Tracer::embree});
      tallies[i].add(map, sensor, pose, expected, by_embree.trace(pose), tolerance);
      const ViewGain gain = evaluator.evaluate(pose);
      const ViewGain by_own = oracle::gain_of_hits(grid, sensor, {}, pose, own);
      EXPECT_EQ(gain.status, by_own.status);
      EXPECT_EQ(gain.hits, by_own.hits);
      EXPECT_EQ(gain.unknown_voxels, by_own.unknown_voxels);
      EXPECT_EQ(gain.occupied_voxels, by_own.occupied_voxels);
      EXPECT_NEAR(gain.gain, by_own.gain, 1e-6 * by_own.gain);
      gains += gain.gain > 0 ? 1U : 0U;
    }
  }
  EXPECT_GT(gains, kPoses * isas.size() / 2);
  for (std::size_t i = 0; i < isas.size(); ++i) {
    EXPECT_EQ(tallies[i].rays, 2 * kPoses * 45 * 33) << isas[i];
    EXPECT_TRUE(tallies[i].agrees(2 * kPoses * 45 * 33 / 5, 30 * tolerance)) << isas[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, CellsOracle, testing::ValuesIn(kLayouts),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

// Rays and gains of random maps against the double-precision oracle, under each instruction set.

using test::MapFamily;

constexpr int kMaps = test::kSlowBuild ? 6 : 40;
constexpr std::size_t kPosesPerMap = test::kSlowBuild ? 3 : 5;
constexpr std::size_t kRaysPerPose = 25 * 19;
constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

/// |a - b| as a share of |b|; 0 if both are 0.
double relative_error(double a, double b) {
  return a == b ? 0.0 : std::abs(a - b) / std::max(std::abs(b), 1e-300);
}

class TraceOracle : public testing::TestWithParam<MapFamily> {
 protected:
  void compare_gains(const BeliefGrid& grid, const std::shared_ptr<const VoxelScene>& scene,
                     const Sensor& sensor, const Pose& pose, const std::vector<RayHit>& expected,
                     const std::vector<RayHit>& own, std::size_t different,
                     const ExecConfig& exec) {
    for (const Criterion criterion : kCriteria) {
      SCOPED_TRACE(criterion_name(criterion));
      const GainConfig config{
          .model = GainModel::paper, .criterion = criterion, .posterior_entropy = true};
      const GainEvaluator evaluator(scene, sensor, config, exec);
      const ViewGain actual = evaluator.evaluate(pose);
      const ViewGain by_own = oracle::gain_of_hits(grid, sensor, config, pose, own);
      ASSERT_EQ(actual.status, by_own.status);
      ++gain_checks_;
      if (actual.status != ViewGain::Status::ok) {
        EXPECT_EQ(actual.gain, 0.0);
        continue;
      }
      EXPECT_LE(relative_error(actual.gain, by_own.gain), 1e-6);
      EXPECT_LE(relative_error(actual.exploration, by_own.exploration), 1e-6);
      EXPECT_LE(relative_error(actual.refinement, by_own.refinement), 1e-6);
      EXPECT_LE(relative_error(actual.posterior_entropy, by_own.posterior_entropy), 1e-6);
      EXPECT_EQ(actual.rays, by_own.rays);
      EXPECT_EQ(actual.hits, by_own.hits);
      EXPECT_EQ(actual.unknown_voxels, by_own.unknown_voxels);
      EXPECT_EQ(actual.occupied_voxels, by_own.occupied_voxels);

      const ViewGain by_oracle = oracle::gain_of_hits(grid, sensor, config, pose, expected);
      const double one_hit =
          std::max(oracle::largest_one_hit_gain(grid, sensor, config, pose, expected),
                   oracle::largest_one_hit_gain(grid, sensor, config, pose, own));
      EXPECT_LE(std::abs(actual.gain - by_oracle.gain),
                static_cast<double>(different) * one_hit + 1e-5 * by_oracle.gain);
    }
  }

  std::size_t gain_checks_ = 0;
};

TEST_P(TraceOracle, AgreesUnderEachInstructionSet) {
  test::Random random(1234 + static_cast<unsigned>(GetParam()));
  const std::vector<std::string> isas = available_isas();
  ASSERT_FALSE(isas.empty());
  std::map<std::pair<std::string, ExecConfig::Tracer>, test::OracleTally> tallies;
  for (int i = 0; i < kMaps; ++i) {
    const test::RandomMap made = test::random_map(GetParam(), random);
    const oracle::DenseMap map(made.grid);
    const Sensor sensor = test::random_sensor(made.grid, random);
    const std::vector<Pose> poses = test::random_poses(made, kPosesPerMap, random);
    std::vector<std::vector<RayHit>> expected;
    for (const Pose& pose : poses) expected.push_back(oracle::trace(map, sensor, {}, pose));

    for (const std::string& isa : isas) {
      SCOPED_TRACE("map " + std::to_string(i) + ", " + isa);
      const test::ScopedIsa scoped(isa);
      const auto scene = VoxelScene::build(made.grid, {}, {.num_threads = 1});
      ASSERT_EQ(scene->isa(), isa);
      for (const ExecConfig::Tracer tracer : test::kTracers) {
        const ExecConfig exec{1, tracer};
        const GainEvaluator evaluator(scene, sensor, test::kPaper, exec);
        test::OracleTally& tally = tallies[{isa, tracer}];
        for (std::size_t k = 0; k < poses.size(); ++k) {
          const std::vector<RayHit> own = evaluator.trace(poses[k]);
          const std::size_t different = tally.add(map, sensor, poses[k], expected[k], own);
          if (k != static_cast<std::size_t>(i) % poses.size()) continue;
          compare_gains(made.grid, scene, sensor, poses[k], expected[k], own, different, exec);
        }
      }
    }
  }

  EXPECT_EQ(tallies.size(), isas.size() * test::kTracers.size());
  EXPECT_EQ(gain_checks_, kMaps * kCriteria.size() * tallies.size());
  for (const auto& [isa_and_tracer, tally] : tallies) {
    EXPECT_EQ(tally.rays, kMaps * kPosesPerMap * kRaysPerPose) << isa_and_tracer.first;
    EXPECT_TRUE(tally.agrees(1)) << isa_and_tracer.first;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, TraceOracle, testing::ValuesIn(test::kMapFamilies),
                         test::family_name);

}  // namespace
}  // namespace viewgain
