// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frame_hits.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "map/belief_sum.hpp"

namespace viewgain::detail {
namespace {

constexpr std::size_t kPixelChunk = 1024, kBlockChunk = 16;
constexpr double kStep = 0.5;    // along the ray [cells]
constexpr double kMargin = 2.0;  // factor by which another voxel must be better
constexpr double kFarthest = 8;  // reach that is searched; limits the cost [cells]

constexpr std::size_t kHitChunk = 1024, kSurfaceRows = 4;
constexpr std::size_t kSortPart = 8192;  // least hits that a thread sorts at a time

Hit hit(const BlockLattice& lattice, Index3 voxel, std::size_t pixel) {
  return {lattice.key(voxel), static_cast<std::uint32_t>(pixel), block_offset(voxel)};
}

/// Sorts the hits by block, stably. `scratch` is working space.
void sort_by_block(std::vector<Hit>& hits, std::vector<Hit>& scratch, ThreadPool& pool) {
  // Radix sort from the lowest digit: stable, and most keys have few varying digits. The hits are
  // counted and moved in parts, each by one thread.
  constexpr unsigned kBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kBits, kMostParts = 16;
  const std::size_t parts = std::clamp<std::size_t>(hits.size() / kSortPart, 1, kMostParts);
  const std::size_t length = (hits.size() + parts - 1) / parts;
  std::vector<std::array<std::uint32_t, kBuckets>> position(parts);
  std::uint64_t varying = 0;
  for (const Hit& hit : hits) varying |= hit.block ^ hits.front().block;
  scratch.resize(hits.size());
  for (unsigned shift = 0; shift < 64 && varying >> shift != 0; shift += kBits) {
    if ((varying >> shift & (kBuckets - 1)) == 0) continue;
    const auto for_each_part = [&](const auto& body) {
      pool.for_each_chunk(hits.size(), length, [&](std::size_t begin, std::size_t end) {
        std::array<std::uint32_t, kBuckets>& own = position[begin / length];
        for (std::size_t i = begin; i < end; ++i) {
          body(hits[i], own[hits[i].block >> shift & (kBuckets - 1)]);
        }
      });
    };
    for (auto& own : position) own.fill(0);
    for_each_part([](const Hit&, std::uint32_t& count) { ++count; });
    std::uint32_t sum = 0;
    for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
      for (auto& own : position) {
        const std::uint32_t count = own[bucket];
        own[bucket] = sum;
        sum += count;
      }
    }
    for_each_part([&](const Hit& hit, std::uint32_t& place) { scratch[place++] = hit; });
    hits.swap(scratch);
  }
}

}  // namespace

void VoxelSupport::gather(const BeliefGrid& map, const BlockLattice& lattice,
                          std::span<const HitBlock> blocks, std::span<const Hit> hits,
                          ThreadPool& pool) {
  map_ = &map;
  lattice_ = &lattice;
  blocks_.resize(blocks.size());
  counts_.resize(blocks.size());
  most_.resize(blocks.size());
  const BeliefMap& beliefs = beliefs_of(map);
  pool.for_each_chunk(blocks.size(), kBlockChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      blocks_[i] = blocks[i].key;
      Counts& counts = counts_[i];
      counts.fill(0);
      for (std::uint32_t h = blocks[i].begin; h < blocks[i].end; ++h) ++counts[hits[h].offset];
      if (const auto found = beliefs.find(blocks[i].key); found != beliefs.end()) {
        for_each_bit(occupied_in(map, lattice.origin(blocks[i].key)), [&](unsigned offset) {
          const Belief* belief = found->second->find(offset);
          if (belief == nullptr) return;
          constexpr std::uint32_t kMost = std::numeric_limits<std::uint32_t>::max();
          counts[offset] += std::min(belief->hits, kMost - counts[offset]);
        });
      }
      most_[i] = *std::max_element(counts.begin(), counts.end());
    }
  });
}

void VoxelSupport::Reader::enter(Index3 voxel) {
  const std::uint64_t block = support_.lattice_->key(voxel);
  scale_ = scale_of(*support_.map_, block);
  counts_ = nullptr;
  beliefs_ = nullptr;
  most_ = 0;
  const std::vector<std::uint64_t>& blocks = support_.blocks_;
  const auto found = std::lower_bound(blocks.begin(), blocks.end(), block);
  if (found != blocks.end() && *found == block) {
    const auto i = static_cast<std::size_t>(found - blocks.begin());
    counts_ = support_.counts_[i].data();
    most_ = support_.most_[i];
    return;
  }
  const BeliefMap& beliefs = beliefs_of(*support_.map_);
  if (const auto of_map = beliefs.find(block); of_map != beliefs.end()) {
    beliefs_ = of_map->second.get();
    most_ = std::numeric_limits<std::uint32_t>::max();
    occupied_ = occupied_in(*support_.map_, support_.lattice_->origin(block));
  }
}

