// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// A scene is gathered, then made ready for tracing.
#include <string>
#include <utility>

#include "scene/gather_scene.hpp"
#include "scene_tracing.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/thread_pool.hpp"
#include "viewgain/raycast/voxel_scene.hpp"

namespace viewgain {
namespace {

using detail::SceneAccess;

std::shared_ptr<const VoxelScene> make_traceable(std::unique_ptr<detail::SceneData> data,
                                                 const detail::SceneData* before) {
  data->cells.emplace(*data);
  data->tracing = std::make_shared<const detail::SceneTracing>(*data, before);
  return SceneAccess::make(std::move(data));
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
      nullptr);
}

std::shared_ptr<const VoxelScene> VoxelScene::update(
    const std::shared_ptr<const VoxelScene>& before, const BeliefGrid& grid,
    const ExecConfig& exec) {
  if (!before) throw Error(ErrorCode::invalid_argument, "there is no scene to update");
  (void)thread_count(exec.num_threads);
  const detail::SceneData& data = SceneAccess::data(*before);
  return make_traceable(
      detail::gather_scene(grid.snapshot(data.snapshot), data.surroundings, data.hazard, &data),
      &data);
}

const HazardField& VoxelScene::hazard() const { return data_->tracing->hazard(); }

std::string_view VoxelScene::isa() const noexcept { return isa_name(data_->tracing->kernels.isa); }

std::vector<std::string> available_isas() {
  std::vector<std::string> names;
  for (const Isa isa : supported_isas()) names.emplace_back(isa_name(isa));
  return names;
}

}  // namespace viewgain
