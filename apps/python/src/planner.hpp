// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "gil.hpp"
#include "map/shared_grid.hpp"
#include "python_call.hpp"
#include "viewgain/planner/view_planner.hpp"

namespace viewgain::python {

/// Python's planner: whoever calls it while it is at work is told so.
class Planner {
 public:
  Planner(Sensor of, ViewPlanner planner) : sensor_(std::move(of)), planner_(std::move(planner)) {}

  [[nodiscard]] const Sensor& sensor() const noexcept { return sensor_; }
  /// For people; asks nothing of a planner that is at work.
  [[nodiscard]] std::string text() const {
    return std::string("<ViewPlanner of ").append(sensor_.name).append(busy_ ? ", at work>" : ">");
  }

  /// Calls f(ViewPlanner&); with the GIL, which f may let go.
  template <typename F>
  auto use(const F& f) {
    if (busy_.exchange(true)) {
      throw std::runtime_error("ViewPlanner: one call at a time; another one is at work");
    }
    const Free free{busy_};
    return f(planner_);
  }
  /// The same without the GIL; f must not touch Python.
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

/// VIEWPOINTSGENERATION by a function of Python's.
class PythonGeneration : public ViewpointGeneration {
 public:
  /// The map is its planner's.
  PythonGeneration(py::object callable, std::string name, const MapModel& map)
      : call_(std::move(callable)), name_(std::move(name)), map_(map) {}

  Proposal generate(const Pose&) override {
    const auto grid = std::make_shared<SharedGrid>(map_.grid().clone());
    const std::vector<Pose> poses =
        with_gil([&] { return pose_list(call_(grid), "what the generator returns"); });
    Proposal proposal;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      proposal.candidates.push_back({poses[i], name_, std::nullopt, i});
    }
    return proposal;
  }

 private:
  PythonCall call_;
  std::string name_;
  const MapModel& map_;
};

/// What the class says of itself.
inline constexpr const char* kPlannerDoc =
    R"(Next best views step by step, for a robot's program: frames in, views out.

``add`` a frame; ask ``should_stop``; ``propose`` candidates; ``rank`` them; move, and say how that
went with ``tried``; ``add`` the next frame. One call at a time: while one is at work another raises
RuntimeError.

Parameters
----------
sensor : Sensor
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of what is mapped, the grid's frame [m]. Begin it at the table: what is
    under it stays unknown.
T_world_grid : array_like, (4, 4), optional
    Places the grid's frame; identity unless given.
prior_sigma : float, optional
    Of an unknown voxel [m]; ``default_prior_sigma`` unless given.
support_plane : float, optional
    Height z of the table [m]. Its readings carve but do not hit.
boxes : array_like, (n, 2, 3), optional
    Known obstacles: lowest and highest corners, world frame [m]. They block rays and the body, and
    their readings carve but do not hit.
meshes : iterable of (vertices, triangles), optional
    The same as triangles: (n, 3) [m] and (m, 3) indices.
gain : {"combined", "surface", "paper"}
    What ranks views: expected new surface and refinement, new surface alone, entropy removed.
criterion : {"log_diagonal", "log_determinant", "trace"}
    Of gain "paper" and of entropies; "trace" does not go with gain "combined".
object_size : float, optional
    Longest side of the object [m]; that of what is seen unless given.
reach : ReachRegion, optional
    Where the camera can be put. Its list of poses, if it has one, is among the candidates.
body_size : array_like, (3,), optional
    Width, height, depth of the housing [m]; the sensor's unless given, the SR4000's where it has none.
clearance : float
    Round the body [m].
jump_edges : bool
    Remove flying pixels.
check_feasibility : bool
    False: every candidate is possible but those that were taken or tried.
max_views, idle_views : int
    End after so many views; after so many in a row that changed entropy and unknown voxels by less
    than 0.1 % (0: never).
stop_gain : float, optional
    By gain "paper": end when the best candidate promises less than this per touched voxel [nat, m**2 for
    trace]. Default: 1.2; for trace 0.01 of the first ranking's.
stop_area : float, optional
    By gain "surface" and "combined": end when no candidate promises this share of the surface so
    far as new surface, on the mean of three rankings; 0: never. Default: 0.0016.
state : path-like, optional
    A file of ``save`` to go on from; what ``load`` gives.
num_threads : int
    0: all hardware threads. Never changes a result.

Raises
------
ValueError
    Names the argument. Or the state's map is laid out otherwise.
OSError, Error
    The state cannot be read, or is none.)";

}  // namespace viewgain::python
