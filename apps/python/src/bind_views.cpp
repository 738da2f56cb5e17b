// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "arrays.hpp"
#include "batch_call.hpp"
#include "evaluator.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "pose_arrays.hpp"
#include "viewgain/raycast/gain_evaluator.hpp"

namespace viewgain::python {

/// A pixel of GainEvaluator.trace().
struct HitRow {
  std::uint8_t kind;
  std::array<std::int32_t, 3> voxel;
  double range;
};

/// A row of GainEvaluator.contributions().
struct ContributionRow {
  std::array<std::int32_t, 3> voxel;
  std::uint8_t state;
  std::uint32_t rays;
  double gain;
  double expected_rays;
};

namespace {

py::array_t<HitRow> trace_array(const Evaluator& self, const py::object& T_world_camera) {
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  const std::vector<RayHit> hits = outside_gil([&] { return self.evaluator.trace(pose); });
  py::array_t<HitRow> rows(Shape{self.height(), self.width()});
  std::transform(hits.begin(), hits.end(), rows.mutable_data(), [](const RayHit& hit) {
    return HitRow{
        static_cast<std::uint8_t>(hit.kind), {hit.voxel.x, hit.voxel.y, hit.voxel.z}, hit.range};
  });
  return rows;
}

py::array_t<float> depth(const Evaluator& self, const py::object& T_world_camera) {
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  const DepthFrame image = outside_gil([&] { return depth_image(self.evaluator, pose); });
  return image_array(image.depth, image.height, image.width);
}

py::array_t<ContributionRow> contributions(const Evaluator& self,
                                           const py::object& T_world_camera) {
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  std::vector<ContributionRow> rows;
  for (const VoxelContribution& c :
       outside_gil([&] { return self.evaluator.contributions(pose); })) {
    rows.push_back({{c.voxel.x, c.voxel.y, c.voxel.z},
                    static_cast<std::uint8_t>(c.state),
                    c.rays,
                    c.gain,
                    c.expected_rays});
  }
  return to_array_1d<ContributionRow>(rows);
}

py::object outcomes(const Evaluator& self, const py::object& T_world_camera) {
  const Pose pose = one_pose(T_world_camera, "T_world_camera");
  return named_outcomes(outside_gil([&] { return self.evaluator.outcomes(pose); }));
}

py::object evaluate_own(const Evaluator& self, const py::object& T_world_camera,
                        const py::object& measure, const GivenOrNone<Control>& control) {
  const PoseBatch batch = pose_batch(T_world_camera, "T_world_camera", false);
  const PythonMeasure own(measure);
  py::array_t<double> gains(batch.shape);
  const std::span<double> out(gains.mutable_data(), batch.poses.size());
  run_batch(control, [&](const BatchControl& watched) {
    self.evaluator.evaluate(batch.poses, out, own, watched);
  });
  return scalar_or_array(gains);
}

}  // namespace

void bind_views(py::module_& module, py::class_<Evaluator>& evaluator) {
  PYBIND11_NUMPY_DTYPE(HitRow, kind, voxel, range);
  PYBIND11_NUMPY_DTYPE(ContributionRow, voxel, state, rays, gain, expected_rays);
  PYBIND11_NUMPY_DTYPE(OwnHitRow, voxel, state, readings, information, ray, range, direction);
  module.attr("HIT_KIND_NAMES") = py::make_tuple("none", "unknown", "occupied", "obstacle");
  evaluator
      .def("trace", &trace_array, "T_world_camera"_a,
           R"(Where each ray of a view ends. Cost: 0.7 ms for 176x144 pixels.

Parameters
----------
T_world_camera : array_like, (4, 4)

Returns
-------
ndarray, (height', width'), structured
    One entry per ray. height' and width' are those of the image divided by pixel_stride, rounded
    up. Fields: kind (index into ``HIT_KIND_NAMES``: what the ray ends in), voxel (int32, 3: index
    on the grid's lattice), range (along the ray [m]; inf if the ray ends nowhere).)")
      .def("depth", &depth, "T_world_camera"_a,
           R"(Depth image of a view of the map. Each ray ends in the first voxel that is not free.

Rays also end in unknown voxels. Cost: that of ``trace``, and with lens distortion, its removal.

Parameters
----------
T_world_camera : array_like, (4, 4)

Returns
-------
ndarray, (height', width'), float32
    Along the optical axis [m]; inf if the ray ends nowhere. The size is that of ``trace``.)")
      .def("contributions", &contributions, "T_world_camera"_a,
           R"(The contribution of each voxel to the gain of a view.

Runs on the calling thread. Cost: 3 times that of ``evaluate`` for this pose.

Parameters
----------
T_world_camera : array_like, (4, 4)

Returns
-------
ndarray, (n,), structured
    Largest gain first. The gains add up to the gain of the view. Fields: voxel (int32, 3: index on
    the grid's lattice; subtract the grid's ``min_index`` to index arrays), state (``VoxelState``),
    rays (number of rays that end in the voxel; with gain "surface" and "combined", number of rays
    that reach it), expected_rays (expected number of rays that end in it), gain (contribution, in
    the unit of ``evaluate``).)")
      .def("outcomes", &outcomes, "T_world_camera"_a,
           R"(Counts where the rays of a view end, to explain its gain.

Cost: twice that of ``trace``.

Parameters
----------
T_world_camera : array_like, (4, 4)

Returns
-------
RayOutcomes
    Its other counts add up to ``rays``.)")
      .def("evaluate_own", &evaluate_own, "T_world_camera"_a, "measure"_a, py::kw_only(),
           "control"_a = py::none(),
           R"(A custom gain, computed by a function from the voxels in which a view's rays end.

Calls the function for one view after the other, with the GIL. ViewMeasure of the C++ library is
faster. Cost: 1.4 times that of ``evaluate``, and one call of the function per pose.

Parameters
----------
T_world_camera : array_like, (..., 4, 4)
measure : callable
    Takes T_world_camera (4, 4) and a structured array (n,) with one row per ray that ends in a
    voxel. Returns a float. Its exceptions pass through. Fields of the array: voxel (int32, 3: index
    on the grid's lattice), state (``VoxelState``), readings (number of measured depths that ended
    in the voxel), information (float32, 6: their information matrix, xx yy zz xy xz yz [1/m**2]),
    ray (index of the ray, row-major), range (along the ray [m]), direction (unit vector of the ray,
    world frame).
control : BatchControl, optional

Returns
-------
ndarray, (...), float64
    Results of measure. NaN for invalid poses and 0 for cameras in an occupied voxel, without a call
    of measure. A single pose gives a scalar.)");
}

}  // namespace viewgain::python
