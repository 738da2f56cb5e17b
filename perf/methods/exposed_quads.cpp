// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "exposed_quads.hpp"

#include <algorithm>
#include <limits>

namespace viewgain::bench {
namespace {

/// Faces of one plane, a cell [row][column] each.
class FacePlane {
 public:
  FacePlane(int rows, int columns)
      : rows_(rows),
        columns_(columns),
        exposed_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns)) {}

  std::uint8_t& at(int row, int column) {
    return exposed_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
  }

  /// Takes the faces as rectangles of at most `most` faces a side: emit(row, column, rows,
  /// columns).
  template <typename Emit>
  void take(int most, Emit&& emit) {
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (at(row, column) == 0) continue;
        const int last_column = std::min(columns_, column + most);
        const int last_row = std::min(rows_, row + most);
        int width = 1;
        while (column + width < last_column && at(row, column + width) != 0) ++width;
        int height = 1;
        while (row + height < last_row && row_is_exposed(row + height, column, width)) ++height;
        for (int r = row; r < row + height; ++r) {
          std::fill_n(&at(r, column), width, std::uint8_t{0});
        }
        emit(row, column, height, width);
      }
    }
  }

 private:
  bool row_is_exposed(int row, int column, int width) {
    return std::all_of(&at(row, column), &at(row, column) + width,
                       [](std::uint8_t face) { return face != 0; });
  }

  int rows_;
  int columns_;
  std::vector<std::uint8_t> exposed_;
};

/// The box round all non-free voxels, relative to the workspace's lowest one: there is no face
/// elsewhere.
struct NonFreeBox {
  std::array<int, 3> first, last;

  explicit NonFreeBox(const oracle::DenseMap& map) {
    first.fill(std::numeric_limits<int>::max());
    last.fill(-1);
    std::array<int, 3> i{};
    for (i[0] = 0; i[0] < map.dims.x; ++i[0]) {
      for (i[1] = 0; i[1] < map.dims.y; ++i[1]) {
        for (i[2] = 0; i[2] < map.dims.z; ++i[2]) {
          const Index3 voxel{map.min_index.x + i[0], map.min_index.y + i[1],
                             map.min_index.z + i[2]};
          if (map.states[map.position(voxel)] == static_cast<std::uint8_t>(VoxelState::free)) {
            continue;
          }
          for (std::size_t k = 0; k < 3; ++k) {
            first[k] = std::min(first[k], i[k]);
            last[k] = std::max(last[k], i[k]);
          }
        }
      }
    }
  }
};

std::vector<Quad> quads_across(const oracle::DenseMap& map, const NonFreeBox& box, std::size_t a,
                               int most) {
  const std::size_t b = (a + 1) % 3;
  const std::size_t c = (a + 2) % 3;
  const auto is_free = [&](int along, int row, int column) {
    std::array<int, 3> i{};
    i[a] = along;
    i[b] = row;
    i[c] = column;
    return map.state({map.min_index.x + i[0], map.min_index.y + i[1], map.min_index.z + i[2]}) ==
           VoxelState::free;
  };
  std::vector<Quad> quads;
  const auto add_plane = [&](int plane, bool lower_side) {
    FacePlane faces(box.last[b] - box.first[b] + 1, box.last[c] - box.first[c] + 1);
    const int front = lower_side ? plane - 1 : plane;
    const int behind = lower_side ? plane : plane - 1;
    for (int row = box.first[b]; row <= box.last[b]; ++row) {
      for (int column = box.first[c]; column <= box.last[c]; ++column) {
        const bool exposed = !is_free(behind, row, column) && is_free(front, row, column);
        faces.at(row - box.first[b], column - box.first[c]) = exposed ? 1 : 0;
      }
    }
    faces.take(most, [&](int row, int column, int rows, int columns) {
      const auto corner = [&](int r, int k) {
        std::array<float, 3> p{};
        p[a] = static_cast<float>(plane);
        p[b] = static_cast<float>(box.first[b] + r);
        p[c] = static_cast<float>(box.first[c] + k);
        return p;
      };
      quads.push_back({{corner(row, column), corner(row + rows, column),
                        corner(row + rows, column + columns), corner(row, column + columns)},
                       lower_side});
    });
  };
  for (const bool lower_side : {true, false}) {
    for (int plane = box.first[a]; plane <= box.last[a] + 1; ++plane) add_plane(plane, lower_side);
  }
  return quads;
}

}  // namespace

std::array<std::vector<Quad>, 3> exposed_quads(const oracle::DenseMap& map, int most) {
  const NonFreeBox box(map);
  return {quads_across(map, box, 0, most), quads_across(map, box, 1, most),
          quads_across(map, box, 2, most)};
}

}  // namespace viewgain::bench
