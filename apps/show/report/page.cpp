// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "show/report/page.hpp"

#include "viewgain/core/error.hpp"
#include "viewgain/support/atomic_file.hpp"

// What viewer/ was bundled to when the program was built (page_bytes.S); empty without npm.
extern "C" const char viewgain_report_page_begin[], viewgain_report_page_end[];

namespace viewgain::app {
namespace {

constexpr std::string_view kPlace = "__VIEWGAIN_DATA__";

std::string_view built_page() {
  return {viewgain_report_page_begin,
          static_cast<std::size_t>(viewgain_report_page_end - viewgain_report_page_begin)};
}

}  // namespace

void check_report_page(std::string_view flag) {
  if (!built_page().empty()) return;
  throw Error(ErrorCode::invalid_argument,
              std::string(flag) +
                  ": this program has no report page, because npm was missing or its registry out "
                  "of reach when it was built (install nodejs and npm, configure and build again)");
}

std::string report_page(const Json& data, std::string_view page) {
  const std::size_t place = page.find(kPlace);
  if (place == std::string_view::npos || page.find(kPlace, place + 1) != std::string_view::npos) {
    throw Error(ErrorCode::format, "the report's page must have " + std::string(kPlace) + " once");
  }
  std::string text(page.substr(0, place));
  // A '<' is text in any JSON string, where it may be written as an escape: so no tag begins.
  for (const char c : dumped(data)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  text += page.substr(place + kPlace.size());
  return text;
}

std::string report_page(const Json& data) { return report_page(data, built_page()); }

void write_report(const std::filesystem::path& path, const Json& data) {
  write_file_atomically(path, report_page(data));
}

}  // namespace viewgain::app
