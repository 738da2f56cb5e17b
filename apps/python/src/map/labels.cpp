// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "labels.hpp"

#include <algorithm>
#include <string>

#include "arrays.hpp"

namespace viewgain::python {

py::array any_labels(const py::object& labels) {
  const char* wanted = "labels must be whole numbers, uint8 at best, of the shape (nx, ny, nz)";
  const py::array any =
      any_array(is_masked_array(labels) ? labels.attr("filled")(0) : labels, wanted);
  if (any.dtype().kind() == 'b') {
    throw py::value_error(
        "labels is of bools, which say two of the three states: numpy.where(labels, 2, 1) makes "
        "True occupied and False free");
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
  std::string text = "labels holds ";
  for (std::size_t i = 0; i < named; ++i) {
    text.append(i > 0 ? ", " : "").append(py::str(values[py::int_(i)]).cast<std::string>());
  }
  if (named < count) text.append(" and ").append(std::to_string(count - named)).append(" more");
  throw py::value_error(text + ": 0 is unknown, 1 free, 2 occupied");
}

}  // namespace viewgain::python
