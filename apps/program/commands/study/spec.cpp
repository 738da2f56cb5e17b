// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/commands/study/spec.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "program/cli/flags/gain_names.hpp"
#include "program/cli/flags/scene_sources.hpp"
#include "program/cli/values.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/planner_mesh/truth.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/hash64.hpp"
#include "viewgain/support/toml_table.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

namespace fs = std::filesystem;
constexpr int kStudyRunFormat = 4;  // of run.json; grows when that changes
constexpr std::size_t kMostRuns = 1'000'000;
constexpr std::int64_t kMostViews = 1000, kMostCandidates = 100'000;

// The elements of a list that must not be empty.
const toml::array& list_of(TableReader& reader, const char* key) {
  const toml::array* list = reader.require(key).as_array();
  if (list == nullptr || list->empty()) reader.fail(key, "must be a list that is not empty");
  return *list;
}

template <typename Value>
void add_once(TableReader& reader, const char* key, std::vector<Value>& values, const Value& value,
              const std::string& said) {
  if (std::find(values.begin(), values.end(), value) != values.end()) {
    reader.fail(key, "holds " + said + " twice");
  }
  values.push_back(value);
}

std::vector<std::string> texts(TableReader& reader, const char* key) {
  std::vector<std::string> values;
  for (const toml::node& node : list_of(reader, key)) {
    const auto* text = node.as_string();
    if (text == nullptr || text->get().empty()) reader.fail(key, "must be a list of texts");
    add_once(reader, key, values, text->get(), "\"" + text->get() + "\"");
  }
  return values;
}

std::vector<double> lengths(TableReader& reader, const char* key) {
  std::vector<double> values;
  for (const toml::node& node : list_of(reader, key)) {
    const double value = reader.number_of(node, key);
    if (!(value > 0)) reader.fail(key, "must be a list of positive numbers [m]");
    add_once(reader, key, values, value, "a number");
  }
  return values;
}

std::int64_t whole_number(TableReader& reader, const toml::node& node, const char* key,
                          std::int64_t least, std::int64_t most) {
  const auto* number = node.as_integer();
  if (number != nullptr && number->get() >= least && number->get() <= most) return number->get();
  reader.fail(key, "must be whole, in " + std::to_string(least) + ".." + std::to_string(most));
}

std::vector<std::int64_t> whole_numbers(TableReader& reader, const char* key, std::int64_t least,
                                        std::int64_t most) {
  std::vector<std::int64_t> values;
  for (const toml::node& node : list_of(reader, key)) {
    const std::int64_t value = whole_number(reader, node, key, least, most);
    add_once(reader, key, values, value, std::to_string(value));
  }
  return values;
}

