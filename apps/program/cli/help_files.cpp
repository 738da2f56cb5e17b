// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/help_files.hpp"

#include <string>
#include <system_error>

#include "program/cli/completion.hpp"
#include "program/cli/man_page.hpp"
#include "viewgain/support/atomic_file.hpp"

namespace viewgain::app {

void write_help_files(const App& program, const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::error_code ignored;
    std::filesystem::create_directories((folder / name).parent_path(), ignored);
    write_file_atomically(folder / name, text);  // which says what is wrong
  };
  write("man1/viewgain.1", man_page(program));
  for (const App* subcommand : program.subcommands()) {
    if (subcommand->group_name().empty()) continue;
    write("man1/viewgain-" + subcommand->name() + ".1", subcommand_man_page(*subcommand));
  }
  write("bash-completion/completions/viewgain", bash_completion(program));
  write("zsh/site-functions/_viewgain", zsh_completion(program));
}

}  // namespace viewgain::app
