// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/next_views.hpp"
#include "program/cli/flags/sensing.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/planner_mesh/candidate_generation.hpp"
#include "viewgain/planner_mesh/truth.hpp"

namespace viewgain::app {

/// Output options of a run on a mesh or on frames.
struct RunOutputs {
  std::string save_maps = "off";
  std::string pictures = "on";
  std::string report = "off";  ///< on, off, or another run to show next to this one
  bool resume = false;
  std::string out;

  [[nodiscard]] bool saves_maps() const { return save_maps == "on"; }
  [[nodiscard]] bool with_pictures() const { return pictures == "on"; }
  [[nodiscard]] bool with_report() const { return report != "off"; }
  [[nodiscard]] std::string beside() const {
    return report == "on" || report == "off" ? "" : report;
  }
  [[nodiscard]] bool draws() const { return with_pictures() || with_report(); }
};
void add_output_options(App& app, RunOutputs& outputs);

/// Flags of `viewgain reconstruct MESH`.
struct ReconstructOptions {
  CommonOptions common;
  std::string mesh;
  std::string sensor;
  double voxel = 0;
  std::optional<double> size;
  std::string workspace;
  std::string from;
  std::optional<double> distance;
  std::string policy = "gain";
  std::string generator;
  std::string poses;
  std::optional<std::size_t> count;
  std::string gain;
  std::string hazard;
  std::string criterion = "log_diagonal";
  std::size_t max_views = PlanningConfig{}.max_views;
  std::string stop;
  std::optional<double> tolerance;
  double cost_per_metre = 0;
  std::string plan = "1";
  std::string reach;
  std::vector<std::string> obstacles;
  std::string body;
  std::string up = "z";
  SensingOptions sensing;
  RegistrationOptions registration;
  std::size_t frames_per_view = 1;
  std::string jump_edge_filter = "5";
  ScaleOptions scales;
  RunOutputs outputs;

  [[nodiscard]] double coverage_tolerance() const {
    return tolerance.value_or(covered_within(voxel));
  }
};

/// Adds the flags, with o's values as defaults.
void add_options(App& app, ReconstructOptions& o);

/// Throws Error(invalid_argument), naming the flag, for invalid numbers.
void check(const ReconstructOptions& options);

}  // namespace viewgain::app
