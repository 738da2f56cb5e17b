// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/pictures/view_picture.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "show/pictures/ray_tracer.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;

constexpr int kWidth = 640;  // of the picture [px]
constexpr std::size_t kMaxCandidates = 200, kMaxRays = 300;

// Widths and lengths as shares of the workspace's diagonal.
constexpr double kOutlineWidth = 0.0026, kBoundaryWidth = 0.006, kRayWidth = 0.0008;
constexpr double kCandidateWidth = 0.0030, kCandidateLength = 0.045;
constexpr double kViewWidth = 0.0045, kViewLength = 0.10;
constexpr double kChosenWidth = 0.006, kChosenLength = 0.14, kChosenEdgeWidth = 0.0030;

std::uint8_t add_line_paint(PaintedMesh& scene, const Vector3d& color) {
  return scene.add_paint({.color = color, .lit = false, .passes_light = true});
}

struct Paints {
  explicit Paints(PaintedMesh& scene)
      : surface(scene.add_paint({.color = {0.58, 0.58, 0.56}, .back_side = 0.55})),
        outline(add_line_paint(scene, {0.45, 0.48, 0.52})),
        view(add_line_paint(scene, {0.01, 0.01, 0.012})),
        chosen(add_line_paint(scene, {0.0, 0.19, 0.05})),
        other(add_line_paint(scene, {0.32, 0.33, 0.35})),
        unknown_ray(add_line_paint(scene, kUnknownColor)),
        occupied_ray(add_line_paint(scene, kOccupiedColor)) {
    const std::array<Vector3d, 4> colors{{{0.75, 0.01, 0.02},    // left: red
                                          {0.03, 0.50, 0.04},    // right: green
                                          {0.02, 0.10, 0.80},    // top: blue
                                          {0.90, 0.58, 0.00}}};  // bottom: yellow
    for (const BoundaryClass c :
         {BoundaryClass::left, BoundaryClass::right, BoundaryClass::top, BoundaryClass::bottom}) {
      const auto k = static_cast<std::size_t>(c);
      of_class[k] = add_line_paint(scene, colors[k]);
    }
  }

  [[nodiscard]] std::uint8_t candidate(std::optional<BoundaryClass> boundary_class) const {
    return boundary_class ? of_class[static_cast<std::size_t>(*boundary_class)] : other;
  }

  std::uint8_t surface, outline, view, chosen, other, unknown_ray, occupied_ray;
  std::array<std::uint8_t, 4> of_class{};
};

// The border vertices of a run as a line that lies a little above the surface. The vertices are as
// far apart as voxels and jump to and fro by about that; two passes of averaging show the course.
std::vector<Vector3d> raised_run(const SurfaceMesh& surface, const BoundaryRun& run,
                                 double height) {
  std::vector<Vector3d> points;
  for (const std::uint32_t v : run.vertices) {
    const auto& p = surface.vertices[v];
    const auto& n = surface.normals[v];
    points.emplace_back(p[0] + height * n[0], p[1] + height * n[1], p[2] + height * n[2]);
  }
  const std::size_t count = points.size();
  if (count < 3) return points;
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<Vector3d> before = points;
    for (std::size_t i = run.closed ? 0 : 1; i < count - (run.closed ? 0 : 1); ++i) {
      points[i] =
          0.5 * before[i] + 0.25 * (before[(i + count - 1) % count] + before[(i + 1) % count]);
    }
  }
  if (run.closed) points.push_back(points.front());
  return points;
}

void add_boundaries(PaintedMesh& scene, const Paints& paints, const SurfaceMesh& surface,
                    const std::vector<BoundaryRun>& runs, double width) {
  for (const BoundaryRun& run : runs) {
    const std::uint8_t paint = paints.of_class[static_cast<std::size_t>(run.boundary_class)];
    const std::vector<Vector3d> points = raised_run(surface, run, 0.5 * width);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vector3d step = points[i] - points[i - 1];
      if (!(step.norm() > 0)) continue;
      // Longer at both ends, so that no wedge is missing where the line bends.
      const Vector3d more = 0.4 * width * step.normalized();
      scene.add_line(points[i - 1] - more, points[i] + more, width, paint);
    }
  }
}

