// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "voxel_sums.hpp"

#include <algorithm>
#include <bit>

#include "trace/scene_tracing.hpp"

namespace viewgain::detail {
namespace {

// Stands for a block without occupied voxels.
const GridSnapshot::Leaf kNoneOccupied{};

}  // namespace

VoxelSums::VoxelSums(const SceneData& scene, const GainSettings& settings, std::size_t max_rays)
    : max_rays_(max_rays) {
  const std::size_t most = max_rays + kOverhang;
  touched_.resize(most);
  sums_.resize(most);
  unknown_.resize(most);
  occupied_.resize(most);
  occupied_block_.resize(most);
  occupied_offset_.resize(most);
  known_a_.resize(most);
  known_b_.resize(most);
  rebind(scene, settings);
}

void VoxelSums::rebind(const SceneData& scene, const GainSettings& settings) {
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

void VoxelSums::begin(std::vector<SampledHit>* sample) {
  batch_.count = 0;
  hits_ = 0;
  sample_ = sample;
  if (sample_ != nullptr) sample_->clear();
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

void VoxelSums::add(const RayTile& tile, const float* expected) {
  for (std::uint32_t left = tile.hit; left != 0; left &= left - 1) {
    sample_->push_back({0, static_cast<std::uint32_t>(std::countr_zero(left))});
  }
  std::copy_n(expected, std::popcount(tile.hit), batch_.expected + batch_.count);
  add(tile);
}

void VoxelSums::add(const HitList& hits) {
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

// From the batch into the sums: Λ_r of every hit, its voxel's place, and one more term there.
void VoxelSums::flush() {
  const std::size_t count = batch_.count;
  kernels_->expand(settings_->sigmas, scene_->snapshot.voxel_size, batch_);
  std::uint32_t places[kMostAtOnce];
  std::uint64_t keep[kMostAtOnce];
  find_places(places, keep);
  if (sample_ != nullptr) {
    // A sum has room for two numbers more: the voxel's hits, and what they are expected to be.
    for (std::size_t i = 0; i < count; ++i) {
      batch_.information_b[i][2] = 1;
      batch_.information_b[i][3] = 1 / static_cast<double>(batch_.expected[i]);
      (*sample_)[hits_ + i].place = places[i];
    }
  }
  kernels_->accumulate(batch_, places, keep, sums_.data());
  hits_ += static_cast<std::uint32_t>(count);
  batch_.count = 0;
}

// Where the voxels of the batch are in the list, new ones at its end; keep as accumulate() has it.
void VoxelSums::find_places(std::uint32_t* places, std::uint64_t* keep) {
  // Loops of independent steps, so that many memory requests are in flight at once.
  const std::size_t count = batch_.count;
  std::uint32_t codes[kMostAtOnce];
  for (std::size_t i = 0; i < count; ++i) {
    codes[i] = code_of(batch_.primitive[i], batch_.offset[i]);
    __builtin_prefetch(&places_[codes[i]], 1);
  }
  // Whether a voxel is new cannot be predicted, so what a new one needs is done for all.
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
}

// The code of the voxel that a hit ends in.
inline std::uint32_t VoxelSums::code_of(std::uint32_t primitive, std::uint32_t offset) {
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

// The block of a larger box whose first voxel has this key.
std::uint32_t VoxelSums::block_in_box(std::uint64_t key) {
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

std::uint32_t VoxelSums::start_block(std::uint64_t key, const GridSnapshot::Leaf* leaf) {
  const auto block = static_cast<std::uint32_t>(blocks_.size());
  blocks_.push_back({leaf, key});
  if (places_.size() < blocks_.size() << 9U) places_.resize(blocks_.size() << 9U, kNone);
  return block;
}

void VoxelSums::close() {
  flush();
  // Which voxel is of which class cannot be predicted, so both lists are written and one of them
  // moves on.
  std::size_t unknown = 0, occupied = 0;
  for (std::uint32_t i = 0; i < touched_count_; ++i) {
    const GridSnapshot::Leaf* leaf = blocks_[touched_[i] >> 9U].leaf;
    const std::size_t is_occupied = test_bit(leaf->occupied, touched_[i] & 511U) ? 1 : 0;
    unknown_[unknown] = i;
    occupied_[occupied] = i;
    unknown += 1 - is_occupied;
    occupied += is_occupied;
  }
  unknown_count_ = unknown;
  occupied_count_ = occupied;
}

void VoxelSums::look_up() {
  for (std::size_t i = 0; i < occupied_count_; ++i) {
    const std::uint32_t code = touched_[occupied_[i]];
    occupied_block_[i] = blocks_[code >> 9U].leaf->beliefs.get();
    occupied_offset_[i] = code & 511U;
  }
  kernels_->look_up(occupied_block_.data(), occupied_offset_.data(), occupied_count_,
                    known_a_.data(), known_b_.data());
}

double VoxelSums::weight(std::uint32_t place) const {
  if (settings_->weights.empty()) return 1.0;
  return task_weight(settings_->weights, scene_->voxel_at(key(place)), scene_->snapshot.voxel_size);
}

void VoxelSums::finish_unknown(LogProduct& ratios, LogProduct* posterior, double* each) const {
  kernels_->finish(settings_->criterion, settings_->prior_information,
                   {sums_.data(), unknown_.data(), nullptr, nullptr, unknown_count_}, ratios,
                   posterior, each);
}

void VoxelSums::finish_occupied(LogProduct& ratios, LogProduct* posterior, double* each) const {
  kernels_->finish(
      settings_->criterion, settings_->prior_information,
      {sums_.data(), occupied_.data(), known_a_.data(), known_b_.data(), occupied_count_}, ratios,
      posterior, each);
}

}  // namespace viewgain::detail
