// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "show/pictures/picture_parts.hpp"
#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/planning.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/mesh/surface.hpp"
#include "viewgain/mesh/viewpoint_estimator.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::app {

/// What one turn of the loop looked at (the paper's Fig. 7).
struct ViewPicture {
  const SurfaceMesh& surface;             ///< seen so far
  const EstimatedViews& estimated;        ///< its boundary runs
  std::span<const Candidate> candidates;  ///< the feasible ones
  Pose T_world_camera;                    ///< the view just taken
  std::optional<Pose> chosen{};           ///< the next one
  const GainEvaluator& evaluator;         ///< traces the chosen view's rays
  const Sensor& sensor;
  /// What the chosen view touches, by `evaluator`; null: looked for here.
  const std::vector<VoxelContribution>* contributions = nullptr;
};

/// A picture of 640x480 px:
/// - the surface in grey, its inside darker, with boundary runs in the colours of their classes
/// - at most 200 candidates as small frusta, in the colours of their boundaries or in grey
/// - the view just taken as a black frustum
/// - the chosen view as a larger green frustum, with some of its rays: orange if they end in
///   unknown voxels, blue if in occupied ones
/// - for the surface and combined gains, unknown voxels that may contain surface; likelier ones are
///   larger
///
/// Throws Error(invalid_argument) for a view that is not rigid (1e-3). The picture does not depend
/// on the number of threads.
[[nodiscard]] RgbImage view_picture(const ViewPicture& picture, const ExecConfig& exec);

/// The amplitude image of a frame (the paper's Fig. 1), 8-bit grey, enlarged by a whole number to
/// at least 480 px in width; brightness ∝ the square root of the amplitude, the 99th percentile is
/// white. Atomic. Throws Error(io); Error(invalid_argument) if the frame has no amplitude.
void write_amplitude_picture(const std::filesystem::path& path, const DepthFrame& frame);

/// What of a surface is drawn.
struct SurfacePicture {
  const SurfaceMesh& surface;
  /// One a vertex [m]: the surface from dark to bright by them; none: grey.
  std::vector<double> sigmas{};
  std::array<double, 2> sigma_range{};  ///< what is darkest and brightest [m]
};

/// The picture, which the surface fills. Throws Error(invalid_argument) for one without a triangle.
/// The same for any number of threads.
[[nodiscard]] RgbImage draw(const SurfacePicture& picture, const Viewer& viewer,
                            const ExecConfig& exec);

/// The 2nd and the 98th percentile, for colours. Zeros without a value.
[[nodiscard]] std::array<double, 2> usual_range(std::vector<double> values);

}  // namespace viewgain::app
