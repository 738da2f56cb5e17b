// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/values.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"
#include "viewgain/raycast/gain_family.hpp"

namespace viewgain::app {

/// Default of --gain.
[[nodiscard]] inline std::string default_gain() {
  return std::string(gain_model_name(kDefaultGain));
}

/// Values of --gain: the models, then the registered gains, which are those of the literature.
[[nodiscard]] inline std::vector<std::string> all_gain_names() {
  std::vector<std::string> names = gain_model_names();
  const std::vector<std::string>& others = registered_gains().names();
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

/// Values of --gain for choosing several views: only the models.
[[nodiscard]] inline CLI::Validator one_of_gain_models() {
  CLI::Validator check = one_of(gain_model_names(), "gain");
  check.operation([](std::string& value) {
    return is_registered_gain(value)
               ? value + " is a gain of the literature, which only score and reconstruct support"
               : fault_of_name(value, gain_model_names(), "gain");
  });
  return check;
}

}  // namespace viewgain::app
