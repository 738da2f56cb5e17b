// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/core/exec_config.hpp"

#include <algorithm>

#include "viewgain/core/error.hpp"
#include "viewgain/support/nearest_name.hpp"

namespace viewgain {

const std::vector<std::string>& tracer_names() {
  static const std::vector<std::string> names{"automatic", "embree", "sweep"};
  return names;
}

Tracer parse_tracer(std::string_view name) {
  const std::vector<std::string>& names = tracer_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw Error(ErrorCode::invalid_argument,
                "unknown tracer \"" + std::string(name) + "\"; valid are " + listed(names));
  }
  return static_cast<Tracer>(found - names.begin());
}

}  // namespace viewgain
