// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Which voxels a view's gain comes from.
#include "viewgain/raycast/view_contributions.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

#include "gain_evaluator_impl.hpp"

namespace viewgain {

std::vector<VoxelContribution> GainEvaluator::contributions(const Pose& T_world_camera) const {
  ViewGain view;
  const auto frame = impl_->open_view(T_world_camera, view);
  if (!frame) return {};
  const VoxelScene::Data& data = impl_->data;
  const detail::GainSettings& settings = impl_->settings;

  Impl::Lease lease(*impl_);
  auto& [accumulator, bins, view_hits] = lease.get();
  std::unordered_map<std::uint64_t, std::uint32_t> rays;
  accumulator.begin();
  impl_->tracer.trace(*frame, bins, [&](std::size_t, const detail::RayTile& tile) {
    accumulator.add(tile);
    for (std::uint32_t left = tile.hit; left != 0; left &= left - 1) {
      const int lane = std::countr_zero(left);
      ++rays[data.hit_key(tile.primitive[lane], tile.offset[lane])];
    }
  });

  std::vector<VoxelContribution> contributions;
  contributions.reserve(rays.size());
  const auto prior = SymmetricMatrix3::identity(settings.prior_information);
  accumulator.visit([&](std::uint64_t key, const std::optional<detail::VoxelSum>& known,
                        const detail::VoxelSum& sum, double weight) {
    const SymmetricMatrix3 before = known ? prior + detail::matrix_of(*known) : prior;
    const double gain =
        weight * entropy_reduction(before, detail::matrix_of(sum), settings.criterion);
    contributions.push_back(
        {data.voxel_at(key), known ? VoxelState::occupied : VoxelState::unknown, rays[key], gain});
  });
  // Ascending; a gain beyond double precision comes last.
  const auto order = [](const VoxelContribution& c) {
    return std::tuple(std::isnan(c.gain) ? std::numeric_limits<double>::infinity() : -c.gain,
                      c.voxel.x, c.voxel.y, c.voxel.z);
  };
  std::sort(contributions.begin(), contributions.end(),
            [&](const auto& a, const auto& b) { return order(a) < order(b); });
  return contributions;
}

}  // namespace viewgain
