// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "bindings.hpp"
#include "fields.hpp"
#include "pickling.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain::python {

namespace py = pybind11;

void bind_noise(py::module_& module) {
  const ShotNoise shot;
  py::class_<ShotNoise> shot_class(module, "ShotNoise", R"(Time-of-flight shot noise.

``axial = reference_sigma * (t / reference_range) * sqrt(reference_integration_time /
integration_time) / sqrt(max(cos, 0.1))``, ``lateral = t / fx``; t is the range along the ray [m].

Parameters
----------
reference_sigma, reference_range : float
    [m]
reference_integration_time, integration_time : float
    [s]
modulation_frequency : float
    Of the light [Hz]; 0: ranges are unambiguous.
min_amplitude : float
    cos / t**2 under which a reading is invalid [1/m**2].)");
  pickle_as_call(shot_class, {"reference_sigma", "reference_range", "reference_integration_time",
                              "integration_time", "modulation_frequency", "min_amplitude"});
  shot_class
      .def(py::init([](double sigma, double range, double reference_time, double time,
                       double frequency, double amplitude) {
             return ShotNoise{sigma, range, reference_time, time, frequency, amplitude};
           }),
           py::kw_only(), py::arg("reference_sigma") = shot.reference_sigma,
           py::arg("reference_range") = shot.reference_range,
           py::arg("reference_integration_time") = shot.reference_integration_time,
           py::arg("integration_time") = shot.integration_time,
           py::arg("modulation_frequency") = shot.modulation_frequency,
           py::arg("min_amplitude") = shot.min_amplitude)
      .def_readonly("reference_sigma", &ShotNoise::reference_sigma,
                    "float: along the ray at the reference [m]")
      .def_readonly("reference_range", &ShotNoise::reference_range, "float: of the reference [m]")
      .def_readonly("reference_integration_time", &ShotNoise::reference_integration_time,
                    "float: of the reference [s]")
      .def_readonly("integration_time", &ShotNoise::integration_time, "float: [s]")
      .def_readonly("modulation_frequency", &ShotNoise::modulation_frequency,
                    "float: of the light [Hz]; 0: ranges are unambiguous")
      .def_readonly("min_amplitude", &ShotNoise::min_amplitude,
                    "float: cos / t**2 under which a reading is invalid [1/m**2]")
      .def(
          "__eq__", [](const ShotNoise& a, const ShotNoise& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const ShotNoise& n) {
        return Fields()
            .add("reference_sigma", n.reference_sigma)
            .add("reference_range", n.reference_range)
            .add("reference_integration_time", n.reference_integration_time)
            .add("integration_time", n.integration_time)
            .add("modulation_frequency", n.modulation_frequency)
            .add("min_amplitude", n.min_amplitude)
            .in("ShotNoise");
      });

  const StructuredLightNoise light;
  py::class_<StructuredLightNoise> light_class(module, "StructuredLightNoise",
                                               R"(Structured light (Nguyen, Izadi, Lovell, 2012).

``axial = offset + quadratic * (z - vertex)**2``, plus ``grazing / sqrt(z) * theta**2 / (pi/2 -
theta)**2`` beyond 60 degrees; ``lateral = (lateral_px + lateral_grazing_px * theta / (pi/2 - theta))
* z / fx``; z is taken as the range along the ray [m].)");
  pickle_as_call(light_class,
                 {"offset", "quadratic", "vertex", "grazing", "lateral_px", "lateral_grazing_px"});
  light_class
      .def(py::init([](double offset, double quadratic, double vertex, double grazing,
                       double lateral_px, double lateral_grazing_px) {
             return StructuredLightNoise{offset,  quadratic,  vertex,
                                         grazing, lateral_px, lateral_grazing_px};
           }),
           py::kw_only(), py::arg("offset") = light.offset, py::arg("quadratic") = light.quadratic,
           py::arg("vertex") = light.vertex, py::arg("grazing") = light.grazing,
           py::arg("lateral_px") = light.lateral_px,
           py::arg("lateral_grazing_px") = light.lateral_grazing_px)
      .def_readonly("offset", &StructuredLightNoise::offset, "float: [m]")
      .def_readonly("quadratic", &StructuredLightNoise::quadratic, "float: [1/m]")
      .def_readonly("vertex", &StructuredLightNoise::vertex, "float: [m]")
      .def_readonly("grazing", &StructuredLightNoise::grazing, "float: [m**1.5]")
      .def_readonly("lateral_px", &StructuredLightNoise::lateral_px, "float: [px]")
      .def_readonly("lateral_grazing_px", &StructuredLightNoise::lateral_grazing_px, "float: [px]")
      .def(
          "__eq__",
          [](const StructuredLightNoise& a, const StructuredLightNoise& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const StructuredLightNoise& n) {
        return Fields()
            .add("offset", n.offset)
            .add("quadratic", n.quadratic)
            .add("vertex", n.vertex)
            .add("grazing", n.grazing)
            .add("lateral_px", n.lateral_px)
            .add("lateral_grazing_px", n.lateral_grazing_px)
            .in("StructuredLightNoise");
      });

  const StereoNoise stereo;
  py::class_<StereoNoise> stereo_class(
      module, "StereoNoise",
      "Stereo: ``axial = t**2 * subpixel / (focal * baseline)``, ``lateral = t / "
      "fx``.\n\nsubpixel and focal in [px], baseline in [m]; a focal of 0\n"
      "stands for the camera's fx.");
  pickle_as_call(stereo_class, {"subpixel", "focal", "baseline"});
  stereo_class
      .def(py::init([](double subpixel, double focal, double baseline) {
             return StereoNoise{subpixel, focal, baseline};
           }),
           py::kw_only(), py::arg("subpixel") = stereo.subpixel, py::arg("focal") = stereo.focal,
           py::arg("baseline") = stereo.baseline)
      .def_readonly("subpixel", &StereoNoise::subpixel, "float: matching error [px]")
      .def_readonly("focal", &StereoNoise::focal, "float: [px]")
      .def_readonly("baseline", &StereoNoise::baseline, "float: [m]")
      .def(
          "__eq__", [](const StereoNoise& a, const StereoNoise& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const StereoNoise& n) {
        return Fields()
            .add("subpixel", n.subpixel)
            .add("focal", n.focal)
            .add("baseline", n.baseline)
            .in("StereoNoise");
      });

  const QuadraticNoise quadratic;
  py::class_<QuadraticNoise> quadratic_class(
      module, "QuadraticNoise",
      "``axial = offset + quadratic * t**2``, ``lateral = t / fx``.\n\noffset in [m], quadratic in "
      "[1/m].");
  pickle_as_call(quadratic_class, {"offset", "quadratic"});
  quadratic_class
      .def(py::init([](double offset, double q) { return QuadraticNoise{offset, q}; }),
           py::kw_only(), py::arg("offset") = quadratic.offset,
           py::arg("quadratic") = quadratic.quadratic)
      .def_readonly("offset", &QuadraticNoise::offset, "float: [m]")
      .def_readonly("quadratic", &QuadraticNoise::quadratic, "float: [1/m]")
      .def(
          "__eq__", [](const QuadraticNoise& a, const QuadraticNoise& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const QuadraticNoise& n) {
        return Fields().add("offset", n.offset).add("quadratic", n.quadratic).in("QuadraticNoise");
      });

  const ConstantNoise constant;
  py::class_<ConstantNoise> constant_class(
      module, "ConstantNoise", "The same everywhere [m]; equal sigmas make an isotropic sensor.");
  pickle_as_call(constant_class, {"sigma_axial", "sigma_lateral"});
  constant_class
      .def(py::init([](double axial, double lateral) { return ConstantNoise{axial, lateral}; }),
           py::kw_only(), py::arg("sigma_axial") = constant.sigma_axial,
           py::arg("sigma_lateral") = constant.sigma_lateral)
      .def_readonly("sigma_axial", &ConstantNoise::sigma_axial, "float: along the ray [m]")
      .def_readonly("sigma_lateral", &ConstantNoise::sigma_lateral, "float: across the ray [m]")
      .def(
          "__eq__", [](const ConstantNoise& a, const ConstantNoise& b) { return a == b; },
          py::is_operator())
      .def("__repr__", [](const ConstantNoise& n) {
        return Fields()
            .add("sigma_axial", n.sigma_axial)
            .add("sigma_lateral", n.sigma_lateral)
            .in("ConstantNoise");
      });
}

}  // namespace viewgain::python
