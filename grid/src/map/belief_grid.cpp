// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/belief_grid.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "grid_blocks.hpp"
#include "grid_storage.hpp"
#include "update/belief_merge.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

using namespace detail;

constexpr double kLatticeTolerance = 1e-6;  // [voxel]
constexpr double kRigidTolerance = 1e-9;
constexpr double kMinVoxelSize = 2e-5;  // [m]; OpenVDB has no transform for less than 1.44e-5
constexpr std::int32_t kMaxDim = 65536;
constexpr double kMaxVoxels = 1099511627776.0;  // 2^40
constexpr double kMaxIndex = 1073741824.0;      // 2^30

template <typename... Parts>
[[noreturn]] void fail(ErrorCode code, const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  throw Error(code, text.str());
}

void check_positive(const char* name, double value) {
  if (!(std::isfinite(value) && value > 0)) {
    fail(ErrorCode::invalid_argument, name, " must be positive and finite, not ", value);
  }
}

/// The box of whole voxels around the workspace.
void index_box(const GridConfig& config, Index3& min_index, Index3& dims) {
  check_positive("voxel size", config.voxel_size);
  std::int32_t low[3], count[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double from = config.workspace.min[a], to = config.workspace.max[a];
    if (!std::isfinite(from) || !std::isfinite(to)) {
      fail(ErrorCode::invalid_argument, "workspace must be finite, axis ", "xyz"[a], " is ", from,
           " .. ", to);
    }
    if (!(from < to)) {
      fail(ErrorCode::invalid_argument, "workspace is inside out or empty, axis ", "xyz"[a], " is ",
           from, " .. ", to);
    }
    const auto snap = [&](double value, double outward) {
      const double nearest = std::round(value);
      return std::abs(value - nearest) <= kLatticeTolerance ? nearest : outward;
    };
    const double a0 = from / config.voxel_size, a1 = to / config.voxel_size;
    const double first = snap(a0, std::floor(a0));
    const double last = std::max(snap(a1, std::ceil(a1)), first + 1.0);
    if (!(last - first <= kMaxDim)) {
      fail(ErrorCode::capacity, "workspace has ", last - first, " voxels along ", "xyz"[a],
           ", the most is ", kMaxDim);
    }
    if (!(std::abs(first) <= kMaxIndex && std::abs(last) <= kMaxIndex)) {
      fail(ErrorCode::capacity, "workspace is ", std::max(std::abs(first), std::abs(last)),
           " voxels off the origin along ", "xyz"[a], ", the most is ", kMaxIndex);
    }
    low[a] = static_cast<std::int32_t>(first);
    count[a] = static_cast<std::int32_t>(last - first);
  }
  min_index = {low[0], low[1], low[2]};
  dims = {count[0], count[1], count[2]};
}

std::unique_ptr<GridStorage> make_storage(const GridConfig& config) {
  Index3 min_index, dims;
  index_box(config, min_index, dims);
  return std::make_unique<GridStorage>(config.voxel_size, config.T_world_grid, config.prior_sigma,
                                       min_index, dims);
}

void check_belief(const Belief& belief) {
  for (const float value : belief.information) {
    if (!std::isfinite(value))
      fail(ErrorCode::invalid_argument, "belief has an information of ", value);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (belief.information[i] < 0) {
      fail(ErrorCode::invalid_argument, "belief has an information of ", belief.information[i]);
    }
    if (!std::isfinite(belief.information_vector[i])) {
      fail(ErrorCode::invalid_argument, "belief has an information vector of ",
           belief.information_vector[i]);
    }
  }
  if (belief.hits > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max())) {
    fail(ErrorCode::invalid_argument, "belief has ", belief.hits, " hits, the most is 2147483647");
  }
}

}  // namespace

std::uint64_t detail::GridStorage::next_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

std::unique_ptr<detail::GridStorage> detail::GridStorage::copy() const {
  auto result = std::make_unique<GridStorage>(*this);
  result->copy_of = number;
  result->copied_at = time;
  result->number = next_number();
  return result;
}

