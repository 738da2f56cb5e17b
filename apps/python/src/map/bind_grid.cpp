// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "grid_class.hpp"
#include "pose_arrays.hpp"
#include "shared_grid.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/grid/fused_points.hpp"

namespace viewgain::python {

/// A row of BeliefGrid.beliefs().
struct BeliefRow {
  std::array<std::int32_t, 3> voxel;
  std::uint32_t hits;
  std::array<float, 6> information;
  std::array<float, 3> information_vector;
};

/// A row of BeliefGrid.points().
struct PointRow {
  std::array<double, 3> position;
  std::array<double, 6> covariance;
  std::array<double, 3> toward_free;
  std::uint32_t hits;
};

namespace {

std::shared_ptr<SharedGrid> from_labels(const py::object& labels, double voxel_size,
                                        const py::object& origin, const py::object& T_world_grid,
                                        std::optional<double> prior_sigma,
                                        const GivenOrNone<Sensor>& sensor) {
  const py::array any = any_labels(labels);
  GridConfig config;
  config.voxel_size = voxel_size;
  config.prior_sigma = prior_of(prior_sigma, sensor.value, voxel_size);
  // The corner of the array is on the lattice.
  config.T_world_grid = T_world_grid.is_none()
                            ? Pose(Eigen::Matrix3d::Identity(), vector3(origin, "origin"))
                            : one_pose(T_world_grid, "T_world_grid");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    config.workspace.min[axis] = 0;
    config.workspace.max[axis] =
        static_cast<double>(any.shape(static_cast<py::ssize_t>(axis))) * voxel_size;
  }
  static_cast<void>(BeliefGrid(config));  // throws before a copy that is too large
  require_states(any);
  const Labels array(any);
  const std::span states(array.data(), static_cast<std::size_t>(array.size()));
  const WithoutGil without_gil;
  return std::make_shared<SharedGrid>(BeliefGrid::from_states(config, states));
}

std::uint64_t update_box(SharedGrid& grid, const std::array<std::int32_t, 3>& first,
                         const py::object& labels) {
  const py::array any = any_labels(labels);
  if (any.size() > 0) require_states(any);
  const Labels array(any);
  const auto edge = [&](py::ssize_t axis) { return static_cast<std::int32_t>(any.shape(axis)); };
  const Index3 low{first[0], first[1], first[2]};
  const VoxelBox box = VoxelBox::from_dims(low, {edge(0), edge(1), edge(2)});
  const std::span states(array.data(), static_cast<std::size_t>(array.size()));
  std::uint64_t count = 0;
  grid.write([&](BeliefGrid& g) { count = g.update_box(box, states); });
  return count;
}

std::shared_ptr<SharedGrid> clone_of(const SharedGrid& grid) {
  return grid.read([](const BeliefGrid& g) { return std::make_shared<SharedGrid>(g.clone()); });
}

py::array_t<std::uint8_t> states_of(const SharedGrid& grid) {
  const Index3 dims = grid.layout().dims();
  py::array_t<std::uint8_t> states(Shape{dims.x, dims.y, dims.z});
  const std::span out(states.mutable_data(), static_cast<std::size_t>(states.size()));
  grid.read([&](const BeliefGrid& g) { g.copy_states(out); });
  return states;
}

std::vector<BeliefRow> belief_rows(const BeliefGrid& grid) {
  std::vector<BeliefRow> rows;
  grid.for_each_belief([&](Index3 voxel, const Belief& belief) {
    rows.push_back(
        {{voxel.x, voxel.y, voxel.z}, belief.hits, belief.information, belief.information_vector});
  });
  return rows;
}

py::array points_of(const SharedGrid& grid, std::uint32_t min_hits, double scale_sigma,
                    int num_threads) {
  FusedPointsConfig config;
  config.min_hits = min_hits;
  config.scale_sigma = scale_sigma;
  std::vector<PointRow> rows;
  for (const FusedPoint& p :
       grid.read([&](const BeliefGrid& g) { return fused_points(g, config, {num_threads}); })) {
    const auto& [xx, yy, zz, xy, xz, yz] = p.covariance;
    rows.push_back({p.position, {xx, yy, zz, xy, xz, yz}, p.toward_free, p.hits});
  }
  return to_array_1d<PointRow>(rows);
}

double pooling_length_of(const SharedGrid& grid) {
  return grid.read([](const BeliefGrid& g) { return pooling_of(g.snapshot()).length; });
}

py::object statistics_of(const SharedGrid& grid, const std::string& criterion) {
  const Criterion parsed = parse_criterion(criterion);
  const BeliefGrid::Statistics s =
      grid.read([&](const BeliefGrid& g) { return g.statistics(parsed); });
  return named("GridStatistics", s.unknown, s.free, s.occupied, s.bytes, s.entropy_removed);
}

std::string repr_of(const SharedGrid& grid) {
  const Index3 dims = grid.layout().dims();
  const BeliefGrid::Statistics s = grid.read([](const BeliefGrid& g) { return g.statistics(); });
  std::ostringstream text;
  text << "<BeliefGrid " << dims.x << "x" << dims.y << "x" << dims.z << " voxels of "
       << grid.layout().voxel_size() << " m: " << s.unknown << " unknown, " << s.free << " free, "
       << s.occupied << " occupied>";
  return text.str();
}

}  // namespace

