// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "show/report/run_page.hpp"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "show/report/page.hpp"
#include "show/report/view_parts.hpp"

namespace viewgain::app {
namespace {

using Eigen::Vector3d;
// So that a run of 40 views stays under 25 MB.
constexpr std::size_t kMaxVertices = 20'000, kMaxTruthVertices = 100'000, kMaxPoints = 1'500,
                      kMaxExpected = 4'000, kMaxExact = 10;

ShownMesh shown_surface(const SurfaceModel& model, const Truth* truth) {
  const SurfaceMesh& surface = model.surface();
  ShownMesh mesh;
  for (const auto& p : surface.vertices) mesh.add_vertex(p);
  mesh.sigma = surface_sigmas(surface, model.points());
  mesh.triangles = surface.triangles;
  if (truth != nullptr) mesh.error = truth->ground_truth().distances_of(surface.vertices);
  return thinned(std::move(mesh), kMaxVertices);
}

Json points_json(const std::vector<FusedPoint>& points) {
  std::vector<Vector3d> positions;
  std::vector<float> covariances;
  const std::size_t count = std::min(points.size(), kMaxPoints);
  for (std::size_t i = 0; i < count; ++i) {
    const FusedPoint& point = points[i * points.size() / count];
    positions.emplace_back(point.position.data());
    const SymmetricMatrix3& c = point.covariance;
    for (const double entry : {c.xx, c.xy, c.xz, c.yy, c.yz, c.zz}) {
      covariances.push_back(static_cast<float>(entry));
    }
  }
  return {{"positions", point_block(positions)}, {"covariances", float_block(covariances, 6)}};
}

Json boundaries_json(const SurfaceMesh& surface, const std::vector<BoundaryRun>& runs) {
  std::vector<Vector3d> points;
  Json starts = Json::array(), classes = starts, closed = starts;
  for (const BoundaryRun& run : runs) {
    starts.push_back(points.size());
    classes.push_back(boundary_class_name(run.boundary_class));
    closed.push_back(run.closed);
    for (const std::uint32_t v : run.vertices) points.emplace_back(surface.vertices[v].data());
  }
  return {
      {"points", point_block(points)}, {"start", starts}, {"class", classes}, {"closed", closed}};
}

// Each patch as a lattice over the region that it was fitted to and as far past the boundary.
Json patches_json(const EstimatedViews& estimated, double length) {
  constexpr std::uint32_t kColumns = 7, kRows = 4;  // along u and v
  if (estimated.patches.empty()) return nullptr;
  ShownMesh mesh;
  for (const QuadraticPatch& patch : estimated.patches) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t j = 0; j < kRows; ++j) {
      for (std::uint32_t i = 0; i < kColumns; ++i) {
        const double u = patch.depth * (2.0 * i / (kColumns - 1) - 1);
        const double v = length * (1.0 * j / (kRows - 1) - 0.5);
        mesh.vertices.push_back(patch.point(u, v));
        if (i + 1 == kColumns || j + 1 == kRows) continue;
        const std::uint32_t corner = first + j * kColumns + i;
        mesh.triangles.push_back({corner, corner + 1, corner + kColumns});
        mesh.triangles.push_back({corner + 1, corner + kColumns + 1, corner + kColumns});
      }
    }
  }
  return to_json(mesh);
}

// Those of the best and of the chosen one by all rays, of the others estimates: to trace the rays
// of thousands of candidates would take longer than the view.
void add_gains(ShownCandidates& shown, const GainEvaluator& evaluator,
               const std::optional<std::size_t>& chosen) {
  if (shown.poses.empty()) return;
  std::vector<ApproximateGain> estimates(shown.poses.size());
  constexpr ApproximateConfig config{.share = 0.005};  // Spearman's ρ with all rays' 0.83 to 0.97
  evaluator.approximate(shown.poses, estimates, config);
  std::vector<ViewGain> ranked(estimates.size());
  for (std::size_t i = 0; i < ranked.size(); ++i) ranked[i].gain = estimates[i].gain;
  std::vector<std::size_t> exact = best_indices(ranked, kMaxExact);
  if (chosen && std::find(exact.begin(), exact.end(), *chosen) == exact.end()) {
    exact.push_back(*chosen);
  }
  std::vector<Pose> poses;
  for (const std::size_t i : exact) poses.push_back(shown.poses[i]);
  const std::vector<ViewGain> gains = evaluator.evaluate(poses);
  for (std::size_t k = 0; k < exact.size(); ++k) ranked[exact[k]] = gains[k];
  for (const ViewGain& gain : ranked) {
    shown.gains.push_back(gain.gain);
    shown.areas.push_back(gain.area);
  }
  shown.exact = std::move(exact);
}

