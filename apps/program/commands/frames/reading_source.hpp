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

/// The flags of `integrate`; see its help.
struct IntegrateOptions {
  CommonOptions common;
  FrameFolderOptions frames;        ///< without a folder: clouds
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

  /// A tree has no place for what is counted.
  [[nodiscard]] bool calibrates_hazard() const { return !is_octomap(out); }
};

/// What `integrate` puts into a map, one part after the other: depth frames or clouds. The order of
/// calls is load, then register_loaded and integrate, of one part after the other.
class ReadingSource {
 public:
  virtual ~ReadingSource() = default;

  [[nodiscard]] virtual const Sensor& sensor() const = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// Poses that were off and were mended.
  [[nodiscard]] virtual std::size_t orthonormalized() const = 0;

  /// For what all parts see. Throws Error(invalid_argument) if none has a reading.
  [[nodiscard]] virtual Box seen_workspace(double voxel, bool quiet) = 0;

  /// By name and content, for the map to remember; empty: it is not remembered, or cannot be read,
  /// as `fault` then says.
  [[nodiscard]] virtual std::string identity(std::size_t /*index*/, FrameFault& /*fault*/) const {
    return {};
  }

  /// Says what is wrong with a frame that cannot be used; a cloud is read or throws.
  virtual FrameFault load(std::size_t index) = 0;
  /// The map that the readings go into.
  virtual void start(BeliefGrid grid) = 0;
  /// After start().
  [[nodiscard]] virtual const BeliefGrid& grid() const = 0;
  /// What registering the loaded part against the map came to, from whose pose it is then
  /// integrated; nothing without --register on.
  virtual std::optional<FrameRegistration> register_loaded() { return {}; }
  /// The part that was loaded, into the map unless the verdict says otherwise.
  virtual MapUpdate integrate() = 0;
  /// Pixels of the loaded part with a depth that its mask took.
  [[nodiscard]] virtual std::uint64_t masked_pixels() const { return 0; }
  /// Whether the frames fit one another; nothing for clouds.
  [[nodiscard]] virtual std::optional<FrameConsistency> consistency() const { return {}; }
  /// Its file.
  [[nodiscard]] virtual std::filesystem::path file(std::size_t index) const = 0;
  /// Of depth images; null for clouds.
  [[nodiscard]] virtual const FrameFolder* folder() const { return nullptr; }
};

/// Throws Error for what is wrong with flags or files.
[[nodiscard]] std::unique_ptr<ReadingSource> open_reading_source(const IntegrateOptions& options);

}  // namespace viewgain::app
