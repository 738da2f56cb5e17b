// Next best views into a bin, frame by frame. Saves its state: stop it at any time and start it
// again.
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <viewgain/core/generators.hpp>
#include <viewgain/formats/frames.hpp>
#include <viewgain/formats/sensor_toml.hpp>
#include <viewgain/planner/view_planner.hpp>

using namespace viewgain;

ScorerConfig bin_map() {
  ScorerConfig config;
  config.voxel_size = 0.005;
  config.workspace = {{-0.20, -0.15, 0.0}, {0.20, 0.15, 0.20}};
  config.support_plane = 0.0;  // the bin's floor
  // The bin's walls, 2 cm thick and 20 cm high.
  config.obstacles.boxes = {{{-0.22, -0.17, 0}, {-0.20, 0.17, 0.2}},
                            {{0.20, -0.17, 0}, {0.22, 0.17, 0.2}},
                            {{-0.22, -0.17, 0}, {0.22, -0.15, 0.2}},
                            {{-0.22, 0.15, 0}, {0.22, 0.17, 0.2}}};
  config.clearance = 0.01;
  return config;
}

PlannerConfig robot() {
  PlannerConfig config;
  config.reach.shells = {{{0.0, 0.0, 0.1}, 0.40, 0.75}};
  config.reach.half_spaces = {{{0, 0, 1}, 0.30}};  // never below 0.3 m
  return config;
}

// Stands for the robot: moves the camera to the pose and returns whether it arrived. Here it always
// does, because the frames are recorded.
bool drive_to(const Pose&) { return true; }

int main(int argc, char** argv) try {
  if (argc != 5)
    throw std::runtime_error("usage: bin_planner SENSOR.toml FRAMES STATE.vdb MOST_FRAMES");
  const Sensor sensor = load_sensor(argv[1]);
  const FrameSequence frames = open_frames(argv[2], argv[1]);
  const std::filesystem::path state = argv[3];
  ViewPlanner planner = exists(state) ? ViewPlanner::load(state, sensor, bin_map(), robot())
                                      : ViewPlanner(ViewScorer(sensor, bin_map()), robot());
  planner.add_poses({"shell", shell_poses(300, 0.45, 0.70, 1, {0.0, 0.0, 0.1})});

  const std::size_t first = planner.scorer().grid().views().size();
  for (std::size_t i = first; i < frames.images.size() && i < first + std::stoul(argv[4]); ++i) {
    const AddedView view = planner.add(load_frame(frames, i), frames.poses[i]);
    std::printf("view %zu: %.1f cm2 of new surface, %.0f nat", i, 1e4 * view.update.new_area,
                view.entropy_removed);
    const std::size_t possible = planner.propose().candidates.size();
    for (const RankedView& best : planner.rank(3, {.cost_per_metre = 20}).views) {  // [nat/m]
      const Eigen::Vector3d at = best.T_world_camera.translation();
      std::printf("; of %zu views the best is %zu at (%.3f, %.3f, %.3f) m, %.1f nat", possible,
                  best.index, at.x(), at.y(), at.z(), best.gain.gain);
      const bool reached = drive_to(best.T_world_camera);
      planner.tried(best.T_world_camera, reached);
      if (reached) break;  // otherwise try the next best
    }
    if (const auto reason = planner.should_stop()) {
      std::printf("; enough: %s", std::string(stop_reason_name(*reason)).c_str());
    }
    std::printf("\n");
    planner.save(state);
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "bin_planner: %s\n", error.what());
  return 2;
}