std::uint32_t VoxelSupport::Reader::at(Index3 voxel) {
  const Index3 block{voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
  if (!(block == block_)) {
    block_ = block;
    enter(voxel);
  }
  const unsigned offset = cell_offset(block_offset(voxel), scale_);
  if (counts_ != nullptr) return counts_[offset];
  if (beliefs_ == nullptr || !test_bit(occupied_, offset)) return 0;
  const Belief* belief = beliefs_->find(offset);
  return belief != nullptr ? belief->hits : 0;
}

namespace {

// Where a line from p leaves a block, along it [voxels], or comes so close to a face that rounding
// may put it beyond. `inverse`: of the components of its direction.
double end_of_block(Index3 block, const Eigen::Vector3d& p, const Eigen::Vector3d& inverse) {
  constexpr double kRounding = 1e-6;  // more than that of coordinates
  const std::array<int, 3> at{block.x, block.y, block.z};
  double end = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    const int face = kBlockSize * (inverse[a] > 0 ? at[axis] + 1 : at[axis]);
    end = std::min(end, (std::abs(face - p[a]) - kRounding) * std::abs(inverse[a]));
  }
  return std::max(end, 0.0);
}

// One direction from a reading, sampled from near to far.
struct Search {
  VoxelSupport::Reader reader;
  Index3 last{};         // voxel of the last sample
  double dull_until{0};  // samples before this are in a block without enough support
};

}  // namespace

void associate(const PlacedFrame& frame, std::span<const Eigen::Vector3d> places,
               const BlockLattice& lattice, double voxel_size, const VoxelSupport& support,
               ThreadPool& pool, std::vector<Hit>& by_pixel) {
  const Readings& pixels = frame.readings;
  const Eigen::Matrix3d R_grid_readings = frame.T_grid_readings.rotation();
  pool.for_each_chunk(by_pixel.size(), kPixelChunk, [&](std::size_t begin, std::size_t end) {
    Search before{.reader = VoxelSupport::Reader(support)};
    Search behind{.reader = VoxelSupport::Reader(support)};
    for (std::size_t i = begin; i < end; ++i) {
      Hit& hit = by_pixel[i];
      if (hit.offset >= kBlockVoxels) continue;
      const double sigma = pixels.sigmas(i).axial / voxel_size;
      if (sigma < kNoisySigma) continue;
      const Eigen::Vector3d& p = places[i];
      const Index3 own = *lattice.voxel_at(p);
      double best = kMargin * before.reader.at(own);
      const double cell = before.reader.cell();
      if (sigma < kNoisySigma * cell) continue;
      const Eigen::Vector3d direction = R_grid_readings * pixels.direction(i);
      const Eigen::Vector3d inverse = direction.cwiseInverse();
      const double reach = std::min(kTaperSigmas * sigma, kFarthest * cell);
      const bool is_dull = before.reader.most() <= best;
      const Index3 block = before.reader.block();
      before.last = behind.last = own;
      before.dull_until = is_dull ? end_of_block(block, p, -inverse) : 0;
      behind.dull_until = is_dull ? end_of_block(block, p, inverse) : 0;
      const double dull_until = std::min(before.dull_until, behind.dull_until);
      if (dull_until >= reach) continue;
      const double range = (pixels.point(i) - pixels.origin()).norm() / voxel_size;
      // A voxel's value is largest at the first sample on its side.
      const auto look = [&](double t, double sign, Search& side) {
        if (t < side.dull_until) return;
        const std::optional<Index3> voxel = lattice.voxel_at(p + sign * t * direction);
        if (!voxel || *voxel == side.last) return;
        side.last = *voxel;
        const double weight = 1 - t / reach * (t / reach);
        const double value = side.reader.at(*voxel) * weight;
        if (value > best) {
          best = value;
          hit.block = lattice.key(*voxel);
          hit.offset = block_offset(*voxel);
        }
        if (side.reader.most() * weight <= best) {  // weights only fall
          side.dull_until = end_of_block(side.reader.block(), p, sign * inverse);
        }
      };
      const int first = std::max(1, static_cast<int>(dull_until / (kStep * cell)));
      for (int step = first; step * kStep * cell < reach; ++step) {
        const double t = step * kStep * cell;
        if (t < range) look(t, -1, before);
        look(t, 1, behind);
      }
    }
  });
}

void FrameHits::find(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                     bool on_surface, ThreadPool& pool) {
  const Readings& pixels = frame.readings;
  by_pixel_.resize(pixels.size());
  places_.resize(pixels.size());
  pool.for_each_chunk(pixels.size(), kHitChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      by_pixel_[i].offset = kBlockVoxels;
      if (pixels.kind(i) != PixelKind::reading) continue;
      places_[i] = frame.T_grid_readings * pixels.point(i) / voxel_size;
      if (const auto voxel = lattice.voxel_at(places_[i])) by_pixel_[i] = hit(lattice, *voxel, i);
    }
  });
  if (on_surface && pixels.row_length() > 0) move_to_surface(frame, lattice, voxel_size, pool);
  sort(pool);
}

