// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/call_files.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "program/cli/command_line.hpp"
#include "program/cli/flags/frame_folder.hpp"
#include "program/cli/flags/pose_source.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/formats/staged_folder.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;

// What kind of file the value of an option names.
enum class Kind {
  input,
  reach,
  folder,
  frames,  // a folder of frames, or a file instead of it
  map,     // or the folder of a run
  output,
  frames_output,
  run_output,
  model_output
};
struct FileOption {
  std::string_view name;
  Kind kind;
};
constexpr auto kFileOptions = std::to_array<FileOption>({{"--config", Kind::input},
                                                         {"MESH", Kind::input},
                                                         {"MAP", Kind::map},
                                                         {"IN", Kind::map},
                                                         {"--map", Kind::map},
                                                         {"--cloud", Kind::input},
                                                         {"--poses", Kind::input},
                                                         {"--sensor", Kind::input},
                                                         {"--reach", Kind::reach},
                                                         {"--hazard", Kind::input},
                                                         {"--obstacle", Kind::input},
                                                         {"FRAMES_DIR", Kind::frames},
                                                         {"OUT", Kind::output},
                                                         {"--picture", Kind::output},
                                                         {"--out", Kind::output},
                                                         {"--save-config", Kind::output},
                                                         {"--report", Kind::output},
                                                         {"SPEC", Kind::input},
                                                         {"--truth", Kind::input},
                                                         {"--points", Kind::output},
                                                         {"SOURCE", Kind::folder},
                                                         {"--mask", Kind::folder},
                                                         {"--confidence", Kind::folder},
                                                         {"--costs", Kind::input}});

bool is_output(Kind kind) { return kind >= Kind::output; }

struct NamedFile {
  std::string option;
  fs::path path;
  Kind kind;
};

Kind kind_of(const FileOption& option, const std::string& subcommand) {
  if (option.name != "--out") return option.kind;
  if (subcommand == "simulate" || subcommand == "import") return Kind::frames_output;
  if (subcommand == "model") return Kind::model_output;
  return subcommand == "reconstruct" ? Kind::run_output : option.kind;
}

bool is_run(const App& subcommand) {
  return subcommand.get_name() == "reconstruct" || subcommand.get_name() == "model";
}

void check_values(const App& subcommand) {
  for (const Option* option : options_of_call(subcommand)) {
    for (const std::string& value : option->results()) {
      if (value.empty()) refuse(option->get_name() + ": the value is empty");
    }
  }
}

// The option of this name; null if the call has none.
const Option* option_of_call(const App& subcommand, std::string_view name) {
  const std::vector<const Option*> options = options_of_call(subcommand);
  const auto found = std::find_if(options.begin(), options.end(),
                                  [&](const Option* option) { return option->get_name() == name; });
  return found == options.end() ? nullptr : *found;
}

// The path in a value that can have more parts.
std::string path_in(std::string_view option, const std::string& value) {
  if (option == "--confidence") return parse_confidence(value).folder;
  return option == "--hazard" ? hazard_file_of(value) : value;
}

std::vector<NamedFile> named_files(const App& subcommand) {
  std::vector<NamedFile> files;
  for (const FileOption& file_option : kFileOptions) {
    const Option* option = option_of_call(subcommand, file_option.name);
    if (option == nullptr) continue;
    for (const std::string& value : option->results()) {
      if (file_option.name == "--sensor" && !is_sensor_file(value)) continue;
      if (file_option.name == "--poses" && is_set_of_poses(value)) continue;
      if (file_option.name == "--hazard" && hazard_file_of(value).empty()) continue;
      if (file_option.name == "--obstacle" && !is_obstacle_file(value)) continue;
      // For runs --report is a switch, and the page is a file of --out.
      if (file_option.name == "--report" && is_run(subcommand)) continue;
      files.push_back({std::string(file_option.name), path_in(file_option.name, value),
                       kind_of(file_option, subcommand.get_name())});
    }
  }
  return files;
}

// Identifies a file independent of its name.
struct Identity {
  fs::path path;
  std::optional<std::pair<dev_t, ino_t>> node{};  // of an existing file

