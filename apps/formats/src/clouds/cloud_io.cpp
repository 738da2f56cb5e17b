// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/cloud_io.hpp"

#include "clouds/cloud_formats.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain {

PointCloud load_cloud(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  const bool is_pcd = ending == ".pcd" || ending == ".PCD";
  if (!is_pcd && ending != ".ply" && ending != ".PLY") {
    throw Error(ErrorCode::format, path.string() + ": clouds are .pcd or .ply files");
  }
  const std::string bytes = file_bytes(path);
  return is_pcd ? detail::parse_pcd(bytes, path.string()) : detail::parse_ply(bytes, path.string());
}

}  // namespace viewgain