detail::GridStorage::GridStorage(double voxel_size_in, const Pose& T_world_grid_in,
                                 double prior_sigma_in, Index3 min_index_in, Index3 dims_in)
    : voxel_size(voxel_size_in),
      T_world_grid(T_world_grid_in),
      prior_sigma(prior_sigma_in),
      min_index(min_index_in),
      dims(dims_in),
      lattice(BlockLattice({0, 0, 0}, {1, 1, 1})) {
  check_positive("voxel size", voxel_size);
  if (voxel_size < kMinVoxelSize) {
    fail(ErrorCode::invalid_argument, "voxel size ", voxel_size, " m is under ", kMinVoxelSize,
         " m, and could not be saved");
  }
  check_positive("prior sigma", prior_sigma);
  const double error = orthonormality_error(T_world_grid);
  if (!(error <= kRigidTolerance)) {
    fail(ErrorCode::invalid_argument, "T_world_grid is no rigid transform: its rotation is off by ",
         error);
  }
  double voxels = 1;
  for (const auto& [low, count] : {std::pair{min_index.x, dims.x}, std::pair{min_index.y, dims.y},
                                   std::pair{min_index.z, dims.z}}) {
    if (count < 1 || count > kMaxDim || std::abs(static_cast<double>(low)) > kMaxIndex ||
        std::abs(static_cast<double>(low) + count) > kMaxIndex) {
      fail(ErrorCode::capacity, "workspace of ", count, " voxels from voxel ", low,
           "; there may be ", kMaxDim, " along an axis, at most ", kMaxIndex, " off the origin");
    }
    voxels *= count;
  }
  if (voxels > kMaxVoxels) {
    fail(ErrorCode::capacity, "workspace has ", voxels, " voxels, the most is ", kMaxVoxels);
  }
  lattice = BlockLattice(min_index, dims);

  constexpr std::int32_t kSpan = CodeUpper::DIM;
  const auto down = [](std::int32_t v) { return v & ~(kSpan - 1); };
  const auto up = [&](std::int32_t v) { return down(v - 1) + kSpan - 1; };
  tree.sparseFill(
      openvdb::CoordBBox({down(lattice.min.x), down(lattice.min.y), down(lattice.min.z)},
                         {up(lattice.max.x), up(lattice.max.y), up(lattice.max.z)}),
      kUnknownCode, true);
}

void detail::GridStorage::put_block(Index3 origin, const std::uint8_t* codes) {
  const bool uniform =
      std::all_of(codes, codes + kBlockVoxels, [&](std::uint8_t code) { return code == codes[0]; });
  if (uniform && may_be_tile(codes[0])) {
    tree.addTile(kBlockTileLevel, to_coord(origin), codes[0], is_non_free(codes[0]));
    return;
  }
  auto leaf = std::make_unique<CodeLeaf>(to_coord(origin), kUnknownCode, true);
  std::memcpy(leaf->buffer().data(), codes, kBlockVoxels);
  const LeafMask mask = code_mask(codes, is_non_free);
  for (openvdb::Index i = 0; i < 8; ++i) leaf->getValueMask().getWord<std::uint64_t>(i) = mask[i];
  tree.addLeaf(leaf.release());
}

BeliefGrid::BeliefGrid(std::unique_ptr<GridStorage> storage) : storage_(std::move(storage)) {}
BeliefGrid::BeliefGrid(const GridConfig& config) : storage_(make_storage(config)) {}
BeliefGrid::~BeliefGrid() = default;
BeliefGrid::BeliefGrid(BeliefGrid&&) noexcept = default;
BeliefGrid& BeliefGrid::operator=(BeliefGrid&&) noexcept = default;

BeliefGrid BeliefGrid::clone() const {
  // Belief blocks are immutable, so sharing them is as good as copying.
  return BeliefGrid(storage_->copy());
}

double BeliefGrid::voxel_size() const noexcept { return storage_->voxel_size; }
const Pose& BeliefGrid::T_world_grid() const noexcept { return storage_->T_world_grid; }
double BeliefGrid::prior_sigma() const noexcept { return storage_->prior_sigma; }
Index3 BeliefGrid::min_index() const noexcept { return storage_->min_index; }
Index3 BeliefGrid::dims() const noexcept { return storage_->dims; }
const std::vector<Pose>& BeliefGrid::views() const noexcept { return storage_->views; }
void BeliefGrid::append_view(const Pose& T_world_camera) {
  storage_->views.push_back(T_world_camera);
}

Box BeliefGrid::workspace() const noexcept {
  const BlockLattice& l = storage_->lattice;
  const double V = storage_->voxel_size;
  return {{l.min.x * V, l.min.y * V, l.min.z * V}, {l.max.x * V, l.max.y * V, l.max.z * V}};
}

