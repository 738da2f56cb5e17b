// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

/// Unit of ViewGain::gain, as JSON and text name it.
[[nodiscard]] inline std::string_view gain_unit(GainModel model, std::string_view criterion) {
  const bool is_area =
      model == GainModel::surface || (model == GainModel::paper && criterion == "trace");
  return is_area ? "m^2" : "nat";
}

}  // namespace viewgain::app
