// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Throws std::bad_alloc if this many bytes cannot be allocated now. Allocates nothing itself. Call
/// it before code that ends the process when memory runs out. Thread safe.
VIEWGAIN_EXPORT void check_room(std::size_t bytes);

}  // namespace viewgain
