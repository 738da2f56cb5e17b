// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Maps the clouds of mapping.py with a library that has no Debian package. mapping.py compiles this
// against a checkout, with one of the macros below.
//
//     mapping_rivals METHOD VOXEL[m] FRAMES SURFACE
//
// FRAMES, all float64: width, height, fx, fy, cx, cy, number of frames; per frame T_world_camera
// (row by row), the number of points, the points in the world frame [m]. Writes SURFACE: numbers of
// vertices and triangles, then both; none if the library has no surface. Prints seconds per frame
// and megabytes as JSON.
#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>
#if defined(MAPPING_VDBFUSION)
#include "vdbfusion/VDBVolume.h"
#elif defined(MAPPING_BONXAI)
#include "bonxai_map/probabilistic_map.hpp"
#elif defined(MAPPING_WAVEMAP)
#include <wavemap/core/integrator/measurement_model/continuous_ray.h>
#include <wavemap/core/integrator/projection_model/pinhole_camera_projector.h>
#include <wavemap/core/integrator/projective/coarse_to_fine/hashed_chunked_wavelet_integrator.h>
#endif

namespace {

struct Camera {
  double width, height, fx, fy, cx, cy;
};

struct Frame {
  Eigen::Matrix4d T_world_camera;
  std::vector<Eigen::Vector3d> points;  // world frame [m]
  Eigen::Vector3d origin() const { return T_world_camera.topRightCorner<3, 1>(); }
};

struct Input {
  Camera camera;
  std::vector<Frame> frames;
};

struct Surface {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

template <class T>
T read(std::ifstream& file) {
  T value;
  file.read(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

Input read_input(const char* path) {
  std::ifstream file(path, std::ios::binary);
  file.exceptions(std::ios::badbit | std::ios::failbit);
  Input input{read<Camera>(file), std::vector<Frame>(std::size_t(read<double>(file)))};
  for (Frame& frame : input.frames) {
    frame.T_world_camera = read<Eigen::Matrix4d>(file).transpose().eval();  // read column by column
    frame.points.resize(std::size_t(read<double>(file)));
    file.read(reinterpret_cast<char*>(frame.points.data()),
              std::streamsize(frame.points.size() * sizeof(Eigen::Vector3d)));
  }
  return input;
}

/// VmRSS or VmHWM of this process [MB].
double memory(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key + ":") {
      double kilobytes = 0;
      status >> kilobytes;
      return kilobytes / 1024;
    }
  return 0;
}

#if defined(MAPPING_VDBFUSION)
struct Mapper {
  vdbfusion::VDBVolume volume;
  Mapper(const std::string& method, double voxel, const Camera&)
      : volume(float(voxel), float(2 * voxel), method == "carving") {}
  void add(const Frame& frame) {
    volume.Integrate(frame.points, frame.origin(), [](float) { return 1.f; });
  }
  Surface surface() const {
    auto [vertices, triangles] = volume.ExtractTriangleMesh(false, 0.f);
    return {std::move(vertices), std::move(triangles)};
  }
};
#elif defined(MAPPING_BONXAI)
struct Mapper {
  Bonxai::ProbabilisticMap map;
  Mapper(const std::string&, double voxel, const Camera&) : map(voxel) {}
  void add(const Frame& frame) { map.insertPointCloud(frame.points, frame.origin(), 10.); }
  Surface surface() const { return {}; }
};
#elif defined(MAPPING_WAVEMAP)
struct Mapper {
  std::shared_ptr<wavemap::HashedChunkedWaveletOctree> map;
  std::unique_ptr<wavemap::HashedChunkedWaveletIntegrator> integrator;

  Mapper(const std::string&, double voxel, const Camera& camera) {
    wavemap::HashedChunkedWaveletOctreeConfig map_config;
    map_config.min_cell_width = float(voxel);
    map = std::make_shared<wavemap::HashedChunkedWaveletOctree>(map_config);
    wavemap::PinholeCameraProjectorConfig pinhole;
    pinhole.width = int(camera.width);
    pinhole.height = int(camera.height);
    pinhole.fx = float(camera.fx);
    pinhole.fy = float(camera.fy);
    pinhole.cx = float(camera.cx);
    pinhole.cy = float(camera.cy);
    const auto projector = std::make_shared<const wavemap::PinholeCameraProjector>(pinhole);
    const auto image = std::make_shared<wavemap::PosedImage<> >(projector->getDimensions());
    const auto offsets =
        std::make_shared<wavemap::Image<wavemap::Vector2D> >(projector->getDimensions());
    const auto beam = std::make_shared<const wavemap::ContinuousRay>(
        wavemap::ContinuousRayConfig(float(voxel / 2), 0.5f, 0.5f), projector, image);
    integrator = std::make_unique<wavemap::HashedChunkedWaveletIntegrator>(
        wavemap::ProjectiveIntegratorConfig(0.05f, 10.f), projector, image, offsets, beam, map);
  }
  void add(const Frame& frame) {
    const Eigen::Matrix4d T_camera_world = frame.T_world_camera.inverse();
    std::vector<wavemap::Point3D> points;
    for (const Eigen::Vector3d& point : frame.points)
      points.push_back(
          (T_camera_world.topLeftCorner<3, 3>() * point + T_camera_world.topRightCorner<3, 1>())
              .cast<float>());
    const wavemap::Transformation3D pose(Eigen::Matrix4f(frame.T_world_camera.cast<float>()));
    integrator->integrate(wavemap::PosedPointcloud<>(pose, wavemap::Pointcloud<>(points)));
  }
  Surface surface() const { return {}; }
};
#endif

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5)
    return std::fprintf(stderr, "usage: mapping_rivals METHOD VOXEL FRAMES SURFACE\n"), 2;
  const Input input = read_input(argv[3]);
  Mapper mapper(argv[1], std::stod(argv[2]), input.camera);
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak is now
  const double before = memory("VmRSS");
  const auto start = std::chrono::steady_clock::now();
  for (const Frame& frame : input.frames) mapper.add(frame);
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
  const double peak = memory("VmHWM");
  const Surface surface = mapper.surface();
  std::ofstream file(argv[4], std::ios::binary);
  const std::int64_t sizes[] = {std::int64_t(surface.vertices.size()),
                                std::int64_t(surface.triangles.size())};
  file.write(reinterpret_cast<const char*>(sizes), sizeof sizes);
  file.write(reinterpret_cast<const char*>(surface.vertices.data()),
             std::streamsize(surface.vertices.size() * sizeof(Eigen::Vector3d)));
  file.write(reinterpret_cast<const char*>(surface.triangles.data()),
             std::streamsize(surface.triangles.size() * sizeof(Eigen::Vector3i)));
  std::printf("{\"seconds\": %.9f, \"megabytes\": %.3f}\n",
              passed.count() / double(input.frames.size()), peak - before);
}
