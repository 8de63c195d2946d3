#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>

#include "ricochet/base/file_version.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/file_change_detector.hpp"
#include "ricochet/io/frame_groups.hpp"
#include "ricochet/io/frame_output.hpp"
#include "ricochet/io/line_checksums.hpp"
#include "ricochet/io/mesh_datasets.hpp"
#include "ricochet/io/obstacle_surfaces.hpp"
#include "ricochet/io/xdmf_reader.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

/// XDMF 3.0 side-file: a temporal collection of grids, a complete document after each of them.
class XdmfFile {
 public:
  /// Creates a file with a collection of this name; with `saved`, continues after the grids that existed when persist()
  /// was called. `included`: another such file, in the same directory, whose collection is displayed with this one; may
  /// be empty. Throws Error(file_access), also if it is not that file.
  XdmfFile(std::string path, const std::string& collection, const std::string& included,
           const std::optional<SnapshotVisitor>& saved);
  void save(const SnapshotVisitor& visit) {
    checksums_.persist(visit, std::filesystem::path(path_).filename().string());
  }

  /// Appends a `Grid` element. Throws Error(file_access), also if another program has changed the file.
  void append(const std::string& grid);
  void require_unchanged() const { change_detector_->require_unchanged(); }

 private:
  std::string path_;
  std::fstream file_;
  std::optional<FileChangeDetector> change_detector_;
  LineChecksums checksums_;  ///< without the closing tags
};

const std::string tail = "    </Grid>\n  </Domain>\n</Xdmf>\n";

XdmfFile::XdmfFile(std::string path, const std::string& collection, const std::string& included,
                   const std::optional<SnapshotVisitor>& saved)
    : path_(std::move(path)) {
  if (saved) {
    checksums_ = LineChecksums(*saved);
    truncate_file(path_, checksums_.length());
  }
  file_.open(path_, std::ios::in | std::ios::out | std::ios::binary | (saved ? std::ios::openmode{} : std::ios::trunc));
  if (!file_) throw_file_error(path_, "write", errno);
  change_detector_.emplace(path_);
  std::string head;
  if (!saved) {
    head = "<?xml version=\"1.0\"?>\n<Xdmf xmlns:xi=\"http://www.w3.org/2001/XInclude\" Version=\"3.0\">\n  <Domain>\n";
    head += fmt::format("    <Information Name=\"{}\" Value=\"{}\"/>\n", version_attribute, version);
    // The include comes first: readers that support only one collection use the last.
    if (!included.empty())
      head += fmt::format("    <xi:include href=\"{}\" xpointer=\"xpointer(/Xdmf/Domain/Grid)\"/>\n", included);
    head += fmt::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", collection);
  }
  append(head);
}

/// Overwrites the closing tags by the grid and new closing tags in one write, once there is space for both.
void XdmfFile::append(const std::string& grid) {
  change_detector_->require_unchanged();
  const std::string text = grid + tail;
  reserve_space(path_, std::int64_t(text.size()));
  errno = 0;
  file_.seekp(checksums_.length());
  file_ << text << std::flush;
  if (!file_) throw_file_error(path_, "write", errno);
  if (!grid.empty()) checksums_.add(grid);
  change_detector_->expect_size(checksums_.length() + std::int64_t(tail.size()));
}

/// XDMF topology of the cells.
std::string topology_of(const DisplacementSpace& space, const FixedDataset& cells) {
  Index count = 0;
  for (const CellBlock& block : space.cells) count += block.size();
  const bool mixed = space.cells.size() > 1;
  return fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" NumberType=\"Int\" "
      "Precision=\"8\" Dimensions=\"{}\">results.h5:/mesh/cells</DataItem></Topology>\n",
      mixed ? "Mixed" : file_type(space.cells.front().shape, space.degree).xdmf, count,
      mixed ? fmt::format("{}", cells.rows) : fmt::format("{} {}", cells.rows, cells.columns));
}

std::string geometry_of(const DisplacementSpace& space) {
  return fmt::format(
      "        <Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{} 3\">results.h5:/mesh/nodes</DataItem></Geometry>\n",
      space.node_count());
}

std::vector<DatasetLayout> datasets_of(const std::vector<Field>& fields) {
  std::vector<DatasetLayout> result;
  for (const Field& field : fields)
    result.push_back({field.name, field.is_integer, field.rows, field.components > 1 ? field.components : 0});
  return result;
}

