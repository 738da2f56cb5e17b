// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "viewgain/core/export.hpp"

namespace viewgain {

/// Instruction sets that the SIMD kernels are built for, in rising order.
enum class Isa : std::uint8_t {
  baseline,  ///< other architectures than x86-64: what the compiler assumes
  sse4,      ///< the least that x86-64 needs
  avx2,
  avx512,
};

/// "avx512", "avx2", "sse4" or "baseline", this also for a number that is none of them: never
/// throws.
[[nodiscard]] VIEWGAIN_EXPORT std::string_view isa_name(Isa isa);

/// What this CPU and operating system can run, best first. Empty on an x86-64 without SSE4.2. Takes
/// constant time.
[[nodiscard]] VIEWGAIN_EXPORT std::vector<Isa> supported_isas();

/// The best supported set, lowered by the environment variable VIEWGAIN_ISA (avx512, avx2 or
/// sse4; a set that the CPU lacks gives the best it has). Throws Error(invalid_argument) that lists
/// the names for any other value, Error(backend) if the CPU has none. Reads the environment at each
/// call; keeps no state.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa();
/// The same choice for a CPU that supports these sets, best first. Takes constant time.
[[nodiscard]] VIEWGAIN_EXPORT Isa select_isa(std::span<const Isa> supported);

}  // namespace viewgain
