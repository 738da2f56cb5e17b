// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "box_hierarchy.hpp"
#include "oriented_box.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// Bodies against obstacles. Boxes are solid, and so are closed meshes (each edge used once in each
/// direction, corners at the same place being one); an open mesh is a sheet. World frame [m].
class ObstacleCheck {
 public:
  explicit ObstacleCheck(const Obstacles& obstacles);

  [[nodiscard]] bool overlaps(const OrientedBox& body, const Eigen::Vector3d& body_center) const;

 private:
  using Triangle = std::array<Eigen::Vector3d, 3>;
  struct Solid {
    Box bounds;
    std::vector<Triangle> triangles;
  };

  std::vector<Box> boxes_;
  std::vector<Triangle> triangles_;
  BoxHierarchy triangle_boxes_;
  std::vector<Solid> solids_;
};

}  // namespace viewgain::detail
