// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace viewgain::bench {

/// The resident memory of this process [byte]: VmRSS of /proc/self/status.
[[nodiscard]] std::uint64_t resident_bytes();

/// Its peak since reset_peak_memory() [byte]: VmHWM.
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// Returns freed memory to the system and resets the peak to the current resident memory.
void reset_peak_memory();

}  // namespace viewgain::bench
