// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "map/depth_images.hpp"
#include "pose_arrays.hpp"
#include "viewgain/formats/frames.hpp"
#include "viewgain/formats/pose_files.hpp"
#include "viewgain/formats/reach_toml.hpp"
#include "viewgain/formats/sensor_toml.hpp"
#include "viewgain/raycast/suspect_frames.hpp"

namespace viewgain::python {
namespace {

// Name of a preset or a file.
std::string preset_or_file(const py::object& value) {
  std::string text = file_path(value);
  return is_sensor_file(text) ? readable_file(value) : text;
}

FrameSequence read_frames(const py::object& folder, const py::object& sensor,
                          std::optional<double> depth_scale,
                          const std::optional<std::string>& out_of_range) {
  if (out_of_range && *out_of_range != "invalid" && *out_of_range != "carve") {
    throw py::value_error("out_of_range is \"" + *out_of_range +
                          "\"; valid values: carve, invalid");
  }
  const std::string given = sensor.is_none() ? std::string() : preset_or_file(sensor);
  const std::string path = file_path(folder);
  FrameSequence frames = outside_gil([&] { return open_frames(path, given, depth_scale); });
  if (out_of_range) {
    frames.out_of_range =
        *out_of_range == "carve" ? Sensor::OutOfRange::carve : Sensor::OutOfRange::invalid;
    frames.is_out_of_range_assumed = false;
  }
  if (const std::string assumed = assumed_text(frames); !assumed.empty()) {
    if (PyErr_WarnEx(PyExc_UserWarning, (path + ": " + assumed).c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
  return frames;
}

py::object frame_at(const FrameSequence& self, py::ssize_t index) {
  const std::size_t i = frame_index(self.images.size(), index);
  const DepthFrame frame = outside_gil([&] { return load_frame(self, i); });
  py::object amplitude = py::none();
  if (!frame.amplitude.empty()) amplitude = image_array(frame.amplitude, frame.height, frame.width);
  return named("Frame", image_array(frame.depth, frame.height, frame.width),
               to_array(self.poses[i]), amplitude);
}

py::array_t<double> pose_array(std::span<const Pose> poses) {
  return to_array(poses, {static_cast<py::ssize_t>(poses.size())});
}

PoseList pose_list_of(const py::object& path) {
  const std::string file = readable_file(path);
  return outside_gil([&] { return load_poses(file); });
}

py::list suspicions(const Given<Sensor>& sensor, const py::sequence& frames) {
  constexpr std::size_t kFrames = 12;
  std::vector<DepthFrame> images;
  std::vector<Pose> poses;
  const std::size_t step = std::max<std::size_t>(1, frames.size() / kFrames);
  for (std::size_t i = 0; i < frames.size() && images.size() < kFrames; i += step) {
    const py::sequence frame = frames[i];
    if (frame.size() < 2)
      throw py::value_error("each entry of frames must be a pair (depth, T_world_camera)");
    const Pose pose =
        pose_batch(doubles(frame[1], "T_world_camera", {4, 4}), "T_world_camera", false).poses[0];
    if (!rigid_pose(pose)) continue;  // the pose is lost
    images.push_back(depth_frame_of_any_unit(*sensor, frame[0]));
    poses.push_back(pose);
  }
  const Suspicion found = outside_gil([&] { return suspect_frames(*sensor, images, poses); });
  py::list all;
  if (!found.kind.empty()) all.append(named("Suspicion", found.kind, found.what));
  return all;
}

void write_poses(const py::object& path, const py::object& T_world_camera,
                 const py::object& timestamps) {
  const std::vector<Pose> poses = pose_list(T_world_camera, "T_world_camera");
  if (poses.empty()) throw py::value_error("poses is empty; give at least one pose");
  const std::string file = writable_file(path);
  std::vector<double> times;
  if (!timestamps.is_none()) {
    const Doubles given = doubles(timestamps, "timestamps", {-1});
    times.assign(given.data(), given.data() + given.size());
  }
  const WithoutGil without_gil;
  if (timestamps.is_none()) {
    save_poses(file, poses);
  } else {
    save_poses(file, poses, times);
  }
}

// Adds to a class that another part of the module has made.
template <typename Class>
py::class_<Class> class_of(py::module_& module, const char* name) {
  return py::reinterpret_borrow<py::class_<Class>>(module.attr(name));
}

void bind_toml(py::module_& module) {
  class_of<Sensor>(module, "Sensor")
      .def_static(
          "load",
          [](const py::object& given) {
            return outside_gil([file = preset_or_file(given)] { return load_sensor(file); });
          },
          "preset_or_file"_a, R"(A sensor from a .toml file, or a preset.

Runs without the GIL. Cost: 0.1 ms.

Parameters
----------
preset_or_file : str or path-like
    A name that ends in .toml is a file, for example from ``save`` or from the program's
    ``simulate``. Any other name is a preset.

Returns
-------
Sensor)")
      .def(
          "save",
          [](const Sensor& self, const py::object& path) {
            outside_gil([&, file = writable_file(path)] { write_sensor_toml(file, self); });
          },
          "path"_a, R"(Writes a .toml file atomically.

Runs without the GIL. Cost: 1 ms.

Parameters
----------
path : path-like
    Must end in .toml.)");
  class_of<ReachRegion>(module, "ReachRegion")
      .def_static(
          "load",
          [](const py::object& path) {
            return outside_gil([file = readable_file(path)] { return read_reach_toml(file); });
          },
          "path"_a, R"(A region from a .toml file: boxes, shells, half-spaces, poses.

Runs without the GIL. Cost: 0.1 ms, and 1 µs per pose.

Parameters
----------
path : path-like

Returns
-------
ReachRegion)")
      .def(
          "save",
          [](const ReachRegion& self, const py::object& path) {
            outside_gil([&, file = writable_file(path)] { write_reach_toml(file, self); });
          },
          "path"_a,
          R"(Writes NAME.toml and, if the region has poses, NAME.poses.txt. Replaces existing files.

A region with a predicate raises ValueError.

Runs without the GIL. Cost: 1 ms, and 2 µs per pose.

Parameters
----------
path : path-like
    Must end in .toml.)");
}

void bind_frames(py::module_& module) {
  auto type = bound_class<FrameSequence>(
      module, "FrameSequence",
      R"(A folder of depth frames, which are read on access. Made by ``read_frames``.

``frames[i]`` and iteration return a ``Frame``. Its depth is corrected with the sensor's
range_calibration. Its pose is NaN if the pose is missing or invalid. ``ViewPlanner.add_frame``
reads, checks and adds a frame.

Notes
-----
Frames are read without the GIL; many threads may read at once. Cost: linear in the pixels of a
frame; ``poses`` is a copy.)");
  refuse_pickling(type);
  type.def(
          "__len__", [](const FrameSequence& self) { return self.images.size(); },
          "Number of frames.\n\nReturns\n-------\nint")
      .def(
          "__iter__",
          [](const py::object& self) {
            (void)py::cast<const FrameSequence&>(self);  // refuses an uninitialised object
            return py::reinterpret_steal<py::object>(PySeqIter_New(self.ptr()));
          },
          "The frames in order.\n\nReturns\n-------\niterator")
      .def("__getitem__", &frame_at, "index"_a,
           R"(Reads a frame.

Parameters
----------
index : int
    Negative indices count from the end.

Returns
-------
Frame)")
      .def_readonly("sensor", &FrameSequence::sensor,
                    "Sensor: sensor of the frames, with the intrinsics of the folder if it has any")
      .def_readonly("depth_scale", &FrameSequence::depth_scale,
                    "float: metres per unit of the depth images")
      .def_property_readonly(
          "poses", [](const FrameSequence& self) { return pose_array(self.poses); },
          "ndarray, (n, 4, 4), float64: T_world_camera")
      .def("__repr__", [](const FrameSequence& self) {
        std::ostringstream text;
        text << "<FrameSequence of " << self.images.size() << " frames, " << self.sensor.name
             << ">";
        return text.str();
      });

  module.def("read_frames", &read_frames, "folder"_a, py::kw_only(), "sensor"_a = py::none(),
             "depth_scale"_a = py::none(), "out_of_range"_a = py::none(),
             R"(Opens a folder of depth frames.

Reads the poses, but no images yet, without the GIL. Cost: linear in the number of frames.

Parameters
----------
folder : path-like
    Contains frame-NNNNNN.depth.png (16 bit), and one of two layouts. The program's ``simulate``
    writes poses.txt (TUM) and sensor.toml. Recordings have frame-NNNNNN.pose.txt and
    camera-intrinsics.txt. A file frames.toml can state how to read the images. A UserWarning lists
    what was assumed.
sensor : str or path-like, optional
    Name of a preset, or a .toml file; default: the sensor of the folder.
depth_scale : float, optional
    Metres per unit of the images; default: that of frames.toml, otherwise 1e-4 with poses.txt and
    1e-3 with pose files.
out_of_range : {"carve", "invalid"}, optional
    Meaning of 65535 in a depth image. "carve": free up to max_range. "invalid": no measured depth.
    Default: that of frames.toml or the sensor's file, otherwise "carve" with poses.txt and
    "invalid" with pose files.

Returns
-------
FrameSequence)");

  module.def("suspect_frames", &suspicions, "sensor"_a, "frames"_a,
             R"(Probable mistakes in the units, conventions or intrinsics of frames of one scene.

Compares the surfaces of a dozen frames as given, and with each common mistake corrected. Ignores
frames without overlap. Runs without the GIL. Cost: up to 0.7 s.

Parameters
----------
sensor : Sensor
    For example ``frames.sensor`` of ``read_frames``.
frames : sequence of frames
    A FrameSequence, or pairs (depth, T_world_camera) as for ``ViewPlanner.add``. Here depths may be
    in any unit. Frames without a rigid pose are ignored.

Returns
-------
list of Suspicion
    Empty: nothing is suspected.)");
}

}  // namespace

void bind_files(py::module_& module) {
  bind_toml(module);
  bind_frames(module);
  module.def(
      "read_poses", [](const py::object& path) { return pose_array(pose_list_of(path).poses); },
      "path"_a, R"(Reads poses from TUM text (time tx ty tz qx qy qz qw) or from a .npy file.

Runs without the GIL. Cost: 1 µs per pose.

Parameters
----------
path : path-like
    A name that ends in .npy is a file with rows tx, ty, tz, qx, qy, qz, qw and optionally
    timestamp, or with (n, 4, 4) matrices, in float64 or float32. Any other name is TUM text.

Returns
-------
ndarray, (n, 4, 4), float64)");
  module.def(
      "read_timed_poses",
      [](const py::object& path) {
        const PoseList list = pose_list_of(path);
        return named("TimedPoses", pose_array(list.poses), to_array_1d<double>(list.timestamps));
      },
      "path"_a, R"(Reads poses and their times from a file; see ``read_poses``.

Parameters
----------
path : path-like

Returns
-------
TimedPoses)");
  module.def("write_poses", &write_poses, "path"_a, "T_world_camera"_a, "timestamps"_a = py::none(),
             R"(Writes poses as TUM text or .npy, according to the ending of the name. Atomic.

Runs without the GIL. Cost: 2 µs per pose.

Parameters
----------
path : path-like
    Must end in .txt or .tum (TUM text), or .npy (rows with timestamp, tx, ty, tz, qx, qy, qz, qw).
T_world_camera : array_like, (n, 4, 4)
timestamps : array_like, (n,), optional
    [s]; default: 0, 1, 2, ...)");
}

}  // namespace viewgain::python
