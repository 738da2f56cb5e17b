// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/cloud_io.hpp"

#include <algorithm>

#include "clouds/cloud_formats.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/ply_file.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::detail {

PointCloud parse_ply(std::string_view bytes, const std::string& name) {
  PlyFile file(bytes, name);
  const auto& elements = file.elements();
  const auto vertices = std::find_if(elements.begin(), elements.end(),
                                     [](const PlyElement& e) { return e.name == "vertex"; });
  if (vertices == elements.end()) file.fail("there is no element \"vertex\"");
  constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
  std::array<std::size_t, 3> xyz{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto property = vertices->find(kNames[a], false);
    if (!property) file.fail("the vertices have no property " + quoted(kNames[a]));
    xyz[a] = *property;
  }
  PointCloud cloud;
  const auto number = static_cast<std::size_t>(vertices - elements.begin());
  // What stands behind the vertices is not looked at.
  file.read(number + 1, [&](std::size_t element, const PlyRow& row) {
    if (element != number) return;
    cloud.points.push_back({row.scalar(xyz[0]), row.scalar(xyz[1]), row.scalar(xyz[2])});
  });
  return cloud;
}

}  // namespace viewgain::detail

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
