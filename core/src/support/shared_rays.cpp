// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/support/shared_rays.hpp"

#include <mutex>
#include <utility>

namespace viewgain {

std::shared_ptr<const std::vector<Eigen::Vector3d>> shared_rays(const PinholeCamera& camera) {
  using Table = const std::vector<Eigen::Vector3d>;
  using Tables = std::vector<std::pair<PinholeCamera, std::weak_ptr<Table>>>;
  static constinit std::mutex mutex;
  // Never freed, because threads may call until the process ends.
  static constinit Tables* tables = nullptr;

  // After a fork, a thread that does not exist in the child may hold the lock. So nobody waits.
  const std::unique_lock lock(mutex, std::try_to_lock);
  if (!lock) return std::make_shared<Table>(camera.ray_table());
  if (tables == nullptr) tables = new Tables;
  std::erase_if(*tables, [](const auto& entry) { return entry.second.expired(); });
  for (const auto& [of, table] : *tables) {
    if (!(of == camera)) continue;
    if (auto found = table.lock()) return found;
  }
  auto made = std::make_shared<Table>(camera.ray_table());
  tables->emplace_back(camera, made);
  return made;
}

}  // namespace viewgain
