// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <ios>
#include <string>
#include <string_view>

#include "core/temporary_folder.hpp"
#include "files/vdb_seal.hpp"
#include "readers/readers.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/grid/hazard.hpp"
#include "viewgain/grid/vdb_io.hpp"

namespace viewgain::test {
namespace {

// A map with all that its files have: free tiles, beliefs, views, a frame that is turned.
BeliefGrid small_map() {
  BeliefGrid grid({0.1, {{-1, -1, -1}, {1, 1, 1}}, look_at({0, 0, 1}, {0.1, 0.2, 0}), 0.05});
  for (std::int32_t z = 0; z < 8; ++z) {
    for (std::int32_t y = 0; y < 8; ++y) {
      for (std::int32_t x = 0; x < 8; ++x) grid.set({x, y, z}, -2);
    }
  }
  for (std::int32_t x = -9; x < 9; ++x) {
    grid.set({x, -2, 3}, -0.4F);
    if (x % 3 == 0) grid.set({x, -2, 4}, 0.85F);
  }
  grid.append_view(look_at({1, 0, 0.5}, {0, 0, 0}));
  return grid;
}

}  // namespace

std::vector<std::string> vdb_seeds() {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "map.vdb", again = folder.path() / "again.vdb";
  save_vdb(small_map(), path, {.notes = MapNotes{.others = {{"planner", "x"}}}});
  const std::string sealed = read_all(path);
  const std::string map = sealed.substr(0, sealed.size() - detail::make_seal({}).size());
  std::vector<std::string> seeds{'\0' + map, '\1' + map, '\2' + map};
  // As other programs write.
  openvdb::initialize();
  openvdb::io::File file(path);
  file.open(false);
  const openvdb::GridPtrVecPtr grids = file.getGrids();
  using namespace openvdb::io;
  for (const std::uint32_t packing : {COMPRESS_ZIP, COMPRESS_ACTIVE_MASK}) {
    openvdb::io::File other(again);
    other.setCompression(packing);
    for (const auto& grid : *grids) grid->setSaveFloatAsHalf(packing == COMPRESS_ZIP);
    other.write(*grids, *file.getMetadata());
    seeds.push_back((packing == COMPRESS_ZIP ? '\2' : '\0') + read_all(again));
  }
  return seeds;
}

std::size_t vdb_maps(std::string_view bytes) {
  if (bytes.empty()) return 0;
  const auto which = static_cast<unsigned char>(bytes.front());
  bytes.remove_prefix(1);
  static const TemporaryFolder folder;
  const auto path = folder.path() / "map.vdb";
  std::ofstream(path, std::ios::binary)
      << bytes << (which % 2 == 0 ? detail::make_seal(bytes) : std::string());
  try {
    if (which % 3 == 2) {
      (void)load_hazard_vdb(path, small_map());
    } else {
      save_vdb(load_vdb(path, {1}), folder.path() / "again.vdb");
    }
    return 1;
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace viewgain::test
