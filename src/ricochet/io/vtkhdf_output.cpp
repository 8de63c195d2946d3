#include <optional>

#include "ricochet/io/frame_output.hpp"
#include "ricochet/io/mesh_datasets.hpp"
#include "ricochet/io/obstacle_surfaces.hpp"
#include "ricochet/io/vtkhdf_reader.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

/// Values of a field in VTK's form, where symmetric tensors have another order.
class VtkValues {
 public:
  explicit VtkValues(const Field& field) : field_(field) {
    if (is_tensor()) reordered_.resize(std::size_t(components * field.rows));
  }
  [[nodiscard]] const void* get() {
    if (!is_tensor()) return field_.values;
    const auto* from = static_cast<const double*>(field_.values);
    for (std::size_t row = 0; row < reordered_.size(); row += components) {
      for (std::size_t k = 0; k < components; ++k)
        reordered_[row + k] = from[row + std::size_t(vtk_tensor_from_ours[k])];
    }
    return reordered_.data();
  }

 private:
  static constexpr int components = 6;
  [[nodiscard]] bool is_tensor() const { return field_.components == components; }

  const Field& field_;
  std::vector<double> reordered_;
};

std::vector<DatasetLayout> vtkhdf_datasets_of(const std::vector<Field>& fields) {
  std::vector<DatasetLayout> result;
  for (const Field& field : fields) {
    result.push_back({(field.location == FieldLocation::nodes ? "PointData/" : "CellData/") + field.name,
                      field.is_integer, field.rows, field.components > 1 ? field.components : 0});
  }
  return result;
}

/// Writes results.vtkhdf, and obstacles.vtkhdf if there are obstacles.
class VtkHdfOutput : public FrameOutput {
 public:
  explicit VtkHdfOutput(const FrameOutputContext& context)
      : directory_(context.directory), obstacles_(context.problem) {
    const DisplacementSpace& space = *context.body.space;
    std::vector<FixedDataset> fixed = mesh_datasets(space, context.problem.contact);
    for (FixedDataset& set : vtkhdf_mesh_datasets(space)) fixed.push_back(std::move(set));
    const FileOfFrames body{"results.vtkhdf", "frames", std::move(fixed), vtkhdf_datasets_of(context.fields)};
    for (const Field& field : context.fields) values_.emplace_back(field);
    const FileOfFrames surfaces = obstacles_.any() ? file_of_surfaces() : FileOfFrames{};
    if (context.saved && obstacles_.any()) {
      FrameFile::check(path(surfaces), surfaces.fixed, surfaces.layout, options_of(context),
                       context.saved->part(surfaces.saved_as));
    }
    open(file_, body, context);
    if (obstacles_.any()) open(obstacle_file_, surfaces, context);
  }

  void write(const State& state) override {
    // The obstacles come first, so that a frame of the body always has them, even if the run is killed in between.
    if (obstacle_file_) {
      const std::vector<double> positions = obstacles_.positions(state.time, state.displacement);
      obstacle_file_->append({positions.data()}, state.time);
    }
    std::vector<const void*> values;
    for (VtkValues& each : values_) values.push_back(each.get());
    file_->append(values, state.time);
  }
  [[nodiscard]] long frames() const override { return file_->frames(); }
  void save(const SnapshotVisitor& visit) override {
    file_->persist(visit.part("frames"));
    if (obstacle_file_) obstacle_file_->persist(visit.part("obstacles"));
  }
  void require_unchanged() const override {
    file_->require_unchanged();
    if (obstacle_file_) obstacle_file_->require_unchanged();
  }
  [[nodiscard]] std::vector<std::string> paths() const override {
    std::vector<std::string> result{directory_ + "/results.vtkhdf"};
    if (obstacle_file_) result.push_back(directory_ + "/obstacles.vtkhdf");
    return result;
  }

 private:
  struct FileOfFrames {
    std::string name, saved_as;
    std::vector<FixedDataset> fixed;
    std::vector<DatasetLayout> layout;
  };

  [[nodiscard]] std::string path(const FileOfFrames& file) const { return directory_ + "/" + file.name; }
  [[nodiscard]] static FrameFileOptions options_of(const FrameOutputContext& context) {
    FrameFileOptions options = context.options;
    options.vtkhdf = true;
    return options;
  }
  void open(std::optional<FrameFile>& file, const FileOfFrames& about, const FrameOutputContext& context) const {
    file.emplace(path(about), about.fixed, about.layout, options_of(context), context.saved_part(about.saved_as));
  }
  [[nodiscard]] FileOfFrames file_of_surfaces() const {
    const int corners = obstacles_.corners();
    const CellShape shape = corners == 2 ? CellShape::interval : CellShape::quadrilateral;
    FileOfFrames file{
        "obstacles.vtkhdf",
        "obstacles",
        vtkhdf_cell_datasets(obstacles_.point_count(), obstacles_.cells(), file_type(shape, 1).vtk, corners),
        {{"Points", false, obstacles_.point_count(), 3}}};
    const std::vector<int>& numbers = obstacles_.numbers();
    file.fixed.push_back({"/VTKHDF/CellData/obstacle", Index(numbers.size()), 0, {}, {numbers.begin(), numbers.end()}});
    return file;
  }

  std::string directory_;
  std::optional<FrameFile> file_;
  std::vector<VtkValues> values_;  ///< of the fields in file_
  ObstacleSurfaces obstacles_;
  std::optional<FrameFile> obstacle_file_;
};

}  // namespace

Registration<ResultsFormat> vtkhdf_format() {
  return {"vtkhdf",
          {.description = "results.vtkhdf, one file with all frames for ParaView 5.12 and later",
           .files = {"results.vtkhdf"},
           .obstacles = "obstacles.vtkhdf",
           .lock = "history.csv",
           .write = write_as<VtkHdfOutput>,
           .open = open_vtkhdf_results,
           .read_obstacles = read_vtkhdf_obstacles}};
}

}  // namespace ricochet
