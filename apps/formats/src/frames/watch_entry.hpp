// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "frames/file_stamp.hpp"
#include "frames/frame_names.hpp"
#include "viewgain/core/frame_verdict.hpp"
#include "viewgain/formats/frame_watch.hpp"

namespace viewgain::detail {

/// What a frame's files are like. A line of poses.txt counts, and not the file, which grows.
struct Signature {
  FileStamp depth, amplitude, pose_file;
  std::optional<ReadPose> line{};
  std::vector<FileStamp> masks{};  // one a folder

  bool operator==(const Signature&) const = default;
};

enum class State { waits, taken, bad };

struct Entry {
  Signature signature{};
  FrameWatch::Time since{};              // when it was first seen
  bool is_examined = false;              // since then
  bool is_judged = false;                // likewise, when nobody was writing any more
  std::filesystem::path missing_mask{};  // when it was judged: all that it waits for
  std::string name{};                    // of the depth image
  State state = State::waits;
  FrameVerdict verdict = FrameVerdict::used;  // of a bad one
};

}  // namespace viewgain::detail
