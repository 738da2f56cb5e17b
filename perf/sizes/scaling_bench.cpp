// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scaling_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "environment.hpp"
#include "peak_memory.hpp"
#include "scaling_run.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kViewsOfCamel = 3;

/// A rate, or its inverse where `inverse` is not 0; a high quantile of the times is a low rate.
Json spread(const ScalingCase& c, double factor, double inverse) {
  const auto value = [&](double share_of_times) {
    const double rate = factor * c.poses_per_second(share_of_times);
    return inverse != 0 ? inverse / rate : rate;
  };
  const double low = value(0.95), high = value(0.05);
  return {{"median", value(0.5)}, {"p05", std::min(low, high)}, {"p95", std::max(low, high)}};
}

Json to_json(const ScalingCase& c) {
  const auto rays = static_cast<double>(c.rays_per_pose);
  return {{"scene", "camel-" + std::to_string(c.voxels)},
          {"rays_per_pose", c.rays_per_pose},
          {"threads", c.num_threads},
          {"poses", c.poses},
          {"poses_per_second", spread(c, 1, 0)},
          {"rays_per_second", spread(c, rays, 0)},
          {"ns_per_ray", spread(c, rays, 1e9)},
          {"agreement", c.agreement.share()},
          {"ties", c.agreement.ties},
          {"wrong", c.agreement.wrong()},
          {"same_bits", c.same_bits}};
}

void print_table(const Json& json) {
  std::printf("full gain, %s, %s\n\n", json["isa"].get<std::string>().c_str(),
              json["cpu"].get<std::string>().c_str());
  std::printf("%-10s %6s %8s %12s %10s %10s %10s %8s %8s  %s\n", "scene", "rays", "threads",
              "poses/s", "Mrays/s", "p05", "p95", "ns/ray", "oracle", "ties, wrong");
  for (const Json& c : json["cases"]) {
    const auto& rate = c["rays_per_second"];
    std::printf("%-10s %6d %8d %12.1f %10.3f %10.3f %10.3f %8.2f %.6f  %d, %d%s\n",
                c["scene"].get<std::string>().c_str(), c["rays_per_pose"].get<int>(),
                c["threads"].get<int>(), c["poses_per_second"]["median"].get<double>(),
                rate["median"].get<double>() / 1e6, rate["p05"].get<double>() / 1e6,
                rate["p95"].get<double>() / 1e6, c["ns_per_ray"]["median"].get<double>(),
                c["agreement"].get<double>(), c["ties"].get<int>(), c["wrong"].get<int>(),
                c["same_bits"].get<bool>() ? "" : ", DEPENDS ON THE THREADS");
  }
  std::printf("\n%-10s %12s %12s %12s\n", "scene", "map MB", "scene MB", "peak MB");
  for (const Json& m : json["memory"]) {
    std::printf("%-10s %12.1f %12.1f %12.1f\n", m["scene"].get<std::string>().c_str(),
                m["map_bytes"].get<double>() / 1e6, m["scene_bytes"].get<double>() / 1e6,
                m["peak_bytes"].get<double>() / 1e6);
  }
}

}  // namespace

int run_scaling(const ScalingOptions& options) {
  const int most = ThreadPool(options.num_threads).num_threads();
  ScalingPlan plan;
  plan.voxels = options.voxels;
  plan.threads = thread_counts(most);
  plan.poses = options.poses;
  plan.repetitions = options.repetitions;
  plan.mesh = options.mesh;
  const std::vector<ScalingCase> cases = run_scaling_cases(plan);

  Json json;
  add_environment(json, most);
  json["repetitions"] = options.repetitions;
  json["cases"] = Json::array();
  bool agree = true;
  for (const ScalingCase& c : cases) {
    json["cases"].push_back(to_json(c));
    agree = agree && c.agrees();
  }
  json["memory"] = Json::array();
  for (const int voxels : options.voxels) {
    const MemoryFigures m = measure_memory({most, voxels, kViewsOfCamel, options.mesh});
    json["memory"].push_back({{"scene", "camel-" + std::to_string(voxels)},
                              {"map_bytes", m.map},
                              {"scene_bytes", m.scene},
                              {"peak_bytes", m.peak}});
  }
  json["agree"] = agree;
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return agree ? 0 : 1;
}

}  // namespace viewgain::bench
