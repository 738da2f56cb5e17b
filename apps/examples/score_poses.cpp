#include <cstdio>
#include <viewgain/viewgain.hpp>
int main(int argc, char** argv) try {
  const auto scorer =
      viewgain::ViewScorer::load(argc > 1 ? argv[1] : "map.vdb", viewgain::sensor_preset("sr4000"));
  const auto poses = viewgain::sphere_poses(2000, 0.6);  // T_world_camera [m]
  const auto best = scorer.best(poses, 3);               // on all cores
  for (std::size_t i = 0; i < best.indices.size(); ++i)
    std::printf("pose %zu: %.1f nat\n", best.indices[i], best.gains[i].gain);
} catch (const viewgain::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
