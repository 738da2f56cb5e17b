// For a planner with its own map. Each cycle it passes on the changes and asks for a view.
#include <cstdio>
#include <viewgain/viewgain.hpp>

using namespace viewgain;

int main() try {
  ViewScorer scorer(sensor_preset("d435"), {.voxel_size = 0.02,
                                            .workspace = {{0, 0, 0}, {0.8, 0.6, 0.4}},
                                            .support_plane = 0.0,
                                            .gain = {.pixel_stride = 4}});
  const std::vector<Pose> poses = dome_poses(500, 0.9, {0.4, 0.3, 0.1});
  const VoxelBox all = scorer.voxels();
  for (int x = all.min.x; x < all.max.x; x += 8) {
    // The planner's map now knows the next eight layers: a block of 12 cm, and free space.
    const VoxelBox layers{{x, all.min.y, all.min.z}, {x + 8, all.max.y, all.max.z}};
    std::vector<std::uint8_t> labels;  // [x][y][z]: 0 unknown, 1 free, 2 occupied
    for (int i = x; i < x + 8; ++i) {
      for (int y = all.min.y; y < all.max.y; ++y) {
        for (int z = all.min.z; z < all.max.z; ++z) {
          labels.push_back(i >= 16 && i < 22 && y >= 12 && y < 18 && z < 6 ? 2 : 1);
        }
      }
    }
    const auto changed = static_cast<unsigned long long>(scorer.set(layers, labels));
    const BestViews best = scorer.best(poses, 1, {.deadline = 0.5});  // [s]
    if (best.indices.empty()) break;
    std::printf("%llu voxels changed; the best of %zu views is %zu, %.1f nat\n", changed,
                poses.size(), best.indices[0], best.gains[0].gain);
  }
} catch (const Error& error) {
  return std::fprintf(stderr, "labels: %s\n", error.what()), 2;
}
