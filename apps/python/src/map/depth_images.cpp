// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include "depth_images.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace viewgain::python {
namespace {

// Single precision, row by row; NaN where masked. `unit` is the unit in the message for images of
// integers.
std::vector<float> image(const py::object& value, const std::string& name, const std::string& unit,
                         int height, int width) {
  const py::dtype type = any_array(value, name + " must be an array of numbers").dtype();
  if (type.kind() == 'i' || type.kind() == 'u' || type.kind() == 'b') {
    throw py::value_error(name + " must be floating point " + unit + ", not dtype " +
                          py::str(py::handle(type)).cast<std::string>());
  }
  const Doubles array = doubles(nan_where_masked(value), name.c_str(), {height, width});
  std::vector<float> pixels(static_cast<std::size_t>(array.size()));
  std::transform(array.data(), array.data() + array.size(), pixels.begin(),
                 [](double x) { return static_cast<float>(x); });
  return pixels;
}

}  // namespace

DepthFrame depth_frame_of_any_unit(const Sensor& sensor, const py::object& depth) {
  const int width = sensor.camera.width, height = sensor.camera.height;
  DepthFrame frame{
      width, height,
      image(depth, "depth", "in metres (from millimetres: depth.astype(numpy.float32) / 1000)",
            height, width)};
  for (float& z : frame.depth) {
    if (!(z > 0)) z = DepthFrame::kInvalid;
  }
  return frame;
}

DepthFrame depth_frame(const Sensor& sensor, const py::object& depth, const py::object& amplitude) {
  DepthFrame frame = depth_frame_of_any_unit(sensor, depth);
  MetresCheck metres(sensor);
  for (const float z : frame.depth) {
    if (z > 0) metres.add(static_cast<double>(z));
  }
  metres.require("depth");
  if (!amplitude.is_none()) {
    frame.amplitude = image(amplitude, "amplitude", "[1/m**2]", frame.height, frame.width);
  }
  return frame;
}

void MetresCheck::add(double range) {
  if (!std::isfinite(range)) return;
  if (range <= 10 * max_range_) {
    ++near_;
    return;
  }
  ++far_;
  nearest_far_ = std::min(nearest_far_, range);
  farthest_ = std::max(farthest_, range);
}

void MetresCheck::require(const char* name) const {
  if (far_ == 0 || far_ < 19 * near_) return;
  if (near_ > 0 && nearest_far_ == farthest_) return;
  std::ostringstream text;
  text << name << " must be in metres: ";
  if (near_ == 0) {
    text << "its nearest reading is at " << nearest_far_ << ", beyond";
  } else {
    text << far_ << " of its " << near_ + far_ << " readings are beyond";
  }
  text << " 10 times the sensor's max_range of " << max_range_
       << " m (use inf where there is nothing up to max_range)";
  throw py::value_error(text.str());
}

py::array_t<float> image_array(const std::vector<float>& pixels, int height, int width) {
  return py::array_t<float>(Shape{height, width}, pixels.data());
}

}  // namespace viewgain::python
