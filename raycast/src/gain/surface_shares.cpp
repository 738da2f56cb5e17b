// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What each voxel or each run of a view contributes to its gain, in double precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "from_behind.hpp"
#include "surface_view.hpp"
#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
void SurfaceView::find_visits(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                              Workspace& workspace) const {
  WalkTask task;
  set_up(tracer_.table(), number, frame, rays, task);
  std::vector<VoxelVisit>& mixed = workspace.mixed_visits;
  mixed.clear();
  walk_.visits(bricks_, walk_limits(scene_, frame), task, mixed);
  // A packet's rays take turns; each ray's visits are in order, and stay so.
  std::array<std::size_t, kTileRays> place{};
  for (const VoxelVisit& visit : mixed) ++place[visit.lane];
  std::size_t sum = 0;
  for (std::size_t& p : place) sum += std::exchange(p, sum);
  workspace.visits.resize(mixed.size());
  for (const VoxelVisit& visit : mixed) workspace.visits[place[visit.lane]++] = visit;
}

// Makes shares of a tile's visits, ray by ray.
class SurfaceView::ShareFinder {
 public:
  ShareFinder(const SurfaceView& surface, std::size_t number, const RayTile& rays,
              Workspace& workspace, SharesOf of)
      : surface_(surface),
        rays_(rays),
        of_(of),
        solid_angle_(&surface.tracer_.table().solid_angle[number * kTileRays]),
        voxel_size_(surface.scene_.snapshot.voxel_size),
        is_weighted_(!surface.core_.config.weights.empty()),
        shares_(workspace.shares),
        areas_(workspace.share_areas) {}

  void run(const std::vector<VoxelVisit>& visits) {
    areas_.clear();
    for (auto first = visits.begin(), last = first; first != visits.end(); first = last) {
      const bool is_new_ray = first == visits.begin() || first->lane != (first - 1)->lane;
      const bool follows_on = !is_new_ray && first->begin == (first - 1)->end;
      if (is_new_ray) passed_ = 1.0;
      last = first + 1;
      if (first->state == BrickTable::kOccupiedVoxel) {
        end(*first, follows_on);
        continue;
      }
      if (!follows_on) {
        stretch_ = {.first = shares_.size(), .begin = first->begin, .passed = passed_};
      }
      while (last != visits.end() && is_same_run(*(last - 1), *last)) ++last;
      add_run(&*first, &*first + (last - first));
    }
  }

 private:
  // Whether two visits are in one cell of the hazard field, one right after the other.
  [[nodiscard]] bool is_same_run(const VoxelVisit& a, const VoxelVisit& b) const {
    const int shift = surface_.bricks_.rate_shift;
    return a.lane == b.lane && a.state == b.state && a.end == b.begin &&
           a.x >> shift == b.x >> shift && a.y >> shift == b.y >> shift &&
           a.z >> shift == b.z >> shift;
  }

  // The ray ends in an occupied voxel.
  void end(const VoxelVisit& visit, bool follows_on) {
    const int lane = static_cast<int>(visit.lane);
    const bool is_hidden = follows_on && visit.begin - stretch_.begin >= FromBehind::kLeastStretch;
    const float cosine =
        is_hidden ? surface_.cosine_at(rays_, lane, {visit.x, visit.y, visit.z}) : 0.0F;
    if (cosine > FromBehind::kLeastCosine) {
      const double chance = stretch_.passed > 0 ? stretch_.share / stretch_.passed : 0;
      const double factor = FromBehind::area_over_across(static_cast<double>(cosine)) / chance;
      for (std::size_t i = stretch_.first; chance > 0 && i < shares_.size(); ++i) {
        shares_[i].probability /= chance;
        shares_[i].area = areas_[i] * factor;
      }
      passed_ = 0;
    }
    SurfaceShare share{lane, visit.begin, surface_.voxel_at(visit.x, visit.y, visit.z),
                       true, passed_,     0.0};
    if (surface_.core_.config.model == GainModel::combined) {
      share.information = surface_.information(rays_, lane, visit.begin) * passed_;
    }
    shares_.push_back(share);
    areas_.push_back(0);
  }

  // The visits of a run, one to each voxel.
  void add_run(const VoxelVisit* first, const VoxelVisit* last) {
    const double V = voxel_size_;
    const double begin = static_cast<double>(first->begin),
                 end = static_cast<double>((last - 1)->end);
    const double rate = std::abs(static_cast<double>(first->rate)), depth = rate * (end - begin);
    const double P = passed_ * -std::expm1(-depth);
    const double t = 0.5 * (begin + end);
    const double squared = t * t + (end - begin) * (end - begin) / 12;  // mean of t² over the run
    const double across = std::min(static_cast<double>(solid_angle_[first->lane]) * squared,
                                   static_cast<double>(surface_.worth_.cap)) *
                          surface_.reading_worth_(t * V);
    const auto put = [&](const VoxelVisit& visit, double part, double weight) {
      const double area = part * across * weight * V * V;
      const bool is_new = !std::signbit(visit.rate);
      areas_.push_back(area);
      shares_.push_back({static_cast<int>(visit.lane),
                         visit.begin,
                         surface_.voxel_at(visit.x, visit.y, visit.z),
                         false,
                         part,
                         is_new ? area : 0.0,
                         {},
                         rate});
    };
    double weight_of_run = is_weighted_ ? 0.0 : 1.0;
    for (const VoxelVisit* visit = first; visit != last; ++visit) {
      const double of_run =
          (static_cast<double>(visit->end) - static_cast<double>(visit->begin)) / (end - begin);
      const auto weight = [&] {
        return surface_.weight_of(surface_.voxel_at(visit->x, visit->y, visit->z));
      };
      if (of_ == SharesOf::voxels) {
        put(*visit, P * of_run, weight());
      } else if (is_weighted_) {
        weight_of_run += of_run * weight();
      }
    }
    if (of_ == SharesOf::runs) put(*first, P, weight_of_run);
    passed_ *= std::exp(-depth);
    stretch_.share += P;
  }

  const SurfaceView& surface_;
  const RayTile& rays_;
  SharesOf of_;
  const float* solid_angle_;
  double voxel_size_;
  bool is_weighted_;
  std::vector<SurfaceShare>& shares_;
  std::vector<double>& areas_;  // of the shares, whether new or not
  double passed_ = 1.0;
  // The stretch of unknown voxels that the ray is in: its first share, where it begins, T there,
  // what of T ends in it.
  struct {
    std::size_t first = 0;
    float begin = 0;
    double passed = 1.0, share = 0;
  } stretch_;
};

void SurfaceView::find_shares(const PoseFrame& frame, std::size_t number, const RayTile& rays,
                              Workspace& workspace, SharesOf of) const {
  find_visits(frame, number, rays, workspace);
  ShareFinder(*this, number, rays, workspace, of).run(workspace.visits);
}

}  // namespace viewgain::detail
