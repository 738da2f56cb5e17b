// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Instruction sets for which the SIMD kernels are built, in ascending order.
enum class Isa : std::uint8_t {
  baseline,  ///< on other architectures than x86-64: the compiler's default
  sse4,      ///< the minimum on x86-64
  avx2,
  avx512,
};

/// Name of the set: "avx512", "avx2", "sse4" or "baseline"; "baseline" for an invalid value. Never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view isa_name(Isa isa);

/// The sets that this CPU and operating system support, best first. Empty on x86-64 without SSE4.2.
/// Constant time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Isa> supported_isas();

/// The best supported set. The environment variable VIEWGAIN_ISA (avx512, avx2 or sse4) can limit
/// it, and is read at each call. Throws Error(invalid_argument) listing the names if the variable
/// has another value, and Error(backend) if the CPU supports no set.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa();
/// As above, for a CPU that supports the given sets, best first. Constant time.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa(std::span<const Isa> supported);

}  // namespace viewgain
