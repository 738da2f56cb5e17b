// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The map is the same bit for bit whatever runs it.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "core/temporary_folder.hpp"
#include "grid/analytic_frames.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain {
namespace {
using Occupancy = IntegrationConfig::Occupancy;
using Carve = IntegrationConfig::Carve;

using namespace test;

/// Sets VIEWGAIN_ISA for its own lifetime.
class IsaLimit {
 public:
  explicit IsaLimit(Isa isa) {
    if (const char* before = std::getenv("VIEWGAIN_ISA")) before_ = before;
    ::setenv("VIEWGAIN_ISA", std::string(isa_name(isa)).c_str(), 1);
  }
  ~IsaLimit() {
    if (before_) {
      ::setenv("VIEWGAIN_ISA", before_->c_str(), 1);
    } else {
      ::unsetenv("VIEWGAIN_ISA");
    }
  }
  IsaLimit(const IsaLimit&) = delete;
  IsaLimit& operator=(const IsaLimit&) = delete;

 private:
  std::optional<std::string> before_;
};

Sensor noisy_sensor(bool distorted) {
  Sensor sensor = small_sensor(32, 24);
  if (distorted) sensor.camera.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
  return sensor;
}

DepthFrame noisy_frame(const Sensor& sensor, int view) {
  DepthFrame frame = see_spheres(sensor, ring_view(view), three_spheres_in_a_room());
  std::mt19937 random(static_cast<unsigned>(view));
  std::normal_distribution<float> normal(0.0F, 0.004F);
  std::uniform_int_distribution<int> dice(0, 49);
  for (float& depth : frame.depth) {
    depth += normal(random);
    const int roll = dice(random);
    if (roll == 0) depth = DepthFrame::kInvalid;
    if (roll == 1) depth = DepthFrame::kOutOfRange;
  }
  return frame;
}

BeliefGrid turned_grid() {
  GridConfig config = object_grid(36);
  config.T_world_grid =
      Pose(Eigen::AngleAxisd(0.3, Eigen::Vector3d(2, 1, -1).normalized()).toRotationMatrix(),
           Eigen::Vector3d(0.01, 0.02, 0.03));
  return BeliefGrid(config);
}

std::string hash_of_run(const Sensor& sensor, const IntegrationConfig& config, int threads) {
  BeliefGrid grid = turned_grid();
  FrameIntegrator integrator(sensor, config, {threads});
  for (int view = 0; view < 3; ++view) {
    integrator.integrate(grid, noisy_frame(sensor, view), ring_view(view));
  }
  return grid.content_hash();
}

TEST(Determinism, ThreadsAndInstructionSets) {
  struct Rule {
    bool distorted;
    IntegrationConfig config;
  };
  for (const auto& [distorted, config] : {Rule{false, {Carve::cones, Occupancy::probabilistic}},
                                          Rule{true, {Carve::cones, Occupancy::probabilistic}},
                                          Rule{true, {Carve::cones, Occupancy::literal}},
                                          Rule{false, {Carve::lines, Occupancy::probabilistic}},
                                          Rule{true, {Carve::lines, Occupancy::literal}}}) {
    const Sensor sensor = noisy_sensor(distorted);
    const std::string expected = hash_of_run(sensor, config, 1);
    for (const int threads : {1, 2, 3, 8}) {
      EXPECT_EQ(hash_of_run(sensor, config, threads), expected) << threads;
    }
    for (const Isa isa : supported_isas()) {
      const IsaLimit limit(isa);
      EXPECT_EQ(hash_of_run(sensor, config, 2), expected) << isa_name(isa);
    }
  }
}

TEST(Determinism, AnIntegratorHasNoMemoryOfOtherFrames) {
  const Sensor sensor = noisy_sensor(true);
  for (const Carve carve : {Carve::cones, Carve::lines}) {
    FrameIntegrator used(sensor, {carve, Occupancy::probabilistic}, {2});
    BeliefGrid other(object_grid(31));
    for (int view = 0; view < 3; ++view) {
      used.integrate(other, noisy_frame(sensor, view), ring_view(view));
    }
    BeliefGrid a = turned_grid(), b = turned_grid();
    used.integrate(a, noisy_frame(sensor, 5), ring_view(5));
    FrameIntegrator(sensor, {carve, Occupancy::probabilistic}, {2})
        .integrate(b, noisy_frame(sensor, 5), ring_view(5));
    EXPECT_EQ(a.content_hash(), b.content_hash());
  }
}

TEST(Determinism, SavingAndLoadingBetweenFramesChangesNothing) {
  const TemporaryFolder folder;
  const Sensor sensor = noisy_sensor(false);
  BeliefGrid straight = turned_grid(), through_files = turned_grid();
  FrameIntegrator integrator(sensor, {}, {2});
  for (int view = 0; view < 4; ++view) {
    const DepthFrame frame = noisy_frame(sensor, view);
    integrator.integrate(straight, frame, ring_view(view));
    integrator.integrate(through_files, frame, ring_view(view));
    save_vdb(through_files, folder.path() / "map.vdb");
    through_files = load_vdb(folder.path() / "map.vdb");
    EXPECT_EQ(through_files.content_hash(), straight.content_hash()) << view;
  }
}

}  // namespace
}  // namespace viewgain
