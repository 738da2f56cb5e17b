// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which voxels a view's gain comes from.
#include "viewgain/raycast/view_contributions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "gain_evaluator_impl.hpp"
#include "viewgain/core/criterion.hpp"

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
                               gain});
    });
  }
};

}  // namespace

std::vector<VoxelContribution> GainEvaluator::contributions(const Pose& T_world_camera) const {
  detail::ViewDriver::Lease lease(impl_->driver);
  ContributionConsumer consumer{impl_->driver, lease.accumulator()};
  impl_->driver.view(T_world_camera, lease, consumer);
  // The largest gain first; one beyond double precision comes last.
  const auto order = [](const VoxelContribution& c) {
    return std::tuple(std::isnan(c.gain) ? std::numeric_limits<double>::infinity() : -c.gain,
                      c.voxel.x, c.voxel.y, c.voxel.z);
  };
  std::sort(consumer.contributions.begin(), consumer.contributions.end(),
            [&](const auto& a, const auto& b) { return order(a) < order(b); });
  return std::move(consumer.contributions);
}

}  // namespace viewgain
