// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// The help's examples work; completion says what the help says.
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "apps/program_runner.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/png.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/support/json.hpp"

namespace viewgain {
namespace {

// In an order in which the examples of their help find what they name.
const Strings kSubcommands{"simulate", "import",  "calibrate",   "integrate", "model",
                           "next",     "score",   "reconstruct", "render",    "info",
                           "convert",  "sensors", "surface"};

Strings words_of(const std::string& text) {
  std::istringstream in(text);
  Strings words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class Help : public test::ProgramTest {
 protected:
  // The calls at the end of a help, without the program's name.
  [[nodiscard]] std::vector<Strings> examples(const Strings& subcommand) const {
    Strings arguments = subcommand;
    arguments.emplace_back("--help");
    std::istringstream lines(run_well(arguments));
    std::vector<Strings> calls;
    bool begun = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("Example")) begun = true;
      for (std::string more; line.ends_with(" \\") && std::getline(lines, more);) {
        line.replace(line.size() - 1, 1, more);
      }
      if (!begun || !line.starts_with("  viewgain ")) continue;
      calls.push_back(words_of(line.substr(11)));
    }
    return calls;
  }
  void run_example(const Strings& call) const {
    const test::ProgramResult result = run(call);
    EXPECT_EQ(result.exit_code, 0) << call[0] << ": " << result.err;
    EXPECT_NE(result.out, "") << call[0];
  }

  // 30 frames of an edge before a wall, with noise along and across the rays.
  void write_static_frames() const {
    std::mt19937 random(1);
    std::normal_distribution<double> along(0, 50), across(0, 1);
    fs::create_directories(dir / "static");
    for (int i = 10; i < 40; ++i) {
      GrayImage image{176, 144, {}};
      for (int k = 0; k < 176 * 144; ++k) {
        const double depth = k % 176 + across(random) < 88 ? 8000 : 12000;
        image.pixels.push_back(static_cast<std::uint16_t>(depth + along(random)));
      }
      write_png(dir / ("static/frame-0000" + std::to_string(i) + ".depth.png"), image);
    }
  }

  // What a shell prints for a command; its exit code must be 0.
  [[nodiscard]] std::string shell(const std::string& command) const {
    const std::string all = "cd '" + dir.string() + "' && { " + command + "; } 2>&1";
    FILE* pipe = ::popen(all.c_str(), "r");
    std::string text;
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      text.append(buffer.data(), n);
    }
    EXPECT_EQ(::pclose(pipe), 0) << command << "\n" << text;
    return text;
  }

  // What bash offers for the last of these words.
  [[nodiscard]] std::set<std::string> completions(const Strings& words) const {
    std::string line = "PATH=\"" + fs::path(VIEWGAIN_PROGRAM).parent_path().string() +
                       ":$PATH\" bash -c '. " VIEWGAIN_COMPLETION "; COMP_WORDS=(";
    for (const std::string& word : words) line += " \"" + word + "\"";
    line += "); COMP_CWORD=" + std::to_string(words.size() - 1) +
            "; _viewgain; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
    const Strings found = words_of(shell(line));
    return {found.begin(), found.end()};
  }

  // The flags that a subcommand takes.
  [[nodiscard]] std::set<std::string> flags_in_help(const std::string& subcommand) const {
    // Its own, and those of the program.
    const std::string help = run_well({subcommand, "--help"}) + run_well({"--help"});
    const std::regex option(R"(\n  (--[a-z-]+))");
    std::set<std::string> flags;
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      flags.insert((*it)[1]);
    }
    return flags;
  }
};

TEST_F(Help, GroupsSubcommandsByTaskAndItsExamplesWork) {
  write_cube();
  fs::copy_file(dir / "cube.off", dir / "mesh.off");
  const std::string help = run_well({"--help"});
  std::size_t last = 0;
  for (const char* line :
       {"\nThe whole loop:\n  model ", "\n  reconstruct ", "\nMake a map:\n  simulate ",
        "\n  import ", "\n  calibrate ", "\n  integrate ", "\nChoose views:\n  score ", "\n  next ",
        "\nLook and convert:\n  info ", "\n  surface ", "\n  convert ", "\n  render ",
        "\n  sensors ", "\nExamples:\n  viewgain "}) {
    const std::size_t at = help.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    EXPECT_GT(at + 1, last) << line;
    last = at;
  }
  const std::vector<Strings> calls = examples({});
  ASSERT_EQ(calls.size(), 2U);
  for (const Strings& call : calls) run_example(call);
}

