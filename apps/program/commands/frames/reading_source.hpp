// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "program/cli/flags/common_options.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/sensing.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/grid/integrate.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain::app {

/// Flags of `integrate`; see its help.
struct IntegrateOptions {
  CommonOptions common;
  FrameFolderOptions frames;        ///< its folder is empty for clouds
  std::vector<std::string> clouds;  ///< --cloud
  std::string origin = "viewpoint";
  std::string poses;
  std::optional<double> voxel;
  std::string workspace;
  std::string jump_edge_filter = "5";
  ScaleOptions scales;
  std::optional<double> support_plane;
  std::vector<std::string> obstacles;
  std::optional<double> prior_sigma;
  RegistrationOptions registration;
  std::string out;
  std::string map;

  /// Whether frames update the hazard counters, which an OctoMap cannot store.
  [[nodiscard]] bool calibrates_hazard() const { return !is_octomap(out); }
};

/// The input of `integrate`, depth frames or clouds. For each part in turn, call load, then
/// register_loaded and integrate.
class ReadingSource {
 public:
  virtual ~ReadingSource() = default;

  [[nodiscard]] virtual const Sensor& sensor() const = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Number of repaired poses.
  [[nodiscard]] virtual std::size_t orthonormalized() const = 0;

  /// Workspace for what all parts see. Throws Error(invalid_argument) if none has a reading.
  [[nodiscard]] virtual Box seen_workspace(double voxel, bool quiet) = 0;

  /// Identity by name and content, which the map stores. Empty if it is not stored, or if it cannot
  /// be read; `fault` then has the reason.
  [[nodiscard]] virtual std::string identity(std::size_t /*index*/, FrameFault& /*fault*/) const {
    return {};
  }

  /// Reads a part. Returns the fault of a frame that cannot be used; throws for a cloud that cannot
  /// be read.
  virtual FrameFault load(std::size_t index) = 0;
  /// Sets the map into which the readings go.
  virtual void start(BeliefGrid grid) = 0;
  /// After start().
  [[nodiscard]] virtual const BeliefGrid& grid() const = 0;
  /// Registers the loaded part with the map; it is then integrated at the resulting pose. Empty
  /// without --register on.
  virtual std::optional<FrameRegistration> register_loaded() { return {}; }
  /// Integrates the loaded part, unless the verdict states otherwise.
  virtual MapUpdate integrate() = 0;
  /// Pixels of the loaded part with a depth that were masked out.
  [[nodiscard]] virtual std::uint64_t masked_pixels() const { return 0; }
  /// Whether the frames agree; empty for clouds.
  [[nodiscard]] virtual std::optional<FrameConsistency> consistency() const { return {}; }
  /// File of a part.
  [[nodiscard]] virtual std::filesystem::path file(std::size_t index) const = 0;
  /// The folder of depth images; null for clouds.
  [[nodiscard]] virtual const FrameFolder* folder() const { return nullptr; }
};

/// Throws Error for invalid flags or files.
[[nodiscard]] std::unique_ptr<ReadingSource> open_reading_source(const IntegrateOptions& options);

}  // namespace viewgain::app
