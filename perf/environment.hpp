// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace viewgain::bench {

/// Adds the conditions of a result: threads, cpu, isa, compiler, build_type, versions of the
/// libraries and commit. `isa` is that of the kernels, which VIEWGAIN_ISA limits.
void add_environment(nlohmann::ordered_json& json, int num_threads);

/// `viewgain-bench environment`: prints only these. Returns the exit code.
int run_environment(int num_threads);

}  // namespace viewgain::bench
