#include <cstdio>
#include <viewgain/viewgain.hpp>
int main(int argc, char** argv) try {
  const viewgain::BeliefGrid grid = viewgain::load_vdb(argc > 1 ? argv[1] : "map.vdb");
  const auto scene = viewgain::VoxelScene::build(grid);  // immutable, for any thread
  const viewgain::GainEvaluator evaluator(scene, viewgain::sensor_preset("sr4000"));
  const std::vector<viewgain::Pose> poses = viewgain::sphere_poses(2000, 0.6);  // T_world_camera
  const std::vector<viewgain::ViewGain> views = evaluator.evaluate(poses);      // on all cores
  for (const std::size_t i : viewgain::best_indices(views, 3)) {
    std::printf("pose %zu: %.1f nat\n", i, views[i].gain);
  }
} catch (const viewgain::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
