// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "sampled_views.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "viewgain/support/hash64.hpp"

namespace viewgain::detail {
namespace {

// Fewer rays of a view say nothing.
constexpr double kLeastRays = 100;

// Pixels of an image with rays, along one edge, beyond those between a lattice's first and last.
int beyond(int rays, int step) { return (rays - 1) % step; }

// Errors as shares of what is gained in voxels that one ray met: of how many small ones there are,
// more where there are large ones too, since the small ones are then farther off and partly hidden;
// of large ones. And the error of a lattice as a share of that of as many rays at random; so few
// rays as kFewRays know their scatter badly. Fitted, see perf/results/choosing.md.
constexpr double kChanceError = 0.031, kMixedError = 0.73, kLoneError = 0.24;
constexpr double kLatticeError = 0.87, kFewRays = 760;

// Is the voxel at this place of a leaf free?
bool is_free_in(const TraceMask& mask, std::uint32_t offset) {
  return (mask.words[offset >> 5U] >> (offset & 31U) & 1U) == 0;
}

// What stands round a hit's voxel.
class Surroundings {
 public:
  Surroundings(const SceneData& scene, std::uint32_t primitive, std::uint32_t offset)
      : scene_(scene),
        primitive_(primitive),
        bits_(primitive < scene.block_count ? kBlockBits : kBoxBits),
        offset_(offset) {}

  // Whether the voxel so many steps away is free.
  [[nodiscard]] bool is_free(const std::array<int, 3>& steps) const {
    const int last = (1 << bits_) - 1;
    std::array<int, 3> at;
    bool is_in_block = primitive_ < scene_.block_count;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto shift = static_cast<unsigned>(2 - axis) * static_cast<unsigned>(bits_);
      at[axis] = static_cast<int>(offset_ >> shift) & last;
      at[axis] += steps[axis];
      is_in_block = is_in_block && at[axis] >= 0 && at[axis] <= last;
    }
    if (is_in_block) {
      if (primitive_ >= scene_.leaf_count) return false;  // a block of unknown voxels
      return is_free_in(scene_.masks[primitive_],
                        static_cast<std::uint32_t>(at[0] << 6 | at[1] << 3 | at[2]));
    }
    Index3 voxel = scene_.voxel_index(primitive_, offset_);
    voxel.x += steps[0], voxel.y += steps[1], voxel.z += steps[2];
    return scene_.snapshot.is_free(voxel);
  }

 private:
  const SceneData& scene_;
  std::uint32_t primitive_;
  int bits_;
  std::uint32_t offset_;
};

// What a voxel shows of itself to rays from `direction`, across them [voxels²]: the faces before
// which nothing stands, without what is hidden by voxels beside the way to them. A ray met it, so
// it shows something.
float exposed_area(const Surroundings& around, const std::array<float, 3>& direction) {
  constexpr float kLeast = 0.15F;  // of a voxel in full view
  float all = 0, exposed = 0;
  for (std::size_t face = 0; face < 3; ++face) {
    const float across = std::abs(direction[face]);
    all += across;
    if (across == 0) continue;
    std::array<int, 3> steps{};
    steps[face] = direction[face] > 0 ? -1 : 1;
    if (!around.is_free(steps)) continue;
    float seen = across;
    for (const std::size_t side : {(face + 1) % 3, (face + 2) % 3}) {
      // Rays to the face pass the voxel beside the one before it where they come that way.
      const float slope = std::min(std::abs(direction[side]) / across, 1.0F);
      if (slope == 0) continue;
      std::array<int, 3> beside = steps;
      beside[side] = direction[side] > 0 ? -1 : 1;
      if (!around.is_free(beside)) seen *= 1 - slope;
    }
    exposed += seen;
  }
  return std::max(exposed, kLeast * all);
}

// Sums a sample's hits by voxel, and what the voxels and those that they stand for gain.
struct SampleConsumer {
  VoxelSums& sums;
  SampleScratch& scratch;
  const SceneData& scene;
  const GainSettings& settings;
  const TileTable& table;
  float min_range;   // [voxels]
  double rays_each;  // that a ray stands for
  SampleTally& tally;

  void begin() { sums.begin(&scratch.hits); }
  void add(std::size_t number, const RayTile& tile) {
    if (tile.hit == 0) return;
    std::array<float, kTileRays> expected;
    std::size_t count = 0;
    for_each_lane(tile.hit, [&](int lane) {
      const float t = tile.range[lane];
      const float angle = table.solid_angle[number * kTileRays + static_cast<std::size_t>(lane)];
      expected[count++] = across(tile, lane) / (t * t * angle);
    });
    sums.add(tile, expected.data());
  }
  void finish(ViewGain&) {
    sums.close();
    sums.look_up();
    scratch.gain_per_hit.resize(sums.voxel_count());
    for (const bool is_known : {false, true}) {
      const std::span<const std::uint32_t> members = is_known ? sums.occupied() : sums.unknown();
      std::vector<double>& copies = scratch.copies;
      copies.clear();
      for (const std::uint32_t place : members) copies.push_back(spread(place));
      scratch.each.resize(members.size() + VoxelSums::kOverhang);
      LogProduct ratios;
      is_known ? sums.finish_occupied(ratios, nullptr, scratch.each.data())
               : sums.finish_unknown(ratios, nullptr, scratch.each.data());
      for (std::size_t i = 0; i < members.size(); ++i) {
        const std::uint32_t place = members[i];
        const double each = scratch.each[i];
        const double gain = (settings.criterion == Criterion::trace ? each : 0.5 * std::log(each)) *
                            copies[i] * sums.weight(place);
        tally.add(gain, sums.hits(place), sums.expected(place));
        scratch.gain_per_hit[place] = gain / sums.hits(place);
      }
    }
    for (const SampledHit& hit : scratch.hits) {
      tally.by_lane[hit.lane] += scratch.gain_per_hit[hit.place];
    }
  }

