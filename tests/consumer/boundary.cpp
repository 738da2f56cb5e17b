// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// What crosses the border of the shared libraries other than by plain calls: exceptions both ways,
// a client's own parts in the library's loop, Eigen's transforms in a vector, OpenVDB's state
// behind it.
#include <cstdio>
#include <stdexcept>
#include <vector>
#include <viewgain/mesh/mesh_io.hpp>
#include <viewgain/mesh/surface.hpp>
#include <viewgain/viewgain.hpp>

namespace {

/// Refuses to move.
class Stuck : public viewgain::DataAcquisition {
 public:
  viewgain::Measurements acquire(const viewgain::Pose&, std::size_t) override {
    throw std::domain_error("stuck");
  }
};
class NoUpdate : public viewgain::RepresentationUpdate {
 public:
  viewgain::ModelProgress update(const viewgain::Measurements&) override { return {}; }
};
class NoProposal : public viewgain::ViewpointGeneration {
 public:
  viewgain::Proposal generate(const viewgain::Pose&) override { return {}; }
};
class NoDecision : public viewgain::DecisionMaking {
 public:
  std::optional<Decision> decide(const viewgain::Pose&,
                                 std::span<const viewgain::Candidate>) override {
    return {};
  }
};

/// Whether `call` throws an exception of this type, caught as such and not as a base.
template <typename Exception, typename Call>
bool throws(Call&& call) {
  try {
    call();
  } catch (const Exception&) {
    return true;
  } catch (...) {
  }
  return false;
}

}  // namespace

int main(int, char** argv) {
  const bool core = throws<viewgain::Error>([] { (void)viewgain::sensor_preset("no such one"); });
  const bool grid = throws<viewgain::Error>([] { (void)viewgain::load_vdb("/no such file"); });
  const bool mesh = throws<viewgain::Error>([] { (void)viewgain::read_mesh("/no such file"); });
  const bool surface =
      throws<viewgain::Error>([] { (void)viewgain::reconstruct_surface({}, {.spacing = -1.0}); });
  const bool back = throws<std::domain_error>([] {
    Stuck stuck;
    NoUpdate update;
    NoProposal proposal;
    NoDecision decision;
    (void)viewgain::active_view_planning({}, stuck, update, proposal, decision);
  });

  std::vector<Eigen::Isometry3d> transforms(3, Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < 3; ++i) transforms[i].translation().x() = static_cast<double>(i);
  const std::vector<viewgain::Pose> poses(transforms.begin(), transforms.end());
  const bool taken =
      viewgain::is_among(poses[2], poses, {}) && viewgain::orthonormality_error(poses[1]) == 0.0;
  const viewgain::PinholeCamera camera{10, 10, 5.0, 5.0, 4.5, 4.5};
  const bool projected = camera.project({0.5, 0.25, 1.0}) == Eigen::Vector2d(7.0, 5.75);

  const viewgain::BeliefGrid map(
      {.voxel_size = 0.1, .workspace = {{0, 0, 0}, {1, 1, 1}}, .prior_sigma = 0.05});
  viewgain::save_vdb(map, argv[1]);
  const bool saved = viewgain::load_vdb(argv[1]).content_hash() == map.content_hash();

  std::printf("%d%d%d%d%d%d%d%d\n", core, grid, mesh, surface, back, taken, projected, saved);
}
