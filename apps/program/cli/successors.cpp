// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/successors.hpp"

#include <array>

namespace viewgain::app {
namespace {

struct Successor {
  std::string_view name, now;
};
constexpr std::array kSuccessors{
    Successor{"candidates", "viewgain next MAP --top all --out FILE"},
    Successor{"follow", "viewgain model FRAMES_DIR --watch --out OUT"},
    Successor{"study", "python3 -m viewgain.study SPEC --out DIR"},
    Successor{"--sphere", "--poses sphere:N,RADIUS"},
    Successor{"--dome", "--poses dome:N,RADIUS"},
    Successor{"--rings", "--poses rings:N,RADIUS"},
    Successor{"--shell", "--poses shell:N,RMIN,RMAX"},
    Successor{"--orbit", "--poses orbit:N,RADIUS,ELEVATION[,START,STEP]"},
    Successor{"--take", "--plan K,M"},
    Successor{"--stop-gain", "--stop gain=LIMIT"},
    Successor{"--stop-area", "--stop area=LIMIT"},
    Successor{"--stop-idle", "--stop idle=LIMIT"},
    Successor{"--stop-promises", "--stop promises=LIMIT"},
    Successor{"--stop-coverage", "--stop coverage=LIMIT"},
    Successor{"--pose-sigma", "--register SIGMA_M,SIGMA_DEG"},
    Successor{"--beside", "--report RUN"},
    Successor{"--flying-pixels", "--noise plain or --noise flying"},
    Successor{"--scale-error", "--noise scale=E"},
    Successor{"--pose-noise", "--noise pose=SIGMA_M/SIGMA_DEG"},
    Successor{"--least-confidence", "--confidence DIR,LEAST"},
    Successor{"--coarsest", "--scales COARSEST[,FINEST]"},
    Successor{"--finest", "--scales COARSEST,FINEST"},
    Successor{"--start", "--from tx,ty,tz,qx,qy,qz,qw"},
    Successor{"--width", "--viewer AZIMUTH,ELEVATION,WIDTH"},
    Successor{"--azimuth", "--viewer AZIMUTH,ELEVATION"},
    Successor{"--elevation", "--viewer AZIMUTH,ELEVATION"},
    Successor{"--min-range", "min_range in a sensor's file"},
    Successor{"--max-range", "max_range in a sensor's file"},
    Successor{"--amplitude", "a sensor with shot noise, for which amplitudes are written"},
    Successor{"--overlap", "EstimatorConfig::overlap in the library"},
    Successor{"--region-depth", "EstimatorConfig::region_depth in the library"},
    Successor{"--refine", "ScorerConfig::refine in the library"},
    Successor{"--carve", "ScorerConfig::carve in the library"},
    Successor{"--occupancy", "ScorerConfig::occupancy in the library"},
    Successor{"--calibrate-hazard", "ScorerConfig::learn_hazard in the library"},
    Successor{"--what", "viewgain render MAP KIND"},
    Successor{"--hash", "viewgain info MAP --json"},
    Successor{"--region", "--workspace BOX"},
    Successor{"--recenter", "--place center"},
    Successor{"--object-size", "--hazard size=L"},
    Successor{"--with-covariance", "viewgain convert MAP OUT.vdb"},
    Successor{"--stride", "GainConfig::pixel_stride in the library"},
    Successor{"--refinement-weight", "GainConfig::refinement_weight in the library"}};

}  // namespace

std::string successor_of(std::string_view name) {
  for (const Successor& successor : kSuccessors) {
    if (successor.name != name) continue;
    return std::string(name) + " was removed; use " + std::string(successor.now);
  }
  return {};
}

}  // namespace viewgain::app
