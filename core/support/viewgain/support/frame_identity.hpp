// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Whether the text has the form of DepthFrame::identity.
[[nodiscard]] VIEWGAIN_EXPORT bool is_identity(const std::string& text);
/// Throws Error(invalid_argument) if the text is neither empty nor an identity.
VIEWGAIN_EXPORT void check_identity(const std::string& identity);

}  // namespace viewgain
