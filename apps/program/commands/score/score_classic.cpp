// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_classic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/json.hpp"
#include "program/cli/values.hpp"

namespace viewgain::app {
namespace {

// What there is no such thing of for classic gains.
void check_classic(const ScoreOptions& options) {
  const std::array<std::pair<const char*, bool>, 13> given{
      {{"--race", options.race},
       {"--trace", options.common.trace != CommonOptions{}.trace},
       {"--approximate", options.approximate.has_value()},
       {"--set", options.set.has_value()},
       {"--picture", !options.picture.empty()},
       {"--report", !options.report.empty()},
       {"--refinement-weight", options.refinement_weight.has_value()},
       {"--object-size", options.object_size.has_value()},
       {"--hazard", !options.hazard.empty()},
       {"--criterion", options.criterion != "log_diagonal"},
       {"--weight", !options.weights.empty()},
       {"--costs or --cost-per-metre", !options.costs.none()},
       {"--prior-sigma", options.prior_sigma.has_value()}}};
  for (const auto& [flag, is_given] : given) {
    if (!is_given) continue;
    refuse(std::string(flag) + " does not go with the classic gains (--gain " + options.gain + ")");
  }
}

std::string name_of(ClassicGain gain) { return std::string(classic_gain_name(gain)); }

}  // namespace

std::optional<std::vector<ClassicGain>> classic_gains_of(const std::string& names) {
  const std::vector<std::string>& models = gain_model_names();
  const std::vector<std::string> asked = names_in(names);
  std::vector<ClassicGain> gains;
  for (const std::string& name : asked) {
    if (std::find(models.begin(), models.end(), name) == models.end()) {
      gains.push_back(parse_classic_gain(name));
    } else if (asked.size() > 1) {
      refuse("--gain " + names + ": " + name + " stands alone; several are classic gains");
    }
  }
  if (gains.empty()) return std::nullopt;
  return gains;
}

ClassicConfig classic_config(const ScoreOptions& options, std::vector<ClassicGain> gains) {
  check_classic(options);
  ClassicConfig config;
  config.gains = std::move(gains);
  config.pixel_stride = options.stride;
  config.min_range = options.min_range;
  config.max_range = options.max_range;
  return config;
}

std::vector<std::size_t> ClassicScores::best(std::size_t top) const {
  const std::size_t n = evaluator.config().gains.size();
  const auto first = [&](std::size_t i) {
    const double gain = gains[i * n];
    return std::isnan(gain) ? -std::numeric_limits<double>::infinity() : gain;
  };
  std::vector<std::size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return first(a) > first(b); });
  order.resize(std::min(order.size(), top));
  return order;
}

Table ClassicScores::table() const {
  const std::vector<ClassicGain>& asked = evaluator.config().gains;
  Table table{{{"index", ColumnType::row}}};
  for (const ClassicGain gain : asked) table.columns.push_back({name_of(gain), ColumnType::real});
  table.columns.push_back({"status", ColumnType::status});
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    table.add(static_cast<std::int64_t>(numbers[i]));
    for (std::size_t g = 0; g < asked.size(); ++g) table.add(gains[i * asked.size() + g]);
    table.add(statuses[i]);
  }
  return table;
}

void ClassicScores::print_json(std::size_t top) const {
  const std::vector<ClassicGain>& asked = evaluator.config().gains;
  Json names = Json::array(), units = Json::array(), best_views = Json::array();
  for (const ClassicGain gain : asked) {
    names.push_back(name_of(gain));
    units.push_back(classic_gain_unit(gain));
  }
  for (const std::size_t i : best(top)) {
    Json view{{"index", numbers[i]}};
    for (std::size_t g = 0; g < asked.size(); ++g) {
      view[name_of(asked[g])] = gains[i * asked.size() + g];  // a NaN becomes null
    }
    view["status"] = view_status_name(statuses[i]);
    view["T_world_camera"] = to_json(source.poses.at(numbers[i]));
    best_views.push_back(std::move(view));
  }
  const auto poses = static_cast<double>(numbers.size());
  app::print_json(
      {{"poses", source.poses.size()},
       {"dropped", dropped},
       {"poses_scored", numbers.size()},
       {"rays_per_pose", evaluator.rays_per_pose()},
       {"threads", evaluator.num_threads()},
       {"isa", evaluator.map().scene().isa()},
       {"voxel_size", grid.voxel_size()},
       {"voxels", grid.voxel_count()},
       {"sensor", sensor.name},
       {"gains", names},
       {"gain_units", units},
       {"orthonormalized_poses", source.orthonormalized},
       {"seconds", seconds},
       {"poses_per_second", poses / seconds},
       {"rays_per_second", poses * static_cast<double>(evaluator.rays_per_pose()) / seconds},
       {"best", best_views}});
}

void ClassicScores::print_table(std::size_t top) const {
  const std::vector<ClassicGain>& asked = evaluator.config().gains;
  std::printf("classic gains, sensor %s\n", printable(sensor.name).c_str());
  if (!dropped.empty()) {
    std::printf("%zu of %zu poses; dropped: %s\n", numbers.size(), source.poses.size(),
                counts_text(dropped).c_str());
  }
  std::vector<std::string> heads;
  std::printf("%4s %8s", "rank", "index");
  for (const ClassicGain gain : asked) {
    std::string head = name_of(gain);
    head.append(" [").append(classic_gain_unit(gain)).append("]");
    std::printf(" %12s", head.c_str());
    heads.push_back(std::move(head));
  }
  std::printf("  %-26s %s\n", "eye x y z [m]", "status");
  std::size_t rank = 0;
  for (const std::size_t i : best(top)) {
    std::printf("%4zu %8zu", ++rank, numbers[i]);
    for (std::size_t g = 0; g < asked.size(); ++g) {
      std::printf(" %*.6g", static_cast<int>(std::max<std::size_t>(12, heads[g].size())),
                  gains[i * asked.size() + g]);
    }
    const Eigen::Vector3d eye = source.poses.at(numbers[i]).translation();
    std::printf("  %8.3f %8.3f %8.3f %s\n", eye.x(), eye.y(), eye.z(),
                std::string(view_status_name(statuses[i])).c_str());
  }
  std::printf("%zu poses in %.3f s: %.0f poses/s, %zu rays per pose, %d threads\n", numbers.size(),
              seconds, static_cast<double>(numbers.size()) / seconds, evaluator.rays_per_pose(),
              evaluator.num_threads());
}

}  // namespace viewgain::app
