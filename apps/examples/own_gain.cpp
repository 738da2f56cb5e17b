// A custom gain: the number of distinct unknown voxels in view, each weighted by 1/range².
#include <algorithm>
#include <cstdio>
#include <set>
#include <stdexcept>
#include <tuple>
#include <viewgain/viewgain.hpp>

class NearUnknown : public viewgain::ViewMeasure {
 public:
  double measure(const viewgain::Pose&,
                 std::span<const viewgain::ViewMeasure::Hit> hits) const override {
    std::set<std::tuple<int, int, int>> seen;
    double sum = 0;
    for (const viewgain::ViewMeasure::Hit& hit : hits) {
      if (hit.state != viewgain::VoxelState::unknown) continue;
      const bool is_new = seen.insert({hit.voxel.x, hit.voxel.y, hit.voxel.z}).second;
      if (is_new) sum += 1 / (hit.range * hit.range);
    }
    return sum;
  }
};

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: own_gain MAP.vdb");
  const auto scorer = viewgain::ViewScorer::load(argv[1], viewgain::sensor_preset("sr4000"));
  const std::vector<viewgain::Pose> poses = viewgain::sphere_poses(200, 0.6);
  const std::vector<double> gains = scorer.evaluate(poses, NearUnknown());  // on all cores
  const auto best = std::max_element(gains.begin(), gains.end());
  std::printf("pose %td: %.1f unknown voxels per m2\n", best - gains.begin(), *best);
} catch (const std::exception& error) {
  std::fprintf(stderr, "own_gain: %s\n", error.what());
  return 2;
}
