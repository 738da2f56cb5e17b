// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/hazard_probe.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>
#include <vector>

#include "block_masks.hpp"
#include "hazard_layout.hpp"
#include "nearest_cells.hpp"
#include "open_directions.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::BlockMasks, detail::HazardLayout;

constexpr int kCoarse = 2;  // cells of a coarse cell, along each axis
// Twice the largest distance between a cell's centre and that of its coarse cell [cells].
constexpr double kSlack = 1.74;
constexpr int kAround = 3;  // cells on each side, of those that make the normal

/// The cells with evidence: one bit per cell, rows along z.
class EvidenceCells {
 public:
  explicit EvidenceCells(const HazardLayout& layout)
      : low_(layout.cells.min),
        size_{layout.cells.max.x - low_.x, layout.cells.max.y - low_.y,
              layout.cells.max.z - low_.z},
        words_(static_cast<std::size_t>(size_.z + 63) / 64),
        rows_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) * words_),
        has_any_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y)),
        reach_(layout.reach),
        coarse_size_{coarse_extent(size_.x), coarse_extent(size_.y), coarse_extent(size_.z)},
        coarse_(coarse_size_[0] * coarse_size_[1] * coarse_size_[2], detail::kNoDistance) {
    for (const Index3& voxel : layout.evidence) {
      const Index3 cell = in_box(layout.cell_of(voxel));
      row(cell.x, cell.y)[cell.z >> 6] |= std::uint64_t{1} << (cell.z & 63);
      has_any_[row_index(cell.x, cell.y)] = 1;
      coarse_[coarse_index(cell)] = 0;
    }
    const int coarse_reach = static_cast<int>(std::ceil((reach_ + kSlack) / kCoarse));
    ThreadPool caller(1);
    (void)detail::NearestCells(coarse_, coarse_size_, coarse_reach, caller);
    for (int squared = 0; squared <= coarse_reach * coarse_reach; ++squared) {
      const double least = std::max(0.0, kCoarse * std::sqrt(squared) - kSlack);
      least_.push_back(static_cast<int>(std::ceil(least * least)));
    }
  }

  struct Nearest {
    int squared;  // [cells²]
    Index3 offset;
  };
  /// The nearest cell with evidence within the reach. Of several, the one that NearestCells finds:
  /// with the smallest offset along x, then y, then z, negative ones first.
  [[nodiscard]] std::optional<Nearest> nearest(Index3 cell) const {
    const Index3 c = in_box(cell);
    const std::uint16_t coarse = coarse_[coarse_index(c)];
    if (coarse == detail::kNoDistance) return std::nullopt;
    const double about = kCoarse * std::sqrt(static_cast<double>(coarse));
    if (about - kSlack > reach_) return std::nullopt;
    const double farthest = about + kSlack;
    return nearest(c, std::min(reach_ * reach_, static_cast<int>(farthest * farthest)));
  }
  /// Whether there is evidence within this squared distance.
  [[nodiscard]] bool is_within(Index3 cell, int squared) const {
    return nearest(in_box(cell), std::min(squared, reach_ * reach_)).has_value();
  }

 private:
  static std::size_t coarse_extent(std::int32_t cells) {
    return static_cast<std::size_t>((cells + kCoarse - 1) / kCoarse);
  }
  [[nodiscard]] Index3 in_box(Index3 cell) const {
    return {cell.x - low_.x, cell.y - low_.y, cell.z - low_.z};
  }
  [[nodiscard]] std::size_t coarse_index(Index3 c) const {
    const auto part = [](std::int32_t at) { return static_cast<std::size_t>(at / kCoarse); };
    return (part(c.x) * coarse_size_[1] + part(c.y)) * coarse_size_[2] + part(c.z);
  }
  [[nodiscard]] std::size_t row_index(std::int32_t x, std::int32_t y) const {
    return static_cast<std::size_t>(x * std::ptrdiff_t{size_.y} + y);
  }
  [[nodiscard]] std::uint64_t* row(std::int32_t x, std::int32_t y) {
    return &rows_[row_index(x, y) * words_];
  }

  // Offset along z to the nearest bit of a row; the lower one of two. A large value without one.
  [[nodiscard]] int along(const std::uint64_t* row, int z) const {
    const auto words = static_cast<int>(words_);
    int below = reach_ + 1, above = reach_ + 1;
    for (int w = z >> 6; w >= 0 && z - (w * 64 + 63) < below; --w) {
      const std::uint64_t bits = w == z >> 6 ? row[w] << (63 - (z & 63)) : row[w];
      if (bits == 0) continue;
      below = std::countl_zero(bits) + (w == z >> 6 ? 0 : z - (w * 64 + 63));
      break;
    }
    for (int w = z >> 6; w < words && w * 64 - z < std::min(above, below); ++w) {
      const std::uint64_t bits = w == z >> 6 ? row[w] >> (z & 63) : row[w];
      if (bits == 0) continue;
      above = std::countr_zero(bits) + (w == z >> 6 ? 0 : w * 64 - z);
      break;
    }
    return above < below ? above : -below;
  }

  // Of a cell in the box: no evidence within the reach is nearer than the root of this [cells²].
  [[nodiscard]] int least(Index3 c) const {
    const std::uint16_t coarse = coarse_[coarse_index(c)];
    return coarse == detail::kNoDistance ? std::numeric_limits<int>::max() / 2 : least_[coarse];
  }

  // Searches rows from near to far. Let q be the cell of a row at the height of c, at the offset
  // (dx, dy). If q's distance to evidence, squared, and dx² + dy² add up to no less than the best
  // so far, then neither this row nor those beyond it on the same side have anything nearer: the
  // angle at q between c and their cells is at least a right angle. The same holds for all rows
  // beyond dx, if dy is 0.
  [[nodiscard]] std::optional<Nearest> nearest(Index3 c, int most) const {
    Nearest best{most + 1, {}};
    std::array<bool, 2> is_open_x{true, true};  // lower and higher x
    for (int a = 0; a * a < best.squared && (is_open_x[0] || is_open_x[1]); ++a) {
      for (int dx = -a; dx <= a; dx += std::max(1, 2 * a)) {
        bool& is_open = is_open_x[dx < 0 ? 0 : 1];
        const int x = c.x + dx;
        is_open = is_open && x >= 0 && x < size_.x && least({x, c.y, c.z}) + a * a < best.squared;
        if (is_open) search_plane(c, dx, best);
      }
    }
    if (best.squared > most) return std::nullopt;
    return best;
  }
  // The rows at this dx.
  void search_plane(Index3 c, int dx, Nearest& best) const {
    const int x = c.x + dx;
    std::array<bool, 2> is_open_y{true, true};
    for (int b = 0; dx * dx + b * b < best.squared && (is_open_y[0] || is_open_y[1]); ++b) {
      for (int dy = -b; dy <= b; dy += std::max(1, 2 * b)) {
        bool& is_open = is_open_y[dy < 0 ? 0 : 1];
        const int y = c.y + dy, across = dx * dx + b * b;
        is_open = is_open && y >= 0 && y < size_.y && least({x, y, c.z}) + across < best.squared;
        if (!is_open) continue;
        const std::size_t row = row_index(x, y);
        if (has_any_[row] == 0) continue;
        const int dz = along(&rows_[row * words_], c.z);
        const int squared = across + dz * dz;
        if (squared < best.squared) best = {squared, {dx, dy, dz}};
      }
    }
  }

  Index3 low_, size_;  // of the box of cells
  std::size_t words_;  // of a row
  std::vector<std::uint64_t> rows_;
  std::vector<std::uint8_t> has_any_;  // of each row
  int reach_;
  detail::CellBox coarse_size_;
  std::vector<std::uint16_t> coarse_;  // squared distances of coarse cells to coarse evidence
  std::vector<int> least_;             // bounds on squared distances of cells, by those of coarse
};

}  // namespace

