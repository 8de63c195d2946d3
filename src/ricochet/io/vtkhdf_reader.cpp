#include "ricochet/io/vtkhdf_reader.hpp"

#include <algorithm>

#include "ricochet/base/file_version.hpp"
#include "ricochet/hdf5/hdf5_rows.hpp"
#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

/// Tolerates a number of steps that differs from that of times, as after a killed run.
std::vector<double> times_of(const Hdf5Reader& file) {
  const std::string name = "/VTKHDF/Steps/Values";
  const std::int64_t size = file.size(name);
  const std::int64_t count = std::clamp<std::int64_t>(file.attribute("/VTKHDF/Steps", "NSteps"), 0, size);
  const Vector times = file.leading_reals(name, count, size);
  return {times.begin(), times.end()};
}

}  // namespace

std::string vtkhdf_name(const ResultField& field) {
  return (field.on_nodes ? "/VTKHDF/PointData/" : "/VTKHDF/CellData/") + field.name;
}

ResultFrames read_vtkhdf_frames(const Hdf5Reader& file) {
  ResultFrames result;
  result.times = times_of(file);
  // In the order of the registry, and fields only.
  for (const std::string& name : field_names()) {
    for (const bool on_nodes : {true, false}) {
      ResultField field{name, on_nodes, 1};
      if (!file.has_dataset(vtkhdf_name(field))) continue;
      field.components = static_cast<int>(std::max<Index>(file.extents(vtkhdf_name(field)).second, 1));
      result.fields.push_back(field);
    }
  }
  return result;
}

std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& path) {
  const Hdf5Reader file(path);
  require_readable_version(path, file.text_attribute("/", version_attribute));
  const auto whole_numbers = [&file](const std::string& name, double limit) {
    std::vector<int> result;
    for (const std::int64_t value : file.integers(name, file.size(name))) {
      if (value < 0 || static_cast<double>(value) >= limit) file.fail(name, "holds a number that is not a valid index");
      result.push_back(static_cast<int>(value));
    }
    return result;
  };
  const auto points = static_cast<Index>(file.integer("/VTKHDF/NumberOfPoints"));
  ObstacleFrame frame;
  frame.cells = whole_numbers("/VTKHDF/Connectivity", static_cast<double>(points));
  frame.obstacle = whole_numbers("/VTKHDF/CellData/obstacle", 1e6);
  const std::size_t cells = std::max<std::size_t>(frame.obstacle.size(), 1);
  frame.corners = static_cast<int>(frame.cells.size() / cells);
  if (frame.corners < 2 || frame.corners > 4 || frame.cells.size() % cells != 0)
    file.fail("/VTKHDF", "points, cells and obstacles are inconsistent: the file is damaged");
  const Hdf5Rows positions(file, "/VTKHDF/Points");
  std::vector<ObstacleFrame> result;
  for (const double time : times_of(file)) {
    frame.time = time;
    positions.read(points * static_cast<Index>(result.size()), points, frame.positions);
    result.push_back(frame);
  }
  return result;
}

}  // namespace ricochet
