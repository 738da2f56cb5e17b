// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace viewgain::bench {

/// What this process has in memory [byte]: VmRSS of /proc/self/status.
[[nodiscard]] std::uint64_t resident_bytes();

/// The most that it had since reset_peak_memory() [byte]: VmHWM.
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// Returns freed memory to the system and starts the peak anew from what is resident now.
void reset_peak_memory();

}  // namespace viewgain::bench
