// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/voxel_scene.hpp"

#include <utility>

#include "scene_data.hpp"

namespace viewgain {
namespace {

std::size_t bytes_of(const TriangleMesh& mesh) {
  return mesh.vertices.size() * sizeof(mesh.vertices[0]) +
         mesh.triangles.size() * sizeof(mesh.triangles[0]);
}

}  // namespace

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

}  // namespace viewgain
