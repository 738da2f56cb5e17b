// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_tracing.hpp"

#include <cmath>
#include <exception>

#include "tracer_rule.hpp"
#include "voxel_bvh.hpp"

namespace viewgain::detail {

int margin_level(double reach) {
  constexpr double kLevelZeroReach = 2e4;
  int level = 0;
  while (level + 1 < kMarginLevels && reach > std::ldexp(kLevelZeroReach, level)) ++level;
  return level;
}

std::shared_ptr<const SceneTracing> make_tracing(const SceneData& data, const SceneData* before) {
  return std::make_shared<const SceneTracing>(data, before);
}

Isa isa_of(const SceneTracing& tracing) { return tracing.kernels.isa; }

// Only obstacles are always Embree's.
SceneTracing::SceneTracing(const SceneData& data, const SceneData* before)
    : kernels(tile_kernels(data.has_obstacles ? packet_isa(select_isa()) : select_isa())),
      obstacles(ObstacleScene::of(data, kernels.isa, before)),
      data_(data) {}

RTCScene SceneTracing::bvh(int level) const {
  Bvh& bvh = bvhs_.at(static_cast<std::size_t>(level));
  std::call_once(bvh.once, [&] {
    bvh.scene = build_bvh(data_, kernels.isa, margin_of(level));
    bvh.is_built.store(true, std::memory_order_release);
  });
  return bvh.scene.get();
}

bool SceneTracing::takes_bvh(std::size_t rays, int level) const {
  if (!bvh_is_faster(rays, data_.boxes.size())) return false;
  Bvh& bvh = bvhs_.at(static_cast<std::size_t>(level));
  if (bvh.is_built.load(std::memory_order_acquire)) return true;
  const std::uint64_t views = views_.fetch_add(1, std::memory_order_relaxed);
  // One thread builds it; the others need not wait.
  if (!bvh_pays(data_.boxes.size(), views) || bvh.is_wanted.exchange(true)) return false;
  try {
    (void)this->bvh(level);
  } catch (const std::exception&) {  // no packets, or no memory: the sweep does without
    return false;
  }
  return true;
}

const BrickTable& SceneTracing::bricks() const {
  std::call_once(bricks_once_, [&] { bricks_.emplace(data_.snapshot, data_.hazard_field()); });
  return *bricks_;
}

const PooledSurface& SceneTracing::pooled_surface() const {
  std::call_once(pooled_once_, [&] { pooled_.emplace(data_.snapshot); });
  return *pooled_;
}

}  // namespace viewgain::detail
