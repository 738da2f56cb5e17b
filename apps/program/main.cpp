// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "program/cli/call_files.hpp"
#include "program/cli/config_file.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/words.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/version.hpp"

namespace viewgain::app {
namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;
constexpr int kStopped = 130;  // as shells have it for SIGINT

// One line, whatever a message or a file name holds.
int report(std::string message, int exit_code) {
  wait_if_ended();
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
bool parse(App& program, const std::vector<Command>& commands,
           const std::vector<std::string>& words) {
  const App* subcommand = subcommand_of(program, words);
  if (subcommand == nullptr) {
    if (!words.empty()) (void)sort_words(program, program.options(), {words[0]});
    return program.parse(words);
  }
  const std::vector<std::string> after(words.begin() + 1, words.end());
  const App& form = form_of(*subcommand, after);
  std::vector<std::string> all = with_config(form, after);
  for (const Command& command : commands) {
    if (command.app == &form && &form != subcommand) return command.app->parse(std::move(all));
  }
  all.insert(all.begin(), words[0]);
  return program.parse(std::move(all));
}

int run(int argc, char** argv) {
  App program(
      "viewgain scores camera poses by expected information gain: simulate or read depth frames, "
      "integrate them into a voxel map, score candidate views against it. Units: m, rad, s, nat, "
      "unless said otherwise.",
      "viewgain");
  program.set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION);
  program.require_subcommand(1);
  std::vector<Command> commands;
  for (const auto add : {add_reconstruct, add_simulate, add_import, add_calibrate, add_integrate,
                         add_score, add_candidates, add_next, add_info, add_surface, add_convert,
                         add_render, add_sensors, add_study, add_follow}) {
    commands.push_back(add(program));
    const Command& first = commands.back();
    if (first.add_form) commands.push_back(first.add_form(*first.app));
  }
  program.footer(
      "Examples:\n"
      "  viewgain reconstruct mesh.off --size 0.35 --sensor sr4000 --voxel 0.005 --max-views 3 "
      "--out run\n"
      "  viewgain score run/map.vdb --sphere 2000,0.6 --race --top 3");
  try {
    if (!parse(program, commands, {argv + 1, argv + argc})) return end_of_output();
  } catch (const UsageError& error) {
    return report(std::string(error.what()) + " (see --help)", kBadInput);
  }
  for (const Command& command : commands) {
    if (!command.app->parsed()) continue;
    check_call(*command.app);
    command.run();
    const Option* save = command.app->find_option("--save-config");
    if (save != nullptr && !save->empty()) {
      write_file_atomically(save->results().back(), config_text(*command.app));
    }
  }
  wait_if_ended();
  return end_of_output();
}

// Runs the call; what it throws becomes a line and an exit code.
int guarded_run(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // who reads no more what a call says does not end its work
  try {
    clean_up_when_ended();
    return run(argc, argv);
  } catch (const Error& error) {
    const bool internal = error.code() == ErrorCode::backend;
    return report(error.what(), internal ? kInternalError : kBadInput);
  } catch (const Stopped& stopped) {
    return report(stopped.message, kStopped);
  } catch (const std::bad_alloc&) {
    return report("out of memory", kInternalError);
  } catch (const std::exception& error) {
    return report(std::string("internal error: ") + error.what(), kInternalError);
  }
}

}  // namespace
}  // namespace viewgain::app

int main(int argc, char** argv) { return viewgain::app::guarded_run(argc, argv); }
