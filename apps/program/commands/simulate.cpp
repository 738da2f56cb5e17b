// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/flags/sensing.hpp"
#include "program/cli/flags/set_up_warnings.hpp"
#include "program/cli/help.hpp"
#include "program/cli/progress.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/mesh/mesh_io.hpp"
#include "viewgain/planner/simulated_acquisition.hpp"
#include "viewgain/raycast/simulated_sensor.hpp"
#include "viewgain/raycast/surface_scene.hpp"
#include "viewgain/raycast/suspect_set_up.hpp"
#include "viewgain/support/stopwatch.hpp"

namespace viewgain::app {
namespace {

struct Options {
  CommonOptions common;
  std::string mesh;
  PoseOptions poses;
  std::string sensor;
  std::optional<double> size;
  std::string up = "z";
  std::string place;
  SensingOptions sensing;
  std::size_t frames_per_view = 1;
  std::string out;
};

struct PixelCounts {
  std::uint64_t readings = 0, out_of_range = 0, invalid = 0;

  void add(const DepthFrame& frame) {
    for (const float z : frame.depth) {
      if (z == DepthFrame::kInvalid) {
        ++invalid;
      } else if (z == DepthFrame::kOutOfRange) {
        ++out_of_range;
      } else {
        ++readings;
      }
    }
  }
};

// Pose of the mesh's frame in the world; empty: unchanged, or its centre at the origin.
std::optional<Pose> parse_place(std::string text) {
  if (text.empty() || text == "center") return std::nullopt;
  if (text.starts_with("center,")) text.erase(0, 7);
  const std::vector<double> n = parse_numbers("--place", text, 3, 7);
  if (n.size() > 4) return parse_pose("--place", text);
  const double yaw = n.size() > 3 ? n[3] * std::numbers::pi / 180 : 0;
  return Pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
              Eigen::Vector3d(n[0], n[1], n[2]));
}

void place(const Pose& T_world_mesh, TriangleMesh& mesh) {
  for (auto& v : mesh.vertices) {
    const Eigen::Vector3d p = T_world_mesh * Eigen::Vector3d(v.data());
    v = {p.x(), p.y(), p.z()};
  }
}

// Whether any pixel shows the mesh, and not only the room.
bool sees_mesh(const SurfaceScene& scene, const Sensor& sensor,
               const std::vector<Eigen::Vector3d>& rays, const Pose& T_world_camera) {
  const Eigen::Matrix3d R_world_camera = T_world_camera.rotation();
  return std::any_of(rays.begin(), rays.end(), [&](const Eigen::Vector3d& ray) {
    const SurfaceScene::Ray in_world{T_world_camera.translation(),
                                     (R_world_camera * ray).normalized(), sensor.max_range};
    return ray.allFinite() && scene.intersect(in_world).range <= sensor.max_range;
  });
}

void check_view(const Options& options, const SurfaceScene& scene, const Sensor& sensor,
                const std::vector<Pose>& poses) {
  const std::vector<Eigen::Vector3d> rays = sensor.camera.ray_table();
  if (std::none_of(poses.begin(), poses.end(),
                   [&](const Pose& pose) { return sees_mesh(scene, sensor, rays, pose); })) {
    refuse(options.mesh + ": no pose sees the mesh within the sensor's range; the mesh lies in " +
           describe(bounds_of(scene.mesh())) + " m (--size, --place)");
  }
}

// A mesh that is far too large is usually in millimetres. Parts below the table are not visible.
void warn_of_place(const Options& options, const Box& box, const Sensor& sensor) {
  constexpr double kTooLarge = 10;  // relative to the sensor's range
  if (const double side = longest_side(box); side > kTooLarge * sensor.max_range) {
    std::fprintf(stderr,
                 "viewgain: warning: %s is %s m long, but the sensor's range ends at %s m. Is it "
                 "in metres? (--size)\n",
                 options.mesh.c_str(), short_text(side).c_str(),
                 short_text(sensor.max_range).c_str());
  }
  const std::optional<double>& plane = options.sensing.support_plane;
  if (!plane || !(box.max[2] - *plane <= 0.501 * (box.max[2] - box.min[2]))) return;
  std::fprintf(
      stderr,
      "viewgain: warning: %s lies in %s m; at least half of it is below the support plane, "
      "whose height is %s m (--place)\n",
      options.mesh.c_str(), describe(box).c_str(), short_text(*plane).c_str());
}

void simulate(const Options& options) {
  const ExecConfig exec = exec_of(options.common);
  Sensor sensor = load_sensor(options.sensor);
  sensor.validate();
  warn_of_sensor(sensor);
  sensor.range_calibration = {};  // the frames have no such error
  if (options.size) check_positive("--size", *options.size);
  const PoseSource source = make_poses(options.poses, options.sensing.seed);
  const std::optional<Pose> T_world_mesh = parse_place(options.place);
  MeshRepairs repairs;
  TriangleMesh mesh =
      read_mesh(options.mesh, placement_of(options.size, options.place, options.up), &repairs);
  warn_of_repairs(options.mesh, repairs);
  if (T_world_mesh) place(*T_world_mesh, mesh);
  const std::size_t triangles = mesh.triangles.size();
  const auto scene = std::make_shared<const SurfaceScene>(std::move(mesh), exec);
  check_view(options, *scene, sensor, source.poses);
  warn_of_place(options, bounds_of(scene->mesh()), sensor);
  const SimulatedNoise noise = parse_noise(options.sensing.noise, false);
  const SimulatedSensor camera(scene, sensor, simulation_config(options.sensing, noise, sensor),
                               exec);
  warn(suspect_pose_sigma(noise.pose, sensor.working_distance), "--noise pose");
  std::vector<Pose> poses, reported;  // one per frame
  for (std::size_t view = 0; view < source.poses.size(); ++view) {
    const Pose& pose = source.poses[view];
    poses.insert(poses.end(), options.frames_per_view, pose);
    reported.insert(reported.end(), options.frames_per_view,
                    reported_pose(pose, view, noise.pose, options.sensing.seed));
  }

  const Stopwatch watch;
  FramesWriter writer(options.out, depth_scale_for(sensor));
  PixelCounts counts;
  const bool writes_amplitude = std::holds_alternative<ShotNoise>(sensor.noise);
  {
    Progress progress("frame", options.common.quiet);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      DepthFrame frame = camera.acquire(poses[i], i);
      counts.add(frame);
      if (!writes_amplitude) frame.amplitude.clear();
      writer.write_frame(i, frame);
      progress.update(i + 1, poses.size());
    }
  }
  writer.commit(reported, sensor);
  const double seconds = watch.seconds();

