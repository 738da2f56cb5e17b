// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "gain_accumulator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <variant>

#include "task_weight.hpp"
#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

// Vectors reach up to this many elements beyond the last voxel.
constexpr std::size_t kOverhang = 8;

// Stands for a block without occupied voxels.
const SnapshotLeaf kNoneOccupied{};

}  // namespace

FrontalSigmas frontal_sigmas(const Sensor& sensor) {
  struct Visitor {
    double fx;
    FrontalSigmas operator()(const ShotNoise& n) const {
      return {.a1 = n.reference_sigma / n.reference_range *
                    std::sqrt(n.reference_integration_time / n.integration_time),
              .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const StructuredLightNoise& n) const {
      return {.a0 = n.offset, .a2 = n.quadratic, .v = n.vertex, .l1 = n.lateral_px / fx};
    }
    FrontalSigmas operator()(const StereoNoise& n) const {
      return {.a2 = n.subpixel / (n.focal_with(fx) * n.baseline), .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const QuadraticNoise& n) const {
      return {.a0 = n.offset, .a2 = n.quadratic, .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const ConstantNoise& n) const {
      return {.a0 = n.sigma_axial, .l0 = n.sigma_lateral};
    }
  };
  FrontalSigmas sigmas = std::visit(Visitor{sensor.camera.fx}, sensor.noise);
  const PoseSigma& pose = sensor.pose_sigma;
  sigmas.p0 = pose.translation * pose.translation;
  sigmas.p2 = pose.rotation * pose.rotation;
  return sigmas;
}

GainAccumulator::GainAccumulator(const SceneData& scene, const GainSettings& settings,
                                 std::size_t max_rays)
    : max_rays_(max_rays) {
  touched_.resize(max_rays + kOverhang);
  sums_.resize(max_rays + kOverhang);
  unknown_.resize(max_rays + kOverhang);
  occupied_.resize(max_rays + kOverhang);
  occupied_leaf_.resize(max_rays + kOverhang);
  occupied_offset_.resize(max_rays + kOverhang);
  known_a_.resize(max_rays + kOverhang);
  known_b_.resize(max_rays + kOverhang);
  if (settings.criterion == Criterion::trace || !settings.weights.empty()) {
    each_.resize(max_rays + 2 * kOverhang);
  }
  rebind(scene, settings);
}

void GainAccumulator::rebind(const SceneData& scene, const GainSettings& settings) {
  begin();  // leaves no trace of the scene before
  scene_ = &scene;
  settings_ = &settings;
  kernels_ = &gain_kernels(scene.tracing->kernels.isa);
  by_primitive_.resize(scene.block_count, kNone);
  if (scene.boxes.size() > scene.block_count && by_key_.empty()) {
    const std::size_t size = std::bit_ceil(std::max<std::size_t>(2 * max_rays_, 64));
    by_key_.resize(size);
    shift_ = 64U - static_cast<unsigned>(std::countr_zero(size));
  }
}

void GainAccumulator::begin() {
  batch_.count = 0;
  hits_ = 0;
  is_sample_ = false;
  for (std::size_t i = 0; i < touched_count_; ++i) places_[touched_[i]] = kNone;
  for (const std::uint32_t primitive : touched_primitives_) by_primitive_[primitive] = kNone;
  touched_primitives_.clear();
  blocks_.clear();
  touched_count_ = 0;
  if (++generation_ == 0) {  // after 2^32 views old stamps would look new
    std::fill(by_key_.begin(), by_key_.end(), BlockSlot{});
    generation_ = 1;
  }
}

std::uint32_t GainAccumulator::start_block(std::uint64_t key, const SnapshotLeaf* leaf) {
  const auto block = static_cast<std::uint32_t>(blocks_.size());
  blocks_.push_back({leaf, key});
  if (places_.size() < blocks_.size() << 9U) places_.resize(blocks_.size() << 9U, kNone);
  return block;
}

// The block of a larger box whose first voxel has this key.
std::uint32_t GainAccumulator::block_in_box(std::uint64_t key) {
  // Fibonacci hashing, linear probing; the table is at most half full.
  std::size_t place = static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ULL) >> shift_);
  while (true) {
    BlockSlot& slot = by_key_[place];
    if (slot.generation != generation_) {
      slot = {key, generation_, start_block(key, &kNoneOccupied)};
      return slot.block;
    }
    if (slot.key == key) return slot.block;
    place = (place + 1) & (by_key_.size() - 1);
  }
}

// The code of the voxel that a hit ends in.
inline std::uint32_t GainAccumulator::code_of(std::uint32_t primitive, std::uint32_t offset) {
  if (primitive >= scene_->block_count) [[unlikely]] {
    const std::uint64_t key = scene_->hit_key(primitive, offset);
    return block_in_box(key & ~std::uint64_t{511}) << 9U | static_cast<std::uint32_t>(key & 511U);
  }
  std::uint32_t block = by_primitive_[primitive];
  if (block == kNone) [[unlikely]] {
    const bool may_be_occupied = primitive < scene_->leaf_count && scene_->has_occupied[primitive];
    touched_primitives_.push_back(primitive);  // first: begin() mends what an exception leaves
    block = start_block(scene_->block_keys[primitive],
                        may_be_occupied ? &scene_->snapshot.leaves[scene_->leaf_source[primitive]]
                                        : &kNoneOccupied);
    by_primitive_[primitive] = block;
  }
  return block << 9U | offset;
}

void GainAccumulator::flush() {
  kernels_->expand(settings_->sigmas, scene_->snapshot.voxel_size, batch_);
  if (is_sample_) count_hits();
  // Three loops of independent steps, so that many memory requests are in flight at once.
  const std::size_t count = batch_.count;
  std::uint32_t codes[kBatchSize + kTileRays];
  for (std::size_t i = 0; i < count; ++i) {
    codes[i] = code_of(batch_.primitive[i], batch_.offset[i]);
    __builtin_prefetch(&places_[codes[i]], 1);
  }
  // Whether a voxel is new cannot be predicted, so what a new one needs is done for all.
  std::uint32_t places[kBatchSize + kTileRays];
  std::uint64_t keep[kBatchSize + kTileRays];
  auto touched_count = static_cast<std::uint32_t>(touched_count_);
  std::uint32_t* const place_of = places_.data();
  std::uint32_t* const touched = touched_.data();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t code = codes[i];
    const std::uint32_t held = place_of[code];
    const std::uint32_t is_new = held == kNone ? 1U : 0U;
    const std::uint32_t place = held ^ ((held ^ touched_count) & (0U - is_new));
    place_of[code] = place;
    touched[place] = code;
    touched_count += is_new;
    places[i] = place;
    keep[i] = std::uint64_t{is_new} - 1;
  }
  touched_count_ = touched_count;
  if (is_sample_) {
    for (std::size_t i = 0; i < count; ++i) sampled_[hits_ + i].place = places[i];
  }
  kernels_->accumulate(batch_, places, keep, sums_.data());
  hits_ += static_cast<std::uint32_t>(count);
  batch_.count = 0;
}