const char* xdmf_type(int components) { return components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor6"; }

/// Writes results.h5 with results.xdmf, which includes obstacles.xdmf if there are obstacles.
class XdmfOutput : public FrameOutput {
 public:
  explicit XdmfOutput(const FrameOutputContext& context)
      : directory_(context.directory),
        fields_(context.fields),
        precision_(context.options.single ? 4 : 8),
        obstacles_(context.problem) {
    const DisplacementSpace& space = *context.body.space;
    const std::vector<FixedDataset> fixed = mesh_datasets(space, context.problem.contact);
    mesh_ = topology_of(space, fixed[1]) + geometry_of(space);
    file_.emplace(path("results.h5"), fixed, datasets_of(fields_), context.options, context.saved_part("frames"));
    const std::string obstacles = obstacles_.any() ? "obstacles.xdmf" : "";
    if (obstacles_.any()) obstacle_side_.emplace(path(obstacles), "obstacles", "", context.saved_part("obstacles"));
    side_.emplace(path("results.xdmf"), "body", obstacles, context.saved_part("side"));
    for (const Field& field : fields_) values_.push_back(field.values);
  }

  void write(const State& state) override {
    const long frame = file_->frames();
    file_->append(values_, state.time);
    // The data named by the side-file are in the file by now, even if the run is killed before the next frame.
    if (obstacle_side_) obstacle_side_->append(obstacles_.grid(state.time, state.displacement));
    side_->append(grid(state.time, frame));
  }
  [[nodiscard]] long frames() const override { return file_->frames(); }
  void save(const SnapshotVisitor& visit) override {
    file_->persist(visit.part("frames"));
    side_->save(visit.part("side"));
    if (obstacle_side_) obstacle_side_->save(visit.part("obstacles"));
  }
  void require_unchanged() const override {
    file_->require_unchanged();
    side_->require_unchanged();
    if (obstacle_side_) obstacle_side_->require_unchanged();
  }
  [[nodiscard]] std::vector<std::string> paths() const override {
    std::vector<std::string> result{path("results.h5"), path("results.xdmf")};
    if (obstacle_side_) result.push_back(path("obstacles.xdmf"));
    return result;
  }

 private:
  [[nodiscard]] std::string path(const std::string& file) const { return directory_ + "/" + file; }
  [[nodiscard]] std::string grid(double time, long frame) const;

  std::string directory_;
  const std::vector<Field>& fields_;
  std::vector<const void*> values_;
  int precision_;     ///< bytes
  std::string mesh_;  ///< XDMF shared by all frames
  std::optional<FrameFile> file_;
  std::optional<XdmfFile> side_;
  ObstacleSurfaces obstacles_;
  std::optional<XdmfFile> obstacle_side_;
};

std::string XdmfOutput::grid(double time, long frame) const {
  std::string text =
      fmt::format("      <Grid Name=\"body\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n", time);
  text += mesh_;
  for (const Field& field : fields_) {
    text += fmt::format(
        "        <Attribute Name=\"{0}\" AttributeType=\"{1}\" Center=\"{2}\"><DataItem Format=\"HDF\" "
        "NumberType=\"{3}\" Precision=\"{4}\" Dimensions=\"{5}\">results.h5:{6}/{0}</DataItem></Attribute>\n",
        field.name, xdmf_type(field.components), field.location == FieldLocation::nodes ? "Node" : "Cell",
        field.is_integer ? "Int" : "Float", field.is_integer ? 4 : precision_,
        field.components > 1 ? fmt::format("{} {}", field.rows, field.components) : fmt::format("{}", field.rows),
        frame_group_name(frame));
  }
  return text + "      </Grid>\n";
}

}  // namespace

Registration<ResultsFormat> xdmf_format() {
  return {"xdmf",
          {.description = "results.h5 with results.xdmf, which ParaView and meshio read",
           .files = {"results.h5", "results.xdmf"},
           .obstacles = "obstacles.xdmf",
           .lock = "results.xdmf",
           .write = write_as<XdmfOutput>,
           .open = open_xdmf_results,
           .read_obstacles = read_xdmf_obstacles}};
}

}  // namespace ricochet
