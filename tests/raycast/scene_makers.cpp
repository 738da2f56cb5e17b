// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "scene_makers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "grid/voxels.hpp"
#include "viewgain/core/covariance.hpp"

namespace viewgain::test {
namespace {

constexpr float kHitLogOdds = 0.85F;
constexpr float kMissLogOdds = -0.4F;

GridConfig layout(double voxel_size, Index3 min, Index3 dims, const Pose& T_world_grid = {}) {
  const auto face = [&](std::int32_t i) { return i * voxel_size; };
  return {.voxel_size = voxel_size,
          .workspace = {{face(min.x), face(min.y), face(min.z)},
                        {face(min.x + dims.x), face(min.y + dims.y), face(min.z + dims.z)}},
          .T_world_grid = T_world_grid,
          .prior_sigma = 0.6 * voxel_size};
}

std::uint8_t code(VoxelState state) { return static_cast<std::uint8_t>(state); }

std::uint8_t salt_and_pepper(double share, Random& random) {
  if (uniform(random, 0, 1) >= share) return code(VoxelState::free);
  return uniform(random, 0, 1) < 0.5 ? code(VoxelState::unknown) : code(VoxelState::occupied);
}

/// Evidence at nine of ten occupied voxels; imported maps have none.
void add_beliefs(BeliefGrid& grid, Random& random) {
  for_each_voxel(grid, [&](Index3 voxel) {
    if (grid.state(voxel) == VoxelState::occupied && uniform(random, 0, 1) < 0.9) {
      set_occupied_with_belief(grid, voxel, random);
    }
  });
}

BeliefGrid salted(const GridConfig& config, Index3 dims, double share, Random& random) {
  std::vector<std::uint8_t> states(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (std::uint8_t& state : states) state = salt_and_pepper(share, random);
  BeliefGrid grid = BeliefGrid::from_states(config, states);
  add_beliefs(grid, random);
  return grid;
}

/// Leaves that are all unknown, all free, or mixed, in equal parts.
BeliefGrid with_tiles_8(Random& random) {
  const Index3 min{8 * uniform_int(random, -3, 1), 8 * uniform_int(random, -3, 1),
                   8 * uniform_int(random, -3, 1)};
  const Index3 dims{32, 32, 32};
  BeliefGrid grid(layout(uniform(random, 0.01, 0.05), min, dims));
  const auto fill = [&](Index3 leaf) {
    const int kind = uniform_int(random, 0, 2);
    if (kind == 0) return;
    const double share = kind == 1 ? 0 : 0.1;
    for_each_voxel(VoxelBox::from_dims(leaf, {8, 8, 8}), [&](Index3 voxel) {
      const std::uint8_t state = salt_and_pepper(share, random);
      if (state == code(VoxelState::unknown)) return;
      grid.set(voxel, state == code(VoxelState::free) ? kMissLogOdds : kHitLogOdds);
    });
  };
  for_each_voxel(grid, fill, 8);
  add_beliefs(grid, random);
  return grid;
}

/// A carved room at a corner where blocks of 128³ meet: of the eight blocks round the corner one is
/// mixed and the others stay tiles as far as the workspace reaches.
RandomMap with_tiles_128(Random& random) {
  const Index3 dims{136 + uniform_int(random, 0, 20), 128 + uniform_int(random, 0, 12),
                    128 + uniform_int(random, 0, 12)};
  BeliefGrid grid(layout(uniform(random, 0.01, 0.05), {-8, 0, 0}, dims));
  const Index3 room_min{-8, uniform_int(random, 8, 100), uniform_int(random, 8, 100)};
  for_each_voxel(VoxelBox::from_dims(room_min, {8, 18, 18}), [&](Index3 voxel) {
    const bool occupied = uniform(random, 0, 1) < 0.002;
    if (occupied) {
      set_occupied_with_belief(grid, voxel, random);
    } else {
      grid.set(voxel, kMissLogOdds);
    }
  });
  const double v = grid.voxel_size();
  const Box room{{room_min.x * v, room_min.y * v, room_min.z * v},
                 {(room_min.x + 8) * v, (room_min.y + 18) * v, (room_min.z + 18) * v}};
  return {std::move(grid), room};
}

Index3 odd_dims(Random& random) {
  const auto odd = [&] { return 2 * uniform_int(random, 6, 16) + 1; };
  return {odd(), odd(), odd()};
}

BeliefGrid odd_and_far(const Pose& T_world_grid, Random& random) {
  const auto offset = [&] { return uniform_int(random, -500'000, 500'000); };
  const Index3 min{offset(), offset(), offset()};
  const Index3 dims = odd_dims(random);
  return salted(layout(uniform(random, 0.01, 0.05), min, dims, T_world_grid), dims,
                uniform(random, 0.002, 0.3), random);
}

/// Salt and pepper with room in between, part of it in cells of up to 8 voxels an edge.
BeliefGrid with_mixed_scales(Random& random) {
  const Index3 dims = odd_dims(random);
  const Index3 min{uniform_int(random, -40, 0), uniform_int(random, -40, 0),
                   uniform_int(random, -40, 0)};
  BeliefGrid grid = salted(layout(uniform(random, 0.01, 0.05), min, dims), dims,
                           uniform(random, 0.001, 0.02), random);
  const Box all = grid.workspace();
  for (int i = 0; i < 6; ++i) {
    Box part = all;
    for (std::size_t a = 0; a < 3; ++a) {
      part.min[a] = uniform(random, all.min[a], all.max[a]);
      part.max[a] = part.min[a] + uniform(random, 0, all.max[a] - part.min[a]);
    }
    grid.resample(part, uniform_int(random, 0, 3));
  }
  return grid;
}

Eigen::Vector3d random_point(const Box& box, double margin, Random& random) {
  Eigen::Vector3d p;
  for (std::size_t k = 0; k < 3; ++k) {
    const double extent = box.max[k] - box.min[k];
    p[static_cast<Eigen::Index>(k)] =
        uniform(random, box.min[k] - margin * extent, box.max[k] + margin * extent);
  }
  return p;
}

}  // namespace

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

int uniform_int(Random& random, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(random);
}

Pose random_rigid(Random& random, double reach) {
  std::normal_distribution<double> normal;
  const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
  const auto shift = [&] { return uniform(random, -reach, reach); };
  return {q.normalized().toRotationMatrix(), Eigen::Vector3d(shift(), shift(), shift())};
}

void set_occupied_with_belief(BeliefGrid& grid, Index3 voxel, Random& random) {
  const double v = grid.voxel_size();
  SymmetricMatrix3 information;
  const int hits = uniform_int(random, 1, 5);
  for (int i = 0; i < hits; ++i) {
    const Eigen::Vector3d d = random_rigid(random, 0).rotation().col(0);
    information += measurement_information(
        d, {uniform(random, 0.3 * v, 2 * v), uniform(random, 0.1 * v, 1.5 * v)});
  }
  Belief belief;
  belief.information = {static_cast<float>(information.xx), static_cast<float>(information.yy),
                        static_cast<float>(information.zz), static_cast<float>(information.xy),
                        static_cast<float>(information.xz), static_cast<float>(information.yz)};
  belief.hits = static_cast<std::uint32_t>(hits);
  grid.set(voxel, kHitLogOdds, belief);
}

RandomMap random_map(MapFamily family, Random& random) {
  const auto whole = [](BeliefGrid grid) {
    const Box box = grid.workspace();
    return RandomMap{std::move(grid), box};
  };
  const auto salt = [&](double share) {
    const auto side = [&] { return 8 * uniform_int(random, 3, 5); };
    const auto corner = [&] { return 8 * uniform_int(random, -4, 0); };
    const Index3 dims{side(), side(), side()};
    const Index3 min{corner(), corner(), corner()};
    return whole(salted(layout(uniform(random, 0.01, 0.05), min, dims), dims, share, random));
  };
  switch (family) {
    case MapFamily::salt_and_pepper_01:
      return salt(0.001);
    case MapFamily::salt_and_pepper_1:
      return salt(0.01);
    case MapFamily::salt_and_pepper_30:
      return salt(0.3);
    case MapFamily::tiles_8:
      return whole(with_tiles_8(random));
    case MapFamily::tiles_128:
      return with_tiles_128(random);
    case MapFamily::odd_and_far:
      return whole(odd_and_far({}, random));
    case MapFamily::mixed_scales:
      return whole(with_mixed_scales(random));
    case MapFamily::rotated:
      break;
  }
  const Pose T_world_grid = random_rigid(random, 3);
  return whole(odd_and_far(T_world_grid, random));
}

Sensor random_sensor(const BeliefGrid& grid, Random& random) {
  const double v = grid.voxel_size();
  const Index3 dims = grid.dims();
  const double extent = v * std::max({dims.x, dims.y, dims.z});
  Sensor sensor;
  sensor.name = "random";
  sensor.camera = {.width = 25, .height = 19, .cx = 11.8, .cy = 9.3};
  sensor.camera.fx = uniform(random, 15, 40);
  sensor.camera.fy = sensor.camera.fx * uniform(random, 0.9, 1.1);
  if (uniform(random, 0, 1) < 0.3) sensor.camera.distortion = {-0.05, 0.01, 1e-3, -1e-3, 0};
  sensor.min_range = uniform(random, 0.2, 6) * v;
  sensor.max_range = sensor.min_range + uniform(random, 0.3, 3) * extent;
  sensor.working_distance = 0.5 * (sensor.min_range + sensor.max_range);
  if (uniform(random, 0, 1) < 0.5) {
    sensor.noise = ShotNoise{.reference_sigma = 0.5 * v, .reference_range = extent};
  } else {
    sensor.noise = ConstantNoise{.sigma_axial = v, .sigma_lateral = 0.3 * v};
  }
  return sensor;
}

std::vector<Pose> random_poses(const RandomMap& map, std::size_t count, Random& random) {
  const Pose& T = map.grid.T_world_grid();
  const Box workspace = map.grid.workspace();
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const bool inside = i % 2 == 0;
    const Eigen::Vector3d eye =
        T * (inside ? random_point(map.room, 0, random) : random_point(workspace, 0.8, random));
    const Eigen::Vector3d target = T * random_point(workspace, 0, random);
    poses.push_back(look_at(eye, target, random_rigid(random, 0).rotation().col(0)));
  }
  return poses;
}

RandomCase random_case(std::uint64_t seed, MapFamily family, std::size_t poses) {
  Random random(seed);
  RandomMap map = random_map(family, random);
  const Sensor sensor = random_sensor(map.grid, random);
  std::vector<Pose> views = random_poses(map, poses, random);
  return {std::move(map), sensor, std::move(views)};
}

Sensor lattice_sensor(int width, int height) {
  Sensor sensor;
  sensor.name = "lattice";
  sensor.camera = {.width = width, .height = height, .fx = 1, .fy = 1};
  sensor.camera.cx = 0.5 * (width - 1);
  sensor.camera.cy = 0.5 * (height - 1);
  sensor.min_range = 0;
  sensor.max_range = 1000;
  sensor.working_distance = 1;
  sensor.noise = ConstantNoise{};
  return sensor;
}

BeliefGrid sparse_map(Index3 dims, const std::vector<Index3>& non_free, VoxelState state) {
  std::vector<std::uint8_t> states(static_cast<std::size_t>(dims.x * dims.y * dims.z),
                                   code(VoxelState::free));
  for (const Index3 voxel : non_free) {
    states[static_cast<std::size_t>((voxel.x * dims.y + voxel.y) * dims.z + voxel.z)] = code(state);
  }
  return BeliefGrid::from_states(layout(kExactVoxel, {0, 0, 0}, dims), states);
}

Pose axis_pose(const Eigen::Vector3d& origin, int axis, bool positive) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Zero();
  const double sign = positive ? 1.0 : -1.0;
  // Columns are the camera's x, y and z: z along the axis, x along the next one, y = z cross x.
  R(axis, 2) = sign;
  R((axis + 1) % 3, 0) = 1.0;
  R.col(1) = R.col(2).cross(R.col(0));
  return {R, origin * kExactVoxel};
}

