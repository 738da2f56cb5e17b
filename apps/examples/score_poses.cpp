#include <cstdio>
#include <viewgain/viewgain.hpp>
int main() {
  const viewgain::BeliefGrid grid = viewgain::load_vdb("out/demo/map.vdb");
  const auto scene = viewgain::VoxelScene::build(grid);  // immutable, shared by readers
  const viewgain::GainEvaluator evaluator(scene, viewgain::sensor_preset("sr4000"));
  const std::vector<viewgain::Pose> poses = viewgain::sphere_poses(2000, 0.6);  // T_world_camera
  const std::vector<viewgain::ViewGain> views = evaluator.evaluate(poses);  // all cores
  for (const std::size_t i : viewgain::best_indices(views, 3)) {
    std::printf("pose %zu: %.1f nat\n", i, views[i].gain);
  }
}