std::uint64_t BeliefGrid::voxel_count() const noexcept {
  const Index3 d = storage_->dims;
  return static_cast<std::uint64_t>(d.x) * static_cast<std::uint64_t>(d.y) *
         static_cast<std::uint64_t>(d.z);
}

std::optional<Index3> BeliefGrid::index_of(const Eigen::Vector3d& p_world) const {
  return storage_->lattice.voxel_at(storage_->T_world_grid.inverse() * p_world /
                                    storage_->voxel_size);
}
Eigen::Vector3d BeliefGrid::center(Index3 voxel) const {
  return storage_->T_world_grid * voxel_center(voxel, storage_->voxel_size);
}

VoxelState BeliefGrid::state(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return VoxelState::unknown;
  const std::uint8_t code = storage_->tree.getValue(to_coord(voxel));
  if (code == kUnknownCode) return VoxelState::unknown;
  return is_occupied(code) ? VoxelState::occupied : VoxelState::free;
}

std::optional<float> BeliefGrid::log_odds(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return std::nullopt;
  const std::uint8_t code = storage_->tree.getValue(to_coord(voxel));
  if (code == kUnknownCode) return std::nullopt;
  return code_log_odds(code);
}

std::optional<Belief> BeliefGrid::belief(Index3 voxel) const {
  if (!storage_->lattice.contains(voxel)) return std::nullopt;
  const BeliefBlock* block = storage_->find_beliefs(storage_->lattice.key(voxel));
  const Belief* found = block != nullptr ? block->find(block_offset(voxel)) : nullptr;
  return found != nullptr ? std::optional<Belief>(*found) : std::nullopt;
}

void BeliefGrid::set(Index3 voxel, float log_odds, const std::optional<Belief>& belief) {
  GridStorage& s = *storage_;
  if (!s.lattice.contains(voxel)) {
    fail(ErrorCode::invalid_argument, "voxel (", voxel.x, ", ", voxel.y, ", ", voxel.z,
         ") lies outside the workspace");
  }
  if (std::isnan(log_odds)) fail(ErrorCode::invalid_argument, "log-odds is NaN");
  if (belief) check_belief(*belief);

  const std::uint8_t code = log_odds_code(log_odds);
  if (is_non_free(code)) {
    s.tree.setValueOn(to_coord(voxel), code);
  } else {
    s.tree.setValueOff(to_coord(voxel), code);
  }
  const std::uint64_t key = s.lattice.key(voxel);
  s.mark_changed(key);
  ++s.time;
  const BeliefBlock* block = s.find_beliefs(key);
  if (!belief && block == nullptr) return;
  auto changed = with_belief(block, block_offset(voxel), belief ? &*belief : nullptr);
  if (changed == nullptr) {
    s.beliefs.erase(key);
  } else {
    s.beliefs[key] = std::move(changed);
  }
}

BeliefGrid BeliefGrid::from_states(const GridConfig& config, std::span<const std::uint8_t> states) {
  BeliefGrid grid(config);
  if (states.size() != grid.voxel_count()) {
    fail(ErrorCode::invalid_argument, "array of ", states.size(), " states for a workspace of ",
         grid.voxel_count(), " voxels");
  }
  const auto wrong =
      std::find_if(states.begin(), states.end(), [](std::uint8_t s) { return s > 2; });
  if (wrong != states.end()) {
    fail(ErrorCode::invalid_argument, "state ", static_cast<int>(*wrong), " at position ",
         wrong - states.begin(), "; valid are 0, 1, 2");
  }
  constexpr std::array<std::uint8_t, 3> kCodes{kUnknownCode, kLiteralFreeCode,
                                               kLiteralOccupiedCode};

  GridStorage& s = *grid.storage_;
  const BlockLattice& l = s.lattice;
  const Index3 first = block_origin(l.min);
  for (std::int32_t x = first.x; x < l.max.x; x += kBlockSize) {
    for (std::int32_t y = first.y; y < l.max.y; y += kBlockSize) {
      for (std::int32_t z = first.z; z < l.max.z; z += kBlockSize) {
        std::array<std::uint8_t, kBlockVoxels> codes{};
        const VoxelBox box = clipped(l, {x, y, z}, kBlockSize);
        bool any = false;
        for (std::int32_t i = box.min.x; i < box.max.x; ++i) {
          for (std::int32_t j = box.min.y; j < box.max.y; ++j) {
            const auto row =
                (static_cast<std::size_t>(i - l.min.x) * static_cast<std::size_t>(s.dims.y) +
                 static_cast<std::size_t>(j - l.min.y)) *
                static_cast<std::size_t>(s.dims.z);
            for (std::int32_t k = box.min.z; k < box.max.z; ++k) {
              const std::uint8_t state = states[row + static_cast<std::size_t>(k - l.min.z)];
              any = any || state != 0;
              codes[block_offset({i, j, k})] = kCodes[state];
            }
          }
        }
        if (any) s.put_block({x, y, z}, codes.data());
      }
    }
  }
  return grid;
}

