// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "command_line/call_files.hpp"
#include "command_line/interrupt.hpp"
#include "commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/version.hpp"

namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

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

// CLI11 says only that there is no subcommand.
std::string explain(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first.empty() || first[0] == '-') return error.what();
  for (const CLI::App* subcommand : program.get_subcommands({})) {
    if (subcommand->get_name() == first) return error.what();
  }
  return first + ": no such subcommand";
}

int run(int argc, char** argv) {
  CLI::App program(
      "viewgain scores camera poses by expected information gain: simulate or read depth frames, "
      "integrate them into a voxel map, score candidate views against it. Units: m, rad, s, nat, "
      "unless said otherwise.",
      "viewgain");
  program.set_version_flag("--version", std::string("viewgain ") + VIEWGAIN_VERSION);
  program.require_subcommand(1);
  const std::vector<viewgain::app::Command> commands{
      viewgain::app::add_simulate(program),    viewgain::app::add_integrate(program),
      viewgain::app::add_score(program),       viewgain::app::add_candidates(program),
      viewgain::app::add_reconstruct(program), viewgain::app::add_info(program),
      viewgain::app::add_convert(program),     viewgain::app::add_render(program)};
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      program.exit(error);  // prints --help or --version
      return end_of_output();
    }
    return report(explain(program, error, argc, argv) + " (see --help)", kBadInput);
  }
  for (const viewgain::app::Command& command : commands) {
    if (!command.app->parsed()) continue;
    viewgain::app::check_call(*command.app);
    command.run();
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
  } catch (const std::bad_alloc&) {
    return report("out of memory", kInternalError);
  } catch (const std::exception& error) {
    return report(std::string("internal error: ") + error.what(), kInternalError);
  }
}