std::string family_name(const testing::TestParamInfo<MapFamily>& info) {
  constexpr std::array<const char*, 8> kNames{
      "SaltAndPepper01", "SaltAndPepper1", "SaltAndPepper30", "Tiles8",
      "Tiles128",        "OddAndFar",      "Rotated",         "MixedScales"};
  return kNames.at(static_cast<std::size_t>(info.param));
}

bool same_bits(const ViewGain& a, const ViewGain& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return bits(a.gain) == bits(b.gain) && bits(a.exploration) == bits(b.exploration) &&
         bits(a.refinement) == bits(b.refinement) &&
         bits(a.posterior_entropy) == bits(b.posterior_entropy) && bits(a.area) == bits(b.area) &&
         bits(a.refinement_saturated) == bits(b.refinement_saturated) && a.rays == b.rays &&
         a.hits == b.hits && a.unknown_voxels == b.unknown_voxels &&
         a.occupied_voxels == b.occupied_voxels && a.status == b.status;
}

bool same_bits(const std::vector<ViewGain>& a, const std::vector<ViewGain>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const ViewGain& x, const ViewGain& y) { return same_bits(x, y); });
}

std::size_t gaining(const std::vector<ViewGain>& views) {
  return static_cast<std::size_t>(
      std::count_if(views.begin(), views.end(), [](const ViewGain& v) { return v.gain > 0; }));
}

Obstacles random_boxes(const BeliefGrid& grid, Random& random) {
  Obstacles obstacles;
  const Box all = grid.workspace();
  for (int i = 0; i < 3; ++i) {
    Eigen::Vector3d p;
    for (std::size_t a = 0; a < 3; ++a) {
      p[static_cast<Eigen::Index>(a)] = uniform(random, all.min[a], all.max[a]);
    }
    p = grid.T_world_grid() * p;
    const double half = 0.05 * (all.max[0] - all.min[0]);
    obstacles.boxes.push_back(
        {{p.x() - half, p.y() - half, p.z() - half}, {p.x() + half, p.y() + half, p.z() + half}});
  }
  return obstacles;
}

void expect_same_hits(const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].kind, b[i].kind);
    ASSERT_EQ(a[i].voxel, b[i].voxel);
    ASSERT_EQ(a[i].range, b[i].range);
  }
}

}  // namespace viewgain::test
