#include "ricochet/io/results_file.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/obstacle_surfaces.hpp"
#include "ricochet/io/vtk_order.hpp"
#include "ricochet/io/xdmf_file.hpp"

namespace ricochet {

namespace {

FixedDataset node_positions(const DisplacementSpace& space) {
  FixedDataset set{"/mesh/nodes", space.node_count(), 3, {}, {}};
  set.reals.assign(static_cast<std::size_t>(3 * space.node_count()), 0.0);
  for (Index i = 0; i < space.node_count(); ++i) {
    const Index row = space.number[static_cast<std::size_t>(i)];
    for (int k = 0; k < space.dimension; ++k) set.reals[static_cast<std::size_t>(3 * row + k)] = space.nodes(k, i);
  }
  return set;
}

/// Cells of several shapes are one list, in which each begins with XDMF's number of its shape.
struct Cells {
  FixedDataset set{"/mesh/cells", 0, 0, {}, {}};
  std::string topology;  ///< XDMF
};

Cells cells_of(const DisplacementSpace& space) {
  Cells result;
  const bool mixed = space.cells.size() > 1;
  Index count = 0;
  std::string type = "Mixed";
  for (const CellBlock& block : space.cells) {
    count += block.size();
    const VtkCell cell = vtk_cell(block.shape, space.degree);
    if (!mixed) type = cell.xdmf_name;
    for (Index i = 0; i < block.size(); ++i) {
      if (mixed) result.set.integers.push_back(cell.xdmf_number);
      for (const int k : cell.from_ours)
        result.set.integers.push_back(space.number[static_cast<std::size_t>(block.cell(i)[k])]);
    }
  }
  result.set.columns = mixed ? 0 : space.cells.front().nodes_per_cell;
  result.set.rows = mixed ? static_cast<Index>(result.set.integers.size()) : count;
  result.topology = fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" NumberType=\"Int\" "
      "Precision=\"8\" Dimensions=\"{}\">results.h5:/mesh/cells</DataItem></Topology>\n",
      type, count,
      mixed ? fmt::format("{}", result.set.rows) : fmt::format("{} {}", result.set.rows, result.set.columns));
  return result;
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
    result.push_back({field.name, field.whole, field.rows, field.components > 1 ? field.components : 0});
  return result;
}

const char* xdmf_type(int components) {
  return components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor6";
}

}  // namespace

struct ResultsWriter::Implementation {
  Implementation(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                 const ResultsOptions& options, const Snapshot* snapshot, const std::string& name);
  [[nodiscard]] std::string grid(double time, long frame) const;

  std::string path, side_path, obstacle_path;
  std::vector<std::unique_ptr<FieldSource>> sources;
  std::vector<Field> fields;
  std::vector<const void*> values;  ///< of the fields
  int precision;                    ///< bytes
  std::string mesh;                 ///< XDMF shared by all frames
  std::optional<FrameFile> file;
  std::optional<XdmfFile> side;
  ObstacleSurfaces obstacles;
  std::optional<XdmfFile> obstacle_side;
};

ResultsWriter::Implementation::Implementation(const std::string& directory, const Body& body,
                                              const SemidiscreteProblem& problem, const ResultsOptions& options,
                                              const Snapshot* snapshot, const std::string& name)
    : path(directory + "/results.h5"),
      side_path(directory + "/results.xdmf"),
      obstacle_path(directory + "/obstacles.xdmf"),
      sources(make_field_sources({body, problem, wanted_fields(options.fields)})),
      precision(options.file.single ? 4 : 8),
      obstacles(problem) {
  for (const auto& source : sources) {
    for (const Field& field : source->fields()) fields.push_back(field);
  }
  for (const Field& field : fields) values.push_back(field.values);
  const DisplacementSpace& space = *body.space;
  Cells cells = cells_of(space);
  mesh = cells.topology + geometry_of(space);
  const std::vector<FixedDataset> fixed{node_positions(space), std::move(cells.set)};
  if (snapshot == nullptr) {
    file.emplace(path, fixed, datasets_of(fields), options.file);
    if (obstacles.any()) obstacle_side.emplace(obstacle_path, "obstacles");
    side.emplace(side_path, "body", obstacles.any() ? "obstacles.xdmf" : "");
  } else {
    file.emplace(path, fixed, datasets_of(fields), options.file, *snapshot, name + ".frames");
    if (obstacles.any()) obstacle_side.emplace(obstacle_path, *snapshot, name + ".obstacles");
    side.emplace(side_path, *snapshot, name + ".side");
  }
}

std::string ResultsWriter::Implementation::grid(double time, long frame) const {
  std::string text =
      fmt::format("      <Grid Name=\"body\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n", time);
  text += mesh;
  for (const Field& field : fields) {
    text += fmt::format(
        "        <Attribute Name=\"{0}\" AttributeType=\"{1}\" Center=\"{2}\"><DataItem Format=\"HDF\" "
        "NumberType=\"{3}\" Precision=\"{4}\" Dimensions=\"{5}\">results.h5:{6}/{0}</DataItem></Attribute>\n",
        field.name, xdmf_type(field.components), field.place == FieldPlace::nodes ? "Node" : "Cell",
        field.whole ? "Int" : "Float", field.whole ? 4 : precision,
        field.components > 1 ? fmt::format("{} {}", field.rows, field.components) : fmt::format("{}", field.rows),
        FrameFile::frame_name(frame));
  }
  return text + "      </Grid>\n";
}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, nullptr, "")) {}

ResultsWriter::ResultsWriter(const std::string& directory, const Body& body, const SemidiscreteProblem& problem,
                             const ResultsOptions& options, const Snapshot& snapshot, const std::string& name)
    : implementation_(std::make_unique<Implementation>(directory, body, problem, options, &snapshot, name)) {}

ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::write(const State& state) {
  Implementation& own = *implementation_;
  for (const auto& source : own.sources) source->evaluate(state);
  const long frame = own.file->frames();
  own.file->append(own.values);
  // What the side-file names is in the file by now, even if the run is killed before the next frame.
  if (own.obstacle_side) own.obstacle_side->append(own.obstacles.grid(state.time));
  own.side->append(own.grid(state.time, frame));
}

long ResultsWriter::frames() const {
  return implementation_->file->frames();
}

void ResultsWriter::save(Snapshot& snapshot, const std::string& name) const {
  implementation_->file->save(snapshot, name + ".frames");
  implementation_->side->save(snapshot, name + ".side");
  if (implementation_->obstacle_side) implementation_->obstacle_side->save(snapshot, name + ".obstacles");
}

void ResultsWriter::sync() const {
  sync_to_disk(implementation_->path);
  sync_to_disk(implementation_->side_path);
  if (implementation_->obstacle_side) sync_to_disk(implementation_->obstacle_path);
}

}  // namespace ricochet