struct HazardProbe::Impl {
  HazardLayout layout;
  double voxel_size;
  bool has_volume;
  std::optional<EvidenceCells> evidence;  // empty without any
  std::optional<BlockMasks> masks;
  std::array<double, detail::OpenDirections::kDirections + 1> openness{};

  Impl(const GridSnapshot& snapshot, const HazardConfig& config)
      : layout(snapshot, config),
        voxel_size(snapshot.voxel_size),
        has_volume(config.volume != nullptr) {
    for (std::size_t k = 0; k < openness.size(); ++k) {
      openness[k] = HazardConfig::Model::openness(static_cast<double>(k) /
                                                  detail::OpenDirections::kDirections);
    }
    if (layout.evidence.empty()) return;
    evidence.emplace(layout);
    masks.emplace(snapshot, layout.cells, layout.shift);
  }

  // FreeShare::gradient(): the values of the outermost cells continue beyond the box.
  [[nodiscard]] Eigen::Vector3d gradient(Index3 cell) const {
    const VoxelBox& box = layout.cells;
    const std::array<std::int32_t, 3> at{cell.x, cell.y, cell.z},
        low{box.min.x, box.min.y, box.min.z}, high{box.max.x - 1, box.max.y - 1, box.max.z - 1};
    const auto plane = [&](std::size_t axis, std::int32_t place) {
      std::array<std::int32_t, 3> p{};
      p[axis] = std::clamp(place, low[axis], high[axis]);
      const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
      int sum = 0;
      for (int a = -kAround; a <= kAround; ++a) {
        p[i] = std::clamp(at[i] + a, low[i], high[i]);
        for (int b = -kAround; b <= kAround; ++b) {
          p[j] = std::clamp(at[j] + b, low[j], high[j]);
          sum += masks->free_voxels({p[0], p[1], p[2]});
        }
      }
      return sum;
    };
    Eigen::Vector3d gradient;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // The sum over 7 planes around the cell above, less that around the cell below.
      const std::int32_t above = std::min(at[axis] + 1, high[axis]),
                         below = std::max(at[axis] - 1, low[axis]);
      int sum = 0;
      for (std::int32_t k = below; k < above; ++k) {
        sum += plane(axis, k + kAround + 1) - plane(axis, k - kAround);
      }
      gradient[static_cast<Eigen::Index>(axis)] = sum;
    }
    return gradient;
  }

  // OpenDirections::count().
  [[nodiscard]] std::size_t open_directions(Index3 cell) const {
    std::size_t open = 0;
    for (int i = 0; i < 27; ++i) {
      const Index3 by{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
      const int squared = by.x * by.x + by.y * by.y + by.z * by.z;
      if (squared == 0) continue;
      const auto steps = static_cast<int>(
          std::max(1.0, layout.open_reach / std::sqrt(static_cast<double>(squared))));
      Index3 there = cell;
      for (int step = 0; step < steps; ++step) {
        there = {there.x + by.x, there.y + by.y, there.z + by.z};
        if (!layout.cells.contains(there)) break;
        const BlockMasks::Cell state = masks->state(there);
        if (state == BlockMasks::Cell::other) continue;
        open += state == BlockMasks::Cell::free ? 1 : 0;
        break;
      }
    }
    return open;
  }
};

