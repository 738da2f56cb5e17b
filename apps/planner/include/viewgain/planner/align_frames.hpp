// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "viewgain/core/depth_frame.hpp"
#include "viewgain/core/exec_config.hpp"
#include "viewgain/core/export.hpp"
#include "viewgain/core/pose.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/belief_grid.hpp"
#include "viewgain/planner/register_frame.hpp"

namespace viewgain {

/// Frames of one scene whose reported poses are a little off, aligned with one another: each new
/// frame is aligned with those so far, then all move together, so that what the first ones could
/// not know is mended by later ones, and those that were in doubt are tried again. The first
/// frame's pose holds.
///
/// Minimises, over the poses T_i of all frames but the first and a width b of rims, Σ_ij Σ_k w ρ(e)
/// / c + Σ_i |T_i ⊖ T_i,reported|² / (s σ²) + (b - 0.03)² / 0.03², e = nᵀ(T_i s - T_j m) the
/// distance of reading s of frame i from the reading m of frame j whose pixel it falls on, along
/// the mean n of both normals (a symmetric distance, after Rusinkiewicz, ACM Trans. Graphics 38(4),
/// 2019). Readings are smoothed, by the planes through the 5x5 pixels round them: single ones, with
/// five times the noise, push frames apart, 12 views of the camel by 7 mm from where they were.
/// What a pixel shows comes from beside its ray, too, so rims seem wider than they are: s and m are
/// taken back along their normals by b lateral sigmas for each of the 25 pixels that lies past a
/// rim. Weights, ρ and gates as of FrameRegistrar. c, at least 3 since readings are used in several
/// pairs, is 8 times how much neighbours disagree about a frame: the squared gradient of single
/// neighbours, over what their readings' noise would give, mean over the motions. On simulated
/// objects that is 0.1 to 0.4; 9 in a room before a real camera, whose systematic errors would else
/// pull frames along. A motion of a frame that the others do not hold stays as reported.
///
/// s, at most 1, is one for all frames and the likeliest given by how much they ask to be moved
/// (empirical Bayes): poses that are better than their sigmas say stay where they are, so that
/// exact ones are not made worse by the noise of readings.
///
/// A frame is refused that lies where others see nothing, or sees nothing where others have their
/// surface, others being those that fit the first frame, or one another in a chain that begins with
/// it: as the frame fits best, or where these say too little of it, give or take a sigma. Where the
/// reported pose leads to a fit that is refused, twelve others within 1.5 sigmas are tried.
///
/// Thread safety: nothing may run beside add(). Deterministic: the same bits for any number of
/// threads. Cost: keeps some 100 bytes a reading; the time grows with the square of the number of
/// frames.
class VIEWGAIN_EXPORT FrameAlignment {
 public:
  /// Readings outside of the workspace of `layout`, whose beliefs do not count, are left out.
  /// Throws Error(invalid_argument), naming the value, if the sensor is not valid or a setting is
  /// out of its range.
  FrameAlignment(const Sensor& sensor, const BeliefGrid& layout,
                 const RegistrationConfig& config = {}, const ExecConfig& exec = {});
  ~FrameAlignment();
  FrameAlignment(FrameAlignment&&) noexcept;
  FrameAlignment& operator=(FrameAlignment&&) noexcept;

  /// Flying pixels should be filtered from the frame. What became of it, until the next call; one
  /// that is refused moves nothing, one with too little overlap stays as reported, until others
  /// show what it shows. Of FrameRegistration, `contradiction` is the larger share of the frame's
  /// readings that others look past and of the others' readings that it looks past. The
  /// covariance is relative to the first frame, whose own is zero. Throws Error(invalid_argument)
  /// as FrameRegistrar; nothing has changed then.
  const FrameRegistration& add(const DepthFrame& frame, const PosePrior& prior);

  /// What has become of all frames, in their order, as known now; the first, which defines the
  /// frame, counts as registered. Until the next add().
  [[nodiscard]] const std::vector<FrameRegistration>& registrations() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace viewgain
