// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/call_files.hpp"
#include "program/cli/config_file.hpp"
#include "program/cli/help_files.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/words.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/version.hpp"

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kStopped = 130;  // as shells have it for SIGINT

// One line, whatever a message or a file name holds.
int report(std::string message, int exit_code) {
  viewgain::app::wait_if_ended();
  for (char& c : message) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  std::fprintf(stderr, "viewgain: %s\n", message.c_str());
  return exit_code;
}

// What --help prints through std::cout, all else through stdout.
int end_of_output() {
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report("cannot write to the standard output", kInternalError);
  }
  return 0;
}

// What CLI11 is to parse: the command line, with what a --config stands for.
std::vector<std::string> all_words(const viewgain::app::App& program,
                                   std::vector<std::string> words) {
  const viewgain::app::App* subcommand = viewgain::app::subcommand_of(program, words);
  if (subcommand == nullptr) {
    if (!words.empty()) (void)viewgain::app::sort_words(program, {words[0]});
    return words;
  }
  std::vector<std::string> all =
      viewgain::app::with_config(*subcommand, {words.begin() + 1, words.end()});
  all.insert(all.begin(), words[0]);
  return all;
}

int run(int argc, char** argv) {
  viewgain::app::App program(
      "viewgain scores camera poses by expected information gain: simulate or read depth frames, "
      "integrate them into a voxel map, score candidate views against it. Units: m, rad, s, nat, "
      "unless said otherwise.",
      "viewgain");
  program.set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION);
  program.require_subcommand(1);
  const std::vector<viewgain::app::Command> commands{
      viewgain::app::add_reconstruct(program), viewgain::app::add_simulate(program),
      viewgain::app::add_import(program),      viewgain::app::add_calibrate(program),
      viewgain::app::add_integrate(program),   viewgain::app::add_score(program),
      viewgain::app::add_candidates(program),  viewgain::app::add_next(program),
      viewgain::app::add_info(program),        viewgain::app::add_surface(program),
      viewgain::app::add_convert(program),     viewgain::app::add_render(program),
      viewgain::app::add_sensors(program),     viewgain::app::add_study(program),
      viewgain::app::add_follow(program),      viewgain::app::add_merge(program)};
  // For the build alone.
  std::string help_folder;
  viewgain::app::App* help_files =
      program.add_subcommand("help-files", "man pages and completion")->group("");
  help_files->add_option("FOLDER", help_folder, "folder to write")->required();
  program.footer(
      "Examples:\n"
      "  viewgain reconstruct mesh.off --size 0.35 --sensor sr4000 --voxel 0.005 --max-views 3 "
      "--out run\n"
      "  viewgain score run/map.vdb --sphere 2000,0.6 --race --top 3");
  std::vector<std::string> words = all_words(program, {argv + 1, argv + argc});
  try {
    if (!program.parse(std::move(words))) return end_of_output();
  } catch (const viewgain::app::UsageError& error) {
    return report(std::string(error.what()) + " (see --help)", kBadInput);
  }
  if (help_files->parsed()) viewgain::app::write_help_files(program, help_folder);
  for (const viewgain::app::Command& command : commands) {
    if (!command.app->parsed()) continue;
    viewgain::app::check_call(*command.app);
    command.run();
    const viewgain::app::Option* save = command.app->find_option("--save-config");
    if (save != nullptr && !save->empty()) {
      viewgain::write_file_atomically(save->results().back(),
                                      viewgain::app::config_text(*command.app));
    }
  }
  viewgain::app::wait_if_ended();
  return end_of_output();
}

}  // namespace

int main(int argc, char** argv) {
  viewgain::app::clean_up_when_ended();
  try {
    return run(argc, argv);
  } catch (const viewgain::Error& error) {
    const bool internal = error.code() == viewgain::ErrorCode::backend;
    return report(error.what(), internal ? kInternalError : kBadInput);
  } catch (const viewgain::app::Stopped& stopped) {
    return report(stopped.message, kStopped);
  } catch (const std::bad_alloc&) {
    return report("out of memory", kInternalError);
  } catch (const std::exception& error) {
    return report(std::string("internal error: ") + error.what(), kInternalError);
  }
}
