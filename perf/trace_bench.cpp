// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "trace_bench.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "embree_quads.hpp"
#include "measure.hpp"
#include "octomap_cast_ray.hpp"
#include "openvdb_dda.hpp"
#include "oracle/rays.hpp"
#include "support/camel_scene.hpp"
#include "trace_method.hpp"
#include "viewgain/core/generators.hpp"
#include "viewgain_methods.hpp"

namespace viewgain::bench {
namespace {

using Json = nlohmann::ordered_json;

/// How one method's answers compare with the oracle's.
struct Agreement {
  std::size_t rays = 0;
  std::size_t same = 0;
  std::size_t ties =
      0;  ///< differ, and pass within 1e-4 voxel of a boundary between the two answers

  Agreement& operator+=(const Agreement& o) {
    rays += o.rays, same += o.same, ties += o.ties;
    return *this;
  }
  [[nodiscard]] double share() const {
    return static_cast<double>(same) / static_cast<double>(std::max<std::size_t>(rays, 1));
  }
  [[nodiscard]] bool agrees() const { return share() >= 0.9999 && same + ties == rays; }
};

/// A method, the poses it is timed on, and what was measured.
struct Entry {
  std::unique_ptr<TraceMethod> method;
  std::vector<Pose> poses;
  std::vector<double> rates{};  ///< rays per second, one a repetition
  Agreement agreement{};
};

/// Every k-th of the poses, at least `least` of them: for methods that would take minutes.
std::vector<Pose> thinned(std::span<const Pose> poses, std::size_t k, std::size_t least) {
  k = std::max<std::size_t>(1, std::min(k, poses.size() / std::max<std::size_t>(1, least)));
  std::vector<Pose> some;
  for (std::size_t i = 0; i < poses.size(); i += k) some.push_back(poses[i]);
  return some;
}

RayHit hit_of(const oracle::DenseMap& map, Ending ending) {
  if (ending == kMiss) return {};
  const int yz = map.dims.y * map.dims.z;
  const Index3 voxel{map.min_index.x + ending / yz, map.min_index.y + ending % yz / map.dims.z,
                     map.min_index.z + ending % map.dims.z};
  const bool occupied = map.state(voxel) == VoxelState::occupied;
  return {occupied ? RayHit::Kind::occupied : RayHit::Kind::unknown, voxel, 0};
}

Agreement compare(const TraceTask& task, const TraceMethod& method, const Pose& pose,
                  std::vector<Ending>& endings) {
  endings.resize(method.rays_per_pose());
  method.trace(pose, endings);
  const oracle::RayLimits limits = oracle::limits_of(task.map, task.sensor, {});
  const std::vector<oracle::Ray> rays =
      oracle::view_rays(task.map.T_world_grid, task.map.voxel_size, task.sensor.camera, 1, pose);
  Agreement result;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit actual = hit_of(task.map, endings[i]);
    ++result.rays;
    if (oracle::same_ending(oracle::first_hit(task.map, rays[i], limits), actual)) {
      ++result.same;
    } else if (oracle::is_tie(task.map, rays[i], limits, actual)) {
      ++result.ties;
    }
  }
  return result;
}

Agreement compare_all(const TraceTask& task, const Entry& entry, ThreadPool& pool) {
  std::vector<Agreement> parts(entry.poses.size());
  pool.for_each_chunk(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    std::vector<Ending> endings;
    for (std::size_t i = begin; i < end; ++i) {
      parts[i] = compare(task, *entry.method, entry.poses[i], endings);
    }
  });
  Agreement sum;
  for (const Agreement& part : parts) sum += part;
  return sum;
}

