// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/grid/cloud_io.hpp"

#include "cloud_formats.hpp"
#include "file_text.hpp"
#include "viewgain/core/error.hpp"

namespace viewgain {

PointCloud load_cloud(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  const bool is_pcd = ending == ".pcd" || ending == ".PCD";
  if (!is_pcd && ending != ".ply" && ending != ".PLY") {
    throw Error(ErrorCode::format, path.string() + ": clouds are .pcd or .ply files");
  }
  const std::string bytes = detail::read_bytes(path);
  return is_pcd ? detail::parse_pcd(bytes, path.string()) : detail::parse_ply(bytes, path.string());
}

}  // namespace viewgain
