// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Scenes that follow a map through thirty changes are, bit for bit, those built anew, and meet the
// oracle.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "grid/analytic_frames.hpp"
#include "grid/voxels.hpp"
#include "raycast/scene_makers.hpp"
#include "raycast/trace/oracle_tally.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/support/block_lattice.hpp"
#include "viewgain/support/log_odds_code.hpp"

namespace viewgain {
namespace {

constexpr int kChanges = 30;
constexpr std::size_t kPoses = 4;
constexpr std::size_t kManyPrimitives = 4096;  ///< more than that are grouped into cells
constexpr int kFine = test::kSlowBuild ? 144 : 176;

/// A map and what is done to it, one change after the other.
class ChangingMap {
 public:
  /// With specks, one voxel of each block of 8³ is known from the start.
  ChangingMap(const GridConfig& config, bool has_specks)
      : random_(5), grid_(config), sensor_(test::small_sensor(48, 36)), integrator_(sensor_) {
    if (!has_specks) return;
    test::for_each_voxel(
        grid_, [&](Index3 voxel) { grid_.set(voxel, 0.85F); }, 8);
  }

  [[nodiscard]] const BeliefGrid& grid() const { return grid_; }

  void change(int i) {
    switch (i % 6) {
      case 0:
      case 1:
        see(i, test::three_spheres_in_a_room());
        break;
      case 2:
        see(i, {test::three_spheres_in_a_room()[0], {{0, 0, 0}, 1.5}});  // two have gone
        break;
      case 3:
        set_region(i, 1.0F, 0.05);
        break;
      case 4:
        set_region(i - 1, -1.0F, 1.0);
        break;
      default:
        grid_ = grid_.clone();  // and nothing else, or
        if (i % 12 == 5) forget();
    }
  }

  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }

 private:
  void see(int view, const std::vector<test::Sphere>& spheres) {
    const Pose pose = test::ring_view(view);
    integrator_.integrate(grid_, test::see_spheres(sensor_, pose, spheres), pose);
  }

  /// A box, aligned to nothing, through the lower half.
  void forget() {
    Box region = grid_.workspace();
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = region.min[k], size = region.max[k] - low;
      region.min[k] = low + test::uniform(random_, 0, 0.3) * size;
      region.max[k] = low + test::uniform(random_, 0.5, 0.7) * size;
    }
    forgotten_ += grid_.forget(region);
  }

  /// Some voxels of one of the cubes of 32³ that the workspace touches.
  void set_region(int which, float log_odds, double share) {
    const Index3 min = grid_.min_index(), dims = grid_.dims();
    const auto begin = [&](int low, int n, int turn) {
      const int cubes = ((low + n - 1) >> 5) - (low >> 5) + 1;
      return ((low >> 5) + (which * turn) % cubes) << 5;
    };
    const Index3 at{begin(min.x, dims.x, 1), begin(min.y, dims.y, 2), begin(min.z, dims.z, 3)};
    for (int n = 0; n < 1 << 15; ++n) {
      const Index3 v{at.x + (n >> 10), at.y + (n >> 5 & 31), at.z + (n & 31)};
      const bool is_inside = v.x >= min.x && v.y >= min.y && v.z >= min.z && v.x < min.x + dims.x &&
                             v.y < min.y + dims.y && v.z < min.z + dims.z;
      if (is_inside && test::uniform(random_, 0, 1) < share) grid_.set(v, log_odds);
    }
  }

  test::Random random_;
  BeliefGrid grid_;
  Sensor sensor_;
  FrameIntegrator integrator_;
  std::uint64_t forgotten_ = 0;
};

struct Chain {
  const char* name;
  int voxels;                 ///< along 0.4 m
  std::array<double, 6> cut;  ///< what is cut off the workspace, low and high ends [m]
  bool is_by_bvh;             ///< with a lens, too
  bool has_obstacles;
  bool has_cells;  ///< some scene has more primitives than are sorted one by one
};

class SceneUpdate : public testing::TestWithParam<Chain> {};