std::vector<Entry> make_entries(const TraceTask& task, const ScenePointer& scene) {
  const std::vector<Pose> all(task.poses.begin(), task.poses.end());
  const auto least = static_cast<std::size_t>(4 * task.num_threads);
  std::vector<Entry> entries;
  entries.push_back({make_viewgain_gain(task, scene), all});
  entries.push_back({make_viewgain_trace(task, scene), all});
  entries.push_back({make_viewgain_trace_bvh(task, scene), all});
  entries.push_back({make_viewgain_floor(task, scene), all});
  for (auto& method : make_embree_quads(task)) entries.push_back({std::move(method), all});
  entries.push_back({make_openvdb_dda(task), thinned(task.poses, 8, least)});
  entries.push_back({make_octomap_cast_ray(task), thinned(task.poses, 25, least)});
  return entries;
}

/// One after the other in every repetition, so that a slow moment of the machine meets all of them.
void measure(std::vector<Entry>& entries, int repetitions, ThreadPool& pool) {
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (Entry& entry : entries) {
      const double seconds = seconds_of([&] { entry.method->run(entry.poses, pool); });
      if (repetition < 0) continue;  // warming up
      const auto rays = static_cast<double>(entry.poses.size() * entry.method->rays_per_pose());
      entry.rates.push_back(rays / seconds);
    }
  }
}

bool is_embree(const Entry& entry) {
  return entry.method->name().find("coherent") != std::string::npos;
}

/// Embree without its robust flag lets a ray in some millions slip through the seam of two
/// triangles; those variants are timed for comparison, but do not count.
bool is_robust(const Entry& entry) { return entry.method->name().find("robust") == 0; }

/// What is reported: of Embree's variants the fastest that is watertight.
struct Report {
  struct Row {
    std::string name;
    const Entry* entry;
  };
  std::vector<Row> rows;
  const Entry* embree = nullptr;

  explicit Report(const std::vector<Entry>& entries) {
    for (const Entry& entry : entries) {
      if (!is_embree(entry) || !is_robust(entry)) continue;
      if (embree == nullptr || median(entry.rates) > median(embree->rates)) embree = &entry;
    }
    bool has_embree = false;
    for (const Entry& entry : entries) {
      if (!is_embree(entry)) {
        rows.push_back({entry.method->name(), &entry});
      } else if (!has_embree) {
        rows.push_back({"embree_quads", embree});
        has_embree = true;
      }
    }
  }

  [[nodiscard]] double rate(const std::string& name) const {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
    return median(row->entry->rates);
  }
};

Json to_json(const TraceOptions& options, const TraceTask& task, const VoxelScene& scene,
             const std::vector<Entry>& entries, const std::vector<double>& build_ms) {
  const Report report(entries);
  Json json;
  json["scene"] = "camel-" + std::to_string(options.voxels);
  json["threads"] = task.num_threads;
  json["rays_per_pose"] = task.sensor.camera.ray_table().size();
  json["isa"] = scene.isa();
  json["cpu"] = cpu_name();
  json["build_type"] = VIEWGAIN_BUILD_TYPE;
  json["embree_major"] = VIEWGAIN_EMBREE_MAJOR;
  json["repetitions"] = options.repetitions;
  json["scene_primitives"] = scene.primitive_count();
  json["scene_build_ms"] = {{"median", median(build_ms)},
                            {"p05", quantile(build_ms, 0.05)},
                            {"p95", quantile(build_ms, 0.95)}};
  json["methods"] = Json::array();
  bool agree = true;
  for (const auto& [name, entry] : report.rows) {
    json["methods"].push_back({{"name", name},
                               {"rays_per_second", median(entry->rates)},
                               {"p05", quantile(entry->rates, 0.05)},
                               {"p95", quantile(entry->rates, 0.95)},
                               {"poses", entry->poses.size()}});
  }
  json["embree_variant"] = report.embree->method->name();
  for (const Entry& entry : entries) {
    if (is_embree(entry)) json["embree_variants"][entry.method->name()] = median(entry.rates);
    agree = agree && (entry.agreement.agrees() || (is_embree(entry) && !is_robust(entry)));
  }
  for (const char* ours : {"viewgain_gain", "viewgain_trace"}) {
    for (const auto& [name, entry] : report.rows) {
      if (name != ours) {
        json["ratios"][std::string(ours) + "/" + name] = report.rate(ours) / report.rate(name);
      }
    }
  }
  double fast = 0;  // Embree without its robust flag, of which a few rays in millions end wrongly
  for (const Entry& entry : entries) {
    if (is_embree(entry) && !is_robust(entry)) fast = std::max(fast, median(entry.rates));
  }
  json["ratios"]["viewgain_gain/embree_quads_fast"] = report.rate("viewgain_gain") / fast;
  for (const auto& [name, entry] : report.rows) {
    json["agreement"][name] = entry->agreement.share();
    json["ties"][name] = entry->agreement.ties;
    json["wrong"][name] = entry->agreement.rays - entry->agreement.same - entry->agreement.ties;
  }
  json["agree"] = agree;
  return json;
}