struct HazardProbe::Reader::Impl {
  const HazardProbe::Impl& map;
  std::unordered_map<std::uint64_t, Eigen::Vector3d> normals;  // of cells with evidence
  std::optional<Index3> last_cell;
  At last;

  [[nodiscard]] double shape(Index3 cell, const EvidenceCells::Nearest& nearest) {
    if (map.masks->state(cell) == BlockMasks::Cell::free) return 1;
    const Index3 by = nearest.offset;
    const Index3 source{cell.x + by.x, cell.y + by.y, cell.z + by.z};
    const auto part = [](std::int32_t at, std::int32_t low) {
      return static_cast<std::uint64_t>(at - low);
    };
    const Index3& low = map.layout.cells.min;
    const auto [entry, is_fresh] = normals.try_emplace(
        part(source.x, low.x) << 42U | part(source.y, low.y) << 21U | part(source.z, low.z));
    if (is_fresh) entry->second = map.gradient(source);
    const Eigen::Vector3d& n = entry->second;
    const Eigen::Vector3d away(-by.x, -by.y, -by.z);
    const double product = n.norm() * away.norm();
    const double sine = product > 0 ? n.dot(away) / product : 0.0;
    const double shape =
        HazardConfig::Model::continuation(sine) * map.openness[map.open_directions(cell)];
    constexpr double kUnit = HazardField::kShapeUnit;
    return static_cast<double>(std::lround(kUnit * shape)) / kUnit;
  }

  [[nodiscard]] At of_cell(Index3 cell) {
    const auto& model = map.layout.model;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto nearest = map.evidence->nearest(cell);
    if (!nearest) return {kFar, model.rate(kFar)};
    const double distance =
        std::sqrt(static_cast<double>(nearest->squared)) * map.voxel_size * (1 << map.layout.shift);
    return {distance, model.rate(distance, shape(cell, *nearest))};
  }
};

HazardProbe::HazardProbe(const GridSnapshot& snapshot, const HazardConfig& config)
    : impl_(std::make_unique<Impl>(snapshot, config)) {}
HazardProbe::~HazardProbe() = default;
HazardProbe::HazardProbe(HazardProbe&&) noexcept = default;
HazardProbe& HazardProbe::operator=(HazardProbe&&) noexcept = default;

const HazardConfig::Model& HazardProbe::model() const { return impl_->layout.model; }
bool HazardProbe::follows_counters() const { return impl_->layout.follows_counters; }
int HazardProbe::cell_shift() const { return impl_->has_volume ? 0 : impl_->layout.shift; }
double HazardProbe::voxel_size() const { return impl_->voxel_size; }
const VoxelBox& HazardProbe::near_box() const { return impl_->layout.voxels; }

HazardProbe::Reader::Reader(const HazardProbe& probe)
    : impl_(std::make_unique<Impl>(Impl{*probe.impl_, {}, {}, {}})) {}
HazardProbe::Reader::~Reader() = default;
HazardProbe::Reader::Reader(Reader&&) noexcept = default;
HazardProbe::Reader& HazardProbe::Reader::operator=(Reader&&) noexcept = default;

HazardProbe::At HazardProbe::Reader::at(Index3 voxel) {
  Impl& m = *impl_;
  const detail::HazardLayout& layout = m.map.layout;
  if (!layout.voxels.contains(voxel)) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    return {kFar, layout.model.rate(kFar)};
  }
  const Index3 cell = layout.cell_of(voxel);
  if (m.last_cell != cell) {  // rays take several steps in a cell
    m.last = m.of_cell(cell);
    m.last_cell = cell;
  }
  return m.last;
}

bool HazardProbe::is_new(Index3 voxel) const {
  const Impl& m = *impl_;
  return !m.layout.voxels.contains(voxel) ||
         !m.evidence->is_within(m.layout.cell_of(voxel), static_cast<int>(m.layout.most_known));
}

}  // namespace viewgain
