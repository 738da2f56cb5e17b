// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewgain/core/error.hpp"

// CLI11, which app.cpp alone includes: a source that declares flags compiles in a third of the time
// so.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace viewgain::app {

/// A command line that is not as its App declares it.
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A flag or positional of a subcommand: what declares it, and what others (help, --config) read of
/// it. Lives as long as its App.
class Option {
 public:
  explicit Option(CLI::Option& option) noexcept : option_(&option) {}

  Option* required();
  /// Help shows the value that the variable has now.
  Option* capture_default_str();
  /// One value each time the flag is given, where `yes` is false.
  Option* allow_extra_args(bool yes);
  /// Refuses numbers outside of [least, most]; `what` stands for them in the help. For int,
  /// std::size_t and double.
  template <typename Number>
  Option* range(Number least, Number most, const std::string& what);
  /// `check` returns what is wrong with a value, or nothing, or throws; `shown` stands for the
  /// values in the help.
  Option* check(std::function<std::string(std::string&)> check, const std::string& shown);

  /// It takes one of these names, which help shows; check_one_of() refuses others.
  Option* one_of(const std::vector<std::string>& names, const char* what);
  /// Likewise several of them with commas.
  Option* several_of(const std::vector<std::string>& names, const char* what);
  /// It takes on or off.
  Option* on_or_off();
  /// It takes a seed, with the same bounds in every subcommand, and shows its default.
  Option* takes_seed();

  [[nodiscard]] bool nonpositional() const;
  /// "--voxel", or the name of a positional.
  [[nodiscard]] std::string name() const;
  /// "voxel" of a flag.
  [[nodiscard]] std::string long_name() const;
  [[nodiscard]] std::string description() const;
  /// Of the values: "FLOAT", "TEXT:{on,off}" and so on.
  [[nodiscard]] std::string type_name() const;
  /// What it takes by one_of() or several_of(), else nothing.
  [[nodiscard]] std::vector<std::string> choices() const;
  [[nodiscard]] std::string default_text() const;
  /// Whether it stands alone, without a value.
  [[nodiscard]] bool is_bare() const;
  /// Whether it may be given more than once.
  [[nodiscard]] bool is_repeated() const;
  /// What it was given, as texts.
  [[nodiscard]] const std::vector<std::string>& results() const;
  [[nodiscard]] bool empty() const { return results().empty(); }
  /// For bool, double and std::int64_t.
  template <typename Value>
  [[nodiscard]] Value as() const;

 private:
  CLI::Option* option_;
};

/// A program, one of its subcommands, or a group of options in one.
class App {
 public:
  App(const std::string& description, const std::string& name);
  ~App();
  App(const App&) = delete;
  App& operator=(const App&) = delete;

  App* add_subcommand(const std::string& name, const std::string& description);
  App* add_option_group(const std::string& name, const std::string& description);
  /// Another form of this subcommand, with flags of its own, for the sources that `takes` says yes
  /// to: what stands as the first positional. It is parsed by itself.
  App* add_form(const std::string& description, std::function<bool(const std::string&)> takes);
  /// A flag "--x", or the positional "X", and the variable that it sets; what it holds is the
  /// default. For texts, paths, bool, int, std::size_t, double, and optional or vectors of them.
  template <typename Value>
  Option* add_option(const std::string& name, Value& value, const std::string& description);
  Option* add_flag(const std::string& name, bool& value, const std::string& description);
  void set_version_flag(const std::string& name, const std::string& version);

  /// The heading under which the program's help lists it.
  App* group(const std::string& name);
  App* footer(const std::string& text);
  /// How many of its options, or subcommands, are to be given.
  App* require_option(std::size_t least, std::size_t most);
  App* require_subcommand(std::size_t count);

  /// False where it has printed --help, of all forms for the first, or --version. Throws
  /// UsageError.
  [[nodiscard]] bool parse(std::vector<std::string> words);
  /// Whether it was named.
  [[nodiscard]] bool parsed() const;
  /// How often the option was given.
  [[nodiscard]] std::size_t count(const std::string& name) const;

  [[nodiscard]] std::string name() const;
  [[nodiscard]] std::string description() const;
  [[nodiscard]] bool has_parent() const noexcept { return parent_ != nullptr; }
  /// Whether one of its options may be given at most.
  [[nodiscard]] bool takes_one_option() const;
  /// Subcommands and groups, in the order of their declaration; groups have no name.
  [[nodiscard]] std::vector<const App*> subcommands() const;
  /// Its own, in the order of their declaration; --help, where it has one, is the first.
  [[nodiscard]] std::vector<const Option*> options() const;
  /// Of the subcommand that this is a form of, the first one first; itself where it has no other.
  [[nodiscard]] std::vector<const App*> forms() const;
  /// Whether this, a form, is for such a source.
  [[nodiscard]] bool takes(const std::string& source) const { return takes_ && takes_(source); }
  /// Null where it has none, as groups may.
  [[nodiscard]] const Option* help_option() const noexcept { return help_; }
  /// Null where there is none; of its groups, too.
  [[nodiscard]] const Option* find_option(std::string_view name) const;

 private:
  App(CLI::App& app, App* parent);
  void wrap_help();
  Option* wrapped(CLI::Option* option);

  std::unique_ptr<CLI::App> own_;  // of the program and of forms
  CLI::App* app_;
  App* parent_ = nullptr;
  std::vector<std::unique_ptr<App>> children_;
  App* first_form_ = this;
  std::vector<std::unique_ptr<App>> more_forms_;  // of the first one
  std::function<bool(const std::string&)> takes_;
  std::vector<std::unique_ptr<Option>> options_;
  const Option* help_ = nullptr;
};

}  // namespace viewgain::app
