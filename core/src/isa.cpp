// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/isa.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "viewgain/core/error.hpp"

namespace viewgain {

std::string_view isa_name(Isa isa) {
  switch (isa) {
    case Isa::avx512:
      return "avx512";
    case Isa::avx2:
      return "avx2";
    case Isa::sse4:
      return "sse4";
    case Isa::baseline:
      break;
  }
  return "baseline";
}

std::vector<Isa> supported_isas() {
  std::vector<Isa> isas;
#if defined(__x86_64__)
  __builtin_cpu_init();
  // CPU features that Highway's targets of the same names require.
  const bool sse4 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("pclmul") &&
                    __builtin_cpu_supports("aes");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
  if (avx512) isas.push_back(Isa::avx512);
  if (avx2) isas.push_back(Isa::avx2);
  if (sse4) isas.push_back(Isa::sse4);
#else
  isas.push_back(Isa::baseline);
#endif
  return isas;
}

Isa select_isa() { return select_isa(supported_isas()); }

Isa select_isa(std::span<const Isa> isas) {
  if (isas.empty()) throw Error(ErrorCode::backend, "viewgain needs a CPU with SSE4.2");
  const char* wish = std::getenv("VIEWGAIN_ISA");
  if (wish == nullptr || *wish == '\0' || isa_name(isas.front()) == wish) return isas.front();
  for (const Isa isa : {Isa::avx512, Isa::avx2, Isa::sse4}) {
    if (isa_name(isa) == wish) return std::min(isa, isas.front());
  }
  refuse("the environment variable VIEWGAIN_ISA is '" + std::string(wish) +
         "'; valid values: avx512, avx2, sse4");
}

}  // namespace viewgain
