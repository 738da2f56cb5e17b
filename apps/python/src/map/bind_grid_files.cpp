// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "arrays.hpp"
#include "classes.hpp"
#include "gil.hpp"
#include "given.hpp"
#include "grid_class.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/core/sensor.hpp"
#include "viewgain/formats/map_file.hpp"
#include "viewgain/formats/octomap_io.hpp"
#include "viewgain/grid/vdb_io.hpp"
#include "viewgain/support/file_bytes.hpp"
#include "viewgain/support/file_names.hpp"

namespace viewgain::python {

namespace {

/// A private temporary folder, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "viewgain-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) {
      throw Error(ErrorCode::io, pattern + ": cannot create a temporary folder");
    }
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string map() const { return (path_ / "map.vdb").string(); }

 private:
  std::filesystem::path path_;
};

// OpenVDB's streams have no seal, so the bytes are those of a file.
py::bytes bytes_of(const SharedGrid& grid) {
  return grid.read([](const BeliefGrid& g) {
    const TemporaryFolder folder;
    save_vdb(g, folder.map());
    return file_bytes(folder.map());
  });
}

std::shared_ptr<SharedGrid> from_bytes(const py::bytes& data) {
  const auto bytes = data.cast<std::string>();
  const WithoutGil without_gil;
  const TemporaryFolder folder;
  if (!(std::ofstream(folder.map(), std::ios::binary) << bytes << std::flush)) {
    throw Error(ErrorCode::io, folder.map() + ": cannot be written");
  }
  try {
    return std::make_shared<SharedGrid>(load_vdb(folder.map()));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::format) throw;
    throw Error(ErrorCode::format, "these bytes are not a map from to_bytes()");
  }
}

}  // namespace

void bind_grid_files(GridClass& grid_class) {
  // By name, so that pickles outlive the extension's own names.
  grid_class.def("__reduce_ex__", [](const py::object& self, int) {
    const py::type of_self = py::type::of(self), own = py::type::of<SharedGrid>();
    if (!of_self.is(own)) {  // attributes of a subclass would be lost
      throw py::type_error("cannot pickle '" + of_self.attr("__name__").cast<std::string>() +
                           "' object: it is a subclass of BeliefGrid");
    }
    const py::object call = py::module_::import("operator").attr("methodcaller");
    return py::make_tuple(call("from_bytes", self.attr("to_bytes")()), py::make_tuple(of_self));
  });
  grid_class
      .def_property_readonly(
          "sensor",
          [](const SharedGrid& grid) {
            return grid.read([](const BeliefGrid& g) { return map_sensor(g); });
          },
          "Sensor or None: sensor of all frames; None if there are several or it is unknown. "
          "Kept in files, copies and pickles.")
      .def_property_readonly(
          "frames",
          [](const SharedGrid& grid) {
            return grid.read([](const BeliefGrid& g) {
              const auto& frames = g.notes().frames;
              return std::vector<std::string>(frames.begin(), frames.end());
            });
          },
          "list of str: identities of the map's frames from folders, which ``viewgain integrate "
          "--map`` skips. Kept in files, copies and pickles.");
  grid_class
      .def("to_bytes", &bytes_of,
           R"(The map as bytes: the contents of a .vdb file of ``save``.

``from_bytes`` and pickles use them. Writes a temporary file. Cost: linear in the blocks of voxels;
0.1 s for 128**3 voxels with 40,000 occupied ones. ``from_bytes`` takes half as long.

Returns
-------
bytes)")
      .def_static("from_bytes", &from_bytes, "data"_a,
                  R"(The map from the bytes of ``to_bytes``, equal to the original.

Parameters
----------
data : bytes

Returns
-------
BeliefGrid)")
      .def_static(
          "load",
          [](const py::object& path, const py::object& workspace, std::optional<double> prior_sigma,
             const GivenOrNone<Sensor>& given, std::optional<double> occupied_from) {
            const std::string file = readable_file(path);
            const Sensor* sensor = given.value;
            OctomapConfig config;
            if (!workspace.is_none()) config.workspace = box(workspace, "workspace");
            if (is_octomap(file)) {
              require_prior(prior_sigma, sensor);
            } else if (!workspace.is_none() || prior_sigma || occupied_from) {
              refuse(file +
                     ": workspace, prior_sigma and occupied_from require an OctoMap file (.ot or "
                     ".bt); a .vdb file defines them");
            }
            if (occupied_from) config.occupied_from = static_cast<float>(*occupied_from);
            config.prior_sigma = prior_sigma;
            const WithoutGil without_gil;
            return std::make_shared<SharedGrid>(load_map(file, sensor, config));
          },
          "path"_a, py::kw_only(), "workspace"_a = py::none(), "prior_sigma"_a = py::none(),
          "sensor"_a = py::none(), "occupied_from"_a = py::none(),
          R"(Reads a map: a .vdb file of ``save`` or the program viewgain, or an OctoMap .ot or .bt.

An OctoMap file only has states, and if it is a .ot, log-odds. Runs without the GIL. Cost: 50 ms for
a .vdb of 4 MB; 20 ms for an OctoMap of 128**3 voxels with 40,000 occupied ones.

Parameters
----------
path : path-like
workspace : array_like, (2, 3), optional
    Only for OctoMap: lowest and highest corner [m], in the frame of the file; default: the bounding
    box of its known voxels.
prior_sigma : float, optional
    Only for OctoMap: standard deviation of the surface position in an unknown voxel [m].
sensor : Sensor, optional
    Only for OctoMap: as for a new grid; sensor or prior_sigma is required.
occupied_from : float, optional
    Only for .ot: log-odds above which a voxel is occupied; default: 0.

Returns
-------
BeliefGrid)")
      .def(
          "save",
          [](const SharedGrid& grid, const py::object& path, bool with_covariance) {
            const std::string file = writable_file(path);
            grid.read([&](const BeliefGrid& g) { return save_map(g, file, {with_covariance}); });
          },
          "path"_a, py::kw_only(), "with_covariance"_a = false,
          R"(Writes the map as an OpenVDB file, or as an OctoMap .ot. Atomic.

A .ot file only has states and log-odds. It is in the world frame if T_world_grid is a shift by
whole voxels, otherwise in the grid frame. Cost: 80 ms for 128**3 voxels with 40,000 occupied ones
(4 MB).

Parameters
----------
path : path-like
    Must end in .vdb or .ot.
with_covariance : bool
    Adds covariances and mean positions to a .vdb file, for viewers.)");
}

}  // namespace viewgain::python
