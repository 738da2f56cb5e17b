// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "grid_class.hpp"
#include "shared_grid.hpp"

namespace viewgain::python {

/// A row of BeliefGrid.occupied().
struct OccupiedRow {
  std::array<std::int32_t, 3> voxel;
  float log_odds;
  std::uint32_t hits;
};

namespace {

// All three numbers of a row without a voxel. Not a valid index on the lattice or in an array.
constexpr std::int32_t kNoVoxel = std::numeric_limits<std::int32_t>::min();

std::int32_t index_number(double number) {
  if (number > kNoVoxel && number <= std::numeric_limits<std::int32_t>::max() &&
      number == std::floor(number)) {
    return static_cast<std::int32_t>(number);
  }
  std::ostringstream text;
  text << "voxels contains " << number << "; an index must be a whole number of 32 bits";
  throw py::value_error(text.str());
}

std::vector<Index3> indices_of(const Doubles& voxels) {
  std::vector<Index3> indices(static_cast<std::size_t>(voxels.size() / 3));
  const double* number = voxels.data();
  for (Index3& index : indices) {
    index = {index_number(number[0]), index_number(number[1]), index_number(number[2])};
    number += 3;
  }
  return indices;
}

py::array_t<std::int32_t> index_of(const SharedGrid& grid, const py::object& points_world) {
  const Doubles points = items(points_world, "points", {3});
  py::array_t<std::int32_t> voxels(Shape(points.shape(), points.shape() + points.ndim()));
  const double* p = points.data();
  std::int32_t* out = voxels.mutable_data();
  const WithoutGil without_gil;
  for (const double* end = p + points.size(); p != end; p += 3) {
    const std::optional<Index3> voxel = grid.layout().index_of({p[0], p[1], p[2]});
    for (const std::int32_t i :
         {voxel ? voxel->x : kNoVoxel, voxel ? voxel->y : kNoVoxel, voxel ? voxel->z : kNoVoxel}) {
      *out++ = i;
    }
  }
  return voxels;
}

py::array_t<double> center(const SharedGrid& grid, const py::object& voxels) {
  const Doubles array = items(voxels, "voxels", {3});
  const std::vector<Index3> indices = indices_of(array);
  py::array_t<double> centers(Shape(array.shape(), array.shape() + array.ndim()));
  double* out = centers.mutable_data();
  const WithoutGil without_gil;
  for (const Index3& index : indices) {
    const Eigen::Vector3d p = grid.layout().center(index);
    out = std::copy_n(p.data(), 3, out);
  }
  return centers;
}

py::array_t<std::uint8_t> scale(const SharedGrid& grid, const py::object& voxels) {
  const Doubles array = items(voxels, "voxels", {3});
  const std::vector<Index3> indices = indices_of(array);
  py::array_t<std::uint8_t> scales(leading_shape(array, 1));
  std::uint8_t* const out = scales.mutable_data();
  grid.read([&](const BeliefGrid& g) {
    std::transform(indices.begin(), indices.end(), out,
                   [&](Index3 v) { return static_cast<std::uint8_t>(g.scale(v)); });
  });
  return scales;
}

void set(SharedGrid& grid, const py::object& voxels, const py::object& log_odds) {
  const Doubles array = items(voxels, "voxels", {3});
  const std::vector<Index3> indices = indices_of(array);
  const Doubles values = doubles(log_odds, "log_odds");
  const bool is_one = values.ndim() == 0;
  const Shape wanted = leading_shape(array, 1);
  if (!is_one &&
      !std::equal(wanted.begin(), wanted.end(), values.shape(), values.shape() + values.ndim())) {
    throw py::value_error("log_odds has the shape " + shape_text(values) +
                          " and voxels the shape " + shape_text(array) +
                          "; expected one number, or one number per voxel");
  }
  std::vector<BeliefGrid::VoxelValue> changes;
  changes.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    changes.push_back({indices[i], static_cast<float>(values.data()[is_one ? 0 : i]), {}});
  }
  grid.write([&](BeliefGrid& g) { g.set(changes); });
}

py::array_t<OccupiedRow> occupied(const SharedGrid& grid) {
  std::vector<OccupiedRow> rows;
  grid.read([&](const BeliefGrid& g) {
    g.for_each_occupied([&](const BeliefGrid::VoxelValue& one) {
      rows.push_back({{one.voxel.x, one.voxel.y, one.voxel.z},
                      one.log_odds,
                      one.belief ? one.belief->hits : 0});
    });
  });
  return to_array_1d<OccupiedRow>(rows);
}

}  // namespace

