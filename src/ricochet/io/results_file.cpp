#include "ricochet/io/results_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/file_lock.hpp"
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

/// Cells (or facets) of a block by their numbers in it.
struct Part {
  const CellBlock* block;
  std::vector<Index> members;
};

/// One row for each cell; cells of several shapes are one list, in which each begins with XDMF's number of its shape.
FixedDataset connectivity(const DisplacementSpace& space, const std::string& name, const std::vector<Part>& parts) {
  FixedDataset set{name, 0, 0, {}, {}};
  const bool mixed = parts.size() > 1;
  for (const Part& part : parts) {
    const VtkCell cell = vtk_cell(part.block->shape, space.degree);
    for (const Index i : part.members) {
      if (mixed) set.integers.push_back(cell.xdmf_number);
      for (const int k : cell.from_ours)
        set.integers.push_back(space.number[static_cast<std::size_t>(part.block->cell(i)[k])]);
    }
  }
  set.columns = mixed ? 0 : parts.front().block->nodes_per_cell;
  set.rows = static_cast<Index>(set.integers.size()) / std::max<Index>(set.columns, 1);
  return set;
}

FixedDataset cells_of(const DisplacementSpace& space) {
  std::vector<Part> parts;
  for (const CellBlock& block : space.cells) {
    parts.push_back({&block, std::vector<Index>(static_cast<std::size_t>(block.size()))});
    std::iota(parts.back().members.begin(), parts.back().members.end(), Index{0});
  }
  return connectivity(space, "/mesh/cells", parts);
}

/// The number of each cell in the mesh file.
FixedDataset element_numbers(const DisplacementSpace& space) {
  FixedDataset set{"/mesh/element", 0, 0, {}, {}};
  for (const CellBlock& block : space.cells)
    set.integers.insert(set.integers.end(), block.tags.begin(), block.tags.end());
  set.rows = static_cast<Index>(set.integers.size());
  return set;
}

FixedDataset contact_facets_of(const DisplacementSpace& space, const ContactBoundary& contact) {
  std::vector<Part> parts;
  for (const Index facet : contact.facets) {
    const PlaceInBlocks place = locate_facet(space, facet);
    const CellBlock* block = &space.facets[place.block];
    if (parts.empty() || parts.back().block != block) parts.push_back({block, {}});
    parts.back().members.push_back(place.local);
  }
  return connectivity(space, "/mesh/contact_facets", parts);
}

/// XDMF of the cells.
std::string topology_of(const DisplacementSpace& space, const FixedDataset& cells) {
  Index count = 0;
  for (const CellBlock& block : space.cells) count += block.size();
  const bool mixed = space.cells.size() > 1;
  return fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" NumberType=\"Int\" "
      "Precision=\"8\" Dimensions=\"{}\">results.h5:/mesh/cells</DataItem></Topology>\n",
      mixed ? "Mixed" : vtk_cell(space.cells.front().shape, space.degree).xdmf_name, count,
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
    result.push_back({field.name, field.whole, field.rows, field.components > 1 ? field.components : 0});
  return result;
}

const char* xdmf_type(int components) {
  return components == 1 ? "Scalar" : components == 3 ? "Vector" : "Tensor6";
}

/// Who looks at the frames does that for a moment; who does not let go does not stop the run.
constexpr double longest_wait_of_the_writer = 2.0;

/// Nobody opens the files while they change.
class LockedFrames {
 public:
  explicit LockedFrames(FileLock& lock) : lock_(lock) {
    lock_.acquire(FileLock::Kind::exclusive, longest_wait_of_the_writer);
  }
  ~LockedFrames() { lock_.release(); }
  LockedFrames(const LockedFrames&) = delete;
  LockedFrames& operator=(const LockedFrames&) = delete;

 private:
  FileLock& lock_;
};

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
  std::optional<FileLock> lock;  ///< of results.xdmf, which HDF5 does not lock
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
  std::vector<FixedDataset> fixed{node_positions(space), cells_of(space)};
  mesh = topology_of(space, fixed.back()) + geometry_of(space);
  fixed.push_back(element_numbers(space));
  if (!problem.contact.facets.empty()) fixed.push_back(contact_facets_of(space, problem.contact));
  if (snapshot == nullptr) {
    file.emplace(path, fixed, datasets_of(fields), options.file);
    if (obstacles.any()) obstacle_side.emplace(obstacle_path, "obstacles");
    side.emplace(side_path, "body", obstacles.any() ? "obstacles.xdmf" : "");
  } else {
    lock.emplace(side_path);
    const LockedFrames locked(*lock);
    file.emplace(path, fixed, datasets_of(fields), options.file, *snapshot, name + ".frames");
    if (obstacles.any()) obstacle_side.emplace(obstacle_path, *snapshot, name + ".obstacles");
    side.emplace(side_path, *snapshot, name + ".side");
  }
  if (!lock) lock.emplace(side_path);
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
  const LockedFrames locked(*own.lock);
  own.file->append(own.values);
  // What the side-file names is in the file by now, even if the run is killed before the next frame.
  if (own.obstacle_side) own.obstacle_side->append(own.obstacles.grid(state.time, state.displacement));
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
