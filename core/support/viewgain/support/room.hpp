// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Throws std::bad_alloc if the process cannot have so many more bytes now. Takes none. For what
/// ends the process where memory ends amid it. Thread safe.
VIEWGAIN_EXPORT void check_room(std::size_t bytes);

}  // namespace viewgain