Json candidates_json(const Proposal& proposal, const CandidateGeneration& generation,
                     const GainEvaluator& evaluator, const std::optional<std::size_t>& chosen) {
  ShownCandidates shown;
  const auto add = [&](const Candidate& candidate, const std::string& reason) {
    shown.poses.push_back(candidate.T_world_camera);
    shown.generators.push_back(candidate.generator);
    shown.classes.emplace_back(
        candidate.boundary_class ? boundary_class_name(*candidate.boundary_class) : "");
    shown.reasons.push_back(reason);
  };
  for (const Candidate& candidate : proposal.candidates) add(candidate, "");
  add_gains(shown, evaluator, chosen);
  if (!proposal.dropped.empty()) {
    for (const DroppedCandidate& dropped : generation.dropped()) {
      add(dropped.candidate, dropped.reason);
    }
  }
  return to_json(shown);
}

// What the robot and the camera allow; with it the page says by how much a candidate was refused.
Json limits_json(const FeasibilityConfig& config) {
  Json boxes = Json::array(), shells = Json::array(), half_spaces = Json::array();
  for (const Box& box : config.reach.boxes) boxes.push_back({box.min, box.max});
  for (const ReachRegion::Shell& shell : config.reach.shells) {
    const Vector3d& c = shell.center;
    shells.push_back({c.x(), c.y(), c.z(), shell.min_radius, shell.max_radius});
  }
  for (const ReachRegion::HalfSpace& half : config.reach.half_spaces) {
    const Vector3d& n = half.normal;
    half_spaces.push_back({n.x(), n.y(), n.z(), half.offset});
  }
  return {{"body", config.body.size},
          {"clearance", config.clearance},
          {"min_range", config.sensor ? Json(config.sensor->min_range) : Json()},
          {"near_share", config.max_near_share},
          {"boxes", boxes},
          {"shells", shells},
          {"half_spaces", half_spaces}};
}

// The unknown voxels from which most is expected of a view.
Json expected_json(const GridSnapshot& snapshot, std::vector<VoxelContribution> voxels,
                   const Json& unit) {
  std::erase_if(voxels, [](const VoxelContribution& v) {
    return v.state != VoxelState::unknown || !(v.gain > 0);
  });
  const std::size_t count = std::min(voxels.size(), kMaxExpected);
  std::partial_sort(voxels.begin(), voxels.begin() + static_cast<std::ptrdiff_t>(count),
                    voxels.end(), [](const VoxelContribution& a, const VoxelContribution& b) {
                      return std::tie(b.gain, a.voxel.x, a.voxel.y, a.voxel.z) <
                             std::tie(a.gain, b.voxel.x, b.voxel.y, b.voxel.z);
                    });
  voxels.resize(count);
  return contributions_json(snapshot, voxels, unit);
}

Json truth_json(const SurfaceScene& object) {
  ShownMesh truth;
  for (const auto& p : object.mesh().vertices) truth.add_vertex(p);
  truth.triangles = object.mesh().triangles;
  return to_json(thinned(std::move(truth), kMaxTruthVertices));
}

}  // namespace

RunPage::RunPage(std::string title, const Sensor& sensor, std::string criterion,
                 std::shared_ptr<const Truth> truth)
    : title_(std::move(title)),
      criterion_(std::move(criterion)),
      sensor_(sensor),
      truth_(std::move(truth)) {}

void RunPage::add_view(const ViewRecord& record, const SurfaceModel& model,
                       const CandidateGeneration& generation, const EstimatedViews& estimated,
                       const GainEvaluator& evaluator,
                       std::vector<VoxelContribution> contributions) {
  if (views_.empty()) {
    head_ = page_head("reconstruct", title_, evaluator, sensor_, criterion_);
    head_["limits"] = limits_json(generation.config().feasibility);
  }
  Json view{{"pose", pose_rows(record.T_world_camera)},
            {"surface", to_json(shown_surface(model, truth_.get()))},
            {"points", points_json(model.points())}};
  view["boundaries"] = boundaries_json(model.surface(), estimated.runs);
  view["patches"] = patches_json(estimated, generation.config().boundary.estimator.patch_length);
  view["candidates"] =
      candidates_json(record.proposal, generation, evaluator,
                      record.decision ? std::optional(record.decision->candidate) : std::nullopt);
  view["chosen"] = nullptr;
  view["bundle"] = nullptr;
  view["expected"] = nullptr;
  if (record.decision) {
    const Pose& next = record.proposal.candidates[record.decision->candidate].T_world_camera;
    view["chosen"] = record.decision->candidate;
    view["bundle"] = bundle_json(evaluator, sensor_, next);
    view["expected"] =
        expected_json(evaluator.scene().snapshot(), std::move(contributions), head_["gain_unit"]);
  }
  views_.push_back(std::move(view));
  indices_.push_back(record.index);
}

Json RunPage::json(const Json& run, const SurfaceScene* object, const Json& beside) const {
  Json page = head_;
  page["settings"] = run.at("settings");
  page["summary"] = run;
  page["summary"].erase("settings");
  page["summary"].erase("per_view");
  page["summary"].erase("next");
  page["truth"] = object == nullptr ? Json() : truth_json(*object);
  page["beside"] = beside;
  page["views"] = views_;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    page["views"][i]["figures"] = run.at("per_view").at(indices_[i]);
  }
  return page;
}

}  // namespace viewgain::app
