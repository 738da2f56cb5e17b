// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/pose_files.hpp"

#include <numeric>
#include <vector>

#include "viewgain/core/error.hpp"
#include "viewgain/support/columns/table.hpp"
#include "viewgain/support/file_names.hpp"
#include "viewgain/support/pose_numbers.hpp"

namespace viewgain {

PoseList load_poses(const std::filesystem::path& path) {
  return is_npy(path) ? read_npy_poses(path) : read_tum(path);
}

void save_poses(const std::filesystem::path& path, std::span<const Pose> poses) {
  std::vector<double> timestamps(poses.size());
  std::iota(timestamps.begin(), timestamps.end(), 0.0);
  save_poses(path, poses, timestamps);
}

void save_poses(const std::filesystem::path& path, std::span<const Pose> poses,
                std::span<const double> timestamps) {
  if (const std::string fault = fault_of_poses_name(path); !fault.empty()) {
    refuse(path.string() + ": " + fault);
  }
  if (!is_npy(path)) return write_tum(path, poses, timestamps);
  check_writable(path, poses, timestamps);
  Table table{{{kTimeColumn}}};
  for (const char* name : kPoseColumns) table.columns.push_back({name});
  for (std::size_t i = 0; i < poses.size(); ++i) {
    table.add(timestamps[i]);
    for (const double number : numbers_of_pose(poses[i])) table.add(number);
  }
  write_table(path, table);
}

std::string fault_of_poses_name(const std::filesystem::path& path) {
  return fault_of_ending(path, "a file of poses", {".txt", ".tum", ".npy"});
}

}  // namespace viewgain
