// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arrays.hpp"
#include "viewgain/raycast/frame_check.hpp"

namespace viewgain::python {

/// As Python's FrameConsistency.
[[nodiscard]] py::object to_python(const FrameConsistency& found);

}  // namespace viewgain::python
