#include <cstdio>
#include <viewgain/viewgain.hpp>
int main(int argc, char** argv) try {
  const auto grid = viewgain::load_vdb(argc > 1 ? argv[1] : "map.vdb");
  const auto scene = viewgain::VoxelScene::build(grid);
  const viewgain::GainEvaluator evaluator(scene, viewgain::sensor_preset("sr4000"),
                                          {.model = viewgain::GainModel::combined});
  const auto poses = viewgain::sphere_poses(2000, 0.6);  // T_world_camera [m]
  const auto views = evaluator.evaluate(poses);          // on all cores
  for (const auto i : viewgain::best_indices(views, 3))
    std::printf("pose %zu: %.1f nat\n", i, views[i].gain);
} catch (const viewgain::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}
