// SPDX-FileCopyrightText: 2026 The viewgain authors
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arrays.hpp"
#include "evaluator.hpp"
#include "viewgain/core/error.hpp"
#include "viewgain/support/columns/mapped_poses.hpp"
#include "viewgain/support/columns/parts.hpp"
#include "viewgain/support/columns/score_job.hpp"

namespace viewgain::python {

// Parts of a job as `viewgain merge` takes them, and lists of poses, for viewgain.distributed.

namespace {

// The numbers of rows with the columns of a pose, or of matrices (n, 4, 4), where they lie.
class PoseNumbers {
 public:
  explicit PoseNumbers(const py::array& poses) : rows_(static_cast<std::size_t>(poses.shape(0))) {
    if (poses.dtype().attr("names").is_none()) {
      const py::object table = poses.attr("reshape")(rows_, 16);
      for (int i = 0; i < 16; ++i) add(table.attr("T")[py::int_(i)]);
    } else {
      for (const char* name : kPoseColumns) add(poses.attr("__getitem__")(name));
    }
  }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const {
    double number = 0;
    const auto* const bytes = reinterpret_cast<const char*>(columns_[column].data());
    std::memcpy(&number, bytes + static_cast<py::ssize_t>(row) * columns_[column].strides(0),
                sizeof number);
    return number;
  }

 private:
  using Column = py::array_t<double, py::array::forcecast>;
  void add(const py::object& column) { columns_.emplace_back(column); }

  std::size_t rows_;
  std::vector<Column> columns_;
};

// What GainEvaluator takes by the same names, and VoxelScene's plane.
ScoreSettings settings_of(const py::dict& settings) {
  const auto given = [&](const char* name, auto unless_given) {
    return settings.contains(name) ? settings[name].cast<decltype(unless_given)>() : unless_given;
  };
  const std::optional<double> none;
  const std::optional<double> plane = given("support_plane", none);
  const GainConfig config = gain_config(
      given("gain", std::string(gain_model_name(kDefaultGain))),
      given("criterion", std::string("log_diagonal")), given("pixel_stride", 1),
      given("prior_sigma", none), given("min_range", none), given("max_range", none),
      given("weights", py::iterable(py::tuple())), given("refinement_weight", none), true);
  if (config.model == GainModel::paper && plane) {
    throw py::value_error("support_plane goes with gain \"surface\" or \"combined\"");
  }
  return {config, std::string(gain_model_name(config.model)), plane};
}

std::string part_head(const std::string& map_hash, const Sensor& sensor, const py::dict& settings,
                      const std::string& isa, const py::array& poses) {
  const PoseNumbers numbers(poses);
  const std::string hash =
      hash_of_poses(numbers.rows(), numbers.columns(),
                    [&](std::size_t row, std::size_t i) { return numbers.at(row, i); });
  return head_text(head_of_job(map_hash, sensor, settings_of(settings), isa, numbers.rows(), hash));
}

std::vector<Column> columns_of(const std::string& gain) {
  return with_pose_columns(gain_columns(parse_gain_model(gain)));
}

py::list part_columns(const std::string& gain) {
  py::list columns;
  for (const Column& column : columns_of(gain)) {
    columns.append(py::make_tuple(column.name, std::string(npy_type(column.type))));
  }
  return columns;
}

void write_part(const py::object& path, const std::string& head, const std::string& gain,
                const py::bytes& rows) {
  const std::string_view bytes = rows;
  Table table{columns_of(gain), std::string(bytes)};
  PartHead said = parse_head("the job", head);
  said.scored = table.size();
  if (said.scored > 0) said.rows.begin = value_at<std::uint64_t>(table.bytes.data());
  said.rows.end = said.rows.begin + said.scored;
  write_table(file_path(path), table, said);
}

py::bytes read_part(const py::object& path, const std::string& head, const std::string& gain) {
  const std::string file = file_path(path);
  PartReader part(file);
  const std::string differs = difference(part.head(), parse_head("the job", head), "this job");
  const std::vector<Column> columns = columns_of(gain);
  if (!differs.empty() || part.columns() != columns) {
    throw Error(ErrorCode::invalid_argument,
                file + ": is of another job (" + differs + "); name a new folder");
  }
  if (part.head().scored == 0 ||
      part.head().scored != part.head().rows.end - part.head().rows.begin) {
    throw Error(ErrorCode::format, file + ": does not hold all rows that it says");
  }
  std::string rows;
  while (const char* row = part.next()) rows.append(row, row_bytes(columns));
  return rows;
}

py::array_t<double> pose_matrices(const py::array& poses) {
  const PoseNumbers numbers(poses);
  std::vector<Pose> found(numbers.rows());
  for (std::size_t row = 0; row < found.size(); ++row) {
    std::array<double, kPoseColumns.size()> one{};
    for (std::size_t i = 0; i < one.size(); ++i) {
      one[i] = numbers.at(row, i);
    }
    if (const auto pose = pose_of_row(one)) {
      found[row] = *pose;
    } else {
      found[row].m.fill(std::numeric_limits<double>::quiet_NaN());  // a bad pose
    }
  }
  return to_array(found, {static_cast<py::ssize_t>(found.size())});
}

// Mended as the program mends what it reads.
py::array_t<double> pose_rows(const py::array& T_world_camera) {
  const std::vector<Pose> poses = pose_batch(T_world_camera, "poses", false).poses;
  py::array_t<double> rows({poses.size(), kPoseColumns.size()});
  double* at = rows.mutable_data();
  for (const Pose& pose : poses) {
    const auto row = row_of_pose(rigid_pose(pose).value_or(pose));
    at = std::copy(row.begin(), row.end(), at);
  }
  return rows;
}

}  // namespace

void bind_parts(py::module_& module) {
  module.def("_part_head", &part_head, "What a job's parts say; rows are none.");
  module.def("_part_columns", &part_columns, "Of the rows, for numpy.dtype.");
  module.def("_write_part", &write_part, "Rows one after the other, as their indices say.");
  module.def("_read_part", &read_part, "The rows of a part of this job.");
  module.def("_pose_matrices", &pose_matrices, "(n, 4, 4) of rows with a pose's columns.");
  module.def("_pose_rows", &pose_rows, "(n, 7), a pose's columns of (n, 4, 4).");
  module.attr("_POSE_COLUMNS") = py::tuple(py::cast(kPoseColumns));
}

}  // namespace viewgain::python
