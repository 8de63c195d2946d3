#include "ricochet/io/vtkhdf_reader.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "ricochet/base/file_version.hpp"
#include "ricochet/hdf5/hdf5_rows.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/io/file_lock.hpp"

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

/// Dataset with the values of a field, frame after frame.
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
      field.components = int(std::max<Index>(file.extents(vtkhdf_name(field)).second, 1));
      result.fields.push_back(field);
    }
  }
  return result;
}

/// results.vtkhdf, one dataset per field with the rows of all frames in sequence.
class RowsStorage : public ResultsStorage {
 public:
  RowsStorage(const std::string& directory, const ResultsFormat& format) : ResultsStorage(directory, format) {
    frames_ = read_vtkhdf_frames(file());
    look_up(file());
  }

  void read(Index frame, const ResultField& field, Index rows, Values values) override {
    std::visit([&](auto* numbers) { read_numbers(frame, field, rows, *numbers); }, values);
  }

 private:
  void look_up(const Hdf5Reader& file) final {
    for (const ResultField& field : frames_.fields) {
      const std::string name = vtkhdf_name(field);
      values_of_.try_emplace(name, file, name);
    }
  }
  void forget() override { values_of_.clear(); }
  template <class Number>
  void read_numbers(Index frame, const ResultField& field, Index rows, std::vector<Number>& values) {
    static_cast<void>(file());
    values_of_.at(vtkhdf_name(field)).read(frame * rows, rows, values);
    if (field.components != int(vtk_tensor_from_ours.size())) return;
    std::array<Number, vtk_tensor_from_ours.size()> tensor;
    for (auto row = values.begin(); row != values.end(); row += tensor.size()) {
      std::copy_n(row, tensor.size(), tensor.begin());
      for (std::size_t k = 0; k < tensor.size(); ++k) row[vtk_tensor_from_ours[k]] = tensor[k];
    }
  }

  std::map<std::string, Hdf5Rows> values_of_;
};

}  // namespace

std::unique_ptr<ResultsStorage> open_vtkhdf_results(const std::string& directory, const ResultsFormat& format) {
  return std::make_unique<RowsStorage>(directory, format);
}

std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& directory, const ResultsFormat& format) {
  FileLock lock(directory + "/" + format.lock);
  lock.acquire(FileLock::Kind::shared, longest_wait_of_a_reader);
  const std::string path = directory + "/" + format.obstacles;
  const Hdf5Reader file(path);
  require_readable_version(path, file.text_attribute("/", version_attribute));
  const auto whole_numbers = [&file](const std::string& name, double limit) {
    std::vector<int> result;
    for (const std::int64_t value : file.integers(name, file.size(name))) {
      if (value < 0 || double(value) >= limit) file.fail(name, "holds a number that is not a valid index");
      result.push_back(int(value));
    }
    return result;
  };
  const auto points = Index(file.integer("/VTKHDF/NumberOfPoints"));
  ObstacleFrame frame;
  frame.cells = whole_numbers("/VTKHDF/Connectivity", double(points));
  frame.obstacle = whole_numbers("/VTKHDF/CellData/obstacle", 1e6);
  const std::size_t cells = std::max<std::size_t>(frame.obstacle.size(), 1);
  frame.corners = int(frame.cells.size() / cells);
  if (frame.corners < 2 || frame.corners > 4 || frame.cells.size() % cells != 0)
    file.fail("/VTKHDF", "points, cells and obstacles are inconsistent: the file is damaged");
  const Hdf5Rows positions(file, "/VTKHDF/Points");
  std::vector<ObstacleFrame> result;
  for (const double time : times_of(file)) {
    frame.time = time;
    positions.read(points * Index(result.size()), points, frame.positions);
    result.push_back(frame);
  }
  return result;
}

}  // namespace ricochet
