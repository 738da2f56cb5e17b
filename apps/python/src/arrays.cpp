// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "arrays.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>

#include "viewgain/support/text.hpp"

namespace viewgain::python {
namespace {

std::string wanted_text(const Shape& wanted) {
  std::string text = "(";
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (i > 0) text += ", ";
    text += wanted[i] < 0 ? std::string("n") : std::to_string(wanted[i]);
  }
  return text + (wanted.size() == 1 ? ",)" : ")");
}

// Whether an array of another library (with __dlpack__) is in memory that the CPU cannot read.
bool is_elsewhere(const py::handle& value) {
  if (!py::hasattr(value, "__dlpack_device__")) return false;
  // DLPack's codes for CPU memory, and for memory pinned by CUDA and ROCm.
  constexpr std::array<int, 3> kReadable{1, 3, 11};
  const auto device = value.attr("__dlpack_device__")().cast<std::pair<int, int>>();
  return std::find(kReadable.begin(), kReadable.end(), device.first) == kReadable.end();
}

[[noreturn]] void raise_os_error(int code, const std::string& path) {
  errno = code;
  PyErr_SetFromErrnoWithFilename(PyExc_OSError, path.c_str());
  throw py::error_already_set();
}

}  // namespace

WayCost way_table(const py::handle& value, const char* name, std::size_t& stops) {
  const Doubles table = doubles(value, name, {-1, -1});
  stops = table.size() == 0 ? 0 : static_cast<std::size_t>(table.shape(1));
  if (table.size() != 0 && table.shape(0) != table.shape(1) + 1) {
    throw py::value_error(std::string(name) + " must have the shape (k + 1, k), not " +
                          shape_text(table));
  }
  return [stops, costs = std::make_shared<const std::vector<double>>(
                     table.data(), table.data() + table.size())](std::size_t from, std::size_t to) {
    return (*costs)[std::min(from, stops) * stops + to];
  };
}

void reject_shape(const char* name, const std::string& wanted, const py::array& array) {
  throw py::value_error(std::string(name) + " must have the shape " + wanted + ", not " +
                        shape_text(array));
}

bool is_empty_list(const py::array& array) { return array.ndim() == 1 && array.shape(0) == 0; }

std::string shape_text(const py::array& array) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) {
    if (i > 0) text += ", ";
    text += std::to_string(array.shape(i));
  }
  return text + (array.ndim() == 1 ? ",)" : ")");
}

py::array any_array(const py::handle& value, const std::string& refusal) {
  try {
    if (!py::isinstance<py::array>(value) && py::hasattr(value, "__dlpack__")) {
      if (is_elsewhere(value)) {
        throw py::value_error(refusal + " in the memory of the CPU; copy it there first");
      }
      if (!py::hasattr(value, "__array__")) {
        return py::module_::import("numpy").attr("from_dlpack")(value);
      }
    }
    return py::array(py::reinterpret_borrow<py::object>(value));
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw;
    throw py::value_error(refusal);
  }
}

bool is_masked_array(const py::handle& value) {
  if (Py_TYPE(value.ptr()) == py::detail::npy_api::get().PyArray_Type_) return false;
  return py::isinstance(value, py::module_::import("numpy.ma").attr("MaskedArray"));
}

py::object nan_where_masked(const py::object& value) {
  if (!is_masked_array(value)) return value;
  return value.attr("astype")("float64").attr("filled")(std::numeric_limits<double>::quiet_NaN());
}

Doubles doubles(const py::handle& value, const char* name) {
  if (is_masked_array(value) && value.attr("mask").attr("any")().cast<bool>()) {
    throw py::value_error(std::string(name) +
                          " has masked entries; drop them or fill them in (numpy.ma.filled)");
  }
  const py::array any = any_array(value, std::string(name) + " must be an array of numbers");
  const char kind = any.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    throw py::value_error(std::string(name) + " must contain real numbers, not dtype " +
                          py::str(any.dtype()).cast<std::string>());
  }
  return Doubles(any);
}

Doubles doubles(const py::handle& value, const char* name, const Shape& wanted) {
  Doubles array = doubles(value, name);
  if (is_empty_list(array) && wanted.front() < 0) {
    Shape none(wanted);
    none.front() = 0;
    return Doubles(none);
  }
  bool same = array.ndim() == static_cast<py::ssize_t>(wanted.size());
  for (std::size_t i = 0; same && i < wanted.size(); ++i) {
    same = wanted[i] < 0 || wanted[i] == array.shape(static_cast<py::ssize_t>(i));
  }
  if (!same) reject_shape(name, wanted_text(wanted), array);
  return array;
}

Doubles items(const py::handle& value, const char* name, const Shape& item) {
  Doubles array = doubles(value, name);
  if (is_empty_list(array)) {
    Shape none(item);
    none.insert(none.begin(), 0);
    return Doubles(none);
  }
  const py::ssize_t axes = array.ndim(), last = static_cast<py::ssize_t>(item.size());
  if (axes < last || !std::equal(item.begin(), item.end(), array.shape() + (axes - last))) {
    std::string wanted = "(...";
    for (const py::ssize_t extent : item) wanted += ", " + std::to_string(extent);
    reject_shape(name, wanted + ")", array);
  }
  return array;
}

Shape leading_shape(const py::array& array, py::ssize_t last_axes) {
  return Shape(array.shape(), array.shape() + (array.ndim() - last_axes));
}

