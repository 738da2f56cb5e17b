// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "classes.hpp"
#include "fields.hpp"
#include "viewgain/core/noise.hpp"

namespace viewgain::python {

namespace py = pybind11;

namespace {

template <typename Model>
struct Parameter {
  const char* name;
  double Model::*member;
  const char* doc;
};

// Of the docstrings.
constexpr const char* kRaises = R"(

Raises
------
TypeError
    A parameter is no number. One that is out of its bounds is refused by ``Sensor``, which names it.)";

// A noise model: its parameters are keywords of the constructor, with the library's defaults, and
// attributes that cannot be set.
template <typename Model, std::size_t count>
void bind_model(py::module_& module, const char* name, const char* doc,
                const std::array<Parameter<Model>, count>& parameters) {
  const std::string whole = std::string(doc) + kRaises;
  auto type = bound_class<Model>(module, name, whole.c_str());
  std::vector<const char*> names;
  for (const auto& parameter : parameters) {
    names.push_back(parameter.name);
    type.def_readonly(parameter.name, parameter.member, parameter.doc);
  }
  pickle_as_call(type, std::move(names));
  const auto with_constructor = [&]<std::size_t... i>(std::index_sequence<i...>) {
    const Model defaults;
    type.def(py::init([parameters](decltype(i, double())... values) {
               Model model;
               ((model.*parameters[i].member = values), ...);
               return model;
             }),
             py::kw_only(), (py::arg(parameters[i].name) = defaults.*parameters[i].member)...);
  };
  with_constructor(std::make_index_sequence<count>());
  type.def(
          "__eq__", [](const Model& a, const Model& b) { return a == b; }, py::is_operator())
      .def("__repr__", [parameters, text = std::string(name)](const Model& model) {
        Fields fields;
        for (const auto& parameter : parameters) {
          fields.add(parameter.name, model.*parameter.member);
        }
        return fields.in(text.c_str());
      });
}

}  // namespace

void bind_noise(py::module_& module) {
  bind_model(module, "ShotNoise", R"(Time-of-flight shot noise.

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
    cos / t**2 under which a reading is invalid [1/m**2].)",
             std::to_array<Parameter<ShotNoise>>(
                 {{"reference_sigma", &ShotNoise::reference_sigma,
                   "float: along the ray at the reference [m]"},
                  {"reference_range", &ShotNoise::reference_range, "float: of the reference [m]"},
                  {"reference_integration_time", &ShotNoise::reference_integration_time,
                   "float: of the reference [s]"},
                  {"integration_time", &ShotNoise::integration_time, "float: [s]"},
                  {"modulation_frequency", &ShotNoise::modulation_frequency,
                   "float: of the light [Hz]; 0: ranges are unambiguous"},
                  {"min_amplitude", &ShotNoise::min_amplitude,
                   "float: cos / t**2 under which a reading is invalid [1/m**2]"}}));

  using Light = StructuredLightNoise;
  bind_model(module, "StructuredLightNoise", R"(Structured light (Nguyen, Izadi, Lovell, 2012).

``axial = offset + quadratic * (z - vertex)**2``, plus ``grazing / sqrt(z) * theta**2 / (pi/2 -
theta)**2`` beyond 60 degrees; ``lateral = (lateral_px + lateral_grazing_px * theta / (pi/2 - theta))
* z / fx``; z is taken as the range along the ray [m].

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
             std::to_array<Parameter<Light>>(
                 {{"offset", &Light::offset, "float: [m]"},
                  {"quadratic", &Light::quadratic, "float: [1/m]"},
                  {"vertex", &Light::vertex, "float: [m]"},
                  {"grazing", &Light::grazing, "float: [m**1.5]"},
                  {"lateral_px", &Light::lateral_px, "float: [px]"},
                  {"lateral_grazing_px", &Light::lateral_grazing_px, "float: [px]"}}));

  bind_model(module, "StereoNoise",
             R"(Stereo: ``axial = t**2 * subpixel / (focal * baseline)``, ``lateral = t / fx``.

Parameters
----------
subpixel : float
    Matching error [px].
focal : float
    Focal length [px]; 0 stands for the camera's fx.
baseline : float
    [m])",
             std::to_array<Parameter<StereoNoise>>(
                 {{"subpixel", &StereoNoise::subpixel, "float: matching error [px]"},
                  {"focal", &StereoNoise::focal, "float: [px]"},
                  {"baseline", &StereoNoise::baseline, "float: [m]"}}));

  bind_model(module, "QuadraticNoise",
             R"(``axial = offset + quadratic * t**2``, ``lateral = t / fx``.

Parameters
----------
offset : float
    [m]
quadratic : float
    [1/m])",
             std::to_array<Parameter<QuadraticNoise>>(
                 {{"offset", &QuadraticNoise::offset, "float: [m]"},
                  {"quadratic", &QuadraticNoise::quadratic, "float: [1/m]"}}));

  bind_model(module, "ConstantNoise",
             R"(The same everywhere; equal sigmas make an isotropic sensor.

Parameters
----------
sigma_axial : float
    Along the ray [m].
sigma_lateral : float
    Across the ray [m].)",
             std::to_array<Parameter<ConstantNoise>>(
                 {{"sigma_axial", &ConstantNoise::sigma_axial, "float: along the ray [m]"},
                  {"sigma_lateral", &ConstantNoise::sigma_lateral, "float: across the ray [m]"}}));
}

}  // namespace viewgain::python