void FrameHits::move_to_surface(const PlacedFrame& frame, const BlockLattice& lattice,
                                double voxel_size, ThreadPool& pool) {
  const Readings& pixels = frame.readings;
  const int width = pixels.row_length();
  const double noisy = kNoisySigma * voxel_size;
  const auto is_noisy_hit = [&](std::size_t i) {
    return by_pixel_[i].offset < kBlockVoxels && pixels.sigmas(i).axial >= noisy;
  };
  const std::size_t rows = pixels.size() / static_cast<std::size_t>(width);
  pool.for_each_chunk(rows, kSurfaceRows, [&](std::size_t begin, std::size_t end) {
    LocalSurfaces surfaces;
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t row = v * static_cast<std::size_t>(width);
      for (int u = 0; u < width; ++u) {
        if (!is_noisy_hit(row + static_cast<std::size_t>(u))) continue;
        const auto [first, count] = kernels_.find(pixels, u, static_cast<int>(v), surfaces);
        for (; u < first + count; ++u) {
          const auto k = static_cast<std::size_t>(u - first);
          const std::size_t i = row + static_cast<std::size_t>(u);
          if (!surfaces.found[k] || !is_noisy_hit(i)) continue;
          const Eigen::Vector3d surface(surfaces.x[k], surfaces.y[k], surfaces.z[k]);
          const Eigen::Vector3d place = frame.T_grid_readings * surface / voxel_size;
          const auto voxel = lattice.voxel_at(place);
          if (!voxel) continue;
          places_[i] = place;
          by_pixel_[i] = hit(lattice, *voxel, i);
        }
        --u;
      }
    }
  });
}

void FrameHits::associate(const PlacedFrame& frame, const BlockLattice& lattice, double voxel_size,
                          const BeliefGrid& map, ThreadPool& pool) {
  const double noisy = kNoisySigma * voxel_size;
  if (std::none_of(hits_.begin(), hits_.end(), [&](const Hit& hit) {
        return frame.readings.sigmas(hit.pixel).axial >= noisy;
      })) {
    return;
  }
  support_.gather(map, lattice, blocks_, hits_, pool);
  detail::associate(frame, places_, lattice, voxel_size, support_, pool, by_pixel_);
  sort(pool);
}

void FrameHits::use_cells(const ScalePlan& plan, BeliefGrid& map) {
  if (plan.is_idle()) return;
  for (const HitBlock& block : blocks_) {
    plan.set(map, block.key);
    const int scale = scale_of(map, block.key);
    for (std::uint32_t i = block.begin; i < block.end; ++i) {
      hits_[i].offset = cell_offset(hits_[i].offset, scale);
    }
  }
}

void FrameHits::sort(ThreadPool& pool) {
  hits_.clear();
  for (const Hit& hit : by_pixel_) {
    if (hit.offset < kBlockVoxels) hits_.push_back(hit);
  }
  sort_by_block(hits_, scratch_, pool);

  blocks_.clear();
  for (std::uint32_t i = 0; i < hits_.size(); ++i) {
    if (blocks_.empty() || blocks_.back().key != hits_[i].block) {
      blocks_.push_back({hits_[i].block, i, i, nullptr});
    }
    blocks_.back().end = i + 1;
  }
}

std::span<const HitBlock> FrameHits::in_region(std::uint64_t region) const {
  const auto below = [](const HitBlock& block, std::uint64_t key) { return block.key < key; };
  const auto first = std::lower_bound(blocks_.begin(), blocks_.end(), region << 6U, below);
  const auto last = std::lower_bound(first, blocks_.end(), (region + 1) << 6U, below);
  return {first, last};
}

std::shared_ptr<const BeliefBlock> with_hits(const BeliefBlock* block, std::span<const Hit> hits,
                                             const Readings& pixels, const Pose& T_grid_readings,
                                             Index3 origin, double voxel_size, int scale) {
  LeafMask mask = block != nullptr ? block->mask : LeafMask{}, hit_mask{};
  for (const Hit& hit : hits) set_bit(hit_mask, hit.offset);
  for (std::size_t w = 0; w < mask.size(); ++w) mask[w] |= hit_mask[w];
  auto result = reshaped(block, mask);
  result->scale = static_cast<std::uint8_t>(scale);

  std::array<std::uint16_t, kBlockVoxels> place;  // index among the sums of voxels that are hit
  std::vector<BeliefSum> sums;
  sums.reserve(count_bits(hit_mask));
  for_each_bit(hit_mask, [&](unsigned offset) {
    place[offset] = static_cast<std::uint16_t>(sums.size());
    sums.emplace_back().add(result->beliefs[result->rank(offset)], Eigen::Vector3d::Zero());
  });
  const Eigen::Matrix3d R_grid_readings = T_grid_readings.rotation();
  for (const Hit& hit : hits) {
    const Index3 voxel = offset_voxel(origin, hit.offset);
    sums[place[hit.offset]].add(
        measurement_information(R_grid_readings * pixels.direction(hit.pixel),
                                pixels.sigmas(hit.pixel)),
        T_grid_readings * pixels.point(hit.pixel) - voxel_center(voxel, voxel_size, scale));
  }
  for_each_bit(hit_mask, [&](unsigned offset) {
    result->beliefs[result->rank(offset)] = sums[place[offset]].rounded();
  });
  return result;
}

}  // namespace viewgain::detail
