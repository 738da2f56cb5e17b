// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/formats/frame_watch.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "folders.hpp"
#include "frames/file_stamp.hpp"
#include "frames/frame_names.hpp"
#include "frames/growing_poses.hpp"
#include "frames/watch_entry.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain {
namespace {

namespace fs = std::filesystem;
using detail::Entry, detail::Signature, detail::State;

// Result of reading a frame's files. With neither a frame nor a fault, something is missing.
struct Finding {
  std::optional<WatchedFrame> frame{};
  FrameFault fault{};
  fs::path missing_mask{};               // set if only a mask is missing
  std::optional<Pose> T_world_camera{};  // set for a fault other than the pose's
};

Finding fault(FrameVerdict verdict, std::string what) { return {{}, {verdict, std::move(what)}}; }

// Limits the number of decided frames that a look checks again, and of looks per listing, because
// both would otherwise take longer with every frame.
constexpr std::size_t kAgain = 256;

// Contents of the folder, and progress of the looks through them.
struct Listing {
  std::map<std::uint64_t, std::string> frames{};  // "frame-NNNNNN" by number
  bool needs_amplitude = false;
  bool is_recorded = false;
  std::uint64_t again_begin = 0,
                again_end = 0;  // frames to check next; end 0: all from the begin on
  std::uint64_t next = 0;       // the first new frame
  std::size_t looks = kAgain;   // looks that used this listing; initially a new listing is due

  [[nodiscard]] bool is_turn(std::uint64_t number) const {
    return number >= again_begin && (again_end == 0 || number < again_end);
  }
};

bool has_end(const fs::path& png) {
  constexpr std::string_view kEnd("\0\0\0\0IEND\xae\x42\x60\x82", 12);
  return folder_file_bytes(png).ends_with(kEnd);
}

}  // namespace

struct FrameWatch::Impl {
  fs::path dir;
  FrameWatchConfig config;
  std::optional<FrameSequence> folder;
  std::map<std::string, std::string> taken;  // frame_identity() by file name
  std::map<std::uint64_t, Entry> entries;
  Listing listing;
  std::set<std::string> twins;     // images whose numbers are used by others, or too large
  Time looked{};                   // time of the last look
  std::size_t quiet_listings = 0;  // consecutive listings without anything new
  GrowingPoses lines;              // of poses.txt

  [[nodiscard]] Signature signature(std::uint64_t number, const std::string& name,
                                    bool is_recorded) const {
    const fs::path image = dir / (name + std::string(kDepthSuffix));
    Signature now{stamp_of(image), stamp_of(amplitude_path(image)), {}};
    for (const MaskFolder& masks : config.masks) {
      now.masks.push_back(stamp_of(masks.file_of(image)));
    }
    if (is_recorded) {
      now.pose_file = stamp_of(dir / (name + std::string(kPoseSuffix)));
    } else {
      now.line = lines.pose_of(number);
    }
    return now;
  }

  // The pose of a frame; empty if it does not exist yet.
  [[nodiscard]] std::optional<ReadPose> pose(const Signature& is, const std::string& name,
                                             bool is_stable) const {
    if (!is.pose_file.is_there()) return is.line;
    const fs::path path = dir / (name + std::string(kPoseSuffix));
    try {
      if (!is_stable && !folder_file_bytes(path).ends_with('\n')) return std::nullopt;
    } catch (const Error&) {  // read_pose_file() reports the reason
    }
    return read_pose_file(path);
  }

  // Loads a frame from complete files, without masked pixels.
  [[nodiscard]] Finding load(std::uint64_t number, const fs::path& image, const ReadPose& pose,
                             std::span<const MaskFolder> masks) const {
    FrameSequence one = *folder;
    one.images = {image};
    one.poses = {pose.T_world_camera};
    one.pose_faults = {pose.fault};
    FrameReading read = read_frame(one, 0, masks);
    if (read.fault.verdict != FrameVerdict::used) return {{}, std::move(read.fault)};
    return {WatchedFrame{number, image, std::move(read.frame), pose.T_world_camera,
                         read.masked_pixels}};
  }

  [[nodiscard]] Finding examine(std::uint64_t number, const std::string& name, const Signature& is,
                                bool needs_amplitude, bool is_stable) {
    const std::optional<ReadPose> read = pose(is, name, is_stable);
    Finding finding = examine(number, name, is, needs_amplitude, is_stable, read);
    if (read && read->fault.verdict == FrameVerdict::used) {
      finding.T_world_camera = read->T_world_camera;
    }
    return finding;
  }

