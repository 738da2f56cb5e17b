// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "pose_arrays.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/support/noise_fields.hpp"
#include "viewgain/support/text.hpp"

namespace viewgain::python {
namespace py = pybind11;

namespace {

// A noise model: its parameters are keywords of the constructor, with the library's defaults, and
// attributes that cannot be set. `docs` has a line for each.
template <typename Model>
void bind_model(py::module_& module, const char* name, const char* doc,
                const std::array<const char*, NoiseLayout<Model>::kFields.size()>& docs) {
  using Layout = NoiseLayout<Model>;
  auto type = bound_class<Model>(module, name, doc);
  std::vector<const char*> names;
  for (const auto& field : Layout::kFields) {
    type.def_readonly(field.name, field.member, docs[names.size()]);
    names.push_back(field.name);
  }
  pickle_by_attributes(type, std::move(names));
  const auto with_constructor = [&]<std::size_t... i>(std::index_sequence<i...>) {
    const Model defaults;
    type.def(py::init([](decltype(i, double())... values) {
               Model model;
               ((model.*Layout::kFields[i].member = values), ...);
               return model;
             }),
             py::kw_only(),
             (py::arg(Layout::kFields[i].name) = defaults.*Layout::kFields[i].member)...);
  };
  with_constructor(std::make_index_sequence<Layout::kFields.size()>());
  type.def(
          "__eq__", [](const Model& a, const Model& b) { return a == b; }, py::is_operator())
      .def("__repr__", [text = std::string(name)](const Model& model) {
        Fields fields;
        for (const auto& field : Layout::kFields) fields.add(field.name, model.*field.member);
        return fields.in(text.c_str());
      });
}

}  // namespace

void bind_noise(py::module_& module) {
  bind_model<ShotNoise>(
      module, "ShotNoise", R"(Shot noise of a time-of-flight camera.

``axial = reference_sigma * (t / reference_range) * sqrt(reference_integration_time /
integration_time) / sqrt(max(cos, 0.1))``, ``lateral = t / fx``. axial and lateral are standard
deviations along and across the ray [m], t is the range along the ray [m], and cos is the cosine of
the angle of incidence.

Parameters
----------
reference_sigma : float
    Axial sigma at the reference range and frontal incidence [m].
reference_range : float
    [m]
reference_integration_time : float
    Integration time with which the reference was measured [s].
integration_time : float
    Integration time of the sensor [s].
modulation_frequency : float
    Modulation frequency of the light [Hz]; 0: no ambiguity of ranges.
min_amplitude : float
    Amplitude cos / t**2 below which a pixel is invalid [1/m**2].)",
      {"float: axial sigma at the reference range [m]", "float: reference range [m]",
       "float: integration time of the reference [s]", "float: integration time [s]",
       "float: modulation frequency of the light [Hz]; 0: no ambiguity of ranges",
       "float: amplitude cos / t**2 below which a pixel is invalid [1/m**2]"});

  bind_model<StructuredLightNoise>(module, "StructuredLightNoise",
                                   R"(Structured light (Nguyen, Izadi, Lovell, 2012).

``axial = offset + quadratic * (t - vertex)**2``; if theta is above 60 degrees, plus
``grazing / sqrt(t) * theta**2 / (pi/2 - theta)**2``.
``lateral = (lateral_px + lateral_grazing_px * theta / (pi/2 - theta)) * t / fx``.
t is the range along the ray [m] and theta the angle of incidence [rad].

Parameters
----------
offset, vertex : float
    [m]
quadratic : float
    [1/m]
grazing : float
    [m**1.5]
lateral_px, lateral_grazing_px : float
    [px])",
                                   {"float: [m]", "float: [1/m]", "float: [m]", "float: [m**1.5]",
                                    "float: [px]", "float: [px]"});

  bind_model<StereoNoise>(
      module, "StereoNoise",
      R"(Stereo: ``axial = t**2 * subpixel / (focal * baseline)``, ``lateral = t / fx``.

Parameters
----------
subpixel : float
    Matching error [px].
focal : float
    Focal length [px]; 0: the camera's fx.
baseline : float
    [m])",
      {"float: matching error [px]", "float: [px]", "float: [m]"});

  bind_model<QuadraticNoise>(
      module, "QuadraticNoise",
      R"(``axial = offset + linear * t + quadratic * t**2``, ``lateral = t / fx``.

Parameters
----------
offset : float
    [m]
quadratic : float
    [1/m]
linear : float
    [1])",
      {"float: [m]", "float: [1/m]", "float: [1]"});

  bind_model<ConstantNoise>(module, "ConstantNoise",
                            R"(Constant sigmas. If both are equal, the noise is isotropic.

Parameters
----------
sigma_axial : float
    Along the ray [m].
sigma_lateral : float
    Across the ray [m].)",
                            {"float: sigma along the ray [m]", "float: sigma across the ray [m]"});
}

