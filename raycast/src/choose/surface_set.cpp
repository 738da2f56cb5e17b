// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gain/voxel_sums.hpp"

namespace viewgain::detail {
namespace {

// A workspace has at most 2^16 voxels per axis, so the lowest bits distinguish its voxels.
constexpr unsigned kBits = 21;  // of a coordinate in a key
constexpr std::uint32_t kMask = (1U << kBits) - 1;

std::uint64_t key_of(Index3 v) {
  const auto bits = [](std::int32_t i) {
    return std::uint64_t{static_cast<std::uint32_t>(i) & kMask};
  };
  return bits(v.x) << 2 * kBits | bits(v.y) << kBits | bits(v.z);
}
/// `lowest` must not be above the voxel along any axis.
Index3 voxel_of(std::uint64_t key, Index3 lowest) {
  const auto number = [key](unsigned shift, std::int32_t from) {
    const auto above = static_cast<std::uint32_t>(key >> shift) - static_cast<std::uint32_t>(from);
    return from + static_cast<std::int32_t>(above & kMask);
  };
  return {number(2 * kBits, lowest.x), number(kBits, lowest.y), number(0, lowest.z)};
}

}  // namespace

double SurfaceSet::worth_of(Index3 least, double rate) const {
  const double V = driver_.scene().snapshot.voxel_size;
  const int side = 1 << surface_.bricks().rate_shift;
  const std::vector<GainConfig::WeightRegion>& weights = driver_.core()->config.weights;
  double weight = 1;
  if (!weights.empty()) {
    weight = 0;
    for (int x = 0; x < side; ++x) {
      for (int y = 0; y < side; ++y) {
        for (int z = 0; z < side; ++z) {
          weight += task_weight(weights, {least.x + x, least.y + y, least.z + z}, V);
        }
      }
    }
    weight /= side * side * side;
  }
  return weight * side * side * V * V * -std::expm1(-rate * side);
}

SurfaceSet::Look SurfaceSet::look(const Pose& T_world_camera, Workspace& workspace) const {
  Look look;
  const auto frame = driver_.open(T_world_camera, look.seen);
  if (!frame) return look;
  look.seen.hits = 0;
  look.seen.status = ViewGain::Status::ok;
  struct Seen {
    double rate, area;
  };
  std::vector<Seen> seen;  // by index of the cell
  const int shift = surface_.bricks().rate_shift;
  const auto least = [shift](Index3 cell) {
    return Index3{cell.x << shift, cell.y << shift, cell.z << shift};
  };
  VoxelPlaces& cells = workspace.cells;
  cells.begin();
  workspace.occupied.begin();
  driver_.tracer().prepare(*frame, workspace.sweep);
  surface_.for_each_share<SurfaceView::SharesOf::runs>(
      *frame, workspace, [&](std::size_t, const RayTile&, const SurfaceShare& share) {
        if (share.is_occupied) {
          ++look.seen.hits;
          if (refines()) workspace.occupied.add(share.voxel, share.information);
          return;
        }
        if (!(share.area > 0)) return;
        const Index3& v = share.voxel;
        bool is_new = false;
        const std::uint32_t place = cells.of({v.x >> shift, v.y >> shift, v.z >> shift}, is_new);
        if (is_new) seen.push_back({share.rate, 0});
        seen[place].area += share.area;
      });
  look.cells.reserve(cells.count());
  for (std::uint32_t i = 0; i < cells.count(); ++i) {
    const Index3 at = least(cells.voxel(i));
    const double worth = worth_of(at, seen[i].rate);
    if (worth > 0) look.cells.push_back({key_of(at), worth, std::min(1.0, seen[i].area / worth)});
  }
  if (refines()) {
    const OccupiedSums& occupied = workspace.occupied;
    look.seen.occupied_voxels = occupied.count();
    look.refines.reserve(occupied.count());
    for (std::uint32_t i = 0; i < occupied.count(); ++i) {
      look.refines.push_back({occupied.voxel(i), occupied.information(i)});
    }
  }
  return look;
}

std::shared_ptr<const SurfaceSet::Look> SurfaceSet::look_of(std::size_t i,
                                                            const Pose& T_world_camera,
                                                            Workspace& workspace) {
  if (looks_[i]) return looks_[i];
  const auto made = std::make_shared<const Look>(look(T_world_camera, workspace));
  const std::size_t bytes =
      made->cells.size() * sizeof(Reached) + made->refines.size() * sizeof(Refined);
  if (kept_.fetch_add(bytes) + bytes <= kMostKept) {
    looks_[i] = made;
  } else {
    kept_ -= bytes;
  }
  return made;
}

double SurfaceSet::refinement(const Refined& added) const {
  const auto chosen = known_.find(key_of(added.voxel));
  if (chosen == known_.end()) return surface_.saturated_gain(added.voxel, added.information);
  return surface_.saturated_gain(added.voxel, chosen->second + added.information) -
         surface_.saturated_gain(added.voxel, chosen->second);
}

ViewGain SurfaceSet::tighter(const Pose& T_world_camera, ViewDriver::Lease& lease) const {
  if (!driver_.core()->config.weights.empty()) {  // the kernel is then not used
    ViewGain none;
    none.gain = std::numeric_limits<double>::infinity();
    return none;
  }
  ViewGain result = driver_.evaluate(T_world_camera, lease, missed_.data());
  if (!refines() || result.status != ViewGain::Status::ok) return result;
  const OccupiedSums& occupied = lease.workspace().occupied;
  result.refinement_saturated = 0;
  for (std::uint32_t i = 0; i < occupied.count(); ++i) {
    result.refinement_saturated += refinement({occupied.voxel(i), occupied.information(i)});
  }
  result.gain = combined(result.area, result.refinement_saturated);
  return result;
}

ViewGain SurfaceSet::after(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease) {
  const std::shared_ptr<const Look> held = look_of(i, T_world_camera, lease.workspace());
  const Look& look = *held;
  ViewGain result = look.seen;
  if (result.status != ViewGain::Status::ok) return result;
  result.area = 0;
  for (const Reached& one : look.cells) {
    const auto cell = cells_.find(one.key);
    result.area += one.worth * one.share * (cell == cells_.end() ? 1.0 : cell->second.missed);
  }
  result.gain = result.area;
  if (!refines()) return result;
  result.refinement_saturated = 0;
  for (const Refined& entry : look.refines) result.refinement_saturated += refinement(entry);
  result.gain = combined(result.area, result.refinement_saturated);
  return result;
}

void SurfaceSet::choose(std::size_t i, const Pose& T_world_camera, ViewDriver::Lease& lease) {
  const std::shared_ptr<const Look> held = look_of(i, T_world_camera, lease.workspace());
  const Look& look = *held;
  if (missed_.empty()) missed_.assign(surface_.bricks().places(), 1.0F);
  const Index3 lowest = surface_.voxel_at(0, 0, 0);
  for (const Reached& one : look.cells) {
    Cell& cell = cells_[one.key];
    cell.worth = one.worth;
    cell.missed *= 1 - one.share;
    cell.largest = std::max(cell.largest, one.share);
    if (const auto place = surface_.bricks().place_of(voxel_of(one.key, lowest))) {
      missed_[*place] = static_cast<float>(cell.missed);
    }
  }
  for (const Refined& entry : look.refines) {
    refined_ += refinement(entry);
    const auto [known, is_new] = known_.try_emplace(key_of(entry.voxel), entry.information);
    if (!is_new) known->second += entry.information;
  }
}

double SurfaceSet::by_best_alone() const {
  double area = 0;
  for (const auto& [key, cell] : cells_) area += cell.worth * cell.largest;
  if (!refines()) return area;
  return combined(area, refined_);
}

}  // namespace viewgain::detail
