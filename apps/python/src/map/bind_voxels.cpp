// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
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

namespace {

// All three numbers of a row where there is no voxel: the index of none, on the lattice or in an
// array.
constexpr std::int32_t kNoVoxel = std::numeric_limits<std::int32_t>::min();

std::int32_t index_number(double number) {
  if (number > kNoVoxel && number <= std::numeric_limits<std::int32_t>::max() &&
      number == std::floor(number)) {
    return static_cast<std::int32_t>(number);
  }
  std::ostringstream text;
  text << "voxels holds " << number << "; an index is a whole number of 32 bits";
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

}  // namespace

void bind_voxels(GridClass& grid_class) {
  grid_class
      .def("index_of", &index_of, py::arg("points"),
           R"(The voxels that hold points.

Parameters
----------
points : array_like, (..., 3)
    World frame [m].

Returns
-------
ndarray, (..., 3), int32
    On the lattice, minus ``min_index`` for arrays. -2**31 in all three places, which is no index of any
    array, for a point that is outside the workspace or not finite.)")
      .def("center", &center, py::arg("voxels"),
           R"(Where the centres of voxels are.

Parameters
----------
voxels : array_like, (..., 3), whole numbers
    On the lattice; they need not lie in the workspace.

Returns
-------
ndarray, (..., 3), float64
    World frame [m].

Raises
------
ValueError
    A number that is no index, such as those that ``index_of`` gives where there is no voxel.)");
}

}  // namespace viewgain::python
