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

/// State of a frame's files. Has the frame's line of poses.txt instead of the file, because the
/// file grows.
struct Signature {
  FileStamp depth, amplitude, pose_file;
  std::optional<ReadPose> line{};
  std::vector<FileStamp> masks{};  // one per folder

  bool operator==(const Signature&) const = default;
};

enum class State { waits, taken, bad };

struct Entry {
  Signature signature{};
  FrameWatch::Time since{};              // when this state was first seen
  bool is_examined = false;              // whether it was read in this state
  bool is_judged = false;                // whether it was read after writing had ended
  std::filesystem::path missing_mask{};  // the mask that alone is missing, when it was judged
  std::string name{};                    // of the depth image
  State state = State::waits;
  FrameVerdict verdict = FrameVerdict::used;  // of a bad frame
};

}  // namespace viewgain::detail
