// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace viewgain::app {

/// 128 bits as 32 hexadecimal digits, as a name for what the text holds. Not for secrets: nobody
/// gains by two texts of one name.
[[nodiscard]] std::string hash_of(std::string_view text);

}  // namespace viewgain::app
