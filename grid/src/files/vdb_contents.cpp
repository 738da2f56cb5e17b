// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "vdb_contents.hpp"

#pragma GCC visibility push(default)
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#pragma GCC visibility pop

#include <algorithm>
#include <cstddef>
#include <istream>
#include <new>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

#include "file_seal.hpp"
#include "map/grid_storage.hpp"
#include "vdb_layout.hpp"
#include "vdb_outline.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain::detail {
namespace {

/// Reads bytes that several threads share.
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

/// Reads the image of a .vdb file, its grids side by side where it says where they are.
class ImageReader : public openvdb::io::Archive {
 public:
  void read(std::string_view bytes, VdbContents& contents, ThreadPool& pool) {
    BytesBuffer buffer(bytes);
    std::istream stream(&buffer);
    begin(stream);
    contents.metadata.readMeta(stream);
    std::vector<openvdb::io::GridDescriptor> descriptors;
    NamedGridMap named;
    for (auto count = readGridCount(stream); count > 0; --count) {
      openvdb::io::GridDescriptor& next = descriptors.emplace_back();
      contents.grids.push_back(next.read(stream));
      named[next.uniqueName()] = contents.grids.back();
      if (inputHasGridOffsets()) {
        next.seekToEnd(stream);
      } else {
        readGrid(contents.grids.back(), next, stream);
      }
    }
    if (inputHasGridOffsets()) {
      pool.for_each_chunk(descriptors.size(), 1, [&](std::size_t i, std::size_t) {
        BytesBuffer own_buffer(bytes);
        std::istream own(&own_buffer);
        ImageReader().begin(own);
        descriptors[i].seekToGrid(own);
        readGrid(contents.grids[i], descriptors[i], own);
      });
    }
    for (const openvdb::io::GridDescriptor& each : descriptors) connectInstance(each, named);
  }

 private:
  // OpenVDB takes from the stream what the head says of all that follows.
  void begin(std::istream& stream) {
    // It does not look whether a read came short.
    stream.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    readHeader(stream);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
  }
};

template <typename Grid>
void take_down_a(openvdb::GridBase& grid) {
  if (grid.isType<Grid>()) take_down(static_cast<Grid&>(grid).tree());
}

}  // namespace

VdbContents::VdbContents(const std::filesystem::path& path, ThreadPool& pool) : pool_(pool) {
  const auto fail = [&path](const std::string& what) {
    throw Error(ErrorCode::format, path.string() + ": " + what);
  };
  const std::string bytes = file_bytes(path);
  const std::string fault = fault_in_outline(bytes);
  if (!fault.empty()) fail(fault);
  if (check_seal(bytes) == SealCheck::broken) fail("is corrupt: its checksum does not fit");

  initialize_openvdb();
  try {
    ImageReader().read(bytes, *this, pool);
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

VdbContents::~VdbContents() {
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

}  // namespace viewgain::detail