void BeliefGrid::copy_states(std::span<std::uint8_t> states) const {
  if (states.size() != voxel_count()) {
    fail(ErrorCode::invalid_argument, "array of ", states.size(), " states for a workspace of ",
         voxel_count(), " voxels");
  }
  const GridStorage& s = *storage_;
  const auto state_of = [](std::uint8_t code) {
    return static_cast<std::uint8_t>(code == kUnknownCode ? VoxelState::unknown
                                     : is_occupied(code)  ? VoxelState::occupied
                                                          : VoxelState::free);
  };
  const auto each_row = [&](const VoxelBox& box, auto&& row) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        const auto at =
            (static_cast<std::size_t>(x - s.min_index.x) * static_cast<std::size_t>(s.dims.y) +
             static_cast<std::size_t>(y - s.min_index.y)) *
                static_cast<std::size_t>(s.dims.z) +
            static_cast<std::size_t>(box.min.z - s.min_index.z);
        row(x, y, states.subspan(at, static_cast<std::size_t>(box.max.z - box.min.z)));
      }
    }
  };
  visit_blocks(
      s,
      [&](const CodeLeaf& leaf, Index3 origin) {
        const std::uint8_t* codes = leaf.buffer().data();
        const VoxelBox box = clipped(s.lattice, origin, kBlockSize);
        each_row(box, [&](std::int32_t x, std::int32_t y, std::span<std::uint8_t> row) {
          const std::uint8_t* from = codes + block_offset({x, y, box.min.z});
          for (std::size_t k = 0; k < row.size(); ++k) row[k] = state_of(from[k]);
        });
      },
      [&](Index3 origin, int size, std::uint8_t code) {
        each_row(clipped(s.lattice, origin, size),
                 [&](std::int32_t, std::int32_t, std::span<std::uint8_t> row) {
                   std::fill(row.begin(), row.end(), state_of(code));
                 });
      });
}

namespace detail {

void put_block(BeliefGrid& grid, Index3 origin, const std::uint8_t* codes) {
  GridAccess::storage(grid).put_block(origin, codes);
}

void fill_cube(BeliefGrid& grid, Index3 origin, std::int32_t size, std::uint8_t code) {
  GridStorage& s = GridAccess::storage(grid);
  if (!s.lattice.overlaps(origin, size)) return;
  // Whole blocks, of large cubes whole nodes, round the part in the workspace.
  const std::int32_t unit = may_be_tile(code) && size > kNodeSize ? kNodeSize : kBlockSize;
  const VoxelBox part = clipped(s.lattice, origin, size);
  const auto down = [&](std::int32_t v) { return v & ~(unit - 1); };
  const auto up = [&](std::int32_t v) { return down(v - 1) + unit; };
  const Index3 from{down(part.min.x), down(part.min.y), down(part.min.z)};
  const Index3 to{up(part.max.x), up(part.max.y), up(part.max.z)};
  if (may_be_tile(code)) {
    s.tree.sparseFill({to_coord(from), {to.x - 1, to.y - 1, to.z - 1}}, code, is_non_free(code));
    return;
  }
  std::array<std::uint8_t, kBlockVoxels> codes;
  codes.fill(code);
  for (std::int32_t x = from.x; x < to.x; x += kBlockSize) {
    for (std::int32_t y = from.y; y < to.y; y += kBlockSize) {
      for (std::int32_t z = from.z; z < to.z; z += kBlockSize) s.put_block({x, y, z}, codes.data());
    }
  }
}

void visit_grid(const BeliefGrid& grid,
                const std::function<void(Index3, const std::uint8_t*)>& block,
                const std::function<void(Index3, std::int32_t, std::uint8_t)>& cube) {
  visit_blocks(
      GridAccess::storage(grid),
      [&](const CodeLeaf& leaf, Index3 origin) { block(origin, leaf.buffer().data()); },
      [&](Index3 origin, int size, std::uint8_t code) { cube(origin, size, code); });
}

}  // namespace detail

}  // namespace viewgain