// A voxel's sum has room for two numbers more: its hits, and what they are expected to be.
void GainAccumulator::count_hits() {
  for (std::size_t i = 0; i < batch_.count; ++i) {
    batch_.information_b[i][2] = 1;
    batch_.information_b[i][3] = 1 / static_cast<double>(batch_.expected[i]);
  }
}

void GainAccumulator::begin_sample() {
  begin();
  is_sample_ = true;
  sampled_.clear();
}

void GainAccumulator::add(const RayTile& tile, const float* expected) {
  for (std::uint32_t left = tile.hit; left != 0; left &= left - 1) {
    sampled_.push_back({0, static_cast<std::uint32_t>(std::countr_zero(left))});
  }
  std::copy_n(expected, std::popcount(tile.hit), batch_.expected + batch_.count);
  add(tile);
}

void GainAccumulator::add(const HitList& hits) {
  if (batch_.count > 0) flush();
  batch_.count = hits.count;
  std::copy_n(hits.dx, hits.count, batch_.dx);
  std::copy_n(hits.dy, hits.count, batch_.dy);
  std::copy_n(hits.dz, hits.count, batch_.dz);
  std::copy_n(hits.range, hits.count, batch_.range);
  std::copy_n(hits.primitive, hits.count, batch_.primitive);
  std::copy_n(hits.offset, hits.count, batch_.offset);
  flush();
}

void GainAccumulator::close() {
  flush();
  // Which voxel is of which class cannot be predicted, so both lists are written and one of them
  // moves on.
  std::size_t unknown = 0, occupied = 0;
  for (std::uint32_t i = 0; i < touched_count_; ++i) {
    const SnapshotLeaf* leaf = blocks_[touched_[i] >> 9U].leaf;
    const std::size_t is_occupied = test_bit(leaf->occupied, touched_[i] & 511U) ? 1 : 0;
    unknown_[unknown] = i;
    occupied_[occupied] = i;
    unknown += 1 - is_occupied;
    occupied += is_occupied;
  }
  unknown_count_ = unknown;
  occupied_count_ = occupied;
}

