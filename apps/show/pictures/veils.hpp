// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "show/pictures/painted_mesh.hpp"
#include "viewgain/core/camera.hpp"
#include "viewgain/core/pose.hpp"

namespace viewgain::app {

/// Translucent triangles. A picture has tens of thousands, dozens behind one another: lists of them
/// by tiles of pixels are looked through in less time than a ray from each to the next takes.
class Veils {
 public:
  struct Layer {
    double range;  ///< along the ray [m]
    const Paint* paint;
  };

  Veils(const PaintedMesh& painted, const PinholeCamera& camera, const Pose& T_world_camera)
      : columns_(tile_of(camera.width, camera.width) + 1),
        tiles_(columns_ * (tile_of(camera.height, camera.height) + 1)) {
    const Pose T_camera_world = T_world_camera.inverse();
    const TriangleMesh& mesh = painted.veils().mesh;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      std::array<Eigen::Vector3d, 3> p;  // from the eye
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d vertex(mesh.vertices[mesh.triangles[i][k]].data());
        const Eigen::Vector3d q = T_camera_world * vertex;
        p[k] = vertex - T_world_camera.translation();
        if (q.z() > 0) {
          triangle.box.extend(Eigen::Vector2d(camera.fx * q.x() / q.z() + camera.cx,
                                              camera.fy * q.y() / q.z() + camera.cy));
          continue;
        }
        // Beside or behind the eye: anywhere.
        triangle.box.extend(Eigen::Vector2d::Constant(-1e9));
        triangle.box.extend(Eigen::Vector2d::Constant(1e9));
      }
      triangle.sides << p[1].cross(p[2]).transpose(), p[2].cross(p[0]).transpose(),
          p[0].cross(p[1]).transpose();
      triangle.volume = p[0].dot(p[1].cross(p[2]));
      triangle.nearest = p[0].norm() - std::max((p[1] - p[0]).norm(), (p[2] - p[0]).norm());
      triangle.paint = &painted.paint_of(painted.veils(), i);
      triangles_.push_back(triangle);
    }
    std::stable_sort(triangles_.begin(), triangles_.end(),
                     [](auto& a, auto& b) { return a.nearest < b.nearest; });
    // By how much a pixel (u, v, 1) is inside of the sides; the ribbons' boxes are mostly empty.
    const Eigen::Vector3d corner = camera.ray(0, 0);
    Eigen::Matrix3d ray;
    ray << camera.ray(1, 0) - corner, camera.ray(0, 1) - corner, corner;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      const auto& [sides, volume, nearest, paint, box] = triangles_[i];
      const Eigen::Matrix3d inside =
          (volume < 0 ? -1.0 : 1.0) * sides * T_world_camera.rotation() * ray;
      const Eigen::Array3d slack = 0.5 * kTile * inside.leftCols<2>().cwiseAbs().rowwise().sum();
      for (auto v = tile_of(box.min().y(), camera.height);
           v <= tile_of(box.max().y() + 0.5, camera.height); ++v) {
        for (auto u = tile_of(box.min().x(), camera.width);
             u <= tile_of(box.max().x() + 0.5, camera.width); ++u) {
          const Eigen::Vector3d center(kTile * (static_cast<double>(u) + 0.5) - 0.5,
                                       kTile * (static_cast<double>(v) + 0.5) - 0.5, 1);
          const Eigen::Array3d most = (inside * center).array() + slack;
          if ((most >= 0).all()) tiles_[v * columns_ + u].push_back(i);
        }
      }
    }
  }

  /// Draws those that a ray from the eye through the pixel (u, v) meets before `max_range` over
  /// `color`, near to far, as long as `visible` is not 0. `waiting` is room to work in.
  void draw(std::size_t u, std::size_t v, const Eigen::Vector3d& direction, double max_range,
            Eigen::Vector3d& color, double& visible, std::vector<Layer>& waiting) const {
    waiting.clear();  // far to near
    const auto draw_until = [&](double range) {
      for (; !waiting.empty() && waiting.back().range <= range && visible > 0; waiting.pop_back()) {
        const Paint& paint = *waiting.back().paint;
        const double opacity = visible < kHidden ? 1 : paint.opacity;
        color += visible * opacity * paint.color;
        visible *= 1 - opacity;
      }
    };
    // A little aside, lest it lies exactly in an edge and meets both triangles that share it.
    const Eigen::Vector3d ray = direction + Eigen::Vector3d(3e-10, 5e-10, 7e-10);
    for (const std::uint32_t i : tiles_[v / kTile * columns_ + u / kTile]) {
      const Triangle& triangle = triangles_[i];
      if (!(triangle.nearest < max_range)) break;
      const Eigen::Array3d inside = triangle.sides * ray;
      if (!((inside >= 0).all() || (inside <= 0).all())) continue;
      const double range = triangle.volume / inside.sum();
      if (!(range > 0 && range < max_range)) continue;
      draw_until(triangle.nearest);
      if (visible == 0) return;
      const auto is_behind = [&](const Layer& layer) { return layer.range > range; };
      waiting.insert(std::partition_point(waiting.begin(), waiting.end(), is_behind),
                     {range, triangle.paint});
    }
    draw_until(max_range);
  }

 private:
  static constexpr std::size_t kTile = 2;  // [px]
  static constexpr double kHidden = 0.05;  // less visible than this is not looked at any more

  struct Triangle {
    Eigen::Matrix3d sides;  // rows: normals of the planes through the eye and an edge
    double volume;          // of the vertices seen from the eye, as a triple product
    double nearest;         // no point of it is nearer to the eye [m]
    const Paint* paint;
    Eigen::AlignedBox2d box;  // [px]
  };

  static std::size_t tile_of(double pixel, int count) {
    return static_cast<std::size_t>(std::clamp(pixel, 0.0, count - 1.0)) / kTile;
  }

  std::size_t columns_;
  std::vector<std::vector<std::uint32_t>> tiles_;
  std::vector<Triangle> triangles_;  // by `nearest`
};

}  // namespace viewgain::app
