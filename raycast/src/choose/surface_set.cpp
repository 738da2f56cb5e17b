// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "surface_set.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gain/task_weight.hpp"

namespace viewgain::detail {
namespace {

std::uint64_t key_of(Index3 v) {
  const auto bits = [](std::int32_t i) { return static_cast<std::uint64_t>(i) & 0x1FFFFFU; };
  return bits(v.x) << 42U | bits(v.y) << 21U | bits(v.z);
}

}  // namespace

double SurfaceSet::worth_of(Index3 least, double rate) const {
  const double V = driver_.scene().snapshot.voxel_size;
  const int side = 1 << surface_.cell_shift();
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

template <typename Visit>
void SurfaceSet::look(const PoseFrame& frame, Workspace& workspace, std::uint32_t& hits,
                      Visit&& cell) const {
  struct Seen {
    std::uint64_t key;
    Index3 least;
    double rate, area;
  };
  std::unordered_map<std::uint64_t, std::size_t> places;
  std::vector<Seen> seen;
  const int shift = surface_.cell_shift();
  workspace.occupied.begin();
  driver_.tracer().prepare(frame, workspace.sweep);
  surface_.for_each_share(
      frame, workspace, [&](std::size_t, const RayTile&, const SurfaceShare& share) {
        if (share.is_occupied) {
          ++hits;
          if (refines()) workspace.occupied.add(share.voxel, share.information);
          return;
        }
        if (!(share.area > 0)) return;
        const Index3& v = share.voxel;
        const Index3 least{v.x >> shift << shift, v.y >> shift << shift, v.z >> shift << shift};
        const auto [found, is_new] = places.try_emplace(key_of(least), seen.size());
        if (is_new) seen.push_back({found->first, least, share.rate, 0});
        seen[found->second].area += share.area;
      });
  for (const Seen& one : seen) {
    const double worth = worth_of(one.least, one.rate);
    if (worth > 0) cell(one.key, worth, std::min(1.0, one.area / worth));
  }
}

double SurfaceSet::refinement(const OccupiedSums::Entry& added) const {
  const auto chosen = known_.find(key_of(added.voxel));
  if (chosen == known_.end()) return surface_.saturated_gain(added.voxel, added.information);
  return surface_.saturated_gain(added.voxel, chosen->second + added.information) -
         surface_.saturated_gain(added.voxel, chosen->second);
}

ViewGain SurfaceSet::after(const Pose& T_world_camera, ViewDriver::Lease& lease) const {
  ViewGain result;
  const auto frame = driver_.open(T_world_camera, result);
  if (!frame) return result;
  Workspace& workspace = lease.workspace();
  result.hits = 0;
  result.area = 0;
  look(*frame, workspace, result.hits, [&](std::uint64_t key, double worth, double reached) {
    const auto cell = cells_.find(key);
    result.area += worth * reached * (cell == cells_.end() ? 1.0 : cell->second.missed);
  });
  result.gain = result.area;
  result.status = ViewGain::Status::ok;
  if (!refines()) return result;
  const auto& occupied = workspace.occupied.entries();
  result.occupied_voxels = static_cast<std::uint32_t>(occupied.size());
  result.refinement_saturated = 0;
  for (const OccupiedSums::Entry& entry : occupied) {
    result.refinement_saturated += refinement(entry);
  }
  result.gain = surface_.nats_per_area() * result.area +
                driver_.core()->config.refinement_weight * result.refinement_saturated;
  return result;
}

void SurfaceSet::choose(const Pose& T_world_camera, ViewDriver::Lease& lease) {
  ViewGain ignored;
  const auto frame = driver_.open(T_world_camera, ignored);
  if (!frame) return;
  Workspace& workspace = lease.workspace();
  std::uint32_t hits = 0;
  look(*frame, workspace, hits, [&](std::uint64_t key, double worth, double reached) {
    Cell& cell = cells_[key];
    cell.worth = worth;
    cell.missed *= 1 - reached;
    cell.largest = std::max(cell.largest, reached);
  });
  if (!refines()) return;
  for (const OccupiedSums::Entry& entry : workspace.occupied.entries()) {
    refined_ += refinement(entry);
    const auto [known, is_new] = known_.try_emplace(key_of(entry.voxel), entry.information);
    if (!is_new) known->second += entry.information;
  }
}

double SurfaceSet::by_best_alone() const {
  double area = 0;
  for (const auto& [key, cell] : cells_) area += cell.worth * cell.largest;
  if (!refines()) return area;
  return surface_.nats_per_area() * area + driver_.core()->config.refinement_weight * refined_;
}

}  // namespace viewgain::detail
