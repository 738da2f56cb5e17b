// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace viewgain {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;
using Strings = std::vector<std::string>;
}  // namespace viewgain

namespace viewgain::test {

/// What the program viewgain said.
struct ProgramResult {
  int exit_code = -1;  ///< -1: it did not end by itself
  std::string out;
  std::string err;
};

/// Calls, and what the message that refuses each must have.
using Refusals = std::vector<std::pair<std::vector<std::string>, std::string>>;

/// One call's words and more.
[[nodiscard]] std::vector<std::string> joined(std::vector<std::string> call,
                                              const std::vector<std::string>& more);

/// A test in an empty folder of its own that can run the built program as a user would.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// Runs viewgain with these arguments, the test's folder as working directory.
  [[nodiscard]] ProgramResult run(const std::vector<std::string>& arguments) const;

  /// As run(), with this file as standard output; `out` of the result is empty.
  [[nodiscard]] ProgramResult run_into(const std::filesystem::path& out,
                                       const std::vector<std::string>& arguments) const;

  /// Starts viewgain as run() does and does not wait for it; returns the process's number.
  [[nodiscard]] pid_t start(const std::vector<std::string>& arguments) const;

  /// Starts viewgain and sends it the signal as soon as `is_time`; fails the test if it ended
  /// before. Returns how it ended, as waitpid() says it.
  int ended_by(const std::vector<std::string>& arguments, int signal,
               const std::function<bool()>& is_time) const;

  /// As run(), and fails the test unless the exit code is 0 and stderr empty. Returns stdout.
  std::string run_well(const std::vector<std::string>& arguments) const;
  /// Whether the program was built with npm at hand, and so can write reports.
  [[nodiscard]] static bool has_report_page();

  /// The call ends with 2, one line on stderr that has the word, nothing on stdout, and every byte
  /// as it was.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& word) const;
  void expect_refused(const Refusals& calls) const;
  /// Each of these flags at the end of a call.
  void expect_refused_with(const std::vector<std::string>& call, const Refusals& flags) const;

  void write(const std::string& name, const std::string& bytes) const;
  [[nodiscard]] std::string read(const std::string& name) const;

  /// Names in the folder (of its subfolder `name`), sorted, hidden ones too.
  [[nodiscard]] std::vector<std::string> list(const std::string& name = ".") const;

  /// Everything in the folder by its path: a file's bytes, where a link goes; hidden ones too.
  [[nodiscard]] std::map<std::string, std::string> contents(const std::string& name = ".") const;

  /// A cube of side 2 round (1, 1, 1) with quadrilateral faces: cube.off.
  void write_cube() const;

  /// A sensor of 48x36 px: small.toml.
  void write_small_sensor() const;

  /// An SR4000 at half its resolution: tof.toml.
  void write_half_sensor() const;

  /// Two views of a cube of 0.2 m by the half sensor: run/, with cube.off and tof.toml beside it.
  void make_small_run() const;

  std::filesystem::path dir;

 private:
  [[nodiscard]] pid_t start_into(const std::filesystem::path& out,
                                 const std::vector<std::string>& arguments) const;
};

}  // namespace viewgain::test