double number(const py::handle& value, const char* name) {
  const double real = PyFloat_AsDouble(value.ptr());
  if (real != -1.0 || PyErr_Occurred() == nullptr) return real;
  const py::error_already_set error;
  if (!error.matches(PyExc_TypeError) && !error.matches(PyExc_ValueError)) throw error;
  throw py::type_error(std::string(name) + " must be a number, not " +
                       py::repr(value).cast<std::string>());
}

Eigen::Vector3d vector3(const py::handle& value, const char* name) {
  const Doubles array = doubles(value, name, {3});
  const Eigen::Vector3d vector(array.at(0), array.at(1), array.at(2));
  if (!vector.allFinite()) {
    throw py::value_error(std::string(name) + " must be finite, not " +
                          py::repr(value).cast<std::string>());
  }
  return vector;
}

std::vector<std::array<double, 3>> points(const py::handle& value, const char* name) {
  const Doubles array = doubles(value, name, {-1, 3});
  std::vector<std::array<double, 3>> result(static_cast<std::size_t>(array.shape(0)));
  const double* x = array.data();
  for (auto& p : result) {
    std::copy_n(x, 3, p.begin());
    x += 3;
  }
  return result;
}

Box box(const py::handle& value, const char* name) {
  const Doubles array = doubles(value, name, {2, 3});
  Box result;
  std::copy_n(array.data(), 3, result.min.begin());
  std::copy_n(array.data() + 3, 3, result.max.begin());
  return result;
}

std::vector<Box> optional_boxes(const py::object& value, const char* name) {
  if (value.is_none()) return {};
  const Doubles array = doubles(value, name, {-1, 2, 3});
  std::vector<Box> boxes;
  const double* x = array.data();
  for (py::ssize_t i = 0; i < array.shape(0); ++i, x += 6) {
    boxes.push_back({{x[0], x[1], x[2]}, {x[3], x[4], x[5]}});
  }
  return boxes;
}

TriangleMesh triangle_mesh(const py::handle& vertices, const py::handle& triangles) {
  TriangleMesh mesh;
  mesh.vertices = points(vertices, "vertices");
  const Doubles array = doubles(triangles, "triangles", {-1, 3});
  mesh.triangles.resize(static_cast<std::size_t>(array.shape(0)));
  const double* index = array.data();
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      const double number = *index++;
      if (!(number >= 0 && number < static_cast<double>(mesh.vertices.size())) ||
          number != std::floor(number)) {
        throw py::value_error("triangles contains " + short_text(number) +
                              "; an index must be a whole number less than the number of "
                              "vertices, " +
                              std::to_string(mesh.vertices.size()));
      }
      corner = static_cast<std::uint32_t>(number);
    }
  }
  return mesh;
}

py::object scalar_or_array(const py::array& array) {
  if (array.ndim() > 0) return array;
  return array[py::tuple()];
}

std::size_t frame_index(std::size_t frames, py::ssize_t index) {
  const auto count = static_cast<py::ssize_t>(frames);
  if (index < 0) index += count;
  if (index < 0 || index >= count) throw py::index_error("frame index out of range");
  return static_cast<std::size_t>(index);
}

std::string file_path(const py::handle& value) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(value.ptr(), &bytes) == 0) throw py::error_already_set();
  return py::reinterpret_steal<py::bytes>(bytes);
}

std::string readable_file(const py::handle& value) {
  std::string path = file_path(value);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) raise_os_error(ENOENT, path);
  if (std::filesystem::is_directory(path, error)) raise_os_error(EISDIR, path);
  return path;
}

std::string writable_file(const py::handle& value) {
  std::string path = file_path(value);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) raise_os_error(EISDIR, path);
  std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (folder.empty()) folder = ".";
  if (!std::filesystem::exists(folder, error)) raise_os_error(ENOENT, folder.string());
  if (!std::filesystem::is_directory(folder, error)) raise_os_error(ENOTDIR, folder.string());
  // A temporary file is written to the same folder first.
  if (::access(folder.c_str(), W_OK | X_OK) != 0) raise_os_error(errno, folder.string());
  return path;
}

py::array any_labels(const py::object& labels) {
  const char* wanted = "labels must be whole numbers, uint8 at best, of the shape (nx, ny, nz)";
  const py::array any =
      any_array(is_masked_array(labels) ? labels.attr("filled")(0) : labels, wanted);
  if (any.dtype().kind() == 'b') {
    throw py::value_error(
        "labels are bools, which distinguish only two of the three states; numpy.where(labels, 2, "
        "1) makes True occupied and False free");
  }
  if ((any.dtype().kind() != 'u' && any.dtype().kind() != 'i') || any.ndim() != 3) {
    throw py::value_error(std::string(wanted) + ", not " +
                          py::str(any.dtype()).cast<std::string>() + " " + shape_text(any));
  }
  return any;
}

void require_states(const py::array& labels) {
  const auto is_state = [](const py::object& label) {
    const auto number = py::int_(label);
    return !(number < py::int_(0)) && !(number > py::int_(2));
  };
  if (is_state(labels.attr("min")()) && is_state(labels.attr("max")())) return;
  const auto numpy = py::module_::import("numpy");
  const py::object values = numpy.attr("setdiff1d")(labels, py::make_tuple(0, 1, 2));
  const std::size_t count = py::len(values), named = std::min<std::size_t>(count, 5);
  std::string text = "labels contains ";
  for (std::size_t i = 0; i < named; ++i) {
    text.append(i > 0 ? ", " : "").append(py::str(values[py::int_(i)]).cast<std::string>());
  }
  if (named < count) text.append(" and ").append(std::to_string(count - named)).append(" more");
  throw py::value_error(text + "; valid values: 0 (unknown), 1 (free), 2 (occupied)");
}

}  // namespace viewgain::python
