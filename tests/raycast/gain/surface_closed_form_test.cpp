// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Surface gains that can be worked out by hand: rays along x through slabs of unknown voxels.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>

#include "core/expect_error.hpp"
#include "raycast/scene_makers.hpp"

namespace viewgain {
namespace {

using test::kExactVoxel;

constexpr Index3 kDims{64, 16, 16};
constexpr double kV2 = kExactVoxel * kExactVoxel;
constexpr double kRate = 3.0;  // [1/m]
// The most that one ray counts for: two readings within a pooling length, here a voxel, of the
// point.
constexpr double kCap = std::numbers::pi * kV2 / 2;

/// One pixel that stands for `angle` sr.
Sensor one_ray(double angle) {
  Sensor sensor = test::lattice_sensor(1, 1);
  sensor.camera.fx = sensor.camera.fy = 1 / std::sqrt(angle);
  return sensor;
}

/// Free, but for what `state_at(x)` says of each plane of voxels across x.
BeliefGrid planes(const std::function<VoxelState(int)>& state_at) {
  BeliefGrid grid = test::sparse_map(kDims, {});
  std::vector<std::uint8_t> states;
  for (int x = 0; x < kDims.x; ++x) {
    states.insert(states.end(), static_cast<std::size_t>(kDims.y * kDims.z),
                  static_cast<std::uint8_t>(state_at(x)));
  }
  GridConfig config;
  config.voxel_size = kExactVoxel;
  config.workspace = grid.workspace();
  config.prior_sigma = 0.5 * kExactVoxel;
  return BeliefGrid::from_states(config, states);
}

BeliefGrid slab(int begin, int end, int wall = 1000) {
  return planes([=](int x) {
    if (x == wall) return VoxelState::occupied;
    return x >= begin && x < end ? VoxelState::unknown : VoxelState::free;
  });
}

/// The same rate everywhere, in cells of 2^shift voxels.
HazardConfig constant(int shift, double rate = kRate) {
  return {
      .model = HazardConfig::Model::constant(
          rate, 4 * kExactVoxel * (1 << shift) / HazardConfig::Model::for_size(1).decay_length)};
}

ViewGain gain_of(const BeliefGrid& grid, const Sensor& sensor, const HazardConfig& hazard,
                 GainConfig config = {},
                 const Pose& pose = test::axis_pose({-30, 8.5, 8.5}, 0, true),
                 const std::optional<double>& support_plane = {}) {
  config.model = GainModel::surface;
  const auto scene = VoxelScene::build(grid, {{}, support_plane}, {}, hazard);
  return GainEvaluator(scene, sensor, config).evaluate(pose);
}

/// Σ T (1 - e^(-h c)) min(ω mean(t²), cap) over the cells of a slab.
double slab_area(int begin, int end, int edge, double angle, double eye, double rate = kRate) {
  double area = 0, passed = 1;
  for (int cell = begin / edge * edge; cell < end; cell += edge) {
    const double from = std::max(cell, begin), to = std::min(cell + edge, end);
    const double P = passed * -std::expm1(-rate * (to - from) * kExactVoxel);
    const double squared = (std::pow(to - eye, 3) - std::pow(from - eye, 3)) / (3 * (to - from));
    area += P * std::min(angle * squared * kExactVoxel * kExactVoxel, kCap);
    passed -= P;
  }
  return area;
}

TEST(SurfaceGain, OneSlabOfConstantHazard) {
  for (int shift = 0; shift < 4; ++shift) {
    for (const double angle : {1e-8, 1e-4, 1.0}) {
      SCOPED_TRACE(std::to_string(shift) + ", " + std::to_string(angle));
      const ViewGain gain = gain_of(slab(21, 43), one_ray(angle), constant(shift));
      const double expected = slab_area(21, 43, 1 << shift, angle, -30);
      EXPECT_NEAR(gain.gain, expected, 1e-5 * expected);
      EXPECT_EQ(gain.area, gain.gain);
      EXPECT_TRUE(std::isnan(gain.exploration));
      EXPECT_EQ(gain.rays, 1U);
      EXPECT_EQ(gain.hits, 0U);
    }
  }
  // Where the ray counts for the most there is, only how likely it is to end matters.
  const double ends = -std::expm1(-kRate * 22 * kExactVoxel);
  EXPECT_NEAR(gain_of(slab(21, 43), one_ray(1.0), constant(2)).gain, kCap * ends, 1e-5 * kCap);
}

// Cells of equal rate are joined where rates are low, and nowhere else: a rate that is off by 1e-5
// in every other voxel keeps them apart, and changes no gain by more.
TEST(SurfaceGain, JoinedCellsAddUpToTheirParts) {
  int cases = 0;
  for (const double rate : {1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 1000.0}) {
    for (const double angle : {1e-8, 1e-4, 1.0}) {
      SCOPED_TRACE(std::to_string(rate) + ", " + std::to_string(angle));
      const auto of = [&](double jitter) {
        HazardConfig::Volume volume{{{0, 0, 0}, kDims}, {}, static_cast<float>(rate)};
        for (int i = 0; i < kDims.x * kDims.y * kDims.z; ++i) {
          const int sum = i / (kDims.y * kDims.z) + i / kDims.z % kDims.y + i % kDims.z;
          volume.rates.push_back(static_cast<float>(rate * (1 + (sum % 2 == 0 ? jitter : 0))));
        }
        return gain_of(slab(16, 56), one_ray(angle),
                       {.volume = std::make_shared<const HazardConfig::Volume>(volume)})
            .gain;
      };
      const double joined = of(0), apart = of(1e-5);
      EXPECT_NEAR(joined, apart, 1e-4 * apart);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 21);
}

TEST(SurfaceGain, AnEmptyBoxBringsNothing) {
  const ViewGain gain = gain_of(slab(0, 0), one_ray(1.0), constant(0));
  EXPECT_EQ(gain.status, ViewGain::Status::ok);
  EXPECT_EQ(gain.gain, 0.0);
  EXPECT_EQ(gain.area, 0.0);
}

TEST(SurfaceGain, NoHazardNoSurface) {
  EXPECT_EQ(gain_of(slab(5, 60), one_ray(1.0), constant(1, 0.0)).gain, 0.0);
}

TEST(SurfaceGain, AWallEndsTheRay) {
  // From the front: free voxels lie before the slab, unknown ones behind the wall.
  const BeliefGrid grid = planes([](int x) {
    if (x < 20) return VoxelState::free;
    if (x == 30) return VoxelState::occupied;
    return VoxelState::unknown;
  });
  const ViewGain gain = gain_of(grid, one_ray(1e-6), constant(1));
  EXPECT_NEAR(gain.gain, slab_area(20, 30, 2, 1e-6, -30), 1e-5 * gain.gain);
  EXPECT_EQ(gain.hits, 1U);
}

TEST(SurfaceGain, AWallSeenFromBehindIsInTheSlabBeforeIt) {
  // Free voxels lie beyond the wall only: the surface looks away from the camera.
  const auto thick = [](int from) {
    return planes([=](int x) {
      if (x == 30) return VoxelState::occupied;
      return x >= from && x < 30 ? VoxelState::unknown : VoxelState::free;
    });
  };
  for (const int from : {28, 25, 10}) {
    EXPECT_NEAR(gain_of(thick(from), one_ray(1.0), constant(1)).gain, kCap, 1e-5 * kCap) << from;
  }
  // One voxel of unknown says little.
  const double one = -std::expm1(-kRate * kExactVoxel);
  EXPECT_NEAR(gain_of(thick(29), one_ray(1.0), constant(1)).gain, kCap * one, 1e-5 * kCap);
  // A free voxel in between: only the stretch that reaches the wall is where the surface is.
  const BeliefGrid parted = planes([](int x) {
    if (x == 30) return VoxelState::occupied;
    return x >= 10 && x < 30 && x != 20 ? VoxelState::unknown : VoxelState::free;
  });
  EXPECT_NEAR(gain_of(parted, one_ray(1.0), constant(1)).gain, kCap, 1e-5 * kCap);
  const BeliefGrid apart = planes([](int x) {
    if (x == 30) return VoxelState::occupied;
    return x >= 10 && x < 29 ? VoxelState::unknown : VoxelState::free;
  });
  const double before = -std::expm1(-kRate * 19 * kExactVoxel);
  EXPECT_NEAR(gain_of(apart, one_ray(1.0), constant(1)).gain, kCap * before, 1e-5 * kCap);
}

// The surface in between is parallel to the wall: across a slanted ray it has the cosine of its
// area.
TEST(SurfaceGain, AWallSeenFromBehindAtASlantHidesMoreThanTheRayIsWide) {
  const BeliefGrid grid = planes([](int x) {
    if (x == 30) return VoxelState::occupied;
    return x == 28 || x == 29 ? VoxelState::unknown : VoxelState::free;
  });
  const Sensor sensor = one_ray(1.0);
  int slants = 0;
  for (const double slant : {0.999, 0.8, 0.5, 0.36, 0.3, 0.27}) {
    const double tangent = std::sqrt(1 - slant * slant) / slant;
    const Eigen::Vector3d eye(26.9, 2.1, 8.4), at(30.2, 2.1 + 3.3 * tangent, 8.4);
    ASSERT_LT(at.y(), kDims.y);
    const Pose pose = look_at(kExactVoxel * eye, kExactVoxel * at);
    const double cosine = (pose.rotation() * sensor.camera.ray_table()[0]).normalized().x();
    const double area = kCap / std::max(cosine, 0.35);
    EXPECT_NEAR(gain_of(grid, sensor, constant(1), {}, pose).gain, area, 2e-5 * area) << slant;
    ++slants;
  }
  EXPECT_EQ(slants, 6);
  // From the front, or along the wall, it says nothing.
  const Eigen::Vector3d eye(27.3, 1.2, 8.4), along(28.5, 12, 8.4);
  const double gain =
      gain_of(grid, one_ray(1.0), constant(1), {}, look_at(kExactVoxel * eye, kExactVoxel * along))
          .gain;
  EXPECT_LT(gain, kCap);
}

TEST(SurfaceGain, ARayInAFaceBelongsToTheLargerIndex) {
  const BeliefGrid grid = slab(8, 40);
  auto volume = std::make_shared<HazardConfig::Volume>();
  volume->box = VoxelBox::from_dims({0, 0, 0}, kDims);
  for (int i = 0; i < kDims.x * kDims.y * kDims.z; ++i) {
    volume->rates.push_back(static_cast<float>(i / kDims.z % kDims.y));  // by y
  }
  for (const int face : {1, 5, 8, 12}) {
    for (const bool forward : {true, false}) {
      const Pose pose = test::axis_pose({forward ? -10.0 : 80.0, double(face), 7.5}, 0, forward);
      const double ends = -std::expm1(-face * 32 * kExactVoxel);
      EXPECT_NEAR(gain_of(grid, one_ray(1.0), {.volume = volume}, {}, pose).gain, kCap * ends,
                  1e-5 * kCap);
    }
  }
}

TEST(SurfaceGain, RangeLimitsWeightsAndThePlaneCutTheRay) {
  const BeliefGrid grid = slab(20, 44);
  const auto ends = [](double voxels) { return kCap * -std::expm1(-kRate * voxels * kExactVoxel); };
  const auto at = [](double x) { return (x + 30) * kExactVoxel; };
  const Sensor sensor = one_ray(1.0);
  EXPECT_NEAR(gain_of(grid, sensor, constant(0), {.min_range = at(30.5)}).gain, ends(13.5),
              1e-5 * kCap);
  EXPECT_NEAR(gain_of(grid, sensor, constant(3), {.max_range = at(30.25)}).gain, ends(10.25),
              1e-5 * kCap);
  // Voxels of weight 0 take their share of the ray all the same.
  Box first = grid.workspace();
  first.max[0] = 24 * kExactVoxel;
  EXPECT_NEAR(gain_of(grid, sensor, constant(3), {.weights = {{first, 0.0}}}).gain,
              ends(24) - ends(4), 1e-5 * kCap);
  // Down along z, onto a plane in the middle of the slab.
  const BeliefGrid all = planes([](int) { return VoxelState::unknown; });
  const Pose down = test::axis_pose({30.5, 8.5, 40}, 2, false);
  EXPECT_NEAR(gain_of(all, sensor, constant(1), {}, down, 6.5 * kExactVoxel).gain, ends(9.5),
              1e-5 * kCap);
  const Pose up = test::axis_pose({30.5, 8.5, -40}, 2, true);
  EXPECT_NEAR(gain_of(all, sensor, constant(1), {}, up, 6.5 * kExactVoxel).gain, ends(16),
              1e-5 * kCap);
}

TEST(SurfaceGain, SurfaceNextToWhatIsSeenIsNotNew) {
  BeliefGrid grid = slab(20, 44);
  Belief belief;
  belief.information = {1e6F, 1e6F, 1e6F, 0, 0, 0};
  belief.hits = 3;
  grid.set({32, 0, 8}, 1.0F, belief);  // 8 voxels off the ray along x at y = 8
  const HazardConfig hazard = constant(0);
  const double all = kCap * -std::expm1(-kRate * 24 * kExactVoxel);
  EXPECT_NEAR(gain_of(grid, one_ray(1.0), hazard).gain, all, 1e-5 * kCap);
  // Along y = 1.5 the voxel 32 (d = 1) is known; those at 31 and 33 are farther away.
  const Pose near = test::axis_pose({-30, 1.5, 8.5}, 0, true);
  const double before = -std::expm1(-kRate * 12 * kExactVoxel);
  const double known = (1 - before) * -std::expm1(-kRate * kExactVoxel);
  EXPECT_NEAR(gain_of(grid, one_ray(1.0), hazard, {}, near).gain, all - kCap * known, 1e-5 * kCap);
}

TEST(SurfaceGain, RefusesWhatCannotBeMeant) {
  const auto scene = VoxelScene::build(slab(1, 2));
  const auto refuses = [&](const char* what, const GainConfig& config) {
    test::expect_error(ErrorCode::invalid_argument, what,
                       [&] { (void)GainEvaluator(scene, one_ray(1.0), config); });
  };
  refuses("criterion trace requires the gain paper",
          {.model = GainModel::combined, .criterion = Criterion::trace});
  refuses("refinement weight must be at least 0 and finite, not -1",
          {.model = GainModel::combined, .refinement_weight = -1});
  test::expect_error(ErrorCode::invalid_argument, "support plane", [] {
    (void)VoxelScene::build(slab(1, 2), {{}, HUGE_VAL});
  });
  test::expect_error(ErrorCode::invalid_argument, "valid values: paper, surface, combined",
                     [] { (void)parse_gain_model("papers"); });
}

// The evaluator's other calls with the surface and the combined gain.

constexpr std::array kModels{GainModel::surface, GainModel::combined};

class SurfaceCalls : public testing::TestWithParam<GainModel> {
 protected:
  test::Random random_{17};
  test::RandomMap made_ = test::random_map(test::MapFamily::tiles_8, random_);
  Sensor sensor_ = test::random_sensor(made_.grid, random_);
  std::vector<Pose> poses_ = test::random_poses(made_, 60, random_);
  std::shared_ptr<const VoxelScene> scene_ = VoxelScene::build(made_.grid);
};

TEST_P(SurfaceCalls, ContributionsAddUpToTheGain) {
  const GainEvaluator evaluator(scene_, sensor_, {.model = GetParam()});
  std::size_t views = 0, known = 0;
  for (const Pose& pose : poses_) {
    const ViewGain gain = evaluator.evaluate(pose);
    const std::vector<VoxelContribution> parts = evaluator.contributions(pose);
    if (gain.status != ViewGain::Status::ok) {
      EXPECT_TRUE(parts.empty());
      continue;
    }
    double sum = 0, expected_rays = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const VoxelContribution& part = parts[i];
      EXPECT_EQ(made_.grid.state(part.voxel), part.state);
      EXPECT_GE(part.rays, 1U);
      EXPECT_LE(part.expected_rays, part.rays * (1 + 1e-6));
      EXPECT_LE(part.gain, parts[i == 0 ? 0 : i - 1].gain);
      sum += part.gain;
      expected_rays += part.expected_rays;
      known += part.state == VoxelState::occupied ? 1 : 0;
    }
    EXPECT_NEAR(sum, gain.gain, 1e-5 * gain.gain);
    EXPECT_LE(expected_rays, gain.rays * (1 + 1e-6));
    views += gain.gain > 0 ? 1 : 0;
  }
  EXPECT_GT(views, 20U);
  EXPECT_EQ(known > 0, GetParam() == GainModel::combined);
}

TEST_P(SurfaceCalls, AnUpdatedSceneKeepsItsHazard) {
  const HazardConfig hazard{.object_size = 0.5};
  const auto before = VoxelScene::build(made_.grid, {}, {}, hazard);
  BeliefGrid grid = made_.grid.clone();
  for (int i = 0; i < 40; ++i) {
    const Index3& base = grid.min_index();
    grid.set({base.x + i % 7, base.y + 3, base.z + i % 16}, i % 2 == 0 ? -1.0F : 1.0F);
  }
  const auto updated = VoxelScene::update(before, grid);
  const auto fresh = VoxelScene::build(grid, {}, {}, hazard);
  const GainEvaluator evaluator(before, sensor_, {.model = GetParam()});
  EXPECT_TRUE(
      test::same_bits(evaluator.with_scene(updated).evaluate(poses_),
                      GainEvaluator(fresh, sensor_, {.model = GetParam()}).evaluate(poses_)));
  EXPECT_FALSE(test::same_bits(
      evaluator.with_scene(updated).evaluate(poses_),
      GainEvaluator(VoxelScene::build(grid), sensor_, {.model = GetParam()}).evaluate(poses_)));
}

std::string model_name(const testing::TestParamInfo<GainModel>& info) {
  return std::string(gain_model_name(info.param));
}
INSTANTIATE_TEST_SUITE_P(Models, SurfaceCalls, testing::ValuesIn(kModels), model_name);

}  // namespace
}  // namespace viewgain
