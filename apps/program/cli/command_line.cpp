// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/command_line.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "program/cli/config_file.hpp"
#include "program/cli/help.hpp"
#include "program/cli/values.hpp"
#include "viewgain/support/text.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

// What does the work of a subcommand or flag that there was once.
struct Successor {
  std::string_view name, now;
};
constexpr std::array kSuccessors{
    Successor{"candidates", "viewgain next MAP --top all --out FILE"},
    Successor{"follow", "viewgain model FRAMES_DIR --watch --out OUT"},
    Successor{"--sphere", "--poses sphere:N,RADIUS"},
    Successor{"--dome", "--poses dome:N,RADIUS"},
    Successor{"--rings", "--poses rings:N,RADIUS"},
    Successor{"--shell", "--poses shell:N,RMIN,RMAX"},
    Successor{"--orbit", "--poses orbit:N,RADIUS,ELEVATION[,START,STEP]"},
    Successor{"--take", "--plan K,M"},
    Successor{"--stop-gain", "--stop gain=LIMIT"},
    Successor{"--stop-area", "--stop area=LIMIT"},
    Successor{"--stop-idle", "--stop idle=LIMIT"},
    Successor{"--stop-promises", "--stop promises=LIMIT"},
    Successor{"--stop-coverage", "--stop coverage=LIMIT"},
    Successor{"--pose-sigma", "--register SIGMA_M,SIGMA_DEG"},
    Successor{"--beside", "--report RUN"},
    Successor{"--flying-pixels", "--noise plain or --noise flying"},
    Successor{"--scale-error", "--noise scale=E"},
    Successor{"--pose-noise", "--noise pose=SIGMA_M/SIGMA_DEG"},
    Successor{"--least-confidence", "--confidence DIR,LEAST"},
    Successor{"--coarsest", "--scales COARSEST[,FINEST]"},
    Successor{"--finest", "--scales COARSEST,FINEST"},
    Successor{"--start", "--from tx,ty,tz,qx,qy,qz,qw"},
    Successor{"--width", "--viewer AZIMUTH,ELEVATION,WIDTH"},
    Successor{"--azimuth", "--viewer AZIMUTH,ELEVATION"},
    Successor{"--elevation", "--viewer AZIMUTH,ELEVATION"},
    Successor{"--min-range", "min_range in a sensor's file"},
    Successor{"--max-range", "max_range in a sensor's file"},
    Successor{"--overlap", "EstimatorConfig::overlap of the library"},
    Successor{"--region-depth", "EstimatorConfig::region_depth of the library"},
    Successor{"--refine", "ScorerConfig::refine of the library"},
    Successor{"--carve", "ScorerConfig::carve of the library"},
    Successor{"--occupancy", "ScorerConfig::occupancy of the library"},
    Successor{"--calibrate-hazard", "ScorerConfig::learn_hazard of the library"},
    Successor{"--what", "viewgain render MAP KIND"},
    Successor{"--hash", "viewgain info MAP --json"},
    Successor{"--region", "--workspace BOX"},
    Successor{"--recenter", "--place center"},
    Successor{"--object-size", "--hazard size=L"},
    Successor{"--with-covariance", "viewgain convert MAP OUT.vdb"},
    Successor{"--stride", "GainConfig::pixel_stride of the library"},
    Successor{"--refinement-weight", "GainConfig::refinement_weight of the library"}};

std::string successor_of(std::string_view name) {
  for (const Successor& successor : kSuccessors) {
    if (successor.name != name) continue;
    return std::string(name) + ": is gone; " + std::string(successor.now) + " does it";
  }
  return {};
}

std::string fault_of_subcommand(const App& program, const std::string& word) {
  std::vector<std::string> names;
  for (const App* subcommand : program.get_subcommands(nullptr)) {
    names.push_back(subcommand->get_name());
  }
  return fault_of_name(word, names, "subcommand");
}

std::string fault_of_flag(const App& called, const std::string& flag) {
  std::vector<std::string> flags;
  for (const Option* option : options_of_call(called)) {
    const std::string name = option->get_name();
    if (option->nonpositional()) flags.push_back(name);
    if (flag == "--" + CLI::detail::to_lower(name)) {  // a positional's
      return flag + ": " + name + " is given without a flag";
    }
  }
  return flag + ": no such flag of " + called.get_name() + did_you_mean(flag, flags);
}

bool is_flag(const std::string& word) {
  return word.size() > 1 && word[0] == '-' &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

// What is wrong with the words that nothing takes; empty: there are none, or the error is another.
std::string fault_of_extras(const App& program, const CLI::ParseError& error) {
  const std::vector<std::string> extras = program.remaining(true);
  const std::vector<App*> called = program.get_subcommands();
  const auto flag = std::find_if(extras.begin(), extras.end(), is_flag);
  const bool is_of_words = error.get_name() == "ExtrasError" || error.get_name() == "RequiredError";
  if (flag == extras.end() && (extras.empty() || !is_of_words)) return {};
  const std::string word = flag == extras.end() ? extras.front() : flag->substr(0, flag->find('='));
  if (const std::string gone = successor_of(word); !gone.empty()) return gone;
  if (called.empty()) {
    return flag == extras.end() ? fault_of_subcommand(program, word) : fault_of_flag(program, word);
  }
  if (flag != extras.end()) return fault_of_flag(*called.front(), word);
  return word + ": is one word more than " + called.front()->get_name() + " takes";
}

}  // namespace

std::unique_ptr<App> make_program(CommonOptions& common) {
  auto program = std::make_unique<App>(
      "viewgain scores camera poses by expected information gain: simulate or read depth frames, "
      "integrate them into a voxel map, score candidate views against it. Units: m, rad, s, nat, "
      "unless said otherwise.",
      "viewgain");
  program->formatter(std::make_shared<HelpFormatter>());
  program->set_help_flag("-h", "the options that most calls need");
  program->set_help_all_flag("--help", "all options");
  program->require_subcommand(1);
  program->fallthrough();
  program->option_defaults()->always_capture_default();
  add_common_options(*program, common);
  program->set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION,
                            "which version this is");
  program
      ->set_config("--config", "",
                   "TOML file: flags without -- and positionals (mesh, map) as keys; what the "
                   "command line says holds")
      ->type_name("FILE");
  program->config_formatter(std::make_shared<FlagFile>(*program));
  return program;
}

const App* parse(App& program, const std::vector<std::string>& words) {
  try {
    program.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 wants them
    return program.get_subcommands().front();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      program.exit(error);
      return nullptr;
    }
    std::string fault = fault_of_extras(program, error);
    if (fault.empty()) fault = error.what();
    const std::vector<App*> called = program.get_subcommands();
    const std::string name = called.empty() ? "" : called.front()->get_name() + " ";
    throw UsageError(ErrorCode::invalid_argument, fault + " (see viewgain " + name + "--help)");
  }
}

}  // namespace viewgain::app
