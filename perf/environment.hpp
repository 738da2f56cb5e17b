// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace viewgain::bench {

/// Adds what a result depends on besides the code that is timed: threads, cpu, isa (that of the
/// kernels, limited by VIEWGAIN_ISA), compiler, build_type, versions of the libraries, commit.
void add_environment(nlohmann::ordered_json& json, int num_threads);

/// `viewgain-bench environment`: prints that alone. Returns the exit code.
int run_environment(int num_threads);

}  // namespace viewgain::bench
