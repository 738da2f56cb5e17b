// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "program/cli/app.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>

#include "program/cli/values.hpp"

namespace viewgain::app {
namespace {

std::string shown(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "{" : ",").append(name);
  return text + "}";
}

}  // namespace

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::capture_default_str() {
  option_->capture_default_str();
  return this;
}

Option* Option::allow_extra_args(bool yes) {
  option_->allow_extra_args(yes);
  return this;
}

template <typename Number>
Option* Option::range(Number least, Number most, const std::string& what) {
  option_->check(CLI::Range(least, most, what));
  return this;
}
template Option* Option::range(int, int, const std::string&);
template Option* Option::range(std::size_t, std::size_t, const std::string&);
template Option* Option::range(double, double, const std::string&);

Option* Option::check(std::function<std::string(std::string&)> check, const std::string& shown) {
  option_->check(CLI::Validator(std::move(check), shown));
  return this;
}

Option* Option::one_of(const std::vector<std::string>& names, const char* what) {
  return check(
      [flag = name(), names, what](std::string& value) {
        check_one_of(flag, value, names, what);
        return std::string();
      },
      shown(names));
}

Option* Option::several_of(const std::vector<std::string>& names, const char* what) {
  return check(
      [flag = name(), names, what](std::string& value) {
        (void)parse_names(flag, value, names, what);
        return std::string();
      },
      shown(names));
}

Option* Option::on_or_off() { return one_of({"on", "off"}, "position of a switch"); }

Option* Option::takes_seed() {
  return range(std::size_t{0}, std::size_t{1} << 62U, "number")->capture_default_str();
}

std::vector<std::string> Option::choices() const {
  const std::string type = type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  std::vector<std::string> names;
  for (std::size_t at = begin; at < end; at = type.find_first_of(",}", at + 1)) {
    names.push_back(type.substr(at + 1, type.find_first_of(",}", at + 1) - at - 1));
  }
  return names;
}

bool Option::nonpositional() const { return option_->nonpositional(); }
std::string Option::name() const {
  return nonpositional() ? "--" + long_name() : option_->get_name(true);
}
std::string Option::long_name() const { return option_->get_lnames().front(); }
std::string Option::description() const { return option_->get_description(); }
std::string Option::type_name() const { return option_->get_type_name(); }
std::string Option::default_text() const { return option_->get_default_str(); }
bool Option::is_bare() const { return option_->get_items_expected_max() == 0; }
bool Option::is_repeated() const { return option_->get_expected_max() > 1; }
const std::vector<std::string>& Option::results() const { return option_->results(); }

template <typename Value>
Value Option::as() const {
  return option_->as<Value>();
}
template bool Option::as() const;
template double Option::as() const;
template std::int64_t Option::as() const;

App::App(const std::string& description, const std::string& name)
    : own_(std::make_unique<CLI::App>(description, name)), app_(own_.get()) {
  wrap_help();
}

App::App(CLI::App& app, App* parent) : app_(&app), parent_(parent) { wrap_help(); }

void App::wrap_help() {
  if (app_->get_help_ptr() != nullptr) help_ = wrapped(app_->get_help_ptr());
}

App::~App() = default;

Option* App::wrapped(CLI::Option* option) {
  return options_.emplace_back(std::make_unique<Option>(*option)).get();
}

App* App::add_subcommand(const std::string& name, const std::string& description) {
  CLI::App* added = app_->add_subcommand(name, description);
  return children_.emplace_back(new App(*added, this)).get();
}

App* App::add_option_group(const std::string& name, const std::string& description) {
  CLI::App* added = app_->add_option_group(name, description);
  return children_.emplace_back(new App(*added, this)).get();
}

App* App::add_form(const std::string& description, std::function<bool(const std::string&)> takes) {
  App* form = more_forms_.emplace_back(new App(description, "viewgain " + name())).get();
  form->parent_ = parent_;
  form->first_form_ = this;
  form->takes_ = std::move(takes);
  return form;
}

std::vector<const App*> App::forms() const {
  std::vector<const App*> found{first_form_};
  for (const auto& form : first_form_->more_forms_) found.push_back(form.get());
  return found;
}

template <typename Value>
Option* App::add_option(const std::string& name, Value& value, const std::string& description) {
  return wrapped(app_->add_option(name, value, description));
}
template Option* App::add_option(const std::string&, std::string&, const std::string&);
template Option* App::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option* App::add_option(const std::string&, int&, const std::string&);
template Option* App::add_option(const std::string&, std::size_t&, const std::string&);
template Option* App::add_option(const std::string&, double&, const std::string&);
template Option* App::add_option(const std::string&, std::optional<std::string>&,
                                 const std::string&);
template Option* App::add_option(const std::string&, std::optional<int>&, const std::string&);
template Option* App::add_option(const std::string&, std::optional<std::size_t>&,
                                 const std::string&);
template Option* App::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option* App::add_option(const std::string&, std::vector<std::string>&, const std::string&);

Option* App::add_flag(const std::string& name, bool& value, const std::string& description) {
  return wrapped(app_->add_flag(name, value, description));
}

void App::set_version_flag(const std::string& name, const std::string& version) {
  wrapped(app_->set_version_flag(name, version));
}

App* App::group(const std::string& name) {
  app_->group(name);
  return this;
}

App* App::footer(const std::string& text) {
  app_->footer(text);
  return this;
}

App* App::require_option(std::size_t least, std::size_t most) {
  app_->require_option(least, most);
  return this;
}

App* App::require_subcommand(std::size_t count) {
  app_->require_subcommand(static_cast<int>(count));
  return this;
}

bool App::parse(std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    app_->parse(std::move(words));
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != static_cast<int>(CLI::ExitCodes::Success)) {
      throw UsageError(ErrorCode::invalid_argument, error.what());
    }
    app_->exit(error);
    for (const auto& child : children_) {
      for (const auto& form : child->more_forms_) {
        if (child->parsed()) std::cout << "\n" << form->app_->help();
      }
    }
    return false;
  }
}

bool App::parsed() const { return app_->parsed(); }

std::size_t App::count(const std::string& name) const { return app_->count(name); }

std::string App::name() const { return first_form_->app_->get_name(); }
std::string App::description() const { return app_->get_description(); }
bool App::takes_one_option() const { return app_->get_require_option_max() == 1; }

std::vector<const App*> App::subcommands() const {
  std::vector<const App*> found;
  for (const auto& child : children_) found.push_back(child.get());
  return found;
}

std::vector<const Option*> App::options() const {
  std::vector<const Option*> found;
  for (const auto& option : options_) found.push_back(option.get());
  return found;
}

const Option* App::find_option(std::string_view name) const {
  for (const auto& option : options_) {
    if (option->name() == name) return option.get();
  }
  for (const auto& child : children_) {
    if (!child->name().empty()) continue;
    if (const Option* found = child->find_option(name)) return found;
  }
  return nullptr;
}

}  // namespace viewgain::app
