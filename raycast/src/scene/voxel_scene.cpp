// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/voxel_scene.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "scene_data.hpp"
#include "scene_primitives.hpp"
#include "trace/voxel_bvh.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::PrimitiveBox;

void check(const Obstacles& obstacles) {
  for (const Box& box : obstacles.boxes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(box.min[axis]) || !std::isfinite(box.max[axis]) ||
          box.min[axis] >= box.max[axis]) {
        throw Error(ErrorCode::invalid_argument, "an obstacle box is inside out or not finite");
      }
    }
  }
  for (const TriangleMesh& mesh : obstacles.meshes) {
    for (const auto& vertex : mesh.vertices) {
      for (const double c : vertex) {
        if (!std::isfinite(static_cast<float>(c))) {
          throw Error(ErrorCode::invalid_argument, "an obstacle has a vertex that is not finite");
        }
      }
    }
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= mesh.vertices.size()) {
          throw Error(ErrorCode::invalid_argument, "an obstacle's triangle refers to vertex " +
                                                       std::to_string(index) + " of " +
                                                       std::to_string(mesh.vertices.size()));
        }
      }
    }
  }
}

}  // namespace

std::shared_ptr<const VoxelScene> VoxelScene::build(const BeliefGrid& grid,
                                                    const Obstacles& obstacles,
                                                    const ExecConfig& exec) {
  return build(grid.snapshot(), obstacles, exec);
}

std::shared_ptr<const VoxelScene> VoxelScene::build(GridSnapshot snapshot,
                                                    const Obstacles& obstacles,
                                                    const ExecConfig& exec) {
  check(obstacles);
  return make(std::move(snapshot), std::make_shared<const Obstacles>(obstacles), exec, nullptr);
}

std::shared_ptr<const VoxelScene> VoxelScene::update(
    const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
    const ExecConfig& exec) {
  if (!before) throw Error(ErrorCode::invalid_argument, "there is no scene to update");
  const Data& data = before->data();
  return make(grid.snapshot(data.snapshot), data.obstacles, exec, &data);
}

std::shared_ptr<const VoxelScene> VoxelScene::make(GridSnapshot snapshot,
                                                   std::shared_ptr<const Obstacles> obstacles,
                                                   const ExecConfig& exec, const Data* before) {
  auto data = std::make_unique<Data>();
  data->build_threads = thread_count(exec.num_threads);
  data->snapshot = std::move(snapshot);
  detail::gather_primitives(*data, before);
  data->scene_boxes.emplace(*data);
  data->kernels = &detail::trace_kernels(detail::packet_isa());
  data->obstacles = std::move(obstacles);
  data->has_obstacles = !data->obstacles->boxes.empty() || !data->obstacles->meshes.empty();
  if (data->has_obstacles) data->ensure_bvh();
  return std::shared_ptr<const VoxelScene>(new VoxelScene(std::move(data)));
}

VoxelScene::VoxelScene(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
VoxelScene::~VoxelScene() = default;

const GridSnapshot& VoxelScene::snapshot() const noexcept { return data_->snapshot; }
const Obstacles& VoxelScene::obstacles() const noexcept { return *data_->obstacles; }
std::string_view VoxelScene::isa() const noexcept { return isa_name(data_->kernels->isa); }
std::size_t VoxelScene::primitive_count() const noexcept { return data_->boxes.size(); }

std::uint64_t VoxelScene::bytes() const noexcept {
  return data_->masks.size() * sizeof(detail::TraceMask) +
         data_->boxes.size() * sizeof(PrimitiveBox) +
         data_->block_keys.size() * sizeof(std::uint64_t) +
         data_->leaf_source.size() * (sizeof(std::uint32_t) + sizeof(std::uint8_t)) +
         data_->regions.size() * sizeof(detail::SceneRegion);
}

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa isa : supported_isas()) names.emplace_back(isa_name(isa));
  return names;
}

}  // namespace viewgain
