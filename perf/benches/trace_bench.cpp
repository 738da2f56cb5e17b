// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "trace_bench.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "measure.hpp"
#include "trace_run.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const TraceOptions& options, const TraceRun& run) {
  Json json;
  json["scene"] = "camel-" + std::to_string(options.voxels);
  add_environment(json, run.num_threads);
  json["isa"] = run.isa;
  json["rays_per_pose"] = run.rays_per_pose;
  json["repetitions"] = options.repetitions;
  json["scene_primitives"] = run.scene_primitives;
  json["scene_build_ms"] = {{"median", median(run.build_ms)},
                            {"p05", quantile(run.build_ms, 0.05)},
                            {"p95", quantile(run.build_ms, 0.95)}};
  json["methods"] = Json::array();
  for (const auto& [name, entry] : run.rows) {
    json["methods"].push_back({{"name", name},
                               {"rays_per_second", median(entry->rates)},
                               {"p05", quantile(entry->rates, 0.05)},
                               {"p95", quantile(entry->rates, 0.95)},
                               {"poses", entry->poses.size()},
                               {"untraced", entry->shares.untraced},
                               {"embree", entry->shares.embree}});
  }
  json["embree_variant"] = run.embree->name;
  for (const TraceEntry& entry : run.entries) {
    if (!entry.is_embree()) continue;
    json["embree_variants"][entry.name] = {{"rays_per_second", median(entry.rates)},
                                           {"wrong", entry.agreement.wrong()}};
  }
  for (const std::string ours : {"viewgain_gain", "viewgain_trace"}) {
    const auto add_ratio = [&](const std::string& name, double rate) {
      json["ratios"][ours + "/" + name] = run.rate(ours) / rate;
    };
    for (const auto& [name, entry] : run.rows) {
      if (name != ours) add_ratio(name, run.rate(name));
      if (name == "embree_quads") add_ratio("embree_quads_fast", run.fast_embree);
    }
  }
  for (const auto& [name, entry] : run.rows) {
    json["agreement"][name] = entry->agreement.share();
    json["ties"][name] = entry->agreement.ties;
    json["wrong"][name] = entry->agreement.wrong();
  }
  json["agree"] = run.agrees();
  json["faults_of_others"] = run.faults_of_others();
  return json;
}

void print_table(const Json& json) {
  std::printf("%s, %d threads, %d rays per pose, %s, %s\n",
              json["scene"].get<std::string>().c_str(), json["threads"].get<int>(),
              json["rays_per_pose"].get<int>(), json["isa"].get<std::string>().c_str(),
              json["cpu"].get<std::string>().c_str());
  std::printf("scene: %d leaves and boxes, built in %.2f ms (median)\n\n",
              json["scene_primitives"].get<int>(), json["scene_build_ms"]["median"].get<double>());
  std::printf("%-18s %12s %8s %8s %6s %9s %9s  %s\n", "method", "Mrays/s", "p05", "p95", "poses",
              "untraced", "by Embree", "rays that end in the reference voxel");
  for (const Json& method : json["methods"]) {
    const auto name = method["name"].get<std::string>();
    std::printf("%-18s %12.3f %8.3f %8.3f %6d %8.1f%% %8.1f%%  %.6f, %d ties, %d wrong\n",
                name.c_str(), method["rays_per_second"].get<double>() / 1e6,
                method["p05"].get<double>() / 1e6, method["p95"].get<double>() / 1e6,
                method["poses"].get<int>(), 100 * method["untraced"].get<double>(),
                100 * method["embree"].get<double>(), json["agreement"][name].get<double>(),
                json["ties"][name].get<int>(), json["wrong"][name].get<int>());
  }
  std::printf(
      "\n"
      "embree_quads is \"%s\", the fastest of these variants that is robust:\n",
      json["embree_variant"].get<std::string>().c_str());
  for (const auto& [name, variant] : json["embree_variants"].items()) {
    std::printf("  %-24s %8.3f, %d wrong\n", name.c_str(),
                variant["rays_per_second"].get<double>() / 1e6, variant["wrong"].get<int>());
  }
  std::printf("\n");
  for (const auto& [name, ratio] : json["ratios"].items()) {
    std::printf("%-36s %10.3f\n", name.c_str(), ratio.get<double>());
  }
  const auto others = json["faults_of_others"].get<std::string>();
  std::printf("\n%s%s%s\n",
              json["agree"].get<bool>()
                  ? "viewgain agrees with the reference implementation"
                  : "VIEWGAIN DOES NOT AGREE WITH THE REFERENCE IMPLEMENTATION",
              others.empty() ? "" : "; other methods have ", others.c_str());
}

}  // namespace

int run_trace(const TraceOptions& options) {
  const TraceRun run = run_trace_methods(options);
  const Json json = to_json(options, run);
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return run.agrees() ? 0 : 1;
}

}  // namespace viewgain::bench
