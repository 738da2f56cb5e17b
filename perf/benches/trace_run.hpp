// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "methods/agreement.hpp"
#include "methods/trace_method.hpp"
#include "trace_bench.hpp"

namespace viewgain::bench {

/// A method, the poses it is timed on, and what was measured.
struct TraceEntry {
  TraceEntry(std::unique_ptr<TraceMethod> m, std::vector<Pose> p)
      : name(m->name()), method(std::move(m)), poses(std::move(p)) {}

  std::string name;
  std::unique_ptr<TraceMethod> method;  ///< null once measured: it refers to the map
  std::vector<Pose> poses;
  std::vector<double> rates;  ///< rays per second, one a repetition
  Agreement agreement;
  RayShares shares;

  /// A way of viewgain's own, and none that it is compared with.
  [[nodiscard]] bool is_ours() const { return name.starts_with("viewgain_"); }
  /// One of Embree's quad variants.
  [[nodiscard]] bool is_embree() const;
  /// Embree's variants that are not watertight let a ray in some millions slip through; they are
  /// timed for comparison, but do not count.
  [[nodiscard]] bool counts() const;
};

/// One interleaved run of all ways to trace camel-N.
struct TraceRun {
  struct Row {
    std::string name;
    const TraceEntry* entry;
  };

  int num_threads = 0;
  std::size_t rays_per_pose = 0;
  std::string isa;
  std::size_t scene_primitives = 0;
  std::vector<double> build_ms;     ///< of the whole scene
  std::vector<TraceEntry> entries;  ///< every variant
  std::vector<Row> rows;            ///< what is reported: of Embree's the fastest that counts
  const TraceEntry* embree = nullptr;
  double fast_embree = 0;  ///< rays per second of the fastest that does not count

  /// Median rays per second of a row.
  [[nodiscard]] double rate(const std::string& name) const;
  /// Viewgain's own methods that do not agree with the oracle, and their wrong rays; empty: none.
  [[nodiscard]] std::string disagreement() const { return wrong_rays(true); }
  /// The same of the methods that it is compared with and that count: their fault, a figure in
  /// their rows.
  [[nodiscard]] std::string faults_of_others() const { return wrong_rays(false); }
  [[nodiscard]] bool agrees() const { return disagreement().empty(); }

 private:
  [[nodiscard]] std::string wrong_rays(bool of_ours) const;
};

/// Makes the map, checks every method against the oracle, times them in turns. Throws Error.
[[nodiscard]] TraceRun run_trace_methods(const TraceOptions& options);

}  // namespace viewgain::bench
