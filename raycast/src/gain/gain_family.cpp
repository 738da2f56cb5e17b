// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "viewgain/raycast/gain_family.hpp"

#include <algorithm>
#include <utility>

#include "viewgain/core/error.hpp"

namespace viewgain {
namespace {

class NoGains : public GainFamily {
 public:
  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] std::string_view unit(std::string_view) const override { return ""; }
  [[nodiscard]] std::unique_ptr<FamilyEvaluator> evaluator(std::shared_ptr<const VoxelScene>,
                                                           const BeliefGrid&, const Sensor&,
                                                           std::span<const std::string>,
                                                           const ExecConfig&) const override {
    refuse("no gains are registered; call register_gains() first");
  }

 private:
  std::vector<std::string> names_;
};

std::shared_ptr<const GainFamily>& registered() {
  static std::shared_ptr<const GainFamily> family;
  return family;
}

}  // namespace

void register_gains(std::shared_ptr<const GainFamily> family) { registered() = std::move(family); }

const GainFamily& registered_gains() noexcept {
  static const NoGains none;
  return registered() ? *registered() : none;
}

bool is_registered_gain(std::string_view name) {
  const std::vector<std::string>& names = registered_gains().names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace viewgain
