// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/voxel_scene.hpp"

#include <utility>

#include "gather_scene.hpp"
#include "scene_data.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain {
namespace {

using detail::SceneAccess;

std::shared_ptr<const VoxelScene> make_traceable(std::unique_ptr<detail::SceneData> data,
                                                 const detail::SceneData* before,
                                                 const ExecConfig& exec) {
  data->exec = exec;
  data->cells.emplace(*data);
  data->tracing = detail::make_tracing(*data, before);
  return SceneAccess::make(std::move(data));
}

std::size_t bytes_of(const TriangleMesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) +
         mesh.triangles.size() * sizeof(mesh.triangles[0]);
}

}  // namespace

std::shared_ptr<const VoxelScene> VoxelScene::build(const BeliefGrid& grid,
                                                    const Surroundings& surroundings,
                                                    const ExecConfig& exec,
                                                    const HazardConfig& hazard) {
  return build(grid.snapshot(), surroundings, exec, hazard);
}

std::shared_ptr<const VoxelScene> VoxelScene::build(GridSnapshot snapshot,
                                                    const Surroundings& surroundings,
                                                    const ExecConfig& exec,
                                                    const HazardConfig& hazard) {
  (void)thread_count(exec.num_threads);
  detail::check_surroundings(surroundings);
  hazard.validate();
  return make_traceable(
      detail::gather_scene(std::move(snapshot), std::make_shared<const Surroundings>(surroundings),
                           std::make_shared<const HazardConfig>(hazard), nullptr),
      nullptr, exec);
}

std::shared_ptr<const VoxelScene> VoxelScene::update(
    const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
    const ExecConfig& exec) {
  if (!before) refuse("the scene to update is null");
  return update(before, grid.snapshot(before->snapshot()), exec);
}

std::shared_ptr<const VoxelScene> VoxelScene::update(
    const std::shared_ptr<const VoxelScene>& before, GridSnapshot snapshot,
    const ExecConfig& exec) {
  if (!before) refuse("the scene to update is null");
  (void)thread_count(exec.num_threads);
  const detail::SceneData& data = SceneAccess::data(*before);
  return make_traceable(
      detail::gather_scene(std::move(snapshot), data.surroundings, data.hazard, &data), &data,
      exec);
}

VoxelScene::VoxelScene(std::unique_ptr<const detail::SceneData> data) : data_(std::move(data)) {}
VoxelScene::~VoxelScene() = default;

const GridSnapshot& VoxelScene::snapshot() const noexcept { return data_->snapshot; }
const Surroundings& VoxelScene::surroundings() const noexcept { return *data_->surroundings; }
std::size_t VoxelScene::primitive_count() const noexcept { return data_->boxes.size(); }

std::uint64_t VoxelScene::bytes() const noexcept {
  std::size_t bytes = data_->masks.size() * sizeof(detail::TraceMask) +
                      data_->boxes.size() * sizeof(detail::PrimitiveBox) +
                      data_->block_keys.size() * sizeof(std::uint64_t) +
                      data_->leaf_source.size() * (sizeof(std::uint32_t) + sizeof(std::uint8_t)) +
                      data_->regions.size() * sizeof(detail::SceneRegion) + data_->cells->bytes() +
                      data_->surroundings->obstacles.boxes.size() * sizeof(Box);
  for (const TriangleMesh& mesh : data_->surroundings->obstacles.meshes) bytes += bytes_of(mesh);
  return bytes;
}

const HazardField& VoxelScene::hazard() const { return data_->hazard_field(); }
HazardProbe VoxelScene::hazard_probe() const { return HazardProbe(snapshot(), *data_->hazard); }

std::string_view VoxelScene::isa() const noexcept {
  return isa_name(detail::isa_of(*data_->tracing));
}

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa isa : supported_isas()) names.emplace_back(isa_name(isa));
  return names;
}

}  // namespace viewgain
