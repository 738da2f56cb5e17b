// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/frame_watch.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "frame_folder.hpp"
#include "frame_names.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/pose_io.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;

// What the file system says of a file; all 0 where there is none.
struct FileStamp {
  std::uint64_t device = 0, inode = 0, size = 0;
  std::int64_t seconds = 0, nanoseconds = 0;  // of the last change

  bool operator==(const FileStamp&) const = default;
  [[nodiscard]] bool is_there() const { return *this != FileStamp{}; }
};

FileStamp stamp_of(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino, static_cast<std::uint64_t>(status.st_size),
          status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

// A pose of a file that may still grow.
struct ReadPose {
  Pose T_world_camera;
  bool is_mended = false;
  std::string fault{};  // empty: it is a pose

  bool operator==(const ReadPose&) const = default;
};

// What a frame's files are like. A line of poses.txt counts, and not the file, which grows.
struct Signature {
  FileStamp depth, amplitude, pose_file;
  std::optional<ReadPose> line{};
  std::vector<FileStamp> masks{};  // one a folder

  bool operator==(const Signature&) const = default;
};

enum class State { waits, taken, bad };

struct Entry {
  Signature signature{};
  FrameWatch::Time since{};  // when it was first seen
  bool is_examined = false;  // since then
  bool is_judged = false;    // likewise, when nobody was writing any more
  fs::path missing_mask{};   // when it was judged: all that it waits for
  State state = State::waits;
  std::string reason{};  // of a bad one
};

// What came of looking into a frame's files; neither a frame nor a reason: something is missing.
struct Verdict {
  std::optional<WatchedFrame> frame{};
  std::string reason{};
  std::string what{};
  fs::path missing_mask{};  // where nothing else is missing
};

Verdict fault(const char* reason, std::string what) { return {{}, reason, std::move(what)}; }

// The poses of lines that have their end.
std::vector<ReadPose> poses_of_lines(const fs::path& path) {
  std::string text;
  try {
    text = file_bytes(path);
  } catch (const Error&) {  // it is being replaced
    return {};
  }
  text.resize(text.rfind('\n') + 1);  // none: 0
  std::vector<ReadPose> poses;
  for (LineReader line(path.string(), text); line.next();) {
    if (line.words().empty() || line.words().front().front() == '#') continue;
    ReadPose& read = poses.emplace_back();
    try {
      read.T_world_camera = tum_line_pose(line, &read.is_mended);
    } catch (const Error& error) {
      read.fault = error.what();
    }
  }
  return poses;
}

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

// A reason, or none, of an image of any kind.
Verdict size_fault(const fs::path& image, const PinholeCamera& camera) {
  const auto [width, height] = png_size(image);
  if (width == camera.width && height == camera.height) return {};
  return fault("size", image.string() + ": has " + size_text(width, height) +
                           " pixels, the sensor " + size_text(camera.width, camera.height));
}

bool has_end(const fs::path& png) {
  constexpr std::string_view kEnd("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  return file_bytes(png).ends_with(kEnd);
}

}  // namespace

struct FrameWatch::Impl {
  fs::path dir;
  FrameWatchConfig config;
  std::optional<FrameSequence> folder;
  std::map<std::string, std::string> taken;  // by file name, as frame_identity() has them
  std::map<std::uint64_t, Entry> entries;
  Time looked{};  // when it was looked at last
  FileStamp poses_stamp;
  std::vector<ReadPose> poses;  // of poses.txt

  [[nodiscard]] Signature signature(std::uint64_t number, const std::string& name,
                                    bool is_recorded) const {
    const fs::path image = dir / (name + std::string(kDepthSuffix));
    Signature now{stamp_of(image), stamp_of(amplitude_path(image)), {}};
    for (const MaskFolder& masks : config.masks) {
      now.masks.push_back(stamp_of(masks.file_of(image)));
    }
    if (is_recorded) {
      now.pose_file = stamp_of(dir / (name + std::string(kPoseSuffix)));
    } else if (number < poses.size()) {
      now.line = poses[static_cast<std::size_t>(number)];
    }
    return now;
  }

  // Nothing: it is not there yet.
  [[nodiscard]] std::optional<ReadPose> pose(const Signature& is, const std::string& name,
                                             bool is_stable) const {
    if (!is.pose_file.is_there()) return is.line;
    const fs::path path = dir / (name + std::string(kPoseSuffix));
    ReadPose read;
    try {
      if (!is_stable && !file_bytes(path).ends_with('\n')) return std::nullopt;
      read.T_world_camera = read_pose_matrix(path, &read.is_mended);
    } catch (const Error& error) {
      read.fault = error.what();
    }
    return read;
  }

  // Of images that have their end.
  [[nodiscard]] Verdict load(std::uint64_t number, const std::vector<fs::path>& images,
                             const ReadPose& pose) const {
    for (const fs::path& image : images) {
      Verdict wrong = size_fault(image, folder->sensor.camera);
      if (!wrong.reason.empty()) return wrong;
    }
    FrameSequence one = *folder;
    one.images = {images.front()};
    one.poses = {pose.T_world_camera};
    return {WatchedFrame{number, images.front(), frame_identity(one, 0),
                         load_frame(one, 0, config.out_of_range), pose.T_world_camera}};
  }

  // Without what its masks take, which are there and have their end.
  [[nodiscard]] Verdict masked(WatchedFrame frame) const {
    for (const MaskFolder& masks : config.masks) {
      Verdict wrong = size_fault(masks.file_of(frame.image), folder->sensor.camera);
      if (!wrong.reason.empty()) return wrong;
      const auto mask = masks.mask_of(frame.image, frame.frame.width, frame.frame.height);
      if (!mask) return {};  // gone meanwhile
      frame.masked_pixels += apply_mask(*mask, frame.frame);
    }
    return {std::move(frame)};
  }

  [[nodiscard]] Verdict examine(std::uint64_t number, const std::string& name, const Signature& is,
                                bool needs_amplitude, bool is_stable) {
    const fs::path depth = dir / (name + std::string(kDepthSuffix));
    // One that was taken is known without its masks.
    const bool is_known = taken.contains(depth.filename().string());
    std::vector<fs::path> files;  // of which each needs its end
    fs::path missing_mask;
    for (std::size_t i = 0; i < is.masks.size() && !is_known; ++i) {
      const fs::path mask = config.masks[i].file_of(depth);
      if (is.masks[i].is_there()) {
        files.push_back(mask);
      } else {
        missing_mask = mask;
      }
    }
    const bool has_amplitude = !needs_amplitude || is.amplitude.is_there();
    if (!is_stable && !(missing_mask.empty() && has_amplitude)) return {};
    const std::optional<ReadPose> read = pose(is, name, is_stable);
    if (!read) return {};
    if (!read->fault.empty()) return fault("pose", read->fault);
    std::vector<fs::path> images{depth};
    if (is.amplitude.is_there()) images.push_back(amplitude_path(images.front()));
    try {
      files.insert(files.begin(), images.begin(), images.end());
      for (const fs::path& image : files) {
        if (!has_end(image)) return fault("truncated", image.string() + ": the image has no end");
      }
    } catch (const Error& error) {
      return fault("image", error.what());
    }
    if (!missing_mask.empty()) return {{}, {}, {}, missing_mask};
    // What is wrong with it is no frame's fault.
    if (!folder) folder = open_frame_folder(dir, config.sensor, config.depth_scale);
    try {
      Verdict loaded = load(number, images, *read);
      if (is_known || !loaded.frame) return loaded;
      return masked(std::move(*loaded.frame));
    } catch (const Error& error) {
      return fault("image", error.what());
    }
  }

  FolderLook look(Time now) {
    std::error_code ignored;
    if (!fs::is_directory(dir, ignored)) {
      throw Error(ErrorCode::io, dir.string() + ": no such folder");
    }
    looked = now;
    const std::vector<fs::path> names = names_in(dir);
    const auto frames = list_frames(names);
    const bool needs_amplitude = std::any_of(names.begin(), names.end(), [](const fs::path& name) {
      return frame_number(name.string(), kAmplitudeSuffix).has_value();
    });
    const bool has_poses = std::find(names.begin(), names.end(), kPoses) != names.end();
    const bool is_recorded = folder ? folder->recorded : !has_poses;
    if (const FileStamp stamp = stamp_of(dir / kPoses); stamp != poses_stamp) {
      poses_stamp = stamp;
      poses = poses_of_lines(dir / kPoses);
    }
    std::erase_if(entries, [&](const auto& entry) { return !frames.contains(entry.first); });
    FolderLook found;
    for (const auto& [number, name] : frames) {
      Entry& entry = entries[number];
      const Signature is = signature(number, name, is_recorded);
      if (!is.depth.is_there()) continue;  // since the folder was listed
      if (is != entry.signature) entry = {is, now};
      const bool is_stable = now - entry.since >= config.settle;
      if (entry.state != State::waits || (is_stable ? entry.is_judged : entry.is_examined))
        continue;
      Verdict verdict = examine(number, name, is, needs_amplitude, is_stable);
      entry.is_examined = true;
      entry.is_judged = is_stable;
      // What was written meanwhile is for the next look.
      if (signature(number, name, is_recorded) != is) continue;
      entry.missing_mask = verdict.missing_mask;
      if (verdict.frame) {
        const auto [known, is_new] =
            taken.emplace(verdict.frame->image.filename().string(), verdict.frame->identity);
        if (is_new || known->second == verdict.frame->identity) entry.state = State::taken;
        if (is_new) {
          found.frame = std::move(verdict.frame);
          return found;
        }
        if (entry.state == State::taken) continue;
        verdict = fault("changed", verdict.frame->image.string() +
                                       ": was taken with other contents; a number is one frame's");
      }
      if (verdict.reason.empty() || !is_stable) continue;
      entry.state = State::bad;
      entry.reason = verdict.reason;
      found.bad.push_back({number, std::move(verdict.reason), std::move(verdict.what)});
    }
    return found;
  }
};

FrameWatch::FrameWatch(fs::path dir, FrameWatchConfig config)
    : impl_(
          std::make_unique<Impl>(Impl{std::move(dir), std::move(config), {}, {}, {}, {}, {}, {}})) {
  for (const std::string& identity : impl_->config.taken) {
    impl_->taken.emplace(identity.substr(identity.find(' ') + 1), identity);
  }
}
FrameWatch::~FrameWatch() = default;
FrameWatch::FrameWatch(FrameWatch&&) noexcept = default;
FrameWatch& FrameWatch::operator=(FrameWatch&&) noexcept = default;

FolderLook FrameWatch::look(Time now) { return impl_->look(now); }

std::vector<BadFrame> FrameWatch::give_up() {
  std::vector<BadFrame> given_up;
  for (auto& [number, entry] : impl_->entries) {
    if (entry.state != State::waits || entry.missing_mask.empty()) continue;
    entry.state = State::bad;
    entry.reason = "no_mask";
    given_up.push_back({number, entry.reason, entry.missing_mask.string() + ": no such mask"});
  }
  return given_up;
}

void FrameWatch::refuse(const WatchedFrame& frame, const std::string& reason) {
  Entry& entry = impl_->entries.at(frame.number);
  entry.state = State::bad;
  entry.reason = reason;
  impl_->taken.erase(frame.image.filename().string());
}

const std::optional<FrameSequence>& FrameWatch::folder() const noexcept { return impl_->folder; }

std::set<std::string> FrameWatch::taken() const {
  std::set<std::string> identities;
  for (const auto& [name, identity] : impl_->taken) identities.insert(identity);
  return identities;
}

std::size_t FrameWatch::waiting() const {
  return static_cast<std::size_t>(
      std::count_if(impl_->entries.begin(), impl_->entries.end(),
                    [](const auto& entry) { return entry.second.state == State::waits; }));
}

std::map<std::string, std::size_t> FrameWatch::bad() const {
  std::map<std::string, std::size_t> counts;
  for (const auto& [number, entry] : impl_->entries) {
    if (entry.state == State::bad) ++counts[entry.reason];
  }
  return counts;
}

bool FrameWatch::is_settled() const {
  return std::all_of(impl_->entries.begin(), impl_->entries.end(), [&](const auto& entry) {
    return entry.second.state != State::waits ||
           impl_->looked - entry.second.since >= impl_->config.settle;
  });
}

}  // namespace viewgain
