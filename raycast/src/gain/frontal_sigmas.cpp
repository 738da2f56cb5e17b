// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "frontal_sigmas.hpp"

#include <cmath>
#include <variant>

namespace viewgain::detail {

FrontalSigmas frontal_sigmas(const Sensor& sensor) {
  struct Visitor {
    double fx;
    FrontalSigmas operator()(const ShotNoise& n) const {
      return {.a1 = n.reference_sigma / n.reference_range *
                    std::sqrt(n.reference_integration_time / n.integration_time),
              .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const StructuredLightNoise& n) const {
      return {.a0 = n.offset, .a2 = n.quadratic, .v = n.vertex, .l1 = n.lateral_px / fx};
    }
    FrontalSigmas operator()(const StereoNoise& n) const {
      return {.a2 = n.subpixel / (n.focal_with(fx) * n.baseline), .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const QuadraticNoise& n) const {
      return {.a0 = n.offset, .a1 = n.linear, .a2 = n.quadratic, .l1 = 1.0 / fx};
    }
    FrontalSigmas operator()(const ConstantNoise& n) const {
      return {.a0 = n.sigma_axial, .l0 = n.sigma_lateral};
    }
  };
  FrontalSigmas sigmas = std::visit(Visitor{sensor.camera.fx}, sensor.noise);
  const PoseSigma& pose = sensor.pose_sigma;
  sigmas.p0 = pose.translation * pose.translation;
  sigmas.p2 = pose.rotation * pose.rotation;
  return sigmas;
}

}  // namespace viewgain::detail