namespace {

// (n, 2); none for None.
RangeCalibration range_calibration(const py::object& value) {
  RangeCalibration calibration;
  if (value.is_none()) return calibration;
  const Doubles rows = doubles(value, "range_calibration", {-1, 2});
  for (const double* row = rows.data(); row != rows.data() + rows.size(); row += 2) {
    calibration.table.push_back({row[0], row[1]});
  }
  return calibration;
}

py::object to_object(const RangeCalibration& calibration) {
  if (calibration.table.empty()) return py::none();
  return py::array_t<double>(Shape{static_cast<py::ssize_t>(calibration.table.size()), 2},
                             calibration.table.front().data());
}

std::optional<Sensor::OutOfRange> out_of_range_of(const std::optional<std::string>& name) {
  if (!name) return std::nullopt;
  if (*name == "carve") return Sensor::OutOfRange::carve;
  if (*name == "invalid") return Sensor::OutOfRange::invalid;
  refuse("out_of_range is \"" + *name + "\"; valid values: carve, invalid");
}

std::optional<std::string> name_of(const std::optional<Sensor::OutOfRange>& meaning) {
  if (!meaning) return std::nullopt;
  return *meaning == Sensor::OutOfRange::carve ? "carve" : "invalid";
}

}  // namespace

void bind_sensors(py::module_& module) {
  auto type = bound_class<Sensor>(
      module, "Sensor",
      R"(A depth camera: intrinsics, range limits and noise. Immutable. Parameters are keyword-only.

Parameters
----------
camera : PinholeCamera
min_range, max_range : float
    Along the ray [m].
working_distance : float
    Intended distance from the surface [m].
noise : ShotNoise or StructuredLightNoise or StereoNoise or QuadraticNoise or ConstantNoise
name : str, optional
    Name in reports.
T_flange_camera : array_like, (4, 4), optional
    Pose of the camera in the frame of the robot's flange: maps points from the camera frame to the
    flange frame.
body_size : sequence of float, (3,), optional
    Width, height and depth of the housing, flange frame [m].
range_calibration : array_like, (n, 2), optional
    Systematic range error: rows of measured range and its error, measured minus true range [m], in
    order of increasing measured range. ``read_frames`` subtracts the error.
pose_sigma : sequence of float, (2,), optional
    Uncertainty of the poses of frames: standard deviation of each coordinate of the camera centre
    [m], and of each component of the rotation vector about it [rad]. Maps and gains add this
    uncertainty to each measured depth.
scale_sigma : float, optional
    Standard deviation of a relative error that all ranges share, so that more readings do not
    reduce it; see ``BeliefGrid.points``.
out_of_range : str, optional
    Meaning of 65535 in the sensor's depth images. "carve": free up to max_range. "invalid": no
    measured depth. Default: depends on the layout of their folder, see ``read_frames``.

Notes
-----
Sensors are equal if their values are, and can be pickled. Invalid noise parameters raise
ValueError. Holds the GIL. Cost: some µs, and linear in the rows of range_calibration.)");
  pickle_by_attributes(type, {"camera", "min_range", "max_range", "working_distance", "noise",
                              "name", "T_flange_camera", "body_size", "range_calibration",
                              "pose_sigma", "scale_sigma", "out_of_range"});
  type.def(py::init([](const Given<PinholeCamera>& camera, double min_range, double max_range,
                       double working_distance, const NoiseModel& noise, std::string name,
                       const py::object& T_flange_camera,
                       std::optional<std::array<double, 3>> body_size, const py::object& table,
                       const std::array<double, 2>& pose_sigma, double scale_sigma,
                       const std::optional<std::string>& out_of_range) {
             Sensor sensor{std::move(name),
                           *camera,
                           min_range,
                           max_range,
                           working_distance,
                           noise,
                           optional_pose(T_flange_camera, "T_flange_camera"),
                           body_size,
                           range_calibration(table),
                           {pose_sigma[0], pose_sigma[1]},
                           scale_sigma,
                           out_of_range_of(out_of_range)};
             sensor.validate();
             return sensor;
           }),
           "camera"_a, py::kw_only(), "min_range"_a, "max_range"_a, "working_distance"_a, "noise"_a,
           "name"_a = "custom", "T_flange_camera"_a = py::none(), "body_size"_a = py::none(),
           "range_calibration"_a = py::none(), "pose_sigma"_a = std::array<double, 2>{0, 0},
           "scale_sigma"_a = 0.0, "out_of_range"_a = py::none())
      .def_readonly("name", &Sensor::name, "str")
      .def_readonly("camera", &Sensor::camera, "PinholeCamera")
      .def_readonly("min_range", &Sensor::min_range, "float: along the ray [m]")
      .def_readonly("max_range", &Sensor::max_range, "float: along the ray [m]")
      .def_readonly("working_distance", &Sensor::working_distance, "float: [m]")
      .def_readonly(
          "noise", &Sensor::noise,
          "ShotNoise or StructuredLightNoise or StereoNoise or QuadraticNoise or ConstantNoise")
      .def_property_readonly(
          "T_flange_camera",
          [](const Sensor& sensor) -> py::object {
            if (!sensor.T_flange_camera) return py::none();
            return to_array(*sensor.T_flange_camera);
          },
          "ndarray, (4, 4), float64, or None: maps points from the camera frame to the flange "
          "frame")
      .def_readonly(
          "body_size", &Sensor::body_size,
          "list of float, (3,), or None: width, height and depth of the housing, flange frame [m]")
      .def_property_readonly(
          "range_calibration",
          [](const Sensor& sensor) { return to_object(sensor.range_calibration); },
          "ndarray, (n, 2), float64, or None: measured range and its error [m]")
      .def_property_readonly(
          "pose_sigma",
          [](const Sensor& sensor) {
            return py::make_tuple(sensor.pose_sigma.translation, sensor.pose_sigma.rotation);
          },
          "(float, float): standard deviations of the poses of frames [m], [rad]; zeros: poses are "
          "exact")
      .def_readonly("scale_sigma", &Sensor::scale_sigma,
                    "float: standard deviation of a relative error that all ranges share; 0: none")
      .def_property_readonly(
          "out_of_range", [](const Sensor& sensor) { return name_of(sensor.out_of_range); },
          "str or None: meaning of 65535 in depth images, carve or invalid")
      .def(
          "corrected",
          [](const Sensor& sensor, const py::object& depth) {
            DepthFrame frame = depth_frame(sensor, depth, py::none());
            sensor.range_calibration.correct(sensor.camera, frame);
            return image_array(frame.depth, frame.height, frame.width);
          },
          "depth"_a,
          R"(A depth image, corrected with range_calibration.

``read_frames`` does this for its frames. Cost: 30 ns per pixel; with distortion 0.5 µs.

Parameters
----------
depth : array_like, (height, width)
    Along the optical axis [m], as the camera measured it.

Returns
-------
ndarray, (height, width), float32
    Along the optical axis [m]; 0 where nothing was measured.)")
      .def(
          "sigmas",
          [](const Sensor& sensor, double t, double cos_incidence) {
            const MeasurementSigmas sigmas = sensor.sigmas(t, cos_incidence);
            return named("Sigmas", sigmas.axial, sigmas.lateral);
          },
          "t"_a, "cos_incidence"_a = 1.0,
          R"(Standard deviations of a reading (one measured depth).

Parameters
----------
t : float
    Range along the ray [m], >= 0; may exceed the sensor's limits.
cos_incidence : float
    Cosine of the angle between ray and surface normal; 1: frontal.

Returns
-------
Sigmas)")
      .def(
          "__eq__", [](const Sensor& a, const Sensor& b) { return a == b; }, py::is_operator())
      .def("__hash__",
           [](const Sensor& s) {
             return py::hash(py::make_tuple(s.name, s.camera.width, s.camera.height, s.camera.fx,
                                            s.min_range, s.max_range));
           })
      .def("__repr__", [](const Sensor& s) {
        return "<Sensor " + s.name + ", " + std::to_string(s.camera.width) + "x" +
               std::to_string(s.camera.height) + " px, " + short_text(s.min_range) + "-" +
               short_text(s.max_range) + " m>";
      });

  module.def(
      "sensor_preset", [](const std::string& name) { return sensor_preset(name); }, "name"_a,
      R"(A sensor with a published noise model.

Parameters
----------
name : str
    One of ``sensor_preset_names()``.

Returns
-------
Sensor)");
  module.def(
      "sensor_preset_names", [] { return sensor_preset_names(); },
      "The valid names of ``sensor_preset``.\n\nReturns\n-------\nlist of str");
  module.def(
      "default_prior_sigma",
      [](double voxel_size, const Given<Sensor>& sensor) {
        return default_prior_sigma(voxel_size, *sensor);
      },
      "voxel_size"_a, "sensor"_a,
      R"(Default standard deviation of the surface position in an unknown voxel [m].

``max(voxel_size / 2, 2 * axial sigma at the working distance)``, so that unknown space is never
more certain than one measured depth.

Parameters
----------
voxel_size : float
    [m]
sensor : Sensor

Returns
-------
float
    [m])");
}

}  // namespace viewgain::python
