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

// From Python's arrays to the library's types and back. All need the GIL. `name` is the argument's,
// for messages; each throws py::value_error that names it and the shape or dtype that came.

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Shape = std::vector<py::ssize_t>;

/// "(3, 4)"
[[nodiscard]] std::string shape_text(const py::array& array);

/// Throws py::value_error: the argument must have the wanted shape, not the array's.
[[noreturn]] void reject_shape(const char* name, const std::string& wanted, const py::array& array);
/// Whether it is what numpy makes of [], whatever that is a list of.
[[nodiscard]] bool is_empty_list(const py::array& array);

/// What numpy.asarray makes of the value, or numpy.from_dlpack of one that has __dlpack__ and no
/// __array__. A TypeError or ValueError on the way becomes ValueError with the text `refusal`, and
/// so does an array in another device's memory; others pass, MemoryError and KeyboardInterrupt
/// among them.
[[nodiscard]] py::array any_array(const py::handle& value, const std::string& refusal);

/// Whether the value is one of numpy.ma's arrays, whose masks any_array() drops.
[[nodiscard]] bool is_masked_array(const py::handle& value);
/// The value; if it is a masked array, a float64 copy with NaN in the masked places.
[[nodiscard]] py::object nan_where_masked(const py::object& value);

/// Real numbers as C-contiguous float64: the caller's own memory if they are that already, else
/// converted once. Masked entries are refused.
[[nodiscard]] Doubles doubles(const py::handle& value, const char* name);

/// The same for a wanted shape; -1 stands for any extent. Where the first axis has any extent, []
/// is an array without rows.
[[nodiscard]] Doubles doubles(const py::handle& value, const char* name, const Shape& wanted);

/// A table of ways between `stops`, shape (stops + 1, stops), its last row from the start; copied.
[[nodiscard]] WayCost way_table(const py::handle& value, const char* name, std::size_t& stops);

/// The same for the shape (..., *item); [] is an array without items.
[[nodiscard]] Doubles items(const py::handle& value, const char* name, const Shape& item);
/// The shape of an array without its last axes.
[[nodiscard]] Shape leading_shape(const py::array& array, py::ssize_t last_axes);

/// Whatever has a __float__; else throws TypeError with the name and the value.
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

/// An array without axes becomes numpy's scalar, as numpy's own functions do it.
[[nodiscard]] py::object scalar_or_array(const py::array& array);

// What calls return when it is more than one thing: named tuples, whose classes are Python's. All
// need the GIL.

/// A named tuple of a module with these values, in the order of its fields.
template <typename... Values>
[[nodiscard]] py::object named_in(const char* module, const char* type, Values&&... values) {
  return py::module_::import(module).attr(type)(std::forward<Values>(values)...);
}
/// The same of viewgain.results.
template <typename... Values>
[[nodiscard]] py::object named(const char* type, Values&&... values) {
  return named_in("viewgain.results", type, std::forward<Values>(values)...);
}

/// Of one of so many frames, from the end if negative. Throws py::index_error.
[[nodiscard]] std::size_t frame_index(std::size_t frames, py::ssize_t index);

/// The name as the system has it, of a str, bytes or os.PathLike; ValueError for one with a NUL.
[[nodiscard]] std::string file_path(const py::handle& value);
/// The same of a file that is there; throws FileNotFoundError, or another OSError, with the name.
[[nodiscard]] std::string readable_file(const py::handle& value);
/// The same where a file can be made; does not look whether a disk is full.
[[nodiscard]] std::string writable_file(const py::handle& value);

using Labels =
    pybind11::array_t<std::uint8_t, pybind11::array::c_style | pybind11::array::forcecast>;

/// Whole numbers of the shape (nx, ny, nz), not yet looked at. Raises ValueError.
[[nodiscard]] pybind11::array any_labels(const pybind11::object& labels);
/// Raises ValueError, naming the labels that are no states.
void require_states(const pybind11::array& labels);

}  // namespace viewgain::python