  if (options.common.json) {
    const SensingOptions& sensing = options.sensing;
    print_json({{"frames", poses.size()},
                {"views", source.poses.size()},
                {"frames_per_view", options.frames_per_view},
                {"width", sensor.camera.width},
                {"height", sensor.camera.height},
                {"sensor", sensor.name},
                {"triangles", triangles},
                {"mended_faces", repairs.mended_faces},
                {"dropped_faces", repairs.dropped_faces},
                {"readings", counts.readings},
                {"out_of_range", counts.out_of_range},
                {"invalid", counts.invalid},
                {"noise", noise.readings},
                {"flying_pixels", noise.has_flying_pixels(sensor)},
                {"scale_error", noise.scale_error},
                {"support_plane", sensing.support_plane},
                {"pose_noise", pose_sigma_json(noise.pose)},
                {"amplitude", writes_amplitude},
                {"seed", sensing.seed},
                {"orthonormalized_poses", source.orthonormalized},
                {"out", options.out},
                {"seconds", seconds}});
    return;
  }
  std::printf("%zu frames of %dx%d px (%s) of %s triangles in %.2f s: %s\n", poses.size(),
              sensor.camera.width, sensor.camera.height, printable(sensor.name).c_str(),
              with_commas(triangles).c_str(), seconds, options.out.c_str());
  std::printf("pixels: %s with a depth, %s out of range, %s invalid\n",
              with_commas(counts.readings).c_str(), with_commas(counts.out_of_range).c_str(),
              with_commas(counts.invalid).c_str());
  print_mended(source.orthonormalized);
}

}  // namespace

Command add_simulate(App& program) {
  auto options = std::make_shared<Options>();
  App* app = program.add_subcommand("simulate", "Simulate depth frames of a mesh.");
  app->add_option("MESH", options->mesh, "OFF, OBJ, STL or PLY file")->required();
  add_pose_options(*app, options->poses);
  app->add_option("--sensor", options->sensor, kSensorHelp)->required();
  begin_group(*app, "Mesh");
  app->add_option("--size", options->size,
                  "length of the mesh's longest side after scaling [m] (default: no scaling)");
  app->add_option("--up", options->up, "axis of the mesh file that points up")
      ->check(one_of({"x", "y", "z"}, "axis"));
  app->add_option("--place", options->place,
                  "place of the mesh in the world: center, x,y,z[,YAW_DEG] or tx,ty,tz,qx,qy,qz,qw "
                  "(default: do not move; see below)");
  explain_values(
      *app,
      "Values of --place [m], applied after --size and --up:\n"
      "  center                move the centre of the bounding box to the origin\n"
      "  x,y,z[,YAW_DEG]       rotate around +z, then shift\n"
      "  tx,ty,tz,qx,qy,qz,qw  rotate by the quaternion, then shift\n"
      "  center,...            first center, then another of these, as in center,x,y,z\n");
  add_sensing_options(*app, options->sensing);
  begin_group(*app, "Output");
  app->add_option("--frames-per-view", options->frames_per_view,
                  "number of frames from each pose; poses.txt has one line per frame")
      ->check(counted(1, 1000));
  app->add_option(
         "--out", options->out,
         "folder to write; frames of an earlier simulate are replaced, other frames cause an error")
      ->required();
  most_need(*app, {"--sensor", "--out", "--size", "--place", "--up", "--noise", "--support-plane",
                   "--background"});
  explain_values(*app,
                 "Files in OUT, for frame NNNNNN:\n"
                 "  frame-NNNNNN.depth.png      16 bit: depth along z in units of 0.1 mm (larger\n"
                 "                              units if max_range is over 6.5534 m);\n"
                 "                              0: invalid, 65535: out of range\n"
                 "  frame-NNNNNN.amplitude.png  16 bit: cos(angle of incidence) / range^2\n"
                 "                              [1e-3 m^-2]; 65535: unknown\n"
                 "  poses.txt                   TUM: reported poses, numbered like the frames\n"
                 "  sensor.toml, frames.toml    sensor and units\n");
  add_help(*app, kMapGroup,
           "simulate mesh.off --size 0.35 --place center --poses orbit:3,0.6,27 --sensor sr4000 "
           "--out frames");
  return command_of(app, options, simulate);
}

}  // namespace viewgain::app
