// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "viewgain/core/reach.hpp"
#include "viewgain/core/sensor.hpp"

namespace viewgain {
struct FrameSequence;
struct SurfaceMesh;
}  // namespace viewgain

namespace viewgain::python {

class SharedGrid;
struct Control;
struct Scene;

// Arguments of the package's own classes. For another class, a TypeError states what is needed and
// how to get it, instead of pybind11's list of signatures. Not for functions with several
// signatures.

/// An object of the class.
template <typename Class>
struct Given {
  Class* value;
  [[nodiscard]] Class& operator*() const { return *value; }
  [[nodiscard]] Class* operator->() const { return value; }
};
/// An object of the class, or None: null.
template <typename Class>
struct GivenOrNone {
  Class* value;
  operator Class*() const { return value; }
};

/// Name of arguments of the class in messages, and how to get one.
struct ArgumentWords {
  const char *name, *source;
};
template <typename Class>
inline constexpr ArgumentWords kWords{"the argument", ""};
template <>
inline constexpr ArgumentWords kWords<SharedGrid>{
    "grid",
    "; make one from an array of states with BeliefGrid.from_labels, or from a file with "
    "BeliefGrid.load"};
template <>
inline constexpr ArgumentWords kWords<FrameSequence>{"frames",
                                                     "; open a folder of them with read_frames"};
template <>
inline constexpr ArgumentWords kWords<Scene>{"scene",
                                             "; make one from a BeliefGrid with VoxelScene(grid)"};
template <>
inline constexpr ArgumentWords kWords<Sensor>{
    "sensor", "; get one with sensor_preset(name) or Sensor.load(path)"};
template <>
inline constexpr ArgumentWords kWords<PinholeCamera>{
    "camera", "; make one from an intrinsic matrix with PinholeCamera.from_matrix"};
template <>
inline constexpr ArgumentWords kWords<Control>{
    "control", "; make one from a function with BatchControl(progress)"};
template <>
inline constexpr ArgumentWords kWords<ReachRegion>{"reach", ""};
template <>
inline constexpr ArgumentWords kWords<SurfaceMesh>{"surface", ""};

template <typename Class>
[[noreturn]] void refuse_class(const pybind11::handle& value) {
  const auto name_of = [](const pybind11::handle& type) {
    return type.attr("__name__").template cast<std::string>();
  };
  throw pybind11::type_error(std::string(kWords<Class>.name) + " must be a " +
                             name_of(pybind11::type::of<Class>()) + ", not " +
                             name_of(pybind11::type::handle_of(value)) + kWords<Class>.source);
}

}  // namespace viewgain::python

namespace pybind11::detail {

template <typename Class>
struct type_caster<viewgain::python::Given<Class>> {
  static constexpr auto name = make_caster<Class>::name;
  template <typename>
  using cast_op_type = viewgain::python::Given<Class>;

  bool load(handle from, bool convert) {
    make_caster<Class> caster;
    if (from.is_none() || !caster.load(from, convert)) viewgain::python::refuse_class<Class>(from);
    value_ = &cast_op<Class&>(caster);
    return true;
  }
  operator viewgain::python::Given<Class>() const { return {value_}; }

 protected:
  Class* value_ = nullptr;  // owned by the Python object, which exists during the call
};

template <typename Class>
struct type_caster<viewgain::python::GivenOrNone<Class>>
    : type_caster<viewgain::python::Given<Class>> {
  using Base = type_caster<viewgain::python::Given<Class>>;
  static constexpr auto name = const_name("Optional[") + make_caster<Class>::name + const_name("]");
  template <typename>
  using cast_op_type = viewgain::python::GivenOrNone<Class>;

  bool load(handle from, bool convert) { return from.is_none() || Base::load(from, convert); }
  operator viewgain::python::GivenOrNone<Class>() const { return {this->value_}; }
};

}  // namespace pybind11::detail
