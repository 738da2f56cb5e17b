// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/report/view_parts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "show/pictures/picture_parts.hpp"
#include "show/report/page.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;
constexpr std::size_t kMaxRays = 1500;

// Each text as its place in `names`, which has every text once; -1 for an empty one.
Json numbered(const std::vector<std::string>& texts, Json& names) {
  std::vector<std::string> found;
  Json numbers = Json::array();
  for (const std::string& text : texts) {
    if (text.empty()) {
      numbers.push_back(-1);
      continue;
    }
    const auto at = std::find(found.begin(), found.end(), text);
    numbers.push_back(at - found.begin());
    if (at == found.end()) found.push_back(text);
  }
  names = found;
  return numbers;
}

Json column_of(const std::vector<double>& values, std::size_t rows) {
  std::vector<float> column(rows, std::numeric_limits<float>::quiet_NaN());
  std::copy_n(values.begin(), std::min(rows, values.size()), column.begin());
  return float_block(column, 1);
}

using Eigen::Vector3d;

// The cell of each vertex, numbered in the order in which they come.
std::vector<std::uint32_t> cells_of(const std::vector<Vector3d>& vertices, double side,
                                    std::size_t& count) {
  std::map<std::array<std::int64_t, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> cells;
  cells.reserve(vertices.size());
  for (const Vector3d& p : vertices) {
    const std::array<std::int64_t, 3> at{std::llround(p.x() / side), std::llround(p.y() / side),
                                         std::llround(p.z() / side)};
    cells.push_back(
        numbers.try_emplace(at, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  count = numbers.size();
  return cells;
}

ShownMesh merged(const ShownMesh& mesh, const std::vector<std::uint32_t>& cells,
                 std::size_t count) {
  ShownMesh result;
  result.vertices.assign(count, Vector3d::Zero());
  result.sigma.assign(mesh.sigma.empty() ? 0 : count, 0.0);
  result.error.assign(mesh.error.empty() ? 0 : count, 0.0);
  std::vector<double> members(count, 0.0);
  for (const std::uint32_t cell : cells) ++members[cell];
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double share = 1 / members[cells[i]];
    result.vertices[cells[i]] += share * mesh.vertices[i];
    if (!mesh.sigma.empty()) result.sigma[cells[i]] += share * mesh.sigma[i];
    if (!mesh.error.empty()) result.error[cells[i]] += share * mesh.error[i];
  }
  for (const auto& t : mesh.triangles) {
    const std::array<std::uint32_t, 3> moved{cells[t[0]], cells[t[1]], cells[t[2]]};
    if (moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0]) continue;
    result.triangles.push_back(moved);
  }
  return result;
}

}  // namespace

Json page_head(const std::string& kind, const std::string& title, const GainEvaluator& evaluator,
               const Sensor& sensor, std::string_view criterion) {
  const GridSnapshot& snapshot = evaluator.scene().snapshot();
  const auto bound = [&](std::int32_t index) { return snapshot.voxel_size * index; };
  const Index3 low = snapshot.min_index, size = snapshot.dims;
  Json frustum = Json::array();
  for (const Vector3d& p : image_corners(sensor, Pose(), 1)) frustum.push_back({p.x(), p.y()});
  return {{"format", 1},
          {"kind", kind},
          {"title", title},
          {"version", VIEWGAIN_VERSION},
          {"gain_model", gain_model_name(evaluator.model())},
          {"gain_unit", gain_unit(evaluator.model(), parse_criterion(criterion))},
          {"entropy_unit", gain_unit(GainModel::paper, parse_criterion(criterion))},
          {"workspace",
           {bound(low.x), bound(low.y), bound(low.z), bound(low.x + size.x), bound(low.y + size.y),
            bound(low.z + size.z)}},
          {"T_world_grid", pose_rows(snapshot.T_world_grid)},
          {"frustum", frustum}};
}

Json pose_rows(const Pose& T_world_camera) { return T_world_camera.m; }

Json to_json(const ShownCandidates& candidates) {
  const std::size_t count = candidates.poses.size();
  std::vector<float> poses;
  poses.reserve(12 * count);
  for (const Pose& pose : candidates.poses) {
    for (const double number : pose.m) poses.push_back(static_cast<float>(number));
  }
  Json json{{"poses", float_block(poses, 12)},
            {"gain", column_of(candidates.gains, count)},
            {"area", column_of(candidates.areas, count)}};
  json["exact"] = candidates.exact;
  Json names;
  json["class"] = numbered(candidates.classes, names);
  json["classes"] = names;
  json["generator"] = numbered(candidates.generators, names);
  json["generators"] = names;
  json["reason"] = numbered(candidates.reasons, names);
  json["reasons"] = names;
  return json;
}

Json bundle_json(const GainEvaluator& evaluator, const Sensor& sensor, const Pose& T_world_camera) {
  std::vector<Vector3d> ends;
  std::vector<std::uint8_t> kinds;
  const GridSnapshot& snapshot = evaluator.scene().snapshot();
  const std::vector<RayHit> hits = evaluator.trace(T_world_camera);
  for (const RayHit& hit : even_hits(hits, sensor.camera, kMaxRays)) {
    ends.push_back(snapshot.center(hit.voxel));
    kinds.push_back(hit.kind == RayHit::Kind::unknown ? 1 : 2);
  }
  return {{"ends", point_block(ends)}, {"kind", byte_block(kinds)}};
}

Json contributions_json(const GridSnapshot& snapshot, const std::vector<VoxelContribution>& voxels,
                        const Json& unit) {
  std::vector<Vector3d> centers;
  std::vector<float> values;
  for (const VoxelContribution& voxel : voxels) {
    centers.push_back(snapshot.center(voxel.voxel));
    values.push_back(static_cast<float>(voxel.gain));
  }
  return {{"centers", point_block(centers)},
          {"value", float_block(values, 1)},
          {"unit", unit},
          {"size", snapshot.voxel_size}};
}

ShownMesh thinned(ShownMesh mesh, std::size_t most) {
  if (mesh.vertices.size() <= most) return mesh;
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : mesh.vertices) box.extend(p);
  // Vertices of a surface are about as many as the squares of its box's diagonal.
  double side = box.diagonal().norm() / std::sqrt(static_cast<double>(most));
  std::size_t count = 0;
  std::vector<std::uint32_t> cells = cells_of(mesh.vertices, side, count);
  while (count > most) cells = cells_of(mesh.vertices, side *= 1.15, count);
  return merged(mesh, cells, count);
}

Json to_json(const ShownMesh& mesh) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  Json json{{"vertices", point_block(mesh.vertices)}, {"triangles", index_block(indices, 3)}};
  if (!mesh.sigma.empty()) json["sigma"] = shade_block(mesh.sigma);
  if (!mesh.error.empty()) json["error"] = shade_block(mesh.error);
  return json;
}

}  // namespace viewgain::app
