// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0

// Names and units of the classic gains.
#include <algorithm>
#include <array>

#include "viewgain/core/error.hpp"
#include "viewgain/literature/classic_gains.hpp"

namespace viewgain {
namespace {

std::size_t parse(std::string_view name, const std::vector<std::string>& names, const char* what) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string text("unknown ");
  text.append(what).append(" \"").append(name).append("\"; valid are");
  for (const std::string& valid : names) text.append(" ").append(valid);
  throw Error(ErrorCode::invalid_argument, text);
}

}  // namespace

const std::vector<std::string>& classic_gain_names() {
  static const std::vector<std::string> names{
      "occlusion_aware",   "unobserved_voxel",      "average_entropy", "rear_side_voxel",
      "rear_side_entropy", "proximity_count",       "area_factor",     "unknown_volume",
      "unknown_count",     "surface_frontier_count"};
  return names;
}
std::string_view classic_gain_name(ClassicGain gain) {
  return classic_gain_names().at(static_cast<std::size_t>(gain));
}
ClassicGain parse_classic_gain(std::string_view name) {
  return static_cast<ClassicGain>(parse(name, classic_gain_names(), "classic gain"));
}
std::string_view classic_gain_unit(ClassicGain gain) {
  static constexpr std::array<std::string_view, 10> kUnits{
      "nat", "nat", "nat", "rays", "nat", "voxels", "1", "m^3", "voxels", "voxels"};
  return kUnits.at(static_cast<std::size_t>(gain));
}
bool needs_occlusion(ClassicGain gain) {
  return gain == ClassicGain::proximity_count || gain == ClassicGain::area_factor;
}

const std::vector<std::string>& gain_semantics_names() {
  static const std::vector<std::string> names{"paper", "shipped"};
  return names;
}
std::string_view gain_semantics_name(GainSemantics semantics) {
  return gain_semantics_names().at(static_cast<std::size_t>(semantics));
}
GainSemantics parse_gain_semantics(std::string_view name) {
  return static_cast<GainSemantics>(parse(name, gain_semantics_names(), "semantics"));
}

}  // namespace viewgain
