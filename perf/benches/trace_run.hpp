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

/// A method, the poses that it is timed on, and its results.
struct TraceEntry {
  TraceEntry(std::unique_ptr<TraceMethod> m, std::vector<Pose> p)
      : name(m->name()), method(std::move(m)), poses(std::move(p)) {}

  std::string name;
  std::unique_ptr<TraceMethod>
      method;  ///< null after the measurement, because it refers to the map
  std::vector<Pose> poses;
  std::vector<double> rates;  ///< rays per second, one per repetition
  Agreement agreement;
  RayShares shares;

  /// Is it a method of viewgain, not one of the others?
  [[nodiscard]] bool is_ours() const { return name.starts_with("viewgain_"); }
  /// Is it one of Embree's quad variants?
  [[nodiscard]] bool is_embree() const;
  /// Do its answers count? Those of Embree's variants that are not watertight do not: a ray in some
  /// millions slips through. They are only timed.
  [[nodiscard]] bool counts() const;
};

/// One interleaved run of all methods on camel-N.
struct TraceRun {
  struct Row {
    std::string name;
    const TraceEntry* entry;
  };

  int num_threads = 0;
  std::size_t rays_per_pose = 0;
  std::string isa;
  std::size_t scene_primitives = 0;
  std::vector<double> build_ms;     ///< time to build the whole scene
  std::vector<TraceEntry> entries;  ///< every variant
  std::vector<Row> rows;            ///< reported methods; of Embree's, the fastest that counts
  const TraceEntry* embree = nullptr;
  double fast_embree = 0;  ///< rays per second of Embree's fastest variant that does not count

  /// Median rays per second of a row.
  [[nodiscard]] double rate(const std::string& name) const;
  /// Methods of viewgain that do not agree with the oracle, and their wrong rays; empty: none.
  [[nodiscard]] std::string disagreement() const { return wrong_rays(true); }
  /// The same for the other methods that count. It is reported and does not fail the run.
  [[nodiscard]] std::string faults_of_others() const { return wrong_rays(false); }
  [[nodiscard]] bool agrees() const { return disagreement().empty(); }

 private:
  [[nodiscard]] std::string wrong_rays(bool of_ours) const;
};

/// Makes the map, checks all methods against the oracle and times them alternately. Throws Error.
[[nodiscard]] TraceRun run_trace_methods(const TraceOptions& options);

}  // namespace viewgain::bench
