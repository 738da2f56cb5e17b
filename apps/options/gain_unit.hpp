// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// Unit of ViewGain::gain, as JSON and text name it.
[[nodiscard]] inline std::string_view gain_unit(GainModel model, std::string_view criterion) {
  const bool is_area =
      model == GainModel::surface || (model == GainModel::paper && criterion == "trace");
  return is_area ? "m^2" : "nat";
}

}  // namespace viewgain::app
