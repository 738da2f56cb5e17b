// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates; with hidden visibility each library would have a copy
// (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <istream>
#include <new>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "map/grid_storage.hpp"
#include "vdb_layout.hpp"
#include "vdb_outline.hpp"
#include "vdb_seal.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/room.hpp"
#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// A stream buffer over bytes that several threads share.
class BytesBuffer : public std::streambuf {
 public:
  explicit BytesBuffer(std::string_view bytes) {
    char* const begin = const_cast<char*>(bytes.data());  // never written to
    setg(begin, begin, begin + bytes.size());
  }

 protected:
  pos_type seekoff(off_type offset, std::ios_base::seekdir way, std::ios_base::openmode) override {
    char* const from = way == std::ios_base::beg   ? eback()
                       : way == std::ios_base::cur ? gptr()
                                                   : egptr();
    if (offset < eback() - from || offset > egptr() - from) return {off_type(-1)};
    setg(eback(), from + offset, egptr());
    return {gptr() - eback()};
  }
  pos_type seekpos(pos_type position, std::ios_base::openmode which) override {
    return seekoff(position, std::ios_base::beg, which);
  }
};

/// Reads the image of a .vdb file; reads its grids in parallel if it states their positions.
class ImageReader : public openvdb::io::Archive {
 public:
  void read(std::string_view bytes, openvdb::MetaMap& metadata, openvdb::GridPtrVec& grids,
            ThreadPool& pool) {
    BytesBuffer buffer(bytes);
    std::istream stream(&buffer);
    begin(stream);
    metadata.readMeta(stream);
    std::vector<openvdb::io::GridDescriptor> descriptors;
    NamedGridMap named;
    for (auto count = readGridCount(stream); count > 0; --count) {
      openvdb::io::GridDescriptor& next = descriptors.emplace_back();
      grids.push_back(next.read(stream));
      named[next.uniqueName()] = grids.back();
      if (inputHasGridOffsets()) {
        next.seekToEnd(stream);
      } else {
        readGrid(grids.back(), next, stream);
      }
    }
    if (inputHasGridOffsets()) {
      pool.for_each_chunk(descriptors.size(), 1, [&](std::size_t i, std::size_t) {
        if (!is_followed(descriptors[i].gridType())) {  // stays empty
          grids[i]->setName(descriptors[i].gridName());
          return;
        }
        BytesBuffer own_buffer(bytes);
        std::istream own(&own_buffer);
        ImageReader().begin(own);
        descriptors[i].seekToGrid(own);
        readGrid(grids[i], descriptors[i], own);
      });
    }
    for (const openvdb::io::GridDescriptor& each : descriptors) connectInstance(each, named);
  }

 private:
  // OpenVDB stores in the stream what the header says about the rest of the file.
  void begin(std::istream& stream) {
    // OpenVDB does not check for short reads.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    readHeader(stream);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
  }
};

/// Contents of a .vdb file. The threads of the pool, which outlives it, destroy its trees.
struct VdbContents {
  openvdb::MetaMap metadata;
  openvdb::GridPtrVec grids;

  /// Reads the grids in parallel. Throws Error(io) if the file cannot be opened, Error(format) with
  /// the file and the fault if it is truncated, corrupt or not a .vdb file, Error(capacity) if it
  /// does not fit into memory.
  VdbContents(const std::filesystem::path& path, ThreadPool& pool) : VdbContents(pool) {
    const auto fail = [&path](const std::string& what, ErrorCode code = ErrorCode::format) {
      throw Error(code, path.string() + ": " + what);
    };
    std::string bytes = file_bytes(path);
    const SealCheck seal = check_seal(bytes);
    const VdbOutline outline = outline_of(bytes);
    if (!outline.fault.empty()) fail(outline.fault);
    if (seal == SealCheck::broken) fail("the file is corrupt: its checksum does not match");

    initialize_openvdb();
    try {
      // Blosc does not check its allocations.
      const auto threads = static_cast<std::size_t>(pool.num_threads());
      check_room(outline.tree_bytes + threads * kBloscBytes);
      ImageReader().read(bytes, metadata, grids, pool);
    } catch (const std::ios_base::failure&) {
      fail("the file is truncated or corrupt");
    } catch (const std::bad_alloc&) {
      fail("the file does not fit into memory", ErrorCode::capacity);
    } catch (const std::exception& error) {
      fail(std::string("OpenVDB cannot read the file: ") + error.what());
    }
  }
  VdbContents(const VdbContents&) = delete;
  VdbContents& operator=(const VdbContents&) = delete;
  ~VdbContents() {
    pool_.for_each_chunk(grids.size(), 1, [this](std::size_t i, std::size_t) {
      const auto shares_tree = [&](const auto& other) {
        return &other->baseTree() == &grids[i]->baseTree();
      };
      const auto begin = grids.begin(), here = begin + static_cast<std::ptrdiff_t>(i);
      if (std::any_of(begin, here, shares_tree)) return;
      take_down_a<openvdb::FloatGrid>(*grids[i]);
      take_down_a<openvdb::Vec3SGrid>(*grids[i]);
    });
  }

 private:
  static constexpr std::size_t kBloscBytes = std::size_t{2} << 20U;  // of a node and its blocks

  // Complete before reading, so that an exception destroys the grids.
  explicit VdbContents(ThreadPool& pool) : pool_(pool) {}

  template <typename Grid>
  static void take_down_a(openvdb::GridBase& grid) {
    // Not isType(), which builds the names of the types.
    const bool is_one = grid.constBaseTree().type() == Grid::TreeType::treeType();
    if (is_one) take_down(static_cast<Grid&>(grid).tree());
  }

  ThreadPool& pool_;
};

}  // namespace viewgain::detail