  [[nodiscard]] Finding examine(std::uint64_t number, const std::string& name, const Signature& is,
                                bool needs_amplitude, bool is_stable,
                                const std::optional<ReadPose>& read) {
    const fs::path depth = dir / (name + std::string(kDepthSuffix));
    // A taken frame is recognised without its masks.
    const bool is_known = taken.contains(depth.filename().string());
    std::vector<fs::path> files{depth};  // files that must be complete
    if (is.amplitude.is_there()) files.push_back(amplitude_path(depth));
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
    if (!read) return {};
    // The folder must be known when a fault is reported.
    const auto no_frame = [&](FrameFault found) -> Finding {
      if (is_stable) open_folder();
      return {{}, std::move(found)};
    };
    if (read->fault.verdict != FrameVerdict::used) return no_frame(read->fault);
    try {
      for (const fs::path& file : files) {
        if (has_end(file)) continue;
        return no_frame({FrameVerdict::unreadable, file.string() + ": the image is incomplete"});
      }
    } catch (const Error& error) {
      return no_frame({FrameVerdict::unreadable, error.what()});
    }
    if (!missing_mask.empty()) return {{}, {}, missing_mask};
    // Faults of the folder are not faults of a frame.
    open_folder();
    try {
      return load(number, depth, *read,
                  is_known ? std::span<const MaskFolder>() : std::span(config.masks));
    } catch (const Error& error) {
      return fault(FrameVerdict::unreadable, error.what());
    }
  }

  void open_folder() {
    if (folder) return;
    folder = open_frame_folder(dir, config.sensor, config.depth_scale);
    if (!config.out_of_range) return;
    folder->out_of_range = *config.out_of_range;
    folder->is_out_of_range_assumed = false;
  }

  static BadFrame set_bad(std::uint64_t number, Entry& entry, Finding why) {
    entry.state = State::bad;
    entry.verdict = why.fault.verdict;
    return {number, std::move(why.fault),
            entry.name.empty() ? frame_name(number, kDepthSuffix) : entry.name, why.T_world_camera};
  }

  FolderLook look(Time now) {
    std::error_code ignored;
    if (!fs::is_directory(dir, ignored)) {
      throw Error(ErrorCode::io, dir.string() + ": no such folder");
    }
    looked = now;
    FolderLook found;
    if (listing.looks < kAgain) look_on(now, found);
    if (found.frame) return found;
    list(found);
    look_on(now, found);
    return found;
  }

  // If two images have the same number, only one counts: the one that was taken, otherwise the
  // first by name.
  void list_numbers(const std::vector<std::string>& names, FolderLook& found) {
    const std::string end(kDepthSuffix);
    FramesLeftOut others;
    listing.frames = list_frames(names, &others);
    std::set<std::string> left;
    for (const auto& [name, number] : others) {
      std::string image = name + end, what = ": the number of the frame has more than 64 bits";
      if (number) {
        std::string& own = listing.frames.at(*number);
        if (taken.contains(image) && !taken.contains(own + end)) {
          image = own + end;
          own = name;
        }
        what = ": the frame has the same number as " + own + "; give each frame another number";
      }
      if (!twins.contains(image)) {
        found.bad.push_back({number.value_or(std::numeric_limits<std::uint64_t>::max()),
                             {FrameVerdict::changed, (dir / image).string() + what},
                             image});
      }
      left.insert(image);
    }
    twins = std::move(left);
  }

  void list(FolderLook& found) {
    const std::vector<std::string> names = names_in(dir);
    const std::uint64_t begin = listing.again_end;
    listing = {};
    list_numbers(names, found);
    listing.needs_amplitude = std::any_of(names.begin(), names.end(), [](const std::string& name) {
      return frame_number(name, kAmplitudeSuffix).has_value();
    });
    const bool has_poses = std::find(names.begin(), names.end(), kPoses) != names.end();
    listing.is_recorded =
        folder ? folder->recorded : lines.is_recorded(looked).value_or(!has_poses);
    if (!listing.is_recorded) {
      std::vector<std::uint64_t> numbers;
      for (const auto& [number, name] : listing.frames) numbers.push_back(number);
      lines.look(std::move(numbers), looked);
    }
    std::erase_if(entries,
                  [&](const auto& entry) { return !listing.frames.contains(entry.first); });
    listing.again_begin = begin;
    auto end = listing.frames.lower_bound(begin);
    for (std::size_t i = 0; i < kAgain && end != listing.frames.end(); ++i) ++end;
    listing.again_end = end == listing.frames.end() ? 0 : end->first;
    listing.looks = 0;
    ++quiet_listings;
  }

