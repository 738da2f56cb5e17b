// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/planner/stop_settings.hpp"

#include <cmath>

#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

void set_stop_rules(PlanningConfig& planning, GainModel model, Criterion criterion,
                    std::optional<double> stop_gain, std::optional<double> stop_area) {
  if (stop_gain && !(*stop_gain >= 0 && std::isfinite(*stop_gain))) {
    refuse("stop_gain must be at least 0 and finite, not " + short_text(*stop_gain));
  }
  if (stop_area && !(*stop_area >= 0 && *stop_area < 1)) {
    refuse("stop_area must be at least 0 and less than 1, not " + short_text(*stop_area));
  }
  const bool by_paper = model == GainModel::paper;
  if (by_paper && stop_area.value_or(0) > 0) {
    refuse("stop_area requires the gain surface or combined");
  }
  if (!by_paper && stop_gain.value_or(0) > 0) refuse("stop_gain requires the gain paper");
  if (model == GainModel::combined && criterion == Criterion::trace) {
    refuse("the criterion trace requires the gain paper, because the combined gain is in nat");
  }
  planning.stop_gain_is_relative = criterion == Criterion::trace && !stop_gain;
  planning.stop_gain =
      stop_gain.value_or(planning.stop_gain_is_relative ? kStopGainShare : kStopGain);
  planning.stop_area = stop_area.value_or(by_paper ? 0.0 : kStopArea);
}

}  // namespace viewgain
