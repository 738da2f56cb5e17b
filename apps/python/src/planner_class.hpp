// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "map/shared_grid.hpp"
#include "pose_arrays.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::python {

/// Python's planner. A concurrent call raises RuntimeError.
class Planner {
 public:
  Planner(Sensor of, ViewPlanner planner) : sensor_(std::move(of)), planner_(std::move(planner)) {}

  [[nodiscard]] const Sensor& sensor() const noexcept { return sensor_; }
  /// Text for repr(). Does not query a planner that is busy.
  [[nodiscard]] std::string text() const {
    return std::string("<ViewPlanner of ").append(sensor_.name).append(busy_ ? ", at work>" : ">");
  }

  /// Calls f(ViewPlanner&) with the GIL, which f may release.
  template <typename F>
  auto use(const F& f) {
    if (busy_.exchange(true)) {
      throw std::runtime_error("ViewPlanner: another call is running; use one call at a time");
    }
    const Free free{busy_};
    return f(planner_);
  }
  /// As above without the GIL; f must not touch Python.
  template <typename F>
  auto run(const F& f) {
    return use([&](ViewPlanner& planner) {
      const WithoutGil without_gil;
      return f(planner);
    });
  }

 private:
  struct Free {
    std::atomic<bool>& busy;
    ~Free() { busy = false; }
  };

  Sensor sensor_;
  ViewPlanner planner_;
  std::atomic<bool> busy_{false};
};

/// VIEWPOINTSGENERATION by a Python function.
class PythonGeneration : public ViewpointGeneration {
 public:
  /// `scorer` is that of the planner.
  PythonGeneration(py::object callable, std::string name, const ViewScorer& scorer)
      : call_(std::move(callable)), name_(std::move(name)), scorer_(scorer) {}

  Proposal generate(const Pose&) override {
    const auto grid = std::make_shared<SharedGrid>(scorer_.grid().clone());
    const std::vector<Pose> poses =
        with_gil([&] { return pose_list(call_(grid), "the result of the generator"); });
    Proposal proposal;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      proposal.candidates.push_back({poses[i], name_, std::nullopt, i});
    }
    return proposal;
  }

 private:
  PythonCall call_;
  std::string name_;
  const ViewScorer& scorer_;
};

}  // namespace viewgain::python