  // Continues until a frame is found or the listing ends.
  void look_on(Time now, FolderLook& found) {
    ++listing.looks;
    for (auto it = listing.frames.lower_bound(listing.next); it != listing.frames.end(); ++it) {
      const auto& [number, name] = *it;
      listing.next = number + 1;
      Entry& entry = entries[number];
      if (entry.state != State::waits && !listing.is_turn(number)) continue;
      const Signature is = signature(number, name, listing.is_recorded);
      if (!is.depth.is_there()) continue;  // removed since the folder was listed
      if (is != entry.signature) {
        entry = {is, now};
        quiet_listings = 0;
      }
      entry.name = name + std::string(kDepthSuffix);
      const bool is_stable = now - entry.since >= config.settle;
      if (entry.state != State::waits || (is_stable ? entry.is_judged : entry.is_examined))
        continue;
      Finding finding = examine(number, name, is, listing.needs_amplitude, is_stable);
      entry.is_examined = true;
      entry.is_judged = is_stable;
      // Files that were written meanwhile are left to the next look.
      if (signature(number, name, listing.is_recorded) != is) continue;
      entry.missing_mask = finding.missing_mask;
      if (finding.frame) {
        const auto [known, is_new] =
            taken.emplace(finding.frame->image.filename().string(), finding.frame->frame.identity);
        if (is_new || known->second == finding.frame->frame.identity) entry.state = State::taken;
        if (is_new) {
          found.frame = std::move(finding.frame);
          quiet_listings = 0;  // later frames were not checked
          return;
        }
        if (entry.state == State::taken) continue;
        finding =
            fault(FrameVerdict::changed, finding.frame->image.string() +
                                             ": the image has changed since it was integrated; "
                                             "give each new frame a new number");
      }
      if (finding.fault.verdict == FrameVerdict::used || !is_stable) continue;
      found.bad.push_back(set_bad(number, entry, std::move(finding)));
    }
    listing.looks = kAgain;
  }
};

FrameWatch::FrameWatch(fs::path dir, FrameWatchConfig config) : impl_(std::make_unique<Impl>()) {
  impl_->dir = std::move(dir);
  impl_->config = std::move(config);
  impl_->lines = GrowingPoses(impl_->dir, impl_->config.settle);
  for (const std::string& identity : impl_->config.taken) {
    const auto known =
        impl_->taken.emplace(identity.substr(identity.find(' ') + 1), identity).first;
    const auto digits = frame_number(known->first, kDepthSuffix);
    if (const auto number = digits ? frame_index(*digits) : std::nullopt) {
      impl_->lines.add_earlier(*number);
    }
  }
}
FrameWatch::~FrameWatch() = default;
FrameWatch::FrameWatch(FrameWatch&&) noexcept = default;
FrameWatch& FrameWatch::operator=(FrameWatch&&) noexcept = default;

FolderLook FrameWatch::look(Time now) { return impl_->look(now); }

std::vector<BadFrame> FrameWatch::give_up() {
  Impl& m = *impl_;
  std::vector<BadFrame> given_up;
  for (auto& [number, entry] : m.entries) {
    if (entry.state != State::waits || !entry.is_judged) continue;
    const bool has_pose = !entry.missing_mask.empty();
    const fs::path image = m.dir / entry.name;
    given_up.push_back(Impl::set_bad(
        number, entry,
        has_pose ? fault(FrameVerdict::no_mask, entry.missing_mask.string() + ": no such mask")
                 : fault(FrameVerdict::no_pose, m.lines.misfit().empty()
                                                    ? image.string() + ": the image has no pose"
                                                    : m.lines.misfit())));
  }
  if (m.listing.is_recorded) return given_up;
  for (const std::uint64_t number : m.lines.numbers()) {
    const fs::path image = m.dir / frame_name(number, kDepthSuffix);
    if (m.taken.contains(image.filename().string())) continue;  // and removed since
    const auto [entry, is_new] = m.entries.try_emplace(number);
    if (!is_new) continue;
    given_up.push_back(Impl::set_bad(
        number, entry->second, fault(FrameVerdict::unreadable, image.string() + ": no such file")));
  }
  return given_up;
}

void FrameWatch::refuse(const WatchedFrame& frame, FrameVerdict verdict) {
  Entry& entry = impl_->entries.at(frame.number);
  entry.state = State::bad;
  entry.verdict = verdict;
  impl_->taken.erase(frame.image.filename().string());
}

const std::optional<FrameSequence>& FrameWatch::folder() const noexcept { return impl_->folder; }

std::set<std::string> FrameWatch::taken() const {
  std::set<std::string> identities;
  for (const auto& [name, identity] : impl_->taken) identities.insert(identity);
  return identities;
}

std::size_t FrameWatch::taken_count() const { return impl_->taken.size(); }

std::size_t FrameWatch::waiting() const {
  return static_cast<std::size_t>(
      std::count_if(impl_->entries.begin(), impl_->entries.end(),
                    [](const auto& entry) { return entry.second.state == State::waits; }));
}

std::map<std::string, std::size_t> FrameWatch::bad() const {
  FrameCounts counts;
  for (const auto& [number, entry] : impl_->entries) {
    if (entry.state == State::bad) ++counts[entry.verdict];
  }
  if (!impl_->twins.empty()) counts[FrameVerdict::changed] += impl_->twins.size();
  return bad_frames(counts);
}

bool FrameWatch::is_settled() const {
  if (impl_->quiet_listings * kAgain < impl_->entries.size()) return false;  // not all were checked
  if (!impl_->lines.is_settled(impl_->looked)) return false;
  return std::all_of(impl_->entries.begin(), impl_->entries.end(), [&](const auto& entry) {
    return entry.second.state != State::waits ||
           impl_->looked - entry.second.since >= impl_->config.settle;
  });
}

}  // namespace viewgain
