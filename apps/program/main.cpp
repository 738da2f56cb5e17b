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

// Parses the command line, with what a --config stands for. False where that printed a help.
bool parse(viewgain::app::App& program, const std::vector<viewgain::app::Command>& commands,
           const std::vector<std::string>& words) {
  const viewgain::app::App* subcommand = viewgain::app::subcommand_of(program, words);
  if (subcommand == nullptr) {
    if (!words.empty()) (void)viewgain::app::sort_words(program, program.options(), {words[0]});
    return program.parse(words);
  }
  const std::vector<std::string> after(words.begin() + 1, words.end());
  const viewgain::app::App& form = viewgain::app::form_of(*subcommand, after);
  std::vector<std::string> all = viewgain::app::with_config(form, after);
  for (const viewgain::app::Command& command : commands) {
    if (command.app == &form && &form != subcommand) return command.app->parse(std::move(all));
  }
  all.insert(all.begin(), words[0]);
  return program.parse(std::move(all));
}

int run(int argc, char** argv) {
  viewgain::app::App program(
      "viewgain scores camera poses by expected information gain: simulate or read depth frames, "
      "integrate them into a voxel map, score candidate views against it. Units: m, rad, s, nat, "
      "unless said otherwise.",
      "viewgain");
  program.set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION);
  program.require_subcommand(1);
  std::vector<viewgain::app::Command> commands;
  for (const auto add :
       {viewgain::app::add_reconstruct, viewgain::app::add_simulate, viewgain::app::add_import,
        viewgain::app::add_calibrate, viewgain::app::add_integrate, viewgain::app::add_score,
        viewgain::app::add_candidates, viewgain::app::add_next, viewgain::app::add_info,
        viewgain::app::add_surface, viewgain::app::add_convert, viewgain::app::add_render,
        viewgain::app::add_sensors, viewgain::app::add_study, viewgain::app::add_follow,
        viewgain::app::add_merge}) {
    commands.push_back(add(program));
    const viewgain::app::Command& first = commands.back();
    if (first.add_form) commands.push_back(first.add_form(*first.app));
  }
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
  try {
    if (!parse(program, commands, {argv + 1, argv + argc})) return end_of_output();
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
