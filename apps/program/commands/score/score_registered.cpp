// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/score/score_registered.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <utility>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/values.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain::app {
namespace {

// Refuses flags that these gains do not support.
void check_flags(const ScoreOptions& options) {
  const std::array<std::pair<const char*, bool>, 10> given{
      {{"--race", options.race},
       {"--approximate", options.approximate.has_value()},
       {"--set", options.set.has_value()},
       {"--picture", !options.picture.empty()},
       {"--report", !options.report.empty()},
       {"--hazard", !options.hazard.empty()},
       {"--criterion", options.criterion != "log_diagonal"},
       {"--weight", !options.weights.empty()},
       {"--costs or --cost-per-metre", !options.costs.none()},
       {"--prior-sigma", options.prior_sigma.has_value()}}};
  for (const auto& [flag, is_given] : given) {
    if (!is_given) continue;
    refuse(std::string(flag) + " cannot be used with a gain of the literature (--gain " +
           options.gain + ")");
  }
}

}  // namespace

std::optional<std::vector<std::string>> registered_gains_of(const ScoreOptions& options) {
  const std::vector<std::string>& models = gain_model_names();
  const std::vector<std::string> asked = names_in(options.gain);
  std::vector<std::string> gains;
  for (const std::string& name : asked) {
    if (std::find(models.begin(), models.end(), name) == models.end()) {
      gains.push_back(name);
    } else if (asked.size() > 1) {
      refuse("--gain " + options.gain + ": " + name +
             " must be given alone; only gains of the literature can be combined");
    }
  }
  if (gains.empty()) return std::nullopt;
  check_flags(options);
  return gains;
}

std::vector<std::size_t> RegisteredScores::best(std::size_t top) const {
  const std::size_t n = names.size();
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

Table RegisteredScores::table() const {
  Table table{{{"index", ColumnType::row}}};
  for (const std::string& name : names) table.columns.push_back({name, ColumnType::real});
  table.columns.push_back({"status", ColumnType::status});
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    table.add(static_cast<std::int64_t>(numbers[i]));
    for (std::size_t g = 0; g < names.size(); ++g) table.add(gains[i * names.size() + g]);
    table.add(statuses[i]);
  }
  return table;
}

void RegisteredScores::print_json(std::size_t top) const {
  Json units = Json::array(), best_views = Json::array();
  for (const std::string& name : names) units.push_back(registered_gains().unit(name));
  for (const std::size_t i : best(top)) {
    Json view{{"index", numbers[i]}};
    for (std::size_t g = 0; g < names.size(); ++g) {
      view[names[g]] = gains[i * names.size() + g];  // a NaN becomes null
    }
    view["status"] = view_status_name(statuses[i]);
    view["T_world_camera"] = to_json(source.poses.at(numbers[i]));
    best_views.push_back(std::move(view));
  }
  const auto poses = static_cast<double>(numbers.size());
  app::print_json({{"poses", source.poses.size()},
                   {"dropped", dropped},
                   {"poses_scored", numbers.size()},
                   {"rays_per_pose", rays_per_pose},
                   {"threads", threads},
                   {"isa", scene.isa()},
                   {"voxel_size", grid.voxel_size()},
                   {"voxels", grid.voxel_count()},
                   {"sensor", sensor.name},
                   {"gains", names},
                   {"gain_units", units},
                   {"orthonormalized_poses", source.orthonormalized},
                   {"seconds", seconds},
                   {"poses_per_second", poses / seconds},
                   {"rays_per_second", poses * static_cast<double>(rays_per_pose) / seconds},
                   {"best", best_views}});
}

void RegisteredScores::print_table(std::size_t top) const {
  std::printf("gains of the literature, sensor %s\n", printable(sensor.name).c_str());
  if (!dropped.empty()) {
    std::printf("%zu of %zu poses scored; dropped: %s\n", numbers.size(), source.poses.size(),
                counts_text(dropped).c_str());
  }
  std::vector<std::string> heads;
  std::printf("%4s %8s", "rank", "index");
  for (const std::string& name : names) {
    std::string head = name;
    head.append(" [").append(registered_gains().unit(name)).append("]");
    std::printf(" %12s", head.c_str());
    heads.push_back(std::move(head));
  }
  std::printf("  %-26s %s\n", "eye x y z [m]", "status");
  std::size_t rank = 0;
  for (const std::size_t i : best(top)) {
    std::printf("%4zu %8zu", ++rank, numbers[i]);
    for (std::size_t g = 0; g < names.size(); ++g) {
      std::printf(" %*.6g", static_cast<int>(std::max<std::size_t>(12, heads[g].size())),
                  gains[i * names.size() + g]);
    }
    const Eigen::Vector3d eye = source.poses.at(numbers[i]).translation();
    std::printf("  %8.3f %8.3f %8.3f %s\n", eye.x(), eye.y(), eye.z(),
                std::string(view_status_name(statuses[i])).c_str());
  }
  std::printf("%zu poses in %.3f s: %.0f poses/s, %zu rays per pose, %d threads\n", numbers.size(),
              seconds, static_cast<double>(numbers.size()) / seconds, rays_per_pose, threads);
}

}  // namespace viewgain::app
