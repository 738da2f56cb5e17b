// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "oriented_box.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain::detail {

/// Checks bodies against obstacles. Boxes and closed meshes are solid; an open mesh is a sheet. A
/// mesh is closed if each edge is used once in each direction; corners at the same position count
/// as one. World frame [m]. Immutable; thread safe.
class ObstacleCheck {
 public:
  explicit ObstacleCheck(const Obstacles& obstacles);

  [[nodiscard]] bool is_empty() const { return boxes_.empty() && triangles_.empty(); }

  [[nodiscard]] bool overlaps(const OrientedBox& body, const Eigen::Vector3d& body_center) const;

  /// Whether a point is inside a solid; inside a box by more than `touch` [m].
  [[nodiscard]] bool enclose(const Eigen::Vector3d& point, double touch) const;

 private:
  using Triangle = std::array<Eigen::Vector3d, 3>;
  /// A closed mesh: its triangles [first, last).
  struct Solid {
    Box bounds;
    std::uint32_t first, last;
  };
  [[nodiscard]] bool encloses(const Solid& solid, const Eigen::Vector3d& point) const;
  [[nodiscard]] bool is_in_mesh(const Eigen::Vector3d& point) const;

  std::vector<Box> boxes_;
  std::vector<Triangle> triangles_;
  BoxHierarchy triangle_boxes_;
  std::vector<Solid> solids_;
};

}  // namespace viewgain::detail
