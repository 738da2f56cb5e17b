// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "bars.hpp"
#include "measure.hpp"
#include "viewgain/support/isa.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Rule {
  std::string_view name;
  std::optional<double> bar;
  bool higher_is_better;

  [[nodiscard]] bool is_met(double value) const {
    return higher_is_better ? value >= *bar : value <= *bar;
  }
};

constexpr std::array kRules{
    Rule{"gain_over_quads", 3.0, true},
    Rule{"gain_over_quads_fast", {}, true},
    Rule{"gain_embree_over_quads", {}, true},
    Rule{"gain_embree_over_gain", {}, true},
    Rule{"trace_embree_over_trace", {}, true},
    Rule{"gain_over_trace", 0.88, true},
    Rule{"floor_over_quads", 6.0, true},
    Rule{"trace_over_floor", 0.45, true},
    Rule{"gain_over_octomap", 1000.0, true},
    Rule{"thread_scaling", 1.9, true},
    Rule{"thread_scaling_embree", {}, true},
    Rule{"cost_512_over_128", 2.5, false},
    Rule{"cost_512_over_128_embree", {}, false},
    Rule{"octomap_over_integrate", 100.0, true},
    Rule{"update_over_build", 0.35, false},
    Rule{"build_ms", 2.0, false},
    Rule{"race_over_exhaustive", 0.25, false},
    Rule{"latency_scaling", 0.6, false},
    Rule{"latency_scaling_embree", {}, false},
    Rule{"memory_mb", 250.0, false},
    Rule{"surface_over_paper", 0.35, true},
    Rule{"combined_over_paper", {}, true},
    Rule{"classic_over_paper", 4.0, false},
    Rule{"wall_over_free", 0.8, true},
    Rule{"mesh_over_free", 0.8, true},
    Rule{"table_over_free", 0.8, true},
    Rule{"lens_over_pinhole", 0.8, true},
    Rule{"stages_over_paper", 0.25, false},
    Rule{"stages_over_paper_combined", {}, false},
    Rule{"hazard_ms_128", 10.0, false},
    Rule{"hazard_ms_512", 40.0, false},
    Rule{"planner_over_decision", 1.1, false},
    Rule{"decision_ms_100", {}, false},
    Rule{"decision_ms_500", {}, false},
    Rule{"decision_ms_2000", {}, false},
    Rule{"stage_ms_integrate", {}, false},
    Rule{"stage_ms_scene", {}, false},
    Rule{"stage_ms_hazard", 10.0, false},
    Rule{"stage_ms_surface", {}, false},
    Rule{"stage_ms_candidates", {}, false},
    Rule{"stage_ms_combined_500", {}, false},
    Rule{"stage_ms_combined_500_two_stages", {}, false},
    Rule{"turn_ms", 250.0, false},
};

constexpr std::array kGroups{
    NamedBarGroup{"trace", trace_figures},
    NamedBarGroup{"scaling", scaling_figures},
    NamedBarGroup{"latency", latency_figures},
    NamedBarGroup{"integrate", integrate_figures},
    NamedBarGroup{"update", update_figures},
    NamedBarGroup{"search", search_figures},
    NamedBarGroup{"memory", memory_figures},
    NamedBarGroup{"decision", decision_figures},
    NamedBarGroup{"hazard", hazard_figures},
    NamedBarGroup{"classic", classic_figures},
    NamedBarGroup{"surroundings", surroundings_figures},
};

/// A bar's entry in the list; `is_missed` is set if it is missed.
Json to_json(const Rule& rule, const Figure& figure, int threads, bool& is_missed) {
  Json entry{{"name", rule.name}, {"value", figure.value},
             {"bar", nullptr},    {"better", rule.higher_is_better ? "higher" : "lower"},
             {"pass", nullptr},   {"isa", isa_name(select_isa())},
             {"threads", threads}};
  if (rule.bar) {
    const bool passes = figure.is_valid && rule.is_met(figure.value);
    entry["bar"] = *rule.bar;
    entry["pass"] = passes;
    is_missed = is_missed || !passes;
  }
  if (!figure.note.empty()) entry["note"] = figure.note;
  return entry;
}

void print_row(const Json& entry, const std::string& note) {
  const bool has_bar = !entry["bar"].is_null();
  std::printf("%-33s %10.3f  ", entry["name"].get<std::string>().c_str(),
              entry["value"].get<double>());
  if (has_bar) {
    std::printf("%s %-8g %s", entry["better"] == "higher" ? ">=" : "<=", entry["bar"].get<double>(),
                entry["pass"].get<bool>() ? "pass" : "MISSED");
  }
  std::printf("%s%s\n", note.empty() ? "" : "  ", note.c_str());
}

}  // namespace

std::span<const NamedBarGroup> bar_groups() { return kGroups; }

int run_bars(const BarsOptions& options) {
  BarsOptions actual = options;
  actual.num_threads = ThreadPool(options.num_threads).num_threads();
  std::vector<Figure> figures;
  for (const NamedBarGroup& group : kGroups) {
    const auto wanted = std::find(options.only.begin(), options.only.end(), group.name);
    if (!options.only.empty() && wanted == options.only.end()) continue;
    const double seconds = seconds_of([&] {
      for (Figure& figure : group.run(actual)) figures.push_back(std::move(figure));
    });
    std::fprintf(stderr, "%s: %.0f s\n", std::string(group.name).c_str(), seconds);
  }

  Json list = Json::array();
  bool is_missed = false;
  for (const Rule& rule : kRules) {
    const auto figure = std::find_if(figures.begin(), figures.end(),
                                     [&](const Figure& f) { return f.name == rule.name; });
    if (figure == figures.end()) continue;
    list.push_back(to_json(rule, *figure, actual.num_threads, is_missed));
    if (!options.json) print_row(list.back(), figure->note);
  }
  if (options.json) std::printf("%s\n", list.dump(2).c_str());
  return is_missed ? 1 : 0;
}

}  // namespace viewgain::bench
