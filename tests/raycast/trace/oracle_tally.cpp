// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "oracle_tally.hpp"

#include <algorithm>
#include <sstream>

namespace viewgain::test {
namespace {

std::string describe(const oracle::Ray& ray, const RayHit& expected, const RayHit& actual) {
  std::ostringstream out;
  const auto put = [&](const RayHit& hit) {
    out << "kind " << static_cast<int>(hit.kind) << " voxel " << hit.voxel.x << ' ' << hit.voxel.y
        << ' ' << hit.voxel.z << " range " << hit.range;
  };
  out.precision(17);
  out << "ray from " << ray.origin.transpose() << " along " << ray.direction.transpose()
      << ": expected ";
  put(expected);
  out << ", got ";
  put(actual);
  return out.str();
}

}  // namespace

std::size_t OracleTally::add(const oracle::DenseMap& map, const Sensor& sensor,
                             const Pose& T_world_camera, const std::vector<RayHit>& expected,
                             const std::vector<RayHit>& actual, double tolerance) {
  const std::vector<oracle::Ray> view =
      oracle::view_rays(map.T_world_grid, map.voxel_size, sensor.camera, 1, T_world_camera);
  const oracle::RayLimits limits = oracle::limits_of(map, sensor, {});
  EXPECT_EQ(actual.size(), view.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < std::min(actual.size(), view.size()); ++i) {
    ++rays;
    if (oracle::same_ending(expected[i], actual[i])) {
      ++same;
    } else {
      ++different;
      if (oracle::is_tie(map, view[i], limits, actual[i], tolerance)) {
        ++ties;
      } else if (first_wrong.empty()) {
        first_wrong = describe(view[i], expected[i], actual[i]);
      }
    }
    if (actual[i].kind == RayHit::Kind::none) continue;
    ++hits;
    if (oracle::range_is_entry(map, view[i], limits, actual[i], tolerance)) ++entries;
  }
  return different;
}

testing::AssertionResult OracleTally::agrees(std::size_t least_hits, double share_of_ties) const {
  if (same + ties == rays && entries == hits && hits >= least_hits &&
      static_cast<double>(ties) <= share_of_ties * static_cast<double>(rays)) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure()
         << rays << " rays, " << same << " the same, " << ties << " ties, " << hits << " hits, "
         << entries << " of them at the entry; " << first_wrong;
}

}  // namespace viewgain::test
