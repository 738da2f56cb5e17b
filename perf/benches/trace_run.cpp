// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "trace_run.hpp"

#include <algorithm>

#include "measure.hpp"
#include "methods/dense_dda.hpp"
#include "methods/embree_quads.hpp"
#include "methods/octomap_methods.hpp"
#include "methods/openvdb_methods.hpp"
#include "methods/tree64.hpp"
#include "methods/viewgain_methods.hpp"
#include "support/camel_scene.hpp"
#include "viewgain/core/generators.hpp"

namespace viewgain::bench {
namespace {

/// Every k-th of the poses, at least `least` of them: for methods that would take minutes.
std::vector<Pose> thinned(std::span<const Pose> poses, std::size_t k, std::size_t least) {
  k = std::max<std::size_t>(1, std::min(k, poses.size() / std::max<std::size_t>(1, least)));
  std::vector<Pose> some;
  for (std::size_t i = 0; i < poses.size(); i += k) some.push_back(poses[i]);
  return some;
}

std::vector<TraceEntry> make_entries(const TraceTask& task, const ScenePointer& scene,
                                     const std::vector<std::string>& without) {
  const auto wants = [&](const char* name) {
    return std::find(without.begin(), without.end(), name) == without.end();
  };
  const std::vector<Pose> all(task.poses.begin(), task.poses.end());
  const auto least = static_cast<std::size_t>(4 * task.num_threads);
  std::vector<TraceEntry> entries;
  for (auto& method : make_viewgain_gains(task, scene))
    entries.emplace_back(std::move(method), all);
  entries.emplace_back(make_viewgain_trace(task, scene), all);
  entries.emplace_back(make_viewgain_trace_embree(task, scene), all);
  entries.emplace_back(make_viewgain_floor(task, scene), all);
  for (auto& method : make_embree_quads(task)) entries.emplace_back(std::move(method), all);
  if (wants("dense")) entries.emplace_back(make_dense_dda(task), all);
  if (wants("tree64"))
    entries.emplace_back(make_tree64_method(task), thinned(task.poses, 4, least));
  if (wants("openvdb")) {
    const std::vector<Pose> some = thinned(task.poses, 8, least);
    for (auto& method : make_openvdb_methods(task)) entries.emplace_back(std::move(method), some);
  }
  if (wants("octomap")) {
    const std::vector<Pose> some = thinned(task.poses, 25, least);
    for (auto& method : make_octomap_methods(task)) entries.emplace_back(std::move(method), some);
  }
  return entries;
}

/// One after the other in every repetition, so that a slow moment of the machine meets all of them.
void measure(std::vector<TraceEntry>& entries, int repetitions, ThreadPool& pool) {
  for (int repetition = -1; repetition < repetitions; ++repetition) {
    for (TraceEntry& entry : entries) {
      const double seconds = seconds_of([&] { entry.method->run(entry.poses, pool); });
      if (repetition < 0) continue;  // warming up
      const auto rays = static_cast<double>(entry.poses.size() * entry.method->rays_per_pose());
      entry.rates.push_back(rays / seconds);
    }
  }
}

/// Chooses the rows that are reported.
void summarize(TraceRun& run) {
  for (const TraceEntry& entry : run.entries) {
    if (!entry.is_embree()) continue;
    const double rate = median(entry.rates);
    if (!entry.counts()) {
      run.fast_embree = std::max(run.fast_embree, rate);
    } else if (run.embree == nullptr || rate > median(run.embree->rates)) {
      run.embree = &entry;
    }
  }
  bool has_embree = false;
  for (const TraceEntry& entry : run.entries) {
    if (!entry.is_embree()) {
      run.rows.push_back({entry.name, &entry});
    } else if (!has_embree) {
      run.rows.push_back({"embree_quads", run.embree});
      has_embree = true;
    }
  }
}

}  // namespace

bool TraceEntry::is_embree() const { return name.find("coherent") != std::string::npos; }

bool TraceEntry::counts() const { return !is_embree() || name.starts_with("single robust"); }

double TraceRun::rate(const std::string& name) const {
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.name == name; });
  return median(row->entry->rates);
}

std::string TraceRun::wrong_rays(bool of_ours) const {
  std::string names;
  for (const TraceEntry& entry : entries) {
    const Agreement& a = entry.agreement;
    if (entry.is_ours() != of_ours || !entry.counts() || a.agrees()) continue;
    names += names.empty() ? "wrong rays: " : ", ";
    names += entry.name;
    names += ' ';
    names += std::to_string(a.wrong());
    names += " of ";
    names += std::to_string(a.rays);
  }
  return names;
}

TraceRun run_trace_methods(const TraceOptions& options) {
  const BeliefGrid grid = test::camel_grid(options.voxels, options.mesh);
  const oracle::DenseMap map(grid);
  const Sensor sensor = sensor_preset("sr4000");
  const std::vector<Pose> poses = sphere_poses(static_cast<std::size_t>(options.poses), 0.6);
  ThreadPool pool(options.num_threads);
  const TraceTask task{grid, map, sensor, poses, pool.num_threads()};
  const ExecConfig exec{.num_threads = pool.num_threads()};

  TraceRun run;
  ScenePointer scene = VoxelScene::build(grid, {}, exec);
  for (int i = 0; i < 3 * options.repetitions; ++i) {
    run.build_ms.push_back(1e3 * seconds_of([&] { scene = VoxelScene::build(grid, {}, exec); }));
  }
  run.num_threads = pool.num_threads();
  run.rays_per_pose = sensor.camera.ray_table().size();
  run.isa = scene->isa();
  run.scene_primitives = scene->primitive_count();
  run.entries = make_entries(task, scene, options.without);
  const OracleEndings expected(task, pool);
  for (TraceEntry& entry : run.entries) {
    entry.agreement = expected.compare(*entry.method, entry.poses, pool);
  }
  measure(run.entries, options.repetitions, pool);
  for (TraceEntry& entry : run.entries) entry.shares = entry.method->shares(entry.poses);
  for (TraceEntry& entry : run.entries) entry.method.reset();
  summarize(run);
  return run;
}

}  // namespace viewgain::bench