void print_table(const Json& json) {
  std::printf("%s, %d threads, %d rays a pose, %s, %s\n", json["scene"].get<std::string>().c_str(),
              json["threads"].get<int>(), json["rays_per_pose"].get<int>(),
              json["isa"].get<std::string>().c_str(), json["cpu"].get<std::string>().c_str());
  std::printf("scene: %d leaves and boxes, built in %.2f ms (median)\n\n",
              json["scene_primitives"].get<int>(), json["scene_build_ms"]["median"].get<double>());
  std::printf("%-18s %12s %8s %8s %6s  %s\n", "method", "Mrays/s", "p05", "p95", "poses",
              "rays in the oracle's voxel");
  for (const Json& method : json["methods"]) {
    const auto name = method["name"].get<std::string>();
    std::printf("%-18s %12.3f %8.3f %8.3f %6d  %.6f, %d ties, %d wrong\n", name.c_str(),
                method["rays_per_second"].get<double>() / 1e6, method["p05"].get<double>() / 1e6,
                method["p95"].get<double>() / 1e6, method["poses"].get<int>(),
                json["agreement"][name].get<double>(), json["ties"][name].get<int>(),
                json["wrong"][name].get<int>());
  }
  std::printf("\nembree_quads is \"%s\", the best robust one of:\n",
              json["embree_variant"].get<std::string>().c_str());
  for (const auto& [name, rate] : json["embree_variants"].items()) {
    std::printf("  %-24s %8.3f\n", name.c_str(), rate.get<double>() / 1e6);
  }
  std::printf("\n");
  for (const auto& [name, ratio] : json["ratios"].items()) {
    std::printf("%-36s %10.3f\n", name.c_str(), ratio.get<double>());
  }
  std::printf("\n%s\n", json["agree"].get<bool>() ? "all agree" : "THEY DO NOT AGREE");
}

}  // namespace

int run_trace(const TraceOptions& options) {
  const BeliefGrid grid = test::camel_grid(options.voxels, options.mesh);
  const oracle::DenseMap map(grid);
  const Sensor sensor = sensor_preset("sr4000");
  const std::vector<Pose> poses = sphere_poses(static_cast<std::size_t>(options.poses), 0.6);
  ThreadPool pool(options.num_threads);
  const TraceTask task{grid, map, sensor, poses, pool.num_threads()};
  const ExecConfig exec{.num_threads = pool.num_threads()};

  ScenePointer scene = VoxelScene::build(grid, {}, exec);
  std::vector<double> build_ms;
  for (int i = 0; i < 3 * options.repetitions; ++i) {
    build_ms.push_back(1e3 * seconds_of([&] { scene = VoxelScene::build(grid, {}, exec); }));
  }

  std::vector<Entry> entries = make_entries(task, scene);
  for (Entry& entry : entries) entry.agreement = compare_all(task, entry, pool);
  measure(entries, options.repetitions, pool);

  const Json json = to_json(options, task, *scene, entries, build_ms);
  if (options.json) {
    std::printf("%s\n", json.dump(2).c_str());
  } else {
    print_table(json);
  }
  return json["agree"].get<bool>() ? 0 : 1;
}

}  // namespace viewgain::bench
