// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "program/cli/app.hpp"
#include "program/cli/values.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// What --gain is unless given.
[[nodiscard]] inline std::string default_gain() {
  return std::string(gain_model_name(kDefaultGain));
}

/// What --gain takes: the models, then the gains of the literature.
[[nodiscard]] inline std::vector<std::string> all_gain_names() {
  std::vector<std::string> names = gain_model_names();
  names.insert(names.end(), classic_gain_names().begin(), classic_gain_names().end());
  return names;
}

/// What --gain takes where views are chosen one after another: the models.
[[nodiscard]] inline CLI::Validator one_of_gain_models() {
  CLI::Validator check = one_of(gain_model_names(), "gain");
  check.operation([](std::string& value) {
    const std::vector<std::string>& classic = classic_gain_names();
    return std::find(classic.begin(), classic.end(), value) != classic.end()
               ? value +
                     " is a gain of the literature, which score, study and reconstruct MESH take"
               : fault_of_name(value, gain_model_names(), "gain");
  });
  return check;
}

/// Unit of ViewGain::gain, as JSON and text name it.
[[nodiscard]] inline std::string_view gain_unit(GainModel model, std::string_view criterion) {
  const bool is_area =
      model == GainModel::surface || (model == GainModel::paper && criterion == "trace");
  return is_area ? "m^2" : "nat";
}

}  // namespace viewgain::app
