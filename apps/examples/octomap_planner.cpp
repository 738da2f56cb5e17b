// A planner on octomap::OcTree: viewgain follows the growing tree and chooses the next view.
#include <cmath>
#include <cstdio>
#include <memory>
#include <viewgain/formats/octomap_tree.hpp>
#include <viewgain/viewgain.hpp>
using namespace viewgain;

octomap::point3d point(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

int main() try {
  const Box mapped{{-0.96, -0.96, -0.96}, {0.96, 0.96, 0.96}};
  const Sensor sensor = sensor_preset("sr4000");
  // Stands for a real camera: a box in the middle of a round room.
  const Obstacles box{{{{-0.15, -0.1, -0.2}, {0.15, 0.1, 0.2}}}, {}};
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(mesh_of(box)), sensor,
                               {.background_radius = 0.9});
  const auto rays = sensor.camera.ray_table();
  octomap::OcTree tree(0.02);
  ViewScorer scorer(sensor, {.voxel_size = 0.02, .workspace = mapped});
  const std::vector<Pose> poses = sphere_poses(500, 0.55);
  Pose view = look_at({0.6, 0.05, 0.1}, {0, 0, 0});
  for (int i = 1; i <= 3; ++i) {
    const DepthFrame frame = camera.acquire(view);
    octomap::Pointcloud cloud;
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const auto z = static_cast<double>(frame.depth[k]);
      if (z > 0 && std::isfinite(z)) cloud.push_back(point((view * (rays[k] * z)).cast<float>()));
    }
    tree.insertPointCloud(cloud, point(view.translation().cast<float>()));  // the planner's own map
    const auto changed = static_cast<unsigned long long>(update_from_octree(scorer, tree, mapped));
    const BestViews best = scorer.best(poses);
    if (best.indices.empty()) break;
    view = poses[best.indices[0]];
    std::printf("view %d: %llu voxels changed, the best of %zu may show %.4f m2\n", i, changed,
                poses.size(), best.gains[0].area);
  }
} catch (const Error& error) {
  return std::fprintf(stderr, "octomap_planner: %s\n", error.what()), 2;
}