TEST_F(Help, EachSubcommandHasAnExampleThatWorks) {
  write_cube();
  fs::copy_file(dir / "cube.off", dir / "mesh.off");
  write("spec.toml",
        "objects = [\"mesh.off\"]\npolicies = [\"frontier\"]\nseeds = [1]\nsensors = "
        "[\"sr4000\"]\nvoxels = [0.02]\nsizes = [0.3]\nmax_views = 1\n");
  fs::create_directories(dir / "scene");
  write_png(dir / "scene/0.png", GrayImage{640, 480, std::vector<std::uint16_t>(640 * 480, 5000)});
  write("scene/depth.txt", "0 0.png\n");
  write("scene/groundtruth.txt", "0 0 0 0 0 0 0 1\n");
  write_static_frames();
  write("frames/done", "");
  for (const std::string& subcommand : kSubcommands) {
    const std::vector<Strings> calls = examples({subcommand});
    ASSERT_EQ(calls.size(), 1U) << subcommand;
    for (const Strings& call : calls) {
      ASSERT_EQ(call.at(0), subcommand);
      run_example(call);
    }
  }
}

TEST_F(Help, BashCompletesSubcommandsFlagsAndValues) {
  using Set = std::set<std::string>;
  Set subcommands(kSubcommands.begin(), kSubcommands.end());
  subcommands.insert({"--help", "--version", "--json", "--quiet", "--threads", "--trace",
                      "--config", "--save-config"});
  EXPECT_EQ(completions({"viewgain", ""}), subcommands);
  EXPECT_EQ(completions({"viewgain", "--threads", "2", ""}), subcommands);
  EXPECT_EQ(completions({"viewgain", "--json", "score", "--feasible", ""}), (Set{"on", "off"}));
  EXPECT_EQ(completions({"viewgain", "s"}), (Set{"score", "sensors", "simulate", "surface"}));
  for (const std::string& subcommand : kSubcommands) {
    EXPECT_EQ(completions({"viewgain", subcommand, "--"}), flags_in_help(subcommand)) << subcommand;
  }
  const std::vector<std::pair<Strings, Set>> values{
      {{"score", "map.vdb", "--gain", "su"}, {"surface", "surface_frontier_count"}},
      {{"score", "--gain", "=", "c"}, {"combined"}},
      {{"score", "--feasible", ""}, {"on", "off"}},
      {{"reconstruct", "--policy", "f"}, {"frontier", "fibonacci"}},
      // A number or a file's name: bash looks for files.
      {{"score", "--top", ""}, {}},
      {{"score", "m"}, {}}};
  for (const auto& [words, expected] : values) {
    EXPECT_EQ(completions(test::joined({"viewgain"}, words)), expected)
        << words[0] << ' ' << words[1];
  }
}

TEST_F(Help, SensorsAreListedWithTheirFigures) {
  const json listed = json::parse(run_well({"sensors", "--json"}));
  const std::string table = run_well({"sensors"});
  std::size_t cases = 0;
  for (const std::string& name : sensor_preset_names()) {
    const Sensor sensor = sensor_preset(name);
    const json& entry = listed.at(cases);
    EXPECT_EQ(entry.at("name"), name);
    EXPECT_EQ(entry.at("sigma_axial"), sensor.sigmas(sensor.working_distance).axial);
    EXPECT_NE(table.find("\n" + name + " "), std::string::npos);
    EXPECT_EQ(run_well({"sensors", name}), sensor_toml(sensor));
    EXPECT_EQ(json::parse(run_well({"sensors", name, "--json"})), entry);
    ++cases;
  }
  EXPECT_EQ(cases, listed.size());
  EXPECT_EQ(cases, 5U);
  // 176 pixels at a focal length of 220 pixels.
  EXPECT_NEAR(listed[0]["field_of_view"][0].get<double>(), 43.6, 0.05);
  // An own sensor begins from one.
  write("own.toml", run_well({"sensors", "d435"}));
  EXPECT_EQ(run_well({"sensors", "own.toml"}), read("own.toml"));
}

}  // namespace
}  // namespace viewgain
