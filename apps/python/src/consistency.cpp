// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "consistency.hpp"

#include <pybind11/stl.h>

#include <limits>
#include <vector>

namespace viewgain::python {

py::object to_python(const FrameConsistency& found) {
  std::vector<double> in_free, seen_past, displacements;
  for (const FrameContradiction& frame : found.frames) {
    in_free.push_back(frame.share_in_free());
    seen_past.push_back(frame.share_seen_past());
    displacements.push_back(frame.compared > 0 ? frame.displacement
                                               : std::numeric_limits<double>::quiet_NaN());
  }
  py::object suspicion = py::none();
  if (!found.suspicion.kind.empty()) {
    suspicion = named("Suspicion", found.suspicion.kind, found.suspicion.what);
  }
  return named("FrameConsistency", found.share_in_free, found.share_seen_past,
               py::tuple(py::cast(found.contradicting)), suspicion, to_array_1d<double>(in_free),
               to_array_1d<double>(seen_past), found.displacement, found.expected,
               to_array_1d<double>(displacements));
}

}  // namespace viewgain::python
