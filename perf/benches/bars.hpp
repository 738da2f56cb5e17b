// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace viewgain::bench {

/// Settings of the measurement. The bars are stated for the defaults. Use other sizes only to try
/// the program.
struct BarsOptions {
  int num_threads = 2;
  int voxels = 128;        ///< per side: camel-128 and the maps of `search`
  int large_voxels = 512;  ///< per side: camel-512
  int poses = 200;         ///< number of views in the tracing comparison
  int repetitions = 7;
  int maps = 200;         ///< number of maps of `search`
  int candidates = 2000;  ///< per search
  std::filesystem::path mesh;
  std::vector<std::string> only{};  ///< names of groups to measure; empty: all
  bool json = false;
};

/// One measured figure.
struct Figure {
  std::string name;
  double value = 0;
  /// The condition besides the bar: answers agree, the index is the same or the regret is small.
  bool is_valid = true;
  std::string note{};  ///< for the reader
};

/// Measures figures that belong together. Throws Error. Returns no figures if the library lacks the
/// calls.
using BarGroup = std::vector<Figure> (*)(const BarsOptions& options);

/// One interleaved run of `trace`: gain_over_quads, gain_over_quads_fast, gain_over_trace,
/// floor_over_quads, trace_over_floor, gain_over_octomap, surface_over_paper, combined_over_paper,
/// build_ms; for the tracer embree gain_embree_over_quads, gain_embree_over_gain,
/// trace_embree_over_trace.
[[nodiscard]] std::vector<Figure> trace_figures(const BarsOptions& options);
/// thread_scaling, cost_512_over_128; also for the tracer embree (`_embree`).
[[nodiscard]] std::vector<Figure> scaling_figures(const BarsOptions& options);
/// latency_scaling; also for the tracer embree (`_embree`).
[[nodiscard]] std::vector<Figure> latency_figures(const BarsOptions& options);
/// octomap_over_integrate.
[[nodiscard]] std::vector<Figure> integrate_figures(const BarsOptions& options);
/// update_over_build.
[[nodiscard]] std::vector<Figure> update_figures(const BarsOptions& options);
/// race_over_exhaustive, stages_over_paper, stages_over_paper_combined.
[[nodiscard]] std::vector<Figure> search_figures(const BarsOptions& options);
/// memory_mb.
[[nodiscard]] std::vector<Figure> memory_figures(const BarsOptions& options);
/// Several figures:
/// - decision_ms_100, decision_ms_500, decision_ms_2000
/// - planner_over_decision: time of ViewPlanner over that of the separate calls, for 500 poses
/// - stage_ms_*: the stages of `decision`, for 500 candidates
/// - turn_ms: from a frame to the best pose by the default gain, found by race()
[[nodiscard]] std::vector<Figure> decision_figures(const BarsOptions& options);
/// hazard_ms_128, hazard_ms_512.
[[nodiscard]] std::vector<Figure> hazard_figures(const BarsOptions& options);
/// classic_over_paper: the time of all classic gains together over that of the paper's.
[[nodiscard]] std::vector<Figure> classic_figures(const BarsOptions& options);
/// wall_over_free, mesh_over_free, table_over_free, lens_over_pinhole: speed with obstacles or a
/// lens over speed without, the minimum of the three gains.
[[nodiscard]] std::vector<Figure> surroundings_figures(const BarsOptions& options);
/// A group and its name in BarsOptions::only.
struct NamedBarGroup {
  std::string_view name;
  BarGroup run;
};
[[nodiscard]] std::span<const NamedBarGroup> bar_groups();

/// Measures and prints a table or a JSON list. Returns the exit code: 1 if a bar is missed.
int run_bars(const BarsOptions& options);

}  // namespace viewgain::bench
