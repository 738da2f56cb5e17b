// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program_runner.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

namespace viewgain::test {
namespace {

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::vector<std::string> joined(std::vector<std::string> call,
                                const std::vector<std::string>& more) {
  call.insert(call.end(), more.begin(), more.end());
  return call;
}

ProgramTest::ProgramTest() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  dir = fs::temp_directory_path() /
        ("viewgain-apps-" + std::string(info->name()) + "-" + std::to_string(::getpid()));
  fs::create_directories(dir / "work");
  dir /= "work";
}

ProgramTest::~ProgramTest() { fs::remove_all(dir.parent_path()); }

pid_t ProgramTest::start(const std::vector<std::string>& arguments) const {
  return start_into(dir.parent_path() / "stdout", arguments);
}

pid_t ProgramTest::start_into(const fs::path& out,
                              const std::vector<std::string>& arguments) const {
  const fs::path err = dir.parent_path() / "stderr";
  std::vector<char*> argv{const_cast<char*>("viewgain")};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const int in_file = ::open("/dev/null", O_RDONLY);
    const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (in_file >= 0 && out_file >= 0 && err_file >= 0 && ::dup2(in_file, STDIN_FILENO) >= 0 &&
        ::dup2(out_file, STDOUT_FILENO) >= 0 && ::dup2(err_file, STDERR_FILENO) >= 0 &&
        ::chdir(dir.c_str()) == 0) {
      ::execv(VIEWGAIN_PROGRAM, argv.data());
    }
    ::_exit(127);
  }
  return child;
}

ProgramResult ProgramTest::run(const std::vector<std::string>& arguments) const {
  const fs::path out = dir.parent_path() / "stdout";
  ProgramResult result = run_into(out, arguments);
  result.out = read_file(out);
  return result;
}

ProgramResult ProgramTest::run_into(const fs::path& out,
                                    const std::vector<std::string>& arguments) const {
  const pid_t child = start_into(out, arguments);
  ProgramResult result;
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  result.err = read_file(dir.parent_path() / "stderr");
  return result;
}

int ProgramTest::ended_by(const std::vector<std::string>& arguments, int signal,
                          const std::function<bool()>& is_time) const {
  const pid_t child = start(arguments);
  int status = 0;
  while (!is_time()) {
    if (::waitpid(child, &status, WNOHANG) != 0) {
      ADD_FAILURE() << "ended too early: " << status;
      return status;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(::kill(child, signal), 0);
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return status;
}

std::string ProgramTest::run_well(const std::vector<std::string>& arguments) const {
  const ProgramResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << arguments.front() << ": " << result.err;
  EXPECT_EQ(result.err, "") << arguments.front();
  return result.out;
}

bool ProgramTest::has_report_page() {
  std::error_code error;
  const auto size = std::filesystem::file_size(VIEWGAIN_REPORT_PAGE, error);
  return !error && size > 0;
}

void ProgramTest::expect_refused(const std::vector<std::string>& arguments,
                                 const std::string& word) const {
  const auto before = contents();
  const ProgramResult result = run(arguments);
  std::string shown = "viewgain";
  for (const std::string& argument : arguments) shown += ' ' + argument;
  shown += "\n" + result.err;
  EXPECT_EQ(result.exit_code, 2) << shown;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << shown;
  EXPECT_TRUE(result.err.starts_with("viewgain: ")) << shown;
  EXPECT_NE(result.err.find(word), std::string::npos) << word << " is not in " << shown;
  EXPECT_EQ(result.out, "") << shown;
  EXPECT_TRUE(contents() == before) << shown;
}

void ProgramTest::expect_refused(const Refusals& calls) const { expect_refused_with({}, calls); }

void ProgramTest::expect_refused_with(const std::vector<std::string>& call,
                                      const Refusals& flags) const {
  for (const auto& [more, word] : flags) expect_refused(joined(call, more), word);
}

void ProgramTest::write(const std::string& name, const std::string& bytes) const {
  fs::create_directories((dir / name).parent_path());
  std::ofstream(dir / name, std::ios::binary) << bytes;
}

std::string ProgramTest::read(const std::string& name) const { return read_file(dir / name); }

std::vector<std::string> ProgramTest::list(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(dir / name)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::map<std::string, std::string> ProgramTest::contents(const std::string& name) const {
  std::map<std::string, std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(dir / name)) {
    const std::string path = entry.path().lexically_relative(dir / name).string();
    if (entry.is_symlink()) {
      found[path] = "-> " + fs::read_symlink(entry.path()).string();
    } else {
      found[path] = entry.is_directory() ? "a folder" : read_file(entry.path());
    }
  }
  return found;
}

void ProgramTest::write_cube() const {
  write("cube.off",
        "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
        "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
}

void ProgramTest::write_small_sensor() const {
  write("small.toml",
        "name = \"small\"\nmin_range = 0.2\nmax_range = 5.0\nworking_distance = 0.4\n"
        "[camera]\nwidth = 48\nheight = 36\nfx = 60.0\nfy = 60.0\ncx = 23.5\ncy = 17.5\n"
        "[noise]\nmodel = \"quadratic\"\noffset = 0.001\nquadratic = 0.001\n");
}

void ProgramTest::write_half_sensor() const {
  write("tof.toml",
        "name = \"tof\"\nmin_range = 0.2\nmax_range = 5.0\nworking_distance = 0.4\n"
        "[camera]\nwidth = 88\nheight = 72\nfx = 110.0\nfy = 115.6\ncx = 43.5\ncy = 35.5\n"
        "[noise]\nmodel = \"shot\"\nreference_sigma = 0.004\nreference_range = 1.3\n"
        "reference_integration_time = 0.0085\nintegration_time = 0.001\n");
}

void ProgramTest::make_small_run() const {
  write_cube();
  write_half_sensor();
  const ProgramResult made =
      run({"reconstruct", "cube.off", "--sensor", "tof.toml", "--voxel", "0.00625", "--size", "0.2",
           "--max-views", "2", "--pictures", "off", "--out", "run", "--json"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
}

}  // namespace viewgain::test