// At most kMaxCandidates of those that can be drawn, evenly over the list, without the chosen one.
std::vector<const Candidate*> shown_candidates(const ViewPicture& picture) {
  std::vector<const Candidate*> all;
  for (const Candidate& candidate : picture.candidates) {
    if (is_rigid(candidate.T_world_camera) && candidate.T_world_camera != picture.chosen) {
      all.push_back(&candidate);
    }
  }
  if (all.size() <= kMaxCandidates) return all;
  std::vector<const Candidate*> shown;
  for (std::size_t i = 0; i < kMaxCandidates; ++i) {
    shown.push_back(all[i * all.size() / kMaxCandidates]);
  }
  return shown;
}

void add_rays(PaintedMesh& scene, const Paints& paints, const VoxelPaints& voxels,
              const std::vector<RayHit>& rays, const Vector3d& eye, const GridSnapshot& snapshot,
              double width) {
  for (const RayHit& ray : rays) {
    const bool unknown = ray.kind == RayHit::Kind::unknown;
    scene.add_line(eye, snapshot.center(ray.voxel), width,
                   unknown ? paints.unknown_ray : paints.occupied_ray);
    voxels.add(scene, snapshot, ray.voxel, unknown);
  }
}

using Eigen::Vector3d;

double share_of(double sigma, const std::array<double, 2>& range) {
  return range[1] > range[0] ? (sigma - range[0]) / (range[1] - range[0]) : 0.5;
}

}  // namespace

RgbImage view_picture(const ViewPicture& picture, const ExecConfig& exec) {
  if (!is_rigid(picture.T_world_camera) || (picture.chosen && !is_rigid(*picture.chosen))) {
    refuse("the pose of a view to draw is not a rigid transform");
  }
  const GridSnapshot& snapshot = picture.evaluator.scene().snapshot();
  const auto workspace = workspace_corners(snapshot);
  const Vector3d center = 0.5 * (workspace[0] + workspace[7]);
  const double extent = (workspace[7] - workspace[0]).norm();

  PaintedMesh scene;
  const Paints paints(scene);
  scene.add_surface(picture.surface.vertices, picture.surface.normals, picture.surface.triangles,
                    paints.surface);
  add_boundaries(scene, paints, picture.surface, picture.estimated.runs, kBoundaryWidth * extent);
  add_box_outline(scene, workspace, kOutlineWidth * extent, paints.outline);

  // What the picture is about: the chosen view, or the one just taken.
  const Pose& subject = picture.chosen ? *picture.chosen : picture.T_world_camera;
  const Vector3d eye = subject.translation();
  const std::vector<RayHit> hits = picture.evaluator.trace(subject);
  const double depth = frustum_depth(hits, picture.sensor);
  const auto far_corners = image_corners(picture.sensor, subject, depth);

  std::vector<Vector3d> in_sight(workspace.begin(), workspace.end());
  const auto add_frustum = [&](const Pose& pose, double length, double width, std::uint8_t paint) {
    const auto base = image_corners(picture.sensor, pose, length * extent);
    add_pyramid(scene, pose.translation(), base, width * extent, paint);
    in_sight.push_back(pose.translation());
    in_sight.insert(in_sight.end(), base.begin(), base.end());
  };
  add_frustum(picture.T_world_camera, kViewLength, kViewWidth, paints.view);
  if (picture.chosen) {
    add_frustum(subject, kChosenLength, kChosenWidth, paints.chosen);
    in_sight.insert(in_sight.end(), far_corners.begin(), far_corners.end());
  }

  // From the side that the view just taken looked from: that is where there is surface to see.
  const Vector3d target = subject * Vector3d(0, 0, depth);
  const Vector3d taken = picture.T_world_camera.translation() - center;
  const Side side = viewer_azimuth(eye, target, Side::counter_clockwise).dot(taken) >=
                            viewer_azimuth(eye, target, Side::clockwise).dot(taken)
                        ? Side::counter_clockwise
                        : Side::clockwise;
  PinholeCamera camera = picture_camera(kWidth);
  const Pose T_world_viewer = place_viewer(in_sight, viewer_beside(eye, target, side), camera);
  const Vector3d viewer_eye = T_world_viewer.translation();

  const double nearest = 0.5 * (viewer_eye - center).norm();
  for (const Candidate* candidate : shown_candidates(picture)) {
    const Pose& pose = candidate->T_world_camera;
    // One just in front of the viewer would hide everything else.
    if ((pose.translation() - viewer_eye).norm() < nearest) continue;
    add_pyramid(scene, pose.translation(),
                image_corners(picture.sensor, pose, kCandidateLength * extent),
                kCandidateWidth * extent, paints.candidate(candidate->boundary_class));
  }
  if (picture.chosen) {
    add_pyramid(scene, eye, far_corners, kChosenEdgeWidth * extent, paints.chosen);
    const VoxelPaints voxels(scene);
    add_rays(scene, paints, voxels, even_hits(hits, picture.sensor.camera, kMaxRays), eye, snapshot,
             kRayWidth * extent);
    // By the paper's gain they are where the rays end.
    if (picture.evaluator.model() != GainModel::paper) {
      for (const VoxelContribution& voxel : picture.contributions != nullptr
                                                ? *picture.contributions
                                                : picture.evaluator.contributions(subject)) {
        if (voxel.state == VoxelState::unknown) voxels.add(scene, snapshot, voxel);
      }
    }
  }
  return render(scene, camera, T_world_viewer, 0.12 * extent, exec);
}