// What is known of the occupied voxels.
void GainAccumulator::look_up() {
  for (std::size_t i = 0; i < occupied_count_; ++i) {
    const std::uint32_t code = touched_[occupied_[i]];
    occupied_leaf_[i] = blocks_[code >> 9U].leaf;
    occupied_offset_[i] = code & 511U;
  }
  kernels_->look_up(occupied_leaf_.data(), occupied_offset_.data(), occupied_count_,
                    known_a_.data(), known_b_.data());
}

double GainAccumulator::weight(std::uint32_t code) const {
  return task_weight(settings_->weights, scene_->voxel_at(blocks_[code >> 9U].key | (code & 511U)),
                     scene_->snapshot.voxel_size);
}

GainAccumulator::ClassGain GainAccumulator::finish_class(std::span<const std::uint32_t> members,
                                                         bool is_known, double* each) const {
  const bool logarithmic = settings_->criterion != Criterion::trace;
  LogProduct ratios, posterior;
  kernels_->finish(settings_->criterion, settings_->prior_information,
                   {sums_.data(), members.data(), is_known ? known_a_.data() : nullptr,
                    known_b_.data(), members.size()},
                   ratios, settings_->posterior_entropy ? &posterior : nullptr, each);
  const double left =
      settings_->posterior_entropy ? posterior.log() : std::numeric_limits<double>::quiet_NaN();
  if (each == nullptr) return {0.5 * ratios.log(), left};
  double sum = 0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const double w = settings_->weights.empty() ? 1.0 : weight(touched_[members[i]]);
    sum += w * (logarithmic ? 0.5 * std::log(each[i]) : each[i]);
  }
  return {sum, left};
}

// What voxels of one class gain with those that they stand for; copies_ are then a hit's share.
void GainAccumulator::spread(std::span<const std::uint32_t> members, bool is_known,
                             double rays_each, SampleTally& tally) {
  for (const std::uint32_t place : members) {
    VoxelSum& sum = sums_[place];
    const SampledVoxel voxel(sum.b[2], sum.b[2] / sum.b[3], rays_each);
    for (double& value : sum.a) value *= voxel.rays_per_hit;
    for (std::size_t k = 0; k < 2; ++k) sum.b[k] *= voxel.rays_per_hit;
    copies_[place] = voxel.copies;
  }
  sampled_each_.resize(members.size() + kOverhang);
  LogProduct ratios;
  kernels_->finish(settings_->criterion, settings_->prior_information,
                   {sums_.data(), members.data(), is_known ? known_a_.data() : nullptr,
                    known_b_.data(), members.size()},
                   ratios, nullptr, sampled_each_.data());
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::uint32_t place = members[i];
    const double hits = sums_[place].b[2], expected = hits / sums_[place].b[3];
    double gain = settings_->criterion == Criterion::trace ? sampled_each_[i]
                                                           : 0.5 * std::log(sampled_each_[i]);
    gain *= copies_[place];
    if (!settings_->weights.empty()) gain *= weight(touched_[place]);
    tally.add(gain, hits, expected);
    copies_[place] = gain / hits;
  }
}

void GainAccumulator::finish_sample(double rays_each, SampleTally& tally) {
  close();
  look_up();
  copies_.resize(touched_count_);
  spread({unknown_.data(), unknown_count_}, false, rays_each, tally);
  spread({occupied_.data(), occupied_count_}, true, rays_each, tally);
  for (const SampledHit& hit : sampled_) tally.by_lane[hit.lane] += copies_[hit.place];
}

GainAccumulator::ClassGain GainAccumulator::explored() {
  return finish_class({unknown_.data(), unknown_count_}, false,
                      each_.empty() ? nullptr : each_.data());
}

GainAccumulator::ClassGain GainAccumulator::refined() {
  look_up();
  return finish_class({occupied_.data(), occupied_count_}, true,
                      each_.empty() ? nullptr : each_.data() + unknown_count_ + kOverhang);
}

void GainAccumulator::finish(const ClassGain& explored, const ClassGain& refined,
                             ViewGain& result) const {
  result.exploration = explored.gain;
  result.refinement = refined.gain;
  result.gain = result.exploration + result.refinement;
  result.posterior_entropy = explored.posterior_entropy + refined.posterior_entropy;
  result.hits = hits_;
  result.unknown_voxels = static_cast<std::uint32_t>(unknown_count_);
  result.occupied_voxels = static_cast<std::uint32_t>(occupied_count_);
}

}  // namespace viewgain::detail