TEST_P(SceneUpdate, AChainOfUpdatesIsWhatBuildsAre) {
  const Chain& chain = GetParam();
  GridConfig config = test::object_grid(chain.voxels);
  for (std::size_t k = 0; k < 3; ++k) {
    config.workspace.min[k] += chain.cut[k];
    config.workspace.max[k] -= chain.cut[3 + k];
  }
  Obstacles obstacles;
  if (chain.has_obstacles) obstacles.boxes.push_back({{0.1, 0.1, -0.3}, {0.12, 0.3, 0.3}});
  ChangingMap map(config, chain.has_cells);
  test::Random random(6);
  Sensor sensor = test::random_sensor(map.grid(), random);
  sensor.camera.distortion = {};
  if (chain.is_by_bvh) sensor.camera.distortion = {-0.05, 0.01, 1e-3, -1e-3, 0};
  sensor.min_range = 0.01;
  sensor.max_range = 1.5;

  const ExecConfig exec{1,
                        chain.is_by_bvh ? ExecConfig::Tracer::embree : ExecConfig::Tracer::sweep};
  const std::vector<std::string> isas = available_isas();
  std::vector<std::shared_ptr<const VoxelScene>> scenes;
  for (const std::string& isa : isas) {
    const test::ScopedIsa scoped(isa);
    scenes.push_back(VoxelScene::build(map.grid(), {obstacles}, {.num_threads = 1}));
  }
  std::vector<test::OracleTally> tallies(isas.size());
  const auto kept = scenes.front();
  const std::vector<Pose> first_poses =
      test::random_poses({map.grid().clone(), map.grid().workspace()}, kPoses, random);
  const std::vector<ViewGain> first_gains =
      GainEvaluator(kept, sensor, test::kPaper).evaluate(first_poses);

  std::size_t compared = 0, gaining = 0, hits = 0, in_cells = 0;
  for (int i = 0; i < kChanges; ++i) {
    SCOPED_TRACE("change " + std::to_string(i));
    map.change(i);
    const std::vector<Pose> poses =
        test::random_poses({map.grid().clone(), map.grid().workspace()}, kPoses, random);
    const bool asks_oracle = i % 5 == 4 && !chain.has_obstacles;
    const oracle::DenseMap dense(asks_oracle ? map.grid().clone()
                                             : test::sparse_map({1, 1, 1}, {}));
    std::vector<std::vector<RayHit>> expected;
    if (asks_oracle) {
      for (const Pose& pose : poses) expected.push_back(oracle::trace(dense, sensor, {}, pose));
    }
    for (std::size_t k = 0; k < isas.size(); ++k) {
      SCOPED_TRACE(isas[k]);
      const test::ScopedIsa scoped(isas[k]);
      scenes[k] = VoxelScene::update(scenes[k], map.grid(), {.num_threads = 1});
      const auto anew = VoxelScene::build(map.grid(), {obstacles}, {.num_threads = 1});
      ASSERT_EQ(scenes[k]->isa(), isas[k]);
      ASSERT_EQ(scenes[k]->primitive_count(), anew->primitive_count());
      in_cells += anew->primitive_count() > kManyPrimitives ? 1U : 0U;
      const GainEvaluator updated(scenes[k], sensor, test::kPaper, exec);
      const GainEvaluator built(anew, sensor, test::kPaper, exec);
      const std::vector<ViewGain> gains = updated.evaluate(poses);
      ASSERT_TRUE(test::same_bits(gains, built.evaluate(poses)));
      for (std::size_t p = 0; p < poses.size(); ++p) {
        const std::vector<RayHit> own = updated.trace(poses[p]);
        test::expect_same_hits(own, built.trace(poses[p]));
        if (asks_oracle) tallies[k].add(dense, sensor, poses[p], expected[p], own);
        gaining += gains[p].gain > 0 ? 1U : 0U;
        hits += gains[p].hits;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, kChanges * kPoses * isas.size());
  EXPECT_GT(gaining, compared / 3);
  EXPECT_GT(hits, compared * 25);
  EXPECT_EQ(in_cells > isas.size(), chain.has_cells) << in_cells;
  EXPECT_GT(map.forgotten(), 10000U);
  if (!chain.has_obstacles) {
    for (std::size_t k = 0; k < isas.size(); ++k) {
      EXPECT_EQ(tallies[k].rays, kChanges / 5 * kPoses * 25 * 19) << isas[k];
      EXPECT_TRUE(tallies[k].agrees(1000, 1e-3)) << isas[k];
    }
  }
  // What a scene was made of stays as it was.
  EXPECT_TRUE(test::same_bits(first_gains,
                              GainEvaluator(kept, sensor, test::kPaper).evaluate(first_poses)));
}

INSTANTIATE_TEST_SUITE_P(
    Chains, SceneUpdate,
    testing::Values(Chain{"Whole", 96, {}, false, false, false},
                    Chain{"Clipped", 96, {0.057, 0, 0.113, 0, 0.049, 0.01}, false, false, false},
                    Chain{
                        "ThroughTheBvh", 96, {0.057, 0, 0.113, 0, 0.049, 0.01}, true, false, false},
                    Chain{"WithAnObstacle", 96, {0, 0.03, 0, 0.07, 0, 0}, false, true, false},
                    Chain{"Cells", kFine, {0.011, 0, 0, 0, 0.023, 0}, false, false, true}),
    [](const auto& chosen) { return std::string(chosen.param.name); });

// Importers put whole blocks and cubes into a map, which scenes of it must follow, too.
TEST(SceneUpdateOfImports, FollowsBlocksAndCubesOfImporters) {
  const GridConfig config{0.01, {{0, 0, 0}, {1.6, 1.6, 1.6}}, {}, 0.005};
  BeliefGrid grid(config);
  std::array<std::uint8_t, 512> solid;
  solid.fill(detail::log_odds_code(0.85));
  const std::uint8_t free = detail::log_odds_code(-0.4);
  const std::vector<std::function<void()>> changes{[&] {
                                                     put_block(grid, {64, 64, 64}, solid.data());
                                                   },
                                                   [&] {
                                                     fill_cube(grid, {0, 0, 0}, 8, free);
                                                   },
                                                   [&] {
                                                     fill_cube(grid, {64, 0, 64}, 32, solid[0]);
                                                   },
                                                   [&] {
                                                     fill_cube(grid, {0, 0, 64}, 64, free);
                                                   },
                                                   [&] {
                                                     fill_cube(grid, {128, 128, 128}, 128, free);
                                                   },  // beyond the workspace
                                                   [&] {
                                                     fill_cube(grid, {0, 0, 0}, 256, free);
                                                   }};
  auto scene = VoxelScene::build(grid, {}, {.num_threads = 1});
  Sensor sensor = test::small_sensor(48, 36);
  sensor.min_range = 0.01, sensor.max_range = 5;
  const std::vector<Pose> poses = sphere_poses(6, 2.0, {0.8, 0.8, 0.8});
  std::vector<ViewGain> last(poses.size());
  for (std::size_t i = 0; i < changes.size(); ++i) {
    changes[i]();
    scene = VoxelScene::update(scene, grid, {.num_threads = 1});
    const auto anew = VoxelScene::build(grid, {}, {.num_threads = 1});
    EXPECT_EQ(scene->primitive_count(), anew->primitive_count()) << i;
    const GainEvaluator updated(scene, sensor), built(anew, sensor);
    const std::vector<ViewGain> gains = built.evaluate(poses);
    EXPECT_TRUE(test::same_bits(updated.evaluate(poses), gains)) << i;
    for (const Pose& pose : poses) test::expect_same_hits(updated.trace(pose), built.trace(pose));
    EXPECT_FALSE(test::same_bits(gains, last)) << i;  // each change is seen
    last = gains;
  }
}

// An evaluator that follows a map: with_scene() gives what an evaluator made for the scene gives.

constexpr std::array kCriteria{Criterion::log_diagonal, Criterion::log_determinant,
                               Criterion::trace};

// Everything that the two say of the poses; returns how many rays that are.
std::size_t expect_same(const GainEvaluator& followed, const GainEvaluator& fresh,
                        const std::vector<Pose>& poses) {
  EXPECT_EQ(followed.prior_sigma(), fresh.prior_sigma());
  EXPECT_TRUE(test::same_bits(followed.evaluate(poses), fresh.evaluate(poses)));
  std::vector<ApproximateGain> a(poses.size()), b(poses.size());
  followed.approximate(poses, a);
  fresh.approximate(poses, b);
  std::size_t rays = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_TRUE(test::same_bits(followed.evaluate(poses[i]), fresh.evaluate(poses[i])));
    EXPECT_EQ(std::isnan(a[i].gain), std::isnan(b[i].gain));
    if (!std::isnan(a[i].gain)) {
      EXPECT_EQ(a[i].gain, b[i].gain);
    }
    const std::vector<RayHit> hits = followed.trace(poses[i]);
    test::expect_same_hits(hits, fresh.trace(poses[i]));
    rays += hits.size();
  }
  EXPECT_EQ(followed.best_set(poses, 3).indices, fresh.best_set(poses, 3).indices);
  return rays;
}

TEST(WithScene, HasTheBitsOfAFreshEvaluatorWhateverTheScenes) {
  std::size_t rays = 0;
  for (const Criterion criterion : kCriteria) {
    for (const int variant : {0, 1, 2, 3}) {  // plain, weights, distortion, several threads
      test::Random random(10 * static_cast<std::uint64_t>(criterion) +
                          static_cast<std::uint64_t>(variant));
      GainConfig config = test::by_paper(criterion);
      if (variant == 1) config.weights = {{{{-9, -9, -9}, {0.1, 9, 9}}, 3.0}};
      const ExecConfig exec{.num_threads = variant == 3 ? 3 : 1};
      std::optional<Sensor> sensor;
      std::optional<GainEvaluator> evaluator;
      std::shared_ptr<const VoxelScene> first;
      std::vector<Pose> first_poses;
      // Maps of other sizes, with larger boxes and without, and obstacles that come and go.
      for (const test::MapFamily family :
           {test::MapFamily::salt_and_pepper_1, test::MapFamily::tiles_128,
            test::MapFamily::salt_and_pepper_30, test::MapFamily::rotated}) {
        const test::RandomMap map = test::random_map(family, random);
        if (!sensor) {
          sensor = test::random_sensor(map.grid, random);
          sensor->camera.distortion = {};
          if (variant == 2) sensor->camera.distortion = {-0.05, 0.01, 1e-3, -1e-3, 0};
        }
        Obstacles obstacles;
        if (family == test::MapFamily::salt_and_pepper_30) obstacles.boxes.push_back(map.room);
        const auto scene = VoxelScene::build(map.grid, {obstacles});
        const std::vector<Pose> poses = test::random_poses(map, 12, random);
        if (evaluator) {
          evaluator = evaluator->with_scene(scene);
        } else {
          evaluator.emplace(scene, *sensor, config, exec);
          first = scene, first_poses = poses;
        }
        rays += expect_same(*evaluator, GainEvaluator(scene, *sensor, config, exec), poses);
        // And back, with the workspaces that the larger scene has left.
        rays += expect_same(evaluator->with_scene(first),
                            GainEvaluator(first, *sensor, config, exec), first_poses);
      }
    }
  }
  EXPECT_GT(rays, 100'000U);
}

TEST(WithScene, ThePriorFollowsTheMapUnlessItIsGiven) {
  const auto scene_of = [](double prior_sigma) {
    return VoxelScene::build(BeliefGrid({.voxel_size = 0.01,
                                         .workspace = {{0, 0, 0}, {0.1, 0.1, 0.1}},
                                         .prior_sigma = prior_sigma}));
  };
  const GainEvaluator follows(scene_of(0.02), sensor_preset("sr4000"));
  EXPECT_EQ(follows.with_scene(scene_of(0.03)).prior_sigma(), 0.03);
  const GainEvaluator given(scene_of(0.02), sensor_preset("sr4000"), {.prior_sigma = 0.05});
  EXPECT_EQ(given.with_scene(scene_of(0.03)).prior_sigma(), 0.05);
}

// What takes long is made once: a sensor's rays, of which the camera is a part, and the threads.
TEST(WithScene, SharesTheRaysAndRefusesNoScene) {
  test::Random random(7);
  const test::RandomMap map = test::random_map(test::MapFamily::salt_and_pepper_1, random);
  const auto scene = VoxelScene::build(map.grid);
  const GainEvaluator evaluator(scene, sensor_preset("kinect_v1"), {.pixel_stride = 2},
                                {.num_threads = 3});
  const GainEvaluator next = evaluator.with_scene(scene);
  EXPECT_EQ(&next.camera(), &evaluator.camera());
  EXPECT_EQ(next.num_threads(), 3);
  EXPECT_EQ(next.pixel_stride(), 2);
  EXPECT_EQ(&next.scene(), scene.get());
  EXPECT_THROW((void)evaluator.with_scene(nullptr), Error);
}

}  // namespace
}  // namespace viewgain
