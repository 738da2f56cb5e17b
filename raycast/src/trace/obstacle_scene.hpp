// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "ray_tile.hpp"
#include "scene/scene_data.hpp"
#include "triangle_scene.hpp"
#include "viewgain/support/isa.hpp"

namespace viewgain::detail {

/// Known obstacles, traced by Embree, in the scene's coordinates, and boxes round pieces of them,
/// by which a view tells where in the image there may be any: smaller ones near the workspace. All
/// scenes of a map that follow one another share it. Immutable; thread safe.
class ObstacleScene {
 public:
  /// Of a scene that has some. Throws Error(backend).
  ObstacleScene(const SceneData& data, Isa isa);

  /// The one of the scene before, if it is the same for this one, else a new one; null if there are
  /// no obstacles.
  [[nodiscard]] static std::shared_ptr<const ObstacleScene> of(const SceneData& data, Isa isa,
                                                               const SceneData* before);

  /// In the scene's coordinates.
  [[nodiscard]] const TriangleScene& triangles() const { return *triangles_; }
  /// Shortens far[lane] [voxels] to where the tile's rays of these lanes meet an obstacle, there
  /// too. Returns the lanes that meet one. Ranges of 0 meet nothing.
  std::uint32_t cut(const PoseFrame& frame, const RayTile& rays, std::uint32_t lanes,
                    float* far) const;

  /// Vector i of the pieces (kBoxVector of them, neighbours) lies in box i of the groups.
  [[nodiscard]] const BoxArrays& pieces() const { return pieces_; }
  [[nodiscard]] const BoxArrays& groups() const { return groups_; }
  [[nodiscard]] std::size_t piece_count() const { return piece_count_; }
  /// Its size along x, y, z [voxels]; coordinates are from its lowest corner.
  [[nodiscard]] const std::array<float, 3>& workspace() const { return workspace_; }
  /// By how much distances may be wrong [voxels]; above 0.
  [[nodiscard]] float rounding() const { return rounding_; }

  static constexpr std::size_t kMostPieces = 2048;

 private:
  Isa isa_;
  std::optional<TriangleScene> triangles_;
  BoxArrays pieces_, groups_;
  std::size_t piece_count_ = 0;
  std::array<float, 3> workspace_;
  float rounding_ = 1e-6F;
};

}  // namespace viewgain::detail
