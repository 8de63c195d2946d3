#include "ricochet/io/results_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/io/hdf5_handle.hpp"
#include "ricochet/io/vtk_order.hpp"

namespace ricochet {

struct ResultsWriter::Implementation {
  std::string path;
  std::string side_path;
  hid_t file = -1;
  std::fstream side;
  const SemidiscreteProblem* problem = nullptr;
  std::string topology;  ///< XDMF text shared by all frames
  std::string geometry;
  long frames = 0;
  std::vector<Index> numbers;  ///< of the nodes in the file
  std::vector<double> vector_values, pressure, gap;
  std::vector<int> status;
  Vector node_gap, node_pressure, traction;

  [[nodiscard]] Index number(Index node) const { return numbers[static_cast<std::size_t>(node)]; }
  void check(bool good, const char* what) const {
    if (!good) throw Error(ErrorKind::file_access, fmt::format("{}: cannot write {} (is the disk full?)", path, what));
  }
  void dataset(const std::string& name, hid_t file_type, hid_t memory_type, hsize_t rows, hsize_t columns,
               const void* data) const;
  void group(const std::string& name) const;
  void write_mesh(const DisplacementSpace& space);
  void vector_field(const std::string& name, const Vector& values);
  void contact_fields(const State& state);
  void friction_field(const std::string& name, const State& state);
  void write_side_frame(const State& state, const std::string& frame);
};

namespace {

constexpr const char* side_tail = "    </Grid>\n  </Domain>\n</Xdmf>\n";

}  // namespace

void ResultsWriter::Implementation::dataset(const std::string& name, hid_t file_type, hid_t memory_type, hsize_t rows,
                                            hsize_t columns, const void* data) const {
  const hsize_t extents[2] = {rows, columns};
  const Hdf5Handle space(H5Screate_simple(columns > 0 ? 2 : 1, extents, nullptr), H5Sclose);
  const Hdf5Handle properties = timeless_hdf5_properties(H5P_DATASET_CREATE);
  const Hdf5Handle set(H5Dcreate2(file, name.c_str(), file_type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                       H5Dclose);
  check(set >= 0 && H5Dwrite(set, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0, name.c_str());
}

void ResultsWriter::Implementation::group(const std::string& name) const {
  check(make_hdf5_group(file, name.c_str()), name.c_str());
}

void ResultsWriter::Implementation::write_mesh(const DisplacementSpace& space) {
  group("/mesh");
  group("/frames");
  numbers = space.number;
  const auto count = static_cast<hsize_t>(space.node_count());
  std::vector<double> positions(count * 3, 0.0);
  for (Index i = 0; i < space.node_count(); ++i) {
    for (int k = 0; k < space.dimension; ++k)
      positions[static_cast<std::size_t>(3 * number(i) + k)] = space.nodes(k, i);
  }
  dataset("/mesh/nodes", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, 3, positions.data());
  geometry = fmt::format(
      "        <Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" NumberType=\"Float\" Precision=\"8\" "
      "Dimensions=\"{} 3\">results.h5:/mesh/nodes</DataItem></Geometry>\n",
      count);
  Index cell_count = 0;
  for (const CellBlock& block : space.cells) cell_count += block.size();
  const bool mixed = space.cells.size() > 1;
  std::vector<std::int64_t> all;
  for (const CellBlock& block : space.cells) {
    const VtkCell cell = vtk_cell(block.shape, space.degree);
    if (!mixed) topology = cell.xdmf_name;
    for (Index i = 0; i < block.size(); ++i) {
      if (mixed) all.push_back(cell.xdmf_number);
      for (const int k : cell.from_ours) all.push_back(number(block.cell(i)[k]));
    }
  }
  const auto columns = mixed ? hsize_t{0} : static_cast<hsize_t>(space.cells.front().nodes_per_cell);
  const hsize_t rows = mixed ? all.size() : static_cast<hsize_t>(cell_count);
  dataset("/mesh/cells", H5T_STD_I64LE, H5T_NATIVE_INT64, rows, columns, all.data());
  topology = fmt::format(
      "        <Topology TopologyType=\"{}\" NumberOfElements=\"{}\"><DataItem Format=\"HDF\" NumberType=\"Int\" "
      "Precision=\"8\" Dimensions=\"{}\">results.h5:/mesh/cells</DataItem></Topology>\n",
      mixed ? "Mixed" : topology, cell_count, mixed ? fmt::format("{}", rows) : fmt::format("{} {}", rows, columns));
}

void ResultsWriter::Implementation::vector_field(const std::string& name, const Vector& values) {
  const int d = problem->dimension;
  const auto count = static_cast<std::size_t>(problem->nodes.cols());
  vector_values.assign(3 * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 0; k < d; ++k) {
      vector_values[3 * static_cast<std::size_t>(numbers[i]) + static_cast<std::size_t>(k)] =
          values[static_cast<Index>(i) * d + k];
    }
  }
  dataset(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, 3, vector_values.data());
}

void ResultsWriter::Implementation::contact_fields(const State& state) {
  const auto count = static_cast<std::size_t>(problem->nodes.cols());
  pressure.assign(count, 0.0);
  gap.assign(count, std::numeric_limits<double>::quiet_NaN());
  status.assign(count, -1);
  const ContactBoundary& contact = problem->contact;
  problem->node_gaps(state.displacement, state.time, node_gap);
  node_pressure = contact.pressure_recovery * state.forces.normal_reaction;
  for (Index i = 0; i < node_gap.size(); ++i) {
    const auto node = static_cast<std::size_t>(number(contact.nodes[static_cast<std::size_t>(i)]));
    pressure[node] = std::max(pressure[node], node_pressure[i]);
    gap[node] = status[node] < 0 ? node_gap[i] : std::min(gap[node], node_gap[i]);
    status[node] = std::max(status[node], 0);
    // A node does what its own contact point does, or, without one, what those do that its pressure comes from.
    const auto take = [&](Index point) {
      const auto at = static_cast<std::size_t>(point);
      if (at < state.contact_status.size())
        status[node] = std::max(status[node], static_cast<int>(state.contact_status[at]));
    };
    const Index own = contact.own_point[static_cast<std::size_t>(i)];
    if (own >= 0) {
      take(own);
      continue;
    }
    for (SparseRowMatrix::InnerIterator entry(contact.pressure_recovery, i); entry; ++entry) {
      if (entry.value() != 0.0) take(entry.col());
    }
  }
}

/// The friction traction on the body, in stress units: −t r_T of the points, recovered at the nodes like pressures.
void ResultsWriter::Implementation::friction_field(const std::string& name, const State& state) {
  const ContactBoundary& contact = problem->contact;
  const int d = problem->dimension;
  traction.setZero(problem->dof_count());
  for (std::size_t i = 0; i < contact.nodes.size() && state.forces.tangential_reaction.size() > 0; ++i) {
    for (SparseRowMatrix::InnerIterator entry(contact.pressure_recovery, static_cast<Index>(i)); entry; ++entry) {
      traction.segment(contact.nodes[i] * d, d) -=
          entry.value() * contact.tangents[static_cast<std::size_t>(entry.col())] *
          state.forces.tangential_reaction.segment(entry.col() * (d - 1), d - 1);
    }
  }
  vector_field(name, traction);
}

void ResultsWriter::Implementation::write_side_frame(const State& state, const std::string& frame) {
  const auto count = problem->nodes.cols();
  const auto attribute = [&](const char* name, const char* kind, const char* type, const std::string& extents) {
    return fmt::format(
        "        <Attribute Name=\"{0}\" AttributeType=\"{1}\" Center=\"Node\"><DataItem Format=\"HDF\" {2} "
        "Dimensions=\"{3}\">results.h5:{4}/{0}</DataItem></Attribute>\n",
        name, kind, type, extents, frame);
  };
  const char* const real = "NumberType=\"Float\" Precision=\"8\"";
  const char* const whole = "NumberType=\"Int\" Precision=\"4\"";
  std::string text =
      fmt::format("      <Grid Name=\"body\" GridType=\"Uniform\">\n        <Time Value=\"{:.17g}\"/>\n", state.time);
  text += topology + geometry;
  text += attribute("displacement", "Vector", real, fmt::format("{} 3", count));
  text += attribute("velocity", "Vector", real, fmt::format("{} 3", count));
  text += attribute("contact_pressure", "Scalar", real, fmt::format("{}", count));
  if (problem->contact.has_friction()) {
    text += attribute("friction_traction", "Vector", real, fmt::format("{} 3", count));
  }
  text += attribute("gap", "Scalar", real, fmt::format("{}", count));
  text += attribute("contact_status", "Scalar", whole, fmt::format("{}", count));
  text += "      </Grid>\n";
  text += side_tail;
  // The file is complete after every frame: the tail is overwritten by the next one, in one piece with what follows.
  const auto tail_at = static_cast<std::streamoff>(side.tellp()) - static_cast<std::streamoff>(std::strlen(side_tail));
  side.seekp(tail_at);
  side << text << std::flush;
  if (!side) throw Error(ErrorKind::file_access, fmt::format("{}: cannot write: {}", side_path, std::strerror(errno)));
}

ResultsWriter::ResultsWriter(const std::string& directory, const DisplacementSpace& space,
                             const SemidiscreteProblem& problem)
    : implementation_(std::make_unique<Implementation>()) {
  Implementation& own = *implementation_;
  own.problem = &problem;
  own.path = directory + "/results.h5";
  own.side_path = directory + "/results.xdmf";
  quiet_hdf5();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  own.file = H5Fcreate(own.path.c_str(), H5F_ACC_TRUNC, timeless_hdf5_properties(H5P_FILE_CREATE), access);
  own.check(own.file >= 0, "the file");
  own.write_mesh(space);
  own.side.open(own.side_path, std::ios::in | std::ios::out | std::ios::trunc | std::ios::binary);
  own.side << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
              "    <Grid Name=\"time\" GridType=\"Collection\" CollectionType=\"Temporal\">\n"
           << side_tail;
  if (!own.side)
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot write: {}", own.side_path, std::strerror(errno)));
}

ResultsWriter::~ResultsWriter() {
  if (implementation_->file >= 0) H5Fclose(implementation_->file);
}

void ResultsWriter::write(const State& state) {
  Implementation& own = *implementation_;
  const std::string frame = fmt::format("/frames/{:06d}", own.frames);
  own.group(frame);
  own.vector_field(frame + "/displacement", state.displacement);
  own.vector_field(frame + "/velocity", state.velocity);
  own.contact_fields(state);
  if (own.problem->contact.has_friction()) own.friction_field(frame + "/friction_traction", state);
  const auto count = static_cast<hsize_t>(own.problem->nodes.cols());
  own.dataset(frame + "/contact_pressure", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, 0, own.pressure.data());
  own.dataset(frame + "/gap", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, count, 0, own.gap.data());
  own.dataset(frame + "/contact_status", H5T_STD_I32LE, H5T_NATIVE_INT, count, 0, own.status.data());
  // What the side-file names must be in the file even if the run is killed before the next frame.
  own.check(H5Fflush(own.file, H5F_SCOPE_LOCAL) >= 0, "the file");
  own.write_side_frame(state, frame);
  ++own.frames;
}

long ResultsWriter::frames() const {
  return implementation_->frames;
}

void ResultsWriter::close() {
  Implementation& own = *implementation_;
  if (own.file < 0) return;
  const bool good = H5Fflush(own.file, H5F_SCOPE_GLOBAL) >= 0 && H5Fclose(own.file) >= 0;
  own.file = -1;
  own.check(good, "the file");
}

}  // namespace ricochet