void write_amplitude_picture(const std::filesystem::path& path, const DepthFrame& frame) {
  const auto columns = static_cast<std::size_t>(std::max(frame.width, 0));
  const auto rows = static_cast<std::size_t>(std::max(frame.height, 0));
  if (frame.amplitude.empty() || frame.amplitude.size() != columns * rows) {
    refuse(path.string() + ": the frame has " + std::to_string(frame.amplitude.size()) +
           " amplitudes, but " + std::to_string(columns) + "x" + std::to_string(rows) + " pixels");
  }
  std::vector<float> sorted;
  for (const float a : frame.amplitude) {
    if (a > 0 && std::isfinite(a)) sorted.push_back(a);
  }
  float white = 1;
  if (!sorted.empty()) {
    const auto rank = static_cast<std::ptrdiff_t>((sorted.size() - 1) * 99 / 100);
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    white = sorted[static_cast<std::size_t>(rank)];
  }

  constexpr std::size_t kMinWidth = 480;
  const std::size_t scale = (kMinWidth + columns - 1) / columns;
  Gray8Image image{static_cast<int>(scale * columns), static_cast<int>(scale * rows), {}};
  image.pixels.reserve(scale * columns * scale * rows);
  for (std::size_t v = 0; v < scale * rows; ++v) {
    for (std::size_t u = 0; u < scale * columns; ++u) {
      const float amplitude = frame.amplitude[v / scale * columns + u / scale];
      const double share =
          amplitude > 0 ? std::min(1.0, static_cast<double>(amplitude) / white) : 0;
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::sqrt(share))));
    }
  }
  write_png(path, image);
}

RgbImage draw(const SurfacePicture& picture, const Viewer& viewer, const ExecConfig& exec) {
  PaintedMesh scene;
  const HeatPaints paints(scene);
  const SurfaceMesh& surface = picture.surface;
  if (surface.triangles.empty()) refuse("the map has no surface to draw yet");
  if (picture.sigmas.empty()) {
    scene.add_surface(surface.vertices, surface.normals, surface.triangles,
                      scene.add_paint({.color = {0.58, 0.58, 0.56}, .back_side = 0.55}));
  } else {
    std::vector<std::uint8_t> paint_of_triangle;
    for (const auto& t : surface.triangles) {
      const double sigma = (picture.sigmas[t[0]] + picture.sigmas[t[1]] + picture.sigmas[t[2]]) / 3;
      paint_of_triangle.push_back(paints.at(share_of(sigma, picture.sigma_range)));
    }
    scene.add_surface(surface.vertices, surface.normals, surface.triangles, paint_of_triangle);
  }
  PinholeCamera camera = picture_camera(viewer.width);
  std::vector<Vector3d> in_sight;
  Eigen::AlignedBox3d box;
  for (const auto& p : surface.vertices) {
    in_sight.emplace_back(p.data());
    box.extend(in_sight.back());
  }
  const Pose T_world_viewer = place_viewer(in_sight, viewer.direction(), camera);
  return render(scene, camera, T_world_viewer, 0.25 * box.diagonal().norm(), exec);
}

std::array<double, 2> usual_range(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {at(0.02), at(0.98)};
}

}  // namespace viewgain::app
