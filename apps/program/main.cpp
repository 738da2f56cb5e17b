// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "program/cli/call_files.hpp"
#include "program/cli/command_line.hpp"
#include "program/cli/config_file.hpp"
#include "program/cli/interrupt.hpp"
#include "program/cli/values.hpp"
#include "program/commands/commands.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/literature/classic_gains.hpp"
#include "viewgain/support/atomic_file.hpp"
#include "viewgain/support/file_bytes.hpp"

namespace viewgain::app {
namespace {

constexpr int kInternalError = 1;
constexpr int kBadInput = 2;

// At most one thread reports why the program ends; others wait for the end.
std::atomic_flag is_reported = ATOMIC_FLAG_INIT;

// Prints one line, whatever a message or a file name contains.
int report(std::string message, int exit_code) {
  wait_if_ended();
  while (is_reported.test_and_set()) ::pause();
  std::fprintf(stderr, "viewgain: %s\n", printable(std::move(message)).c_str());
  return exit_code;
}

// Flushes both: --help prints to std::cout, everything else to stdout.
int end_of_output() {
  if (!std::cout.flush() || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report("cannot write to the standard output", kInternalError);
  }
  return 0;
}

int run(int argc, char** argv) {
  CommonOptions common;
  const std::unique_ptr<App> program = make_program(common);
  std::vector<Command> commands;
  for (const auto add :
       {add_model, add_reconstruct, add_simulate, add_import, add_calibrate, add_integrate,
        add_score, add_next, add_info, add_surface, add_convert, add_render, add_sensors}) {
    commands.push_back(add(*program));
  }
  program->footer(
      "Examples:\n"
      "  viewgain reconstruct mesh.off --size 0.35 --sensor sr4000 --voxel 0.005 --max-views 3 "
      "--out run\n"
      "  viewgain score run/map.vdb --poses sphere:2000,0.6 --race --top 3");
  const App* called = nullptr;
  try {
    called = parse(*program, {argv + 1, argv + argc});
  } catch (const UsageError& error) {
    return report(error.what(), kBadInput);
  }
  if (called == nullptr) return end_of_output();
  check_call(*called);
  for (const Command& command : commands) {
    if (command.app == called) command.run(common);
  }
  if (!common.save_config.empty()) {
    write_file_atomically(common.save_config, config_text(*called));
  }
  wait_if_ended();
  return end_of_output();
}

// Ends the program when memory has run out. Does not use exit(), because threads of libraries may
// be in any state.
[[noreturn]] void leave(int exit_code) {
  (void)std::fflush(stdout);
  std::_Exit(exit_code);
}

// For std::terminate(), which TBB calls on one of its threads if it cannot start another.
[[noreturn]] void end_in_one_line() {
  if (is_reported.test_and_set()) {
    ::sleep(1);  // another thread reports
    std::_Exit(kInternalError);
  }
  try {
    if (std::current_exception()) throw;
    std::fputs("viewgain: internal error\n", stderr);
  } catch (const std::bad_alloc&) {
    std::fputs("viewgain: out of memory\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "viewgain: internal error: %s\n", error.what());
  } catch (...) {
    std::fputs("viewgain: internal error\n", stderr);
  }
  remove_unfinished_files();
  std::_Exit(kInternalError);
}

// Runs the call, and turns exceptions into a message and an exit code.
int guarded_run(int argc, char** argv) {
  std::set_terminate(end_in_one_line);
  std::signal(SIGXFSZ, SIG_IGN);  // a write past the limit then fails with a message
  std::signal(SIGPIPE, SIG_IGN);  // a closed output pipe does not end the work
  try {
    clean_up_when_ended();
    keep_bytes_of_pipes();  // --poses <(...)
    register_gains(literature_gains());
    return run(argc, argv);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::backend) leave(report(error.what(), kInternalError));
    return report(error.what(), kBadInput);
  } catch (const std::bad_alloc&) {
    leave(report("out of memory", kInternalError));
  } catch (const std::system_error& error) {
    const bool of_thread = error.code() == std::errc::resource_unavailable_try_again;
    const std::string what = of_thread ? "cannot start a thread" : "internal error";
    leave(report(what + ": " + error.what(), kInternalError));
  } catch (const std::exception& error) {
    return report(std::string("internal error: ") + error.what(), kInternalError);
  }
}

}  // namespace
}  // namespace viewgain::app

int main(int argc, char** argv) { return viewgain::app::guarded_run(argc, argv); }