 private:
  // The voxel's hits become all that stand for them; how many voxels it stands for.
  double spread(std::uint32_t place) {
    const SampledVoxel voxel(sums.hits(place), sums.expected(place), rays_each);
    VoxelSum& sum = sums.sum(place);
    for (double& value : sum.a) value *= voxel.rays_per_hit;
    for (std::size_t k = 0; k < 2; ++k) sum.b[k] *= voxel.rays_per_hit;
    return voxel.copies;
  }
  // What the ray's voxel shows of itself, across the ray [voxels²].
  [[nodiscard]] float across(const RayTile& tile, int lane) const {
    const std::array<float, 3> direction{tile.dx[lane], tile.dy[lane], tile.dz[lane]};
    if (tile.range[lane] > min_range) {
      return exposed_area({scene, tile.primitive[lane], tile.offset[lane]}, direction);
    }
    // Rays that begin inside of what is unknown end on a sphere through the voxels.
    return 1 / (std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]));
  }
};

std::array<double, kTileRays> lane_shares(const TileTable& table) {
  std::array<double, kTileRays> shares{};
  double rays = 0;
  for (const std::uint16_t lanes : table.valid) {
    for_each_lane(lanes, [&](int lane) { shares[static_cast<std::size_t>(lane)] += 1; });
    rays += std::popcount(lanes);
  }
  for (double& share : shares) share /= std::max(rays, 1.0);
  return shares;
}

}  // namespace

int step_for_rays(const EvaluatorCore& core, double rays) {
  return std::max(1, static_cast<int>(std::lround(std::sqrt(core.ray_count / rays))));
}

int step_for_share(const EvaluatorCore& core, double share) {
  const int wanted = static_cast<int>(std::ceil(std::sqrt(1 / share) * (1 - 1e-12)));
  const int most = static_cast<int>(std::sqrt(core.ray_count / kLeastRays));
  return std::max(1, std::min(wanted, most));
}

RayLattice centred_lattice(const EvaluatorCore& core, int step) {
  const TileTable& table = core.rays->table;
  return {step, beyond(table.columns, step) / 2, beyond(table.rows, step) / 2};
}

RayLattice random_lattice(const EvaluatorCore& core, int step, std::uint64_t seed) {
  const TileTable& table = core.rays->table;
  const auto below = [&](int rays, std::uint64_t number) {
    const int count = std::min(step, rays);
    return std::min(static_cast<int>(unit_number(mix64(mix64(seed) + number)) * count), count - 1);
  };
  return {step, below(table.columns, 0), below(table.rows, 1)};
}

SampledViews::SampledViews(const VoxelScene& scene, const ViewDriver& full,
                           const RayLattice& lattice)
    : driver_(scene, std::make_shared<EvaluatorCore>(*full.core(), lattice)),
      step_squared_(static_cast<double>(lattice.step) * lattice.step),
      scale_(rays() > 0 ? full.core()->ray_count / (rays() * step_squared_) : 0.0),
      lane_share_(lane_shares(driver_.tracer().table())) {}

ApproximateGain SampledViews::estimate(const Pose& T_world_camera, ViewDriver::Lease& lease) const {
  SampleTally tally;
  ViewGain result;
  if (const SurfaceView* surface = driver_.surface()) {
    const auto frame = driver_.open(T_world_camera, result);
    if (!frame) return {result.gain, result.gain};  // 0 or NaN, both
    surface->sample(*frame, lease.workspace(), step_squared_, tally);
  } else {
    const auto min_range =
        static_cast<float>(driver_.core()->min_range / driver_.scene().snapshot.voxel_size);
    SampleConsumer consumer{
        lease.accumulator(),      lease.workspace().sample, driver_.scene(), driver_.settings(),
        driver_.tracer().table(), min_range * 1.000001F,    step_squared_,   tally};
    result = driver_.view(T_world_camera, lease, consumer);
    if (result.status != ViewGain::Status::ok) return {result.gain, result.gain};
  }
  return {scale_ * tally.gain, scale_ * standard_error(tally)};
}

double SampledViews::standard_error(const SampleTally& tally) const {
  // The scatter of sixteen lattices of every fourth ray, each as an estimate of the whole.
  double squares = 0;
  int lattices = 0;
  for (std::size_t lane = 0; lane < lane_share_.size(); ++lane) {
    if (lane_share_[lane] == 0) continue;
    const double off = tally.by_lane[lane] / lane_share_[lane] - tally.gain;
    squares += off * off;
    ++lattices;
  }
  const double scatter = lattices > 1 ? squares / (lattices * (lattices - 1.0)) : 0.0;
  const double chance = tally.gain > 0 ? tally.by_chance / tally.gain : 0.0;
  const double small = tally.by_chance * std::hypot(kChanceError, kMixedError * (1 - chance));
  const double lattice =
      kLatticeError * std::hypot(1.0, (1 - chance) * kFewRays / std::max(1U, rays()));
  // What the sample's own rays see is no guess.
  const double guessed = 1 - 1 / step_squared_;
  return guessed * std::hypot(lattice * std::sqrt(scatter), small, kLoneError * tally.lone);
}

}  // namespace viewgain::detail
