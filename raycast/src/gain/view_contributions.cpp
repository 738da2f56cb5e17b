// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which voxels a view's gain comes from.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "gain_evaluator_impl.hpp"
#include "viewgain/core/criterion.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain {
namespace {

// Sums hits as the gain does and counts rays by voxel.
struct ContributionConsumer {
  const detail::ViewDriver& driver;
  detail::GainAccumulator& accumulator;
  std::unordered_map<std::uint64_t, std::uint32_t> rays{};
  std::vector<VoxelContribution> contributions{};

  void begin() { accumulator.begin(); }
  void add(std::size_t, const detail::RayTile& tile) {
    accumulator.add(tile);
    detail::for_each_lane(tile.hit, [&](int lane) {
      ++rays[driver.scene().hit_key(tile.primitive[lane], tile.offset[lane])];
    });
  }
  void finish(ViewGain&) {
    const detail::GainSettings& settings = driver.settings();
    contributions.reserve(rays.size());
    const auto prior = SymmetricMatrix3::identity(settings.prior_information);
    accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>& known,
                          const detail::VoxelSum& sum, double weight) {
      const SymmetricMatrix3 before = known ? prior + detail::matrix_of(*known) : prior;
      const double gain =
          weight * entropy_reduction(before, detail::matrix_of(sum), settings.criterion);
      contributions.push_back({driver.scene().voxel_at(key),
                               known ? VoxelState::occupied : VoxelState::unknown, rays[key],
                               static_cast<double>(rays[key]), gain});
    });
  }
};

// The shares of a view that may show new surface, added up by voxel.
std::vector<VoxelContribution> surface_contributions(const detail::ViewDriver& driver,
                                                     const detail::SurfaceView& surface,
                                                     const Pose& T_world_camera,
                                                     detail::Workspace& workspace) {
  ViewGain ignored;
  const auto frame = driver.open(T_world_camera, ignored);
  if (!frame) return {};
  const GainConfig& config = driver.core()->config;
  const bool refines = config.model == GainModel::combined;
  const double per_area = refines ? surface.nats_per_area() : 1.0;
  detail::VoxelPlaces& places = workspace.cells;
  places.begin();
  std::vector<VoxelContribution> parts;
  std::vector<SymmetricMatrix3> information;  // of parts
  driver.tracer().prepare(*frame, workspace.sweep);
  surface.for_each_share(
      *frame, workspace,
      [&](std::size_t, const detail::RayTile&, const detail::SurfaceShare& share) {
        if (share.is_occupied && !refines) return;
        const Index3& v = share.voxel;
        bool is_new = false;
        const std::uint32_t place = places.of(v, is_new);
        if (is_new) {
          parts.push_back({v, share.is_occupied ? VoxelState::occupied : VoxelState::unknown});
          information.emplace_back();
        }
        VoxelContribution& part = parts[place];
        ++part.rays;
        part.expected_rays += share.probability;
        part.gain += per_area * share.area;
        information[place] += share.information;
      });
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].state != VoxelState::occupied) continue;
    parts[i].gain =
        config.refinement_weight * surface.saturated_gain(parts[i].voxel, information[i]);
  }
  return parts;
}

}  // namespace

std::vector<VoxelContribution> GainEvaluator::contributions(const Pose& T_world_camera) const {
  detail::ViewDriver::Lease lease(impl_->driver);
  std::vector<VoxelContribution> contributions;
  if (const detail::SurfaceView* surface = impl_->driver.surface()) {
    contributions =
        surface_contributions(impl_->driver, *surface, T_world_camera, lease.workspace());
  } else {
    ContributionConsumer consumer{impl_->driver, lease.accumulator()};
    impl_->driver.view(T_world_camera, lease, consumer);
    contributions = std::move(consumer.contributions);
  }
  // The largest gain first; one beyond double precision comes last.
  const auto order = [](const VoxelContribution& c) {
    return std::tuple(std::isnan(c.gain) ? std::numeric_limits<double>::infinity() : -c.gain,
                      c.voxel.x, c.voxel.y, c.voxel.z);
  };
  std::sort(contributions.begin(), contributions.end(),
            [&](const auto& a, const auto& b) { return order(a) < order(b); });
  return contributions;
}

}  // namespace viewgain