void bind_voxels(GridClass& grid_class) {
  PYBIND11_NUMPY_DTYPE(OccupiedRow, voxel, log_odds, hits);
  grid_class
      .def("index_of", &index_of, "points"_a,
           R"(The voxels that contain points. Cost: about 20 ns per point.

Parameters
----------
points : array_like, (..., 3)
    World frame [m].

Returns
-------
ndarray, (..., 3), int32
    Indices on the lattice; subtract ``min_index`` to index arrays. For a point that lies outside
    the workspace or is not finite, all three numbers are -2**31, which is never a valid index.)")
      .def("center", &center, "voxels"_a,
           R"(Centres of voxels. Cost: about 25 ns per voxel.

Parameters
----------
voxels : array_like, (..., 3), whole numbers
    Indices on the lattice; they may lie outside the workspace.

Returns
-------
ndarray, (..., 3), float64
    World frame [m].)")
      .def("set", &set, "voxels"_a, "log_odds"_a,
           R"(Sets voxels of the workspace, all or none. Cost: about 0.25 µs per voxel.

Parameters
----------
voxels : array_like, (..., 3), whole numbers
    On the lattice.
log_odds : float or array_like, (...)
    Above 0 the voxel is occupied, otherwise free. Values are rounded to steps of 0.05 and clamped
    to -2..3.5. The beliefs of the voxels are removed.)")
      .def(
          "forget",
          [](SharedGrid& grid, const py::object& region) {
            const Box bounds = box(region, "region");
            std::uint64_t count = 0;
            grid.write([&](BeliefGrid& g) { count = g.forget(bounds); });
            return count;
          },
          "region"_a,
          R"(Makes voxels unknown again, for example when objects or the robot have moved.

Views remain. Cost: linear in the map's blocks of voxels; 0.4 ms for 128**3 voxels.

Parameters
----------
region : array_like, (2, 3)
    Lowest and highest corner of a box in the grid frame [m]. Bounds may be infinite. Applies to
    voxels whose centre lies in the box.

Returns
-------
int
    Number of voxels that were known.)")
      .def("scale", &scale, "voxels"_a,
           R"(Scales of the cells that contain the voxels. Cost: linear in the voxels.

Parameters
----------
voxels : array_like, (..., 3), whole numbers
    On the lattice.

Returns
-------
ndarray, (...), uint8
    0 to 3. A cell of scale s has 2**s voxels per edge, which share one state and one belief. 0
    outside the workspace.)")
      .def(
          "resample",
          [](SharedGrid& grid, const py::object& region, int to) {
            const Box bounds = box(region, "region");
            std::uint64_t count = 0;
            grid.write([&](BeliefGrid& g) { count = g.resample(bounds, to); });
            return count;
          },
          "region"_a, "scale"_a,
          R"(Sets the scale of leaves, which are blocks of 8**3 voxels.

A leaf of scale s is divided into cells of 2**s voxels per edge. When cells are merged, their
beliefs are added. When a cell is split, the new cell that contains the mean of its readings gets
its belief; the rest of an occupied cell becomes unknown. Cost: linear in the map's leaves.

Parameters
----------
region : array_like, (2, 3)
    Lowest and highest corner of a box in the grid frame [m]. Bounds may be infinite. Applies to all
    leaves that the box touches.
scale : int
    New scale, 0 to 3.

Returns
-------
int
    Number of changed leaves.)")
      .def("occupied", &occupied,
           R"(The occupied voxels. Equal maps give the same order.

Returns
-------
ndarray, (n,), structured
    Of a cell larger than a voxel, only the lowest voxel is listed. Fields: voxel (int32, 3: index
    on the lattice; subtract ``min_index`` to index arrays), log_odds (float32), hits (number of
    measured depths that ended in the voxel).)");
}

}  // namespace viewgain::python
