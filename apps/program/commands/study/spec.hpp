// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "viewgain/support/json.hpp"

namespace viewgain::app {

/// How a study's run chooses its views: a policy of `reconstruct`, for the policy gain with the
/// gain that it ranks by; or plans by the default gain.
struct StudyPolicy {
  std::string name;          ///< as in the spec: "frontier", "gain:combined"
  std::string policy, gain;  ///< the last may be empty
  std::string plan, take;    ///< of "tour:K:M"; else empty
};

/// One run of a study.
struct StudyRun {
  std::size_t object = 0, policy = 0;  ///< indices in the spec
  std::uint64_t seed = 1;
  std::string sensor;          ///< preset or file, as in the spec
  double voxel = 0;            ///< [m]
  std::optional<double> size;  ///< longest side [m]; none: the file's own
  Json configuration;          ///< all that can change its result
  std::string hash;            ///< of that: the name of the run's folder
};

struct StudyObject {
  std::string name;  ///< the file's name without its ending
  std::filesystem::path mesh;
};

/// What `viewgain study` is asked for: every object, policy, seed, sensor, voxel and size with
/// every other.
struct StudySpec {
  std::vector<StudyObject> objects;
  std::vector<StudyPolicy> policies;
  std::size_t max_views = 0;
  /// A point is covered where the surface is within this [m]; default: covered_within() the voxels.
  double tolerance = 0;
  std::size_t against = 0;          ///< index of the policy that the others are paired with
  std::vector<std::string> flags;   ///< further ones of `reconstruct`, for all runs
  std::size_t kept_candidates = 0;  ///< at most so many of each view's are left in candidates.txt
  std::vector<StudyRun> runs;       ///< by sensor, voxel, size, object, seed, policy
};

/// Reads a spec; paths in it are relative to its folder. Throws Error(io) for files that cannot be
/// read, Error(format), naming file, line and key, for whatever is not as it should be.
[[nodiscard]] StudySpec read_study_spec(const std::filesystem::path& path);

/// The command line of a run, after `reconstruct`.
[[nodiscard]] std::vector<std::string> reconstruct_words(const StudySpec& spec,
                                                         const StudyRun& run);

/// "camel, gain:combined, seed 3", and where there are several of them sensor, voxel and size.
[[nodiscard]] std::string name_of(const StudySpec& spec, const StudyRun& run);

}  // namespace viewgain::app
