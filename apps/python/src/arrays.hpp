// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "viewgain/core/box.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/tour.hpp"
#include "viewgain/core/triangle_mesh.hpp"

namespace viewgain::python {

namespace py = pybind11;
using namespace py::literals;

// Conversions from Python's arrays to the library's types and back. All need the GIL. `name` is
// that of the argument, for messages. Each throws py::value_error with the name and the given shape
// or dtype.

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Shape = std::vector<py::ssize_t>;

/// "(3, 4)"
[[nodiscard]] std::string shape_text(const py::array& array);

/// Throws py::value_error that states the wanted shape and the array's shape.
[[noreturn]] void reject_shape(const char* name, const std::string& wanted, const py::array& array);
/// Whether it is the array that numpy makes from [].
[[nodiscard]] bool is_empty_list(const py::array& array);

/// numpy.asarray() of the value, or numpy.from_dlpack() if it has __dlpack__ but no __array__. A
/// TypeError or ValueError, or an array in another device's memory, becomes ValueError with the
/// text `refusal`. Other exceptions pass, such as MemoryError and KeyboardInterrupt.
[[nodiscard]] py::array any_array(const py::handle& value, const std::string& refusal);

/// Whether the value is one of numpy.ma's arrays, whose masks any_array() drops.
[[nodiscard]] bool is_masked_array(const py::handle& value);
/// The value; if it is a masked array, a float64 copy with NaN in the masked places.
[[nodiscard]] py::object nan_where_masked(const py::object& value);

/// Real numbers as C-contiguous float64: the caller's memory if possible, otherwise converted once.
/// Masked entries are refused.
[[nodiscard]] Doubles doubles(const py::handle& value, const char* name);

/// As above with a required shape; -1 stands for any extent. If the first axis may have any extent,
/// [] is an array without rows.
[[nodiscard]] Doubles doubles(const py::handle& value, const char* name, const Shape& wanted);

/// A copied table of path costs between `stops`, shape (stops + 1, stops), with the start in the
/// last row.
[[nodiscard]] WayCost way_table(const py::handle& value, const char* name, std::size_t& stops);

/// As above for the shape (..., *item); [] is an array without items.
[[nodiscard]] Doubles items(const py::handle& value, const char* name, const Shape& item);
/// The shape of an array without its last axes.
[[nodiscard]] Shape leading_shape(const py::array& array, py::ssize_t last_axes);

/// A number from a value with __float__; otherwise throws TypeError with the name and the value.
[[nodiscard]] double number(const py::handle& value, const char* name);
[[nodiscard]] Eigen::Vector3d vector3(const py::handle& value, const char* name);
[[nodiscard]] std::vector<std::array<double, 3>> points(const py::handle& value, const char* name);
/// (2, 3): lowest and highest corner.
[[nodiscard]] Box box(const py::handle& value, const char* name);
/// (n, 2, 3); none for None.
[[nodiscard]] std::vector<Box> optional_boxes(const py::object& value, const char* name);
/// A pair of vertices (n, 3) and triangles (m, 3).
[[nodiscard]] TriangleMesh triangle_mesh(const py::handle& vertices, const py::handle& triangles);

/// A copy of `values` as an array of one axis.
template <typename T>
[[nodiscard]] py::array_t<T> to_array_1d(std::span<const T> values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// A copy of `values`, three columns each.
template <typename T>
[[nodiscard]] py::array_t<T> to_array_3(const std::vector<std::array<T, 3>>& values) {
  return py::array_t<T>(Shape{static_cast<py::ssize_t>(values.size()), 3},
                        values.empty() ? nullptr : values.front().data());
}

/// Converts an array without axes to a numpy scalar, like numpy's own functions.
[[nodiscard]] py::object scalar_or_array(const py::array& array);

// Results with several parts are named tuples, whose classes are in Python. All functions need the
// GIL.

/// A named tuple of a module with these values, in the order of its fields.
template <typename... Values>
[[nodiscard]] py::object named_in(const char* module, const char* type, Values&&... values) {
  return py::module_::import(module).attr(type)(std::forward<Values>(values)...);
}
/// As above, from viewgain.results.
template <typename... Values>
[[nodiscard]] py::object named(const char* type, Values&&... values) {
  return named_in("viewgain.results", type, std::forward<Values>(values)...);
}

/// Index of a frame, counted from the end if negative. Throws py::index_error.
[[nodiscard]] std::size_t frame_index(std::size_t frames, py::ssize_t index);

/// File name of a str, bytes or os.PathLike, in the system's encoding; ValueError for one with a
/// NUL.
[[nodiscard]] std::string file_path(const py::handle& value);
/// As above for an existing file; throws FileNotFoundError, or another OSError, with the name.
[[nodiscard]] std::string readable_file(const py::handle& value);
/// As above for a file that can be created; does not check for a full disk.
[[nodiscard]] std::string writable_file(const py::handle& value);

using Labels =
    pybind11::array_t<std::uint8_t, pybind11::array::c_style | pybind11::array::forcecast>;

/// Whole numbers of the shape (nx, ny, nz), whose values are unchecked. Raises ValueError.
[[nodiscard]] pybind11::array any_labels(const pybind11::object& labels);
/// Raises ValueError that names invalid labels.
void require_states(const pybind11::array& labels);

}  // namespace viewgain::python