  explicit Identity(const fs::path& given) {
    std::error_code ignored;
    path = fs::weakly_canonical(fs::absolute(given, ignored), ignored);
    struct stat status {};
    if (::stat(given.c_str(), &status) == 0) node = std::pair(status.st_dev, status.st_ino);
  }
  [[nodiscard]] bool is(const Identity& other) const {
    return node && other.node ? *node == *other.node : path == other.path;
  }
};

// The files that a name refers to; for a folder, those in it that are read or replaced.
std::vector<Identity> identities(const NamedFile& file) {
  std::vector<Identity> found{Identity(file.path)};
  std::vector<fs::path> inside;
  if (file.kind == Kind::frames || file.kind == Kind::frames_output)
    inside = frame_files(file.path);
  if (file.kind == Kind::map || file.kind == Kind::run_output || file.kind == Kind::model_output) {
    inside = run_files(file.path);
  }
  if (file.kind == Kind::map) inside.emplace_back("state.vdb");
  if (file.kind == Kind::model_output) {
    inside.insert(inside.end(), {"state.vdb", "next.txt", "next.json"});
  }
  for (const fs::path& name : inside) found.emplace_back(file.path / name);
  if (file.kind == Kind::reach) {
    if (const auto poses = reach_poses_file(file.path)) found.emplace_back(*poses);
  }
  return found;
}

// Whether a file lies in a folder, of which any file may be read.
bool lies_in(const NamedFile& file, const NamedFile& folder) {
  const fs::path inner = Identity(file.path).path, outer = Identity(folder.path).path;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

bool have_a_common_file(const NamedFile& a, const NamedFile& b) {
  if (b.kind == Kind::folder) return lies_in(a, b);
  const std::vector<Identity> of_b = identities(b);
  for (const Identity& file : identities(a)) {
    for (const Identity& other : of_b) {
      if (file.is(other)) return true;
    }
  }
  return false;
}

void check_not_read(const NamedFile& output, const std::vector<NamedFile>& files) {
  if (is_special_file(output.path)) return;  // written to, not replaced
  for (const NamedFile& other : files) {
    const bool is_continued = other.option == "--map";
    if (&other == &output || is_continued || !have_a_common_file(output, other)) continue;
    refuse(output.option, output.path.string(),
           (other.kind == Kind::folder ? "the file must not lie in "
                                       : "the file would overwrite a file of ") +
               other.option + " " + other.path.string());
  }
}

// What is wrong with the ending of an output file, checked before the work; empty if it is valid.
// For maps it is the message of check_map_name().
std::string fault_of_output(const NamedFile& file, const std::string& subcommand) {
  if (file.kind != Kind::output) return "";
  const fs::path& path = file.path;
  if (file.option == "--picture") return fault_of_ending(path, "a picture", {".png"});
  if (file.option == "--report") return fault_of_ending(path, "a report", {".html"});
  if (file.option == "--save-config") return fault_of_ending(path, "a file of flags", {".toml"});
  if (file.option == "--points") return fault_of_ending(path, "a file of points", {".ply"});
  if (subcommand == "render") return fault_of_ending(path, "a picture", {".png"});
  if (subcommand == "surface") return fault_of_ending(path, "a surface", {".ply"});
  if (subcommand == "score") return fault_of_ending(path, "a table", {".csv", ".npy"});
  if (subcommand == "calibrate") return fault_of_ending(path, "a sensor file", {".toml"});
  if (subcommand == "next") return fault_of_poses_name(path);
  return "";
}

}  // namespace

void check_call(const App& subcommand) {
  check_values(subcommand);
  if (const std::string fault = fault_of_folder(subcommand); !fault.empty()) refuse(fault);
  const std::vector<NamedFile> files = named_files(subcommand);
  for (const NamedFile& file : files) {
    if (!is_output(file.kind)) continue;
    if (file.path == "-") {
      refuse(file.option, "-",
             "this is not a file name; to write to the standard output, use /dev/stdout");
    }
    check_not_read(file, files);
    const std::string fault = fault_of_output(file, subcommand.get_name());
    if (!fault.empty()) refuse(file.option, file.path.string(), fault);
  }
  for (const NamedFile& file : files) {
    if (file.kind == Kind::output) {
      const AtomicFile writable(file.path);  // fails now rather than after the work
    }
  }
}

}  // namespace viewgain::app
