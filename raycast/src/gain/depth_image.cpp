// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/depth_image.hpp"

#include "trace/ray_tile.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {

DepthFrame depth_image(const GainEvaluator& evaluator, const Pose& T_world_camera,
                       std::vector<RayHit::Kind>* labels) {
  const PinholeCamera& camera = evaluator.camera();
  const int stride = evaluator.pixel_stride();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  if (hits.empty()) {
    throw Error(ErrorCode::invalid_argument,
                "the pose of a depth image is off from a rigid transform by " +
                    short_text(orthonormality_error(T_world_camera)) + "; 1e-3 is allowed");
  }
  DepthFrame image;
  image.width = detail::strided(camera.width, stride);
  image.height = detail::strided(camera.height, stride);
  image.depth.assign(hits.size(), DepthFrame::kOutOfRange);
  if (labels != nullptr) labels->resize(hits.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (labels != nullptr) (*labels)[i] = hits[i].kind;
    if (hits[i].kind == RayHit::Kind::none) continue;
    const auto columns = static_cast<std::size_t>(image.width);
    const Eigen::Vector3d ray = camera.ray(static_cast<double>(i % columns) * stride,
                                           static_cast<double>(i / columns) * stride);
    image.depth[i] = static_cast<float>(hits[i].range / ray.norm());
  }
  return image;
}

}  // namespace viewgain