void bind_grid(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(BeliefRow, voxel, hits, information, information_vector);
  PYBIND11_NUMPY_DTYPE(PointRow, position, covariance, toward_free, hits);

  GridClass grid_class =
      bound_class<SharedGrid, std::shared_ptr<SharedGrid>>(module, "BeliefGrid",
                                                           R"(A map of a workspace, voxel by voxel.

In the grid frame, voxel (i, j, k) covers [i, i+1) x [j, j+1) x [k, k+1) times the voxel size. These
indices are called indices on the lattice. A new grid is unknown everywhere and takes little memory.
Two grids are equal if their ``content_hash()`` is equal. Grids can be pickled.

Parameters
----------
voxel_size : float
    [m]
workspace : array_like, (2, 3)
    Lowest and highest corner of the mapped space, grid frame [m]. It is extended to whole voxels,
    at most 65,536 along an axis and 2**40 in total.
prior_sigma : float, optional
    Standard deviation of the surface position in an unknown voxel [m].
sensor : Sensor, optional
    Sensor of the map's frames. Sets ``prior_sigma`` to ``default_prior_sigma``. Required unless
    ``prior_sigma`` is given.
T_world_grid : array_like, (4, 4), optional
    Pose of the grid frame in the world.

Notes
-----
Methods release the GIL. Threads may share a grid: several may read it at once, and a thread that
changes it waits until it is alone. Cost: linear in the voxels that a method returns or changes;
some ms for 128**3 voxels with 40,000 occupied ones. Properties take constant time.)");
  bind_grid_files(grid_class);
  bind_voxels(grid_class);
  grid_class
      .def(py::init([](double voxel_size, const py::object& workspace,
                       std::optional<double> prior_sigma, const GivenOrNone<Sensor>& sensor,
                       const py::object& T_world_grid) {
             GridConfig config;
             config.voxel_size = voxel_size;
             config.workspace = box(workspace, "workspace");
             config.prior_sigma = prior_of(prior_sigma, sensor.value, voxel_size);
             config.T_world_grid = optional_pose(T_world_grid, "T_world_grid").value_or(Pose{});
             return std::make_shared<SharedGrid>(BeliefGrid(config));
           }),
           py::kw_only(), "voxel_size"_a, "workspace"_a, "prior_sigma"_a = py::none(),
           "sensor"_a = py::none(), "T_world_grid"_a = py::none())
      .def_static("from_labels", &from_labels, "labels"_a, py::kw_only(), "voxel_size"_a,
                  "origin"_a = std::array<double, 3>{}, "T_world_grid"_a = py::none(),
                  "prior_sigma"_a = py::none(), "sensor"_a = py::none(),
                  R"(A grid from an array of states.

Parameters
----------
labels : array_like, (nx, ny, nz), whole numbers
    0 unknown, 1 free, 2 occupied. Masked entries of a masked array are unknown. bools raise
    ValueError, because they cannot express unknown. C-contiguous uint8 is read without a copy;
    other integers and nested lists are converted once.
voxel_size : float
    [m]
origin : array_like, (3,)
    Lowest corner of voxel (0, 0, 0), world frame [m]. It becomes the origin of the grid frame.
T_world_grid : array_like, (4, 4), optional
    Pose of the grid frame in the world; replaces origin.
prior_sigma : float, optional
    Standard deviation of the surface position in an unknown voxel [m].
sensor : Sensor, optional
    As for a new grid; sensor or prior_sigma is required. Only frames set the map's property
    ``sensor``.

Returns
-------
BeliefGrid)")
      .def("clone", &clone_of,
           "A deep copy. Beliefs are copied on write.\n\nReturns\n-------\nBeliefGrid")
      .def("__copy__", &clone_of)
      .def("__deepcopy__", [](const SharedGrid& grid, const py::dict&) { return clone_of(grid); })
      .def_property_readonly(
          "voxel_size", [](const SharedGrid& grid) { return grid.layout().voxel_size(); },
          "float: [m]")
      .def_property_readonly(
          "prior_sigma", [](const SharedGrid& grid) { return grid.layout().prior_sigma(); },
          "float: standard deviation of the surface position in an unknown voxel [m]")
      .def_property_readonly(
          "shape",
          [](const SharedGrid& grid) {
            const Index3 dims = grid.layout().dims();
            return py::make_tuple(dims.x, dims.y, dims.z);
          },
          "tuple of 3 int: number of voxels along x, y, z")
      .def_property_readonly(
          "min_index",
          [](const SharedGrid& grid) {
            const Index3 min = grid.layout().min_index();
            return py::make_tuple(min.x, min.y, min.z);
          },
          "tuple of 3 int: index on the lattice of the voxel that is at (0, 0, 0) in arrays")
      .def_property_readonly(
          "workspace",
          [](const SharedGrid& grid) {
            const Box box = grid.layout().workspace();
            return to_array_3<double>({box.min, box.max});
          },
          "ndarray, (2, 3), float64: lowest and highest corner, grid frame [m]")
      .def_property_readonly(
          "T_world_grid",
          [](const SharedGrid& grid) { return to_array(grid.layout().T_world_grid()); },
          "ndarray, (4, 4), float64: pose of the grid frame in the world")
      .def("states", &states_of, R"(States of all voxels.

Returns
-------
ndarray, (nx, ny, nz), uint8
    0 unknown, 1 free, 2 occupied. A copy.)")
      .def("update_box", &update_box, "first"_a, "labels"_a,
           R"(Sets the states of the voxels in a box, for planners with their own growing map.

Voxels that already have the state keep their log-odds and belief. The others lose their belief.
Cost: linear in the labels.

Parameters
----------
first : array_like, (3,), whole numbers
    Index on the lattice of the lowest voxel of the box; ``min_index`` for the corner of the
    workspace.
labels : array_like, (nx, ny, nz), whole numbers
    0 unknown, 1 free, 2 occupied, as in ``from_labels``.

Returns
-------
int
    Number of changed voxels.)")
      .def(
          "views",
          [](const SharedGrid& grid) {
            const auto views = grid.read([](const BeliefGrid& g) { return g.views(); });
            return to_array(views, {static_cast<py::ssize_t>(views.size())});
          },
          R"(Poses of all integrated frames, in order.

Returns
-------
ndarray, (n, 4, 4), float64
    T_world_camera.)")
      .def_property_readonly(
          "hazard_factors",
          [](const SharedGrid& grid) {
            const auto counters =
                grid.read([](const BeliefGrid& g) { return g.hazard_counters(); });
            std::vector<double> factors;
            for (std::size_t k = 0; k < HazardCounters::kClasses; ++k) {
              factors.push_back(counters.factor(k));
            }
            return py::array_t<double>(static_cast<py::ssize_t>(factors.size()), factors.data());
          },
          R"(ndarray, (8,), float64: factors that correct the hazard of unknown space, from frames.

The hazard is the rate at which a ray meets the surface in unknown voxels. There is one factor per
class of distance from known surface, nearest first. It multiplies the rate of the hazard model. All
factors are 1 until ``FrameIntegrator.calibrate_hazard`` is called.)")
      .def(
          "beliefs",
          [](const SharedGrid& grid) {
            const auto rows = grid.read(belief_rows);
            return to_array_1d<BeliefRow>(rows);
          },
          R"(For each voxel, sums over the readings (measured depths) that ended in it.

Returns
-------
ndarray, (n,), structured
    One row per voxel with readings. Fields: voxel (int32, 3: index on the lattice; subtract
    ``min_index`` to index arrays), hits (number of readings), information (float32, 6: sum of their
    information matrices, xx yy zz xy xz yz [1/m**2]), information_vector (float32, 3: sum of their
    information matrices times their positions relative to the voxel's centre [1/m]).)")
      .def("points", &points_of, py::kw_only(), "min_hits"_a = 2, "scale_sigma"_a = 0.0,
           "num_threads"_a = 0,
           R"(The surface points of the map.

Cost: some µs per voxel with readings; 0.25 s for 40,000 occupied voxels on two threads.

Parameters
----------
min_hits : int
    Omits points with fewer readings (measured depths).
scale_sigma : float
    scale_sigma of the sensor. Adds the relative error that all readings of a point share to its
    covariance.
num_threads : int
    0: all hardware threads. Does not affect the result.

Returns
-------
ndarray, (n,), structured
    Fields: position (float64, 3, world frame [m]), covariance (float64, 6: xx yy zz xy xz yz
    [m**2]), toward_free (float64, 3: unit normal towards free space, world frame), hits (number of
    readings).)")
      .def("pooling_length", &pooling_length_of,
           R"(Distance between neighbouring points of the map.

Cost: linear in the map's blocks of voxels.

Returns
-------
float
    The voxel size or the footprint of a pixel on the surface, whichever is larger [m].)")
      .def("statistics", &statistics_of, "criterion"_a = "log_diagonal",
           R"(Number of voxels per state, and entropy removed.

Parameters
----------
criterion : {"log_diagonal", "log_determinant", "trace"}
    Measure of entropy.

Returns
-------
GridStatistics)")
      .def(
          "content_hash",
          [](const SharedGrid& grid) {
            return grid.read([](const BeliefGrid& g) { return g.content_hash(); });
          },
          "Hash of the map, 16 hexadecimal digits. Equal maps have equal "
          "hashes.\n\nReturns\n-------\nstr")
      .def(
          "__eq__",
          [](const SharedGrid& a, const SharedGrid& b) {
            const auto hash = [](const BeliefGrid& g) { return g.content_hash(); };
            return &a == &b || a.read(hash) == b.read(hash);
          },
          py::is_operator())
      .def("__repr__", &repr_of);
}

}  // namespace viewgain::python
