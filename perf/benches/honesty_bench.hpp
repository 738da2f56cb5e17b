// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace viewgain::bench {

struct HonestyOptions {
  int num_threads = 2;
  int views = 12;  ///< on the sphere
  std::filesystem::path mesh;
  bool json = false;
};

/// Do the reported sigmas stay honest, and does the surface get better, as readings accumulate?
/// Consistency of pooled points and of the literal rule against readings per voxel; RMS of the
/// region of view 1 when the same three views are repeated. Returns the exit code.
int run_honesty(const HonestyOptions& options);

}  // namespace viewgain::bench
