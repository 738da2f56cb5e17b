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
  baseline,  ///< architectures other than x86-64: the compiler's default
  sse4,      ///< the minimum on x86-64
  avx2,
  avx512,
};

/// "avx512", "avx2", "sse4" or "baseline"; "baseline" also for an invalid value. Never throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view isa_name(Isa isa);

/// Sets that this CPU and operating system support, best first. Empty on an x86-64 without SSE4.2.
/// Takes constant time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Isa> supported_isas();

/// The best supported set, limited by the environment variable VIEWGAIN_ISA (avx512, avx2 or sse4).
/// Throws Error(invalid_argument) that lists the names for any other value, Error(backend) if the
/// CPU supports no set. Reads the environment at each call; keeps no state.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa();
/// The same choice for a CPU that supports these sets, best first. Takes constant time.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa(std::span<const Isa> supported);

}  // namespace viewgain