bool is_count(const std::string& text) {
  return !text.empty() && text.size() <= 4 && text.front() != '0' &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

// "tour:K:M": K views are planned, M of them taken before it is planned anew.
StudyPolicy tour_of(TableReader& reader, const std::string& name) {
  StudyPolicy policy{name, name, "", "", ""};
  const std::string counts = name.substr(name.find(':') + 1);
  const std::size_t between = counts.find(':');
  policy.plan = counts.substr(0, between);
  policy.take = between == std::string::npos ? "" : counts.substr(between + 1);
  const bool is_right = is_count(policy.plan) && is_count(policy.take) &&
                        std::stoul(policy.plan) >= 2 && std::stoul(policy.plan) <= 1000 &&
                        std::stoul(policy.take) <= std::stoul(policy.plan);
  if (is_right) return policy;
  reader.fail("policies", "holds \"" + name +
                              "\"; a tour is \"tour:K:M\", K of 2 to 1000 views planned, M of them "
                              "taken before it is planned anew");
}

// "gain:GAIN", "tour:K:M" or another policy. `reconstruct` knows which names there are.
StudyPolicy policy_of(TableReader& reader, const std::string& name) {
  if (name == "tour" || name.starts_with("tour:")) return tour_of(reader, name);
  StudyPolicy policy{name, name, "", "", ""};
  if (const std::size_t first = name.find(':'); first != std::string::npos) {
    policy.policy = name.substr(0, first);
    policy.gain = name.substr(first + 1);
  }
  const bool by_gain = policy.policy == "gain";
  const std::vector<std::string> gains = all_gain_names();
  if (std::find(gains.begin(), gains.end(), policy.policy) != gains.end()) {
    reader.fail("policies",
                "holds \"" + name + "\", a gain; as a policy it is \"gain:" + name + "\"");
  }
  if (by_gain == policy.gain.empty() || name.ends_with(':')) {
    reader.fail("policies", "holds \"" + name +
                                "\"; a policy is \"gain:NAME\" (\"gain:combined\") or another one "
                                "of reconstruct's (\"frontier\")");
  }
  if (by_gain) {
    const std::string fault = fault_of_name(policy.gain, gains, "gain");
    if (!fault.empty()) reader.fail("policies", "holds \"" + name + "\": " + fault);
  }
  return policy;
}

std::vector<StudyObject> objects_of(TableReader& reader, const fs::path& folder) {
  std::vector<StudyObject> objects;
  std::set<std::string> names;
  for (const std::string& file : texts(reader, "objects")) {
    StudyObject object{fs::path(file).stem().string(), (folder / file).lexically_normal()};
    if (!fs::is_regular_file(object.mesh)) {
      reader.fail("objects", "holds \"" + file + "\": no file at " + object.mesh.string());
    }
    if (printable(object.name) != object.name) {
      reader.fail("objects", "holds \"" + file + "\", a name that a table cannot show");
    }
    if (!names.insert(object.name).second) {
      reader.fail("objects", "holds two objects of the name \"" + object.name + "\"");
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

// What a run is asked by the study itself.
const std::set<std::string>& own_flags() {
  static const std::set<std::string> flags{
      "--sensor",  "--voxel",     "--size",     "--seed",   "--policy",      "--gain",
      "--out",     "--max-views", "--pictures", "--report", "--save-maps",   "--plan",
      "--threads", "--json",      "--quiet",    "--config", "--save-config", "--tolerance"};
  return flags;
}

std::vector<std::string> flags_of(TableReader& reader) {
  if (reader.find("flags") == nullptr) return {};
  std::vector<std::string> flags;
  for (const toml::node& node : list_of(reader, "flags")) {
    const auto* text = node.as_string();
    if (text == nullptr || !text->get().starts_with("--") || text->get().size() < 3) {
      reader.fail("flags", "must be a list of texts like \"--up=y\"");
    }
    const std::string flag = text->get().substr(0, text->get().find('='));
    if (own_flags().contains(flag)) {
      reader.fail("flags", "holds " + flag + ", which the study sets itself");
    }
    if (flag == "--help") reader.fail("flags", "holds --help, which is no setting of a run");
    flags.push_back(text->get());
  }
  return flags;
}

// By its contents.
std::string identity_of(const fs::path& file) { return "file " + hash_of(file_bytes(file)); }

// Files that flags name, each by its contents.
std::string identity_of_flag(const std::string& flag) {
  const std::string name = flag.substr(0, flag.find('='));
  const std::string value = flag.substr(std::min(flag.size(), name.size() + 1));
  if (name == "--reach") {
    const auto poses = reach_poses_file(value);
    return name + "=" + identity_of(value) + (poses ? " " + identity_of(*poses) : "");
  }
  const bool is_file = name == "--poses" ||
                       (name == "--hazard" && !hazard_file_of(value).empty()) ||
                       (name == "--obstacle" && is_obstacle_file(value));
  return is_file ? name + "=" + identity_of(value) : flag;
}

// The policy that a key names.
std::size_t policy_at(TableReader& reader, const char* key, const StudySpec& spec) {
  const std::string name = reader.text(key);
  const auto found = std::find_if(spec.policies.begin(), spec.policies.end(),
                                  [&](const StudyPolicy& policy) { return policy.name == name; });
  if (found == spec.policies.end()) reader.fail(key, "is none of the policies");
  return static_cast<std::size_t>(found - spec.policies.begin());
}

}  // namespace

StudySpec read_study_spec(const fs::path& path) {
  const toml::table table = read_toml(path);
  TableReader reader(table, path.string(), "");
  const fs::path folder = path.parent_path();
  StudySpec spec;
  spec.objects = objects_of(reader, folder);
  for (const std::string& name : texts(reader, "policies")) {
    spec.policies.push_back(policy_of(reader, name));
  }
  const std::vector<std::int64_t> seeds = whole_numbers(reader, "seeds", 0, INT64_MAX);
  std::vector<std::string> sensors = texts(reader, "sensors");
  for (std::string& sensor : sensors) {
    if (is_sensor_file(sensor)) sensor = (folder / sensor).lexically_normal().string();
    try {
      (void)load_sensor(sensor);  // refuses what is none, before the first run
    } catch (const Error& error) {
      reader.fail("sensors", error.what());
    }
  }
  const std::vector<double> voxels = lengths(reader, "voxels");
  std::vector<std::optional<double>> sizes;
  if (reader.find("sizes") != nullptr) {
    for (const double size : lengths(reader, "sizes")) sizes.emplace_back(size);
  } else {
    sizes.emplace_back();
  }
  spec.max_views = static_cast<std::size_t>(
      whole_number(reader, reader.require("max_views"), "max_views", 1, kMostViews));
  spec.flags = flags_of(reader);
  spec.tolerance = covered_within(*std::max_element(voxels.begin(), voxels.end()));
  if (reader.find("tolerance") != nullptr) {
    spec.tolerance = reader.number("tolerance");
    if (!(spec.tolerance > 0)) reader.fail("tolerance", "must be a positive number [m]");
  }
  if (reader.find("kept_candidates") != nullptr) {
    spec.kept_candidates = static_cast<std::size_t>(whole_number(
        reader, reader.require("kept_candidates"), "kept_candidates", 1, kMostCandidates));
  }
  if (reader.find("against") != nullptr) spec.against = policy_at(reader, "against", spec);
  reader.refuse_unknown_keys();

  const std::size_t count = spec.objects.size() * spec.policies.size() * seeds.size() *
                            sensors.size() * voxels.size() * sizes.size();
  if (count > kMostRuns) {
    reader.fail("seeds", "make " + with_commas(count) + " runs with the other lists; " +
                             with_commas(kMostRuns) + " at most");
  }
  std::vector<std::string> meshes;
  for (const StudyObject& object : spec.objects) meshes.push_back(identity_of(object.mesh));
  std::vector<std::string> flags;
  for (const std::string& flag : spec.flags) flags.push_back(identity_of_flag(flag));
  for (const std::string& sensor : sensors) {
    for (const double voxel : voxels) {
      for (const std::optional<double>& size : sizes) {
        for (std::size_t object = 0; object < spec.objects.size(); ++object) {
          for (const std::int64_t seed : seeds) {
            for (std::size_t policy = 0; policy < spec.policies.size(); ++policy) {
              StudyRun run{object, policy, static_cast<std::uint64_t>(seed), sensor, voxel, size,
                           {},     {}};
              run.configuration = {
                  {"version", VIEWGAIN_VERSION},
                  {"format", kStudyRunFormat},
                  {"object", spec.objects[object].name},
                  {"mesh", meshes[object]},
                  {"policy", spec.policies[policy].name},
                  {"seed", seed},
                  {"sensor", is_sensor_file(sensor) ? identity_of(sensor) : sensor},
                  {"voxel", voxel},
                  {"size", size},
                  {"max_views", spec.max_views},
                  {"tolerance", spec.tolerance},
                  {"flags", flags},
                  {"kept_candidates", spec.kept_candidates}};
              run.hash = hash_of(dumped(run.configuration));
              spec.runs.push_back(std::move(run));
            }
          }
        }
      }
    }
  }
  return spec;
}

std::vector<std::string> reconstruct_words(const StudySpec& spec, const StudyRun& run) {
  const StudyPolicy& policy = spec.policies[run.policy];
  std::vector<std::string> words{"--sensor=" + run.sensor,
                                 "--voxel=" + short_text(run.voxel),
                                 "--seed=" + std::to_string(run.seed),
                                 "--max-views=" + std::to_string(spec.max_views),
                                 "--tolerance=" + short_text(spec.tolerance),
                                 "--policy=" + (policy.plan.empty() ? policy.policy : "gain"),
                                 "--out=unused"};
  if (!policy.gain.empty()) words.push_back("--gain=" + policy.gain);
  if (!policy.plan.empty()) words.push_back("--plan=" + policy.plan + "," + policy.take);
  if (run.size) words.push_back("--size=" + short_text(*run.size));
  // Every policy has the whole budget, unless the spec says otherwise.
  std::string stop = "--stop=gain=0,area=0,idle=0,promises=0";
  for (const std::string& flag : spec.flags) {
    if (flag.starts_with("--stop=")) {
      stop += "," + flag.substr(7);
    } else {
      words.push_back(flag);
    }
  }
  words.push_back(stop);
  words.insert(words.end(), {"--", spec.objects[run.object].mesh.string()});
  return words;
}

std::string name_of(const StudySpec& spec, const StudyRun& run) {
  std::string name = spec.objects[run.object].name + ", " + spec.policies[run.policy].name +
                     ", seed " + std::to_string(run.seed);
  const auto differs = [&](auto member) {
    return std::any_of(spec.runs.begin(), spec.runs.end(), [&](const StudyRun& other) {
      return other.*member != spec.runs.front().*member;
    });
  };
  if (differs(&StudyRun::sensor)) name.append(", ").append(run.sensor);
  if (differs(&StudyRun::voxel)) name.append(", voxel ").append(short_text(run.voxel));
  if (differs(&StudyRun::size)) name.append(", size ").append(short_text(run.size.value_or(0)));
  return name;
}

}  // namespace viewgain::app
