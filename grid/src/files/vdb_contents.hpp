// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB keeps state in its templates: hidden, each library would have its own (grid/README.md).
#pragma GCC visibility push(default)
#include <openvdb/openvdb.h>
#pragma GCC visibility pop

#include <filesystem>

#include "viewgain/support/thread_pool.hpp"

namespace viewgain::detail {

/// What a .vdb file holds. Its trees are taken down by the threads of the pool, which outlives it.
struct VdbContents {
  openvdb::MetaMap metadata;
  openvdb::GridPtrVec grids;

  /// Reads the grids side by side. Throws Error(io) if the file cannot be opened, Error(format),
  /// naming it and what is wrong, if it is truncated, corrupt or no .vdb file.
  VdbContents(const std::filesystem::path& path, ThreadPool& pool);
  VdbContents(const VdbContents&) = delete;
  VdbContents& operator=(const VdbContents&) = delete;
  ~VdbContents();

 private:
  ThreadPool& pool_;
};

}  // namespace viewgain::detail
