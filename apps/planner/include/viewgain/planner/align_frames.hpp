// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/register_frame.hpp"
#include "viewgain/raycast/view_scorer.hpp"

namespace viewgain {

/// Frames of one scene whose reported poses are a little off, aligned with one another: each new
/// frame is aligned with those so far, then all move together, so that what the first ones could
/// not know is mended by later ones, and those that were in doubt are tried again. The first
/// frame's pose holds. Or one frame is aligned with a map, which stands in as a frame that does not
/// move.
///
/// Minimises, over the poses T_i of all that move and a width b of rims, Σ_ij Σ_k w ρ(e)
/// / c + Σ_i |T_i ⊖ T_i,reported|² / (s σ²) + (b - 0.03)² / 0.03², e = nᵀ(T_i s - T_j m) the
/// distance of reading s of frame i from the reading m of frame j whose pixel it falls on, along
/// the mean n of both normals (a symmetric distance, after Rusinkiewicz, ACM Trans. Graphics 38(4),
/// 2019), or that of a map. 1/w is the sum of both variances along their normals, ρ Cauchy's, of e²
/// over the variance; pairs are gated by distance and angle of normals, by gates that begin at what
/// the reports allow. Gauss-Newton on each 4th, 2nd and every looked-at pixel of a row.
///
/// Readings are smoothed, by the planes through the 5x5 pixels round them: single ones, with
/// five times the noise, push frames apart, 12 views of the camel by 7 mm from where they were.
/// What a pixel shows comes from beside its ray, too, so rims seem wider than they are: s and m are
/// taken back along their normals by b lateral sigmas for each of the 25 pixels that lies past a
/// rim. Readings of a map are its fused_points(), drawn into the image, and those of a frame that
/// is held against it single ones; each reading of the map is in about 3 points, and several of the
/// frame share one.
///
/// Neighbours' errors are alike, so that readings say less than if they were independent. c, at
/// least 3 since readings are used in several pairs and points share errors, is the squared
/// gradient of single neighbours, over what their readings' noise would give, mean over the motions
/// (a sandwich estimate, Huber 1967). A map's neighbours are cubes of 10 pooling lengths; a frame's
/// are other frames, where it counts 8 times: on simulated objects it is 0.1 to 0.4 there, 9 in a
/// room before a real camera, whose systematic errors would else pull frames along.
///
/// Normals that are wrong at random would hold a sphere. What counts as information is therefore
/// Σ w (J_m J_sᵀ + J_s J_mᵀ) / 2c, J with either side's own normals, whose errors are independent.
/// A motion of which that says less than the report is free and stays as reported.
///
/// s, at most 1, is one for all frames and the likeliest given by how much they ask to be moved
/// (empirical Bayes): poses that are better than their sigmas say stay where they are, so that
/// exact ones are not made worse by the noise of readings. Covariances are those of s = 1.
///
/// A frame is refused that lies where others see nothing, or sees nothing where others have their
/// surface, others being those that fit the first frame, or one another in a chain that begins with
/// it: as the frame fits best, or where these say too little of it, give or take a sigma. Where the
/// reported pose leads to a fit that is refused, twelve others within 1.5 sigmas are tried.
///
/// Frames are taken as a map takes them: without flying pixels, known obstacles and the support
/// plane, in the workspace.
///
/// Thread safety: nothing may run beside add(); const members may run from many threads at once.
/// Deterministic: the same bits for any number of threads.
class VIEWGAIN_EXPORT FrameAlignment {
 public:
  /// `map` has the settings of the map that frames go into, or are compared with. Undoes the lens
  /// distortion once. Throws Error(invalid_argument), naming the value, if the sensor, an obstacle
  /// or the filter is not valid.
  FrameAlignment(const Sensor& sensor, const ScorerConfig& map, const ExecConfig& exec = {});
  ~FrameAlignment();
  FrameAlignment(FrameAlignment&&) noexcept;
  FrameAlignment& operator=(FrameAlignment&&) noexcept;

  /// What became of the frame, until the next call; one that is refused moves nothing, one with too
  /// little overlap stays as reported, until others show what it shows. Covariances are relative to
  /// the first frame, whose own is zero. `sigma`: by how much the pose may be off. Throws
  /// Error(invalid_argument) as check_frame_size(), if the pose is not rigid (1e-3), a sigma is not
  /// positive and finite or map.grid is not valid; nothing has changed then. Cost: keeps some 100
  /// bytes a reading; the time grows with the square of the number of frames.
  const FrameRegistration& add(DepthFrame frame, const Pose& T_reported,
                               const PoseSigma& sigma = kUsualPoseSigma);

  /// What has become of all frames, in their order, as known now; the first, which defines the
  /// world, counts as registered. Until the next add().
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const;

  /// What becomes of a frame that is none of those, against a map. An empty map's first frame stays
  /// as reported; its covariance is zero. Throws as add(). Cost: fused_points() of the part that
  /// the frame may show, and 10 to 60 ms on two cores.
  [[nodiscard]] FrameRegistration register_frame(const BeliefGrid& grid, DepthFrame frame,
                                                 const Pose& T_reported,
                                                 const PoseSigma& sigma = kUsualPoseSigma) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
