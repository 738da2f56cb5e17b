// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates: hidden, each library would have its own (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "file_seal.hpp"
#include "map/grid_storage.hpp"
#include "vdb_layout.hpp"
#include "vdb_outline.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain::detail {

/// What a .vdb file holds. Its trees are taken down by the thread that drops it.
struct VdbContents {
  openvdb::MetaMap::Ptr metadata;
  openvdb::GridPtrVecPtr grids;

  /// Throws Error(io) if the file cannot be opened, Error(format), naming it and what is wrong, if
  /// it is truncated, corrupt or no .vdb file.
  explicit VdbContents(const std::filesystem::path& path) {
    const auto fail = [&path](const std::string& what) {
      throw Error(ErrorCode::format, path.string() + ": " + what);
    };
    std::string bytes = file_bytes(path);
    const std::string fault = fault_in_outline(bytes);
    if (!fault.empty()) fail(fault);
    if (check_seal(bytes) == SealCheck::broken) fail("is corrupt: its checksum does not fit");

    initialize_openvdb();
    std::istringstream stream(std::move(bytes), std::ios::binary);
    // OpenVDB does not look whether a read came short.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    try {
      openvdb::io::Stream archive(stream, /*delayLoad=*/false);
      metadata = archive.getMetadata();
      grids = archive.getGrids();
    } catch (const std::ios_base::failure&) {
      fail("is truncated or corrupt");
    } catch (const std::bad_alloc&) {
      fail("is corrupt: it asks for more memory than there is");
    } catch (const std::length_error&) {
      fail("is corrupt: it asks for more memory than there is");
    } catch (const std::exception& error) {
      fail(std::string("cannot be read by OpenVDB: ") + error.what());
    }
  }
  VdbContents(const VdbContents&) = delete;
  VdbContents& operator=(const VdbContents&) = delete;
  ~VdbContents() {
    for (const auto& grid : *grids) {
      take_down_a<openvdb::FloatGrid>(*grid);
      take_down_a<openvdb::Vec3SGrid>(*grid);
    }
  }

 private:
  template <typename Grid>
  static void take_down_a(openvdb::GridBase& grid) {
    if (grid.isType<Grid>()) take_down(static_cast<Grid&>(grid).tree());
  }
};

}  // namespace viewgain::detail
