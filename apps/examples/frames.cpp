// Depth frames into a map, and where to look next.
#include <cstdio>
#include <memory>
#include <viewgain/viewgain.hpp>

using namespace viewgain;

int main() try {
  const Sensor sensor = sensor_preset("sr4000");
  // A simulated camera in place of a real one: a 16 cm box in front of a wall.
  const Obstacles box{{{{-0.08, -0.08, -0.08}, {0.08, 0.08, 0.08}}}, {}};
  const SimulatedSensor camera(std::make_shared<const SurfaceScene>(mesh_of(box)), sensor,
                               {.background_radius = 1.5});

  ViewScorer scorer(sensor,
                    {.voxel_size = 0.01, .workspace = {{-0.15, -0.15, -0.15}, {0.15, 0.15, 0.15}}});
  const std::vector<Pose> poses = sphere_poses(500, 0.5);
  Pose T_world_camera = look_at({0.5, 0.1, 0.2}, {0, 0, 0});
  for (int view = 0; view < 5; ++view) {
    const DepthFrame frame = camera.acquire(T_world_camera, static_cast<std::uint64_t>(view));
    const MapUpdate update = scorer.add(frame, T_world_camera);
    const BestViews best = scorer.best(poses);
    if (!is_in_map(update.verdict) || best.indices.empty()) break;
    std::printf("view %d showed %.0f cm2 of new surface", view, 1e4 * update.new_area);
    std::printf("; the next one may show %.0f cm2\n", 1e4 * best.gains[0].area);
    T_world_camera = poses[best.indices[0]];
  }
  std::printf("%s\n", scorer.consistency().suspicion.what.c_str());  // empty: the frames agree
  scorer.save("frames_map.vdb");
} catch (const Error& error) {
  return std::fprintf(stderr, "frames: %s\n", error.what()), 2;
}
