#include "ricochet/io/results_reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/vtk_order.hpp"

namespace ricochet {

struct ResultsReader::File {
  /// What tells a file from another one at its path, also where that has the same number again.
  struct Identity {
    std::uint64_t number = 0;
    std::int64_t born = 0, born_part = 0;  ///< seconds and nanoseconds, where the file system knows
    bool operator==(const Identity&) const = default;
  };

  explicit File(std::string name)
      : path(std::move(name)), reader(path), frames(reader->members("/frames")), identity(identify(path)) {}

  static Identity identify(const std::string& path) {
    struct statx file {};
    if (statx(AT_FDCWD, path.c_str(), 0, STATX_INO | STATX_BTIME, &file) != 0) return {};
    return {file.stx_ino, file.stx_btime.tv_sec, file.stx_btime.tv_nsec};
  }

  const Hdf5Reader& open() {
    if (reader) return *reader;
    reader.emplace(path);
    if (identify(path) != identity)
      reader->fail("/frames", "another run has been written since this one was read: read it again");
    return *reader;
  }

  std::string path;
  std::optional<Hdf5Reader> reader;
  std::vector<Hdf5Member> frames;  ///< looked up at once: a run may go on adding to them
  Identity identity;
};

namespace {

constexpr double longest_wait_of_a_reader = 10.0;

std::vector<CellShape> shapes_of(int dimension) {
  if (dimension == 1) return {CellShape::interval};
  if (dimension == 2) return {CellShape::triangle, CellShape::quadrilateral};
  return {CellShape::tetrahedron, CellShape::hexahedron};
}

/// Reads connectivity as results_file.cpp writes it: a table of cells of one shape, or XDMF's mixed list.
class Connectivity {
 public:
  Connectivity(const Hdf5Reader& file, std::string name, int dimension, int degree, Index nodes)
      : file_(file), name_(std::move(name)), dimension_(dimension), degree_(degree), nodes_(nodes) {}

  [[nodiscard]] std::vector<CellBlock> read() {
    const auto [rows, columns] = file_.extents(name_);
    const std::vector<std::int64_t> list = file_.whole_table(name_, rows, columns);
    if (columns > 0) {
      const CellShape shape =
          shape_of([this, columns = columns](CellShape s) { return node_count(s, degree_) == columns; },
                   fmt::format("cells of {} nodes", columns));
      for (Index row = 0; row < rows; ++row) append(shape, list.data() + row * columns);
    } else {
      for (std::size_t at = 0; at < list.size();) {
        const std::int64_t number = list[at++];
        const CellShape shape =
            shape_of([this, number](CellShape s) { return vtk_cell(s, degree_).xdmf_number == number; },
                     fmt::format("cells of XDMF's kind {}", number));
        const auto size = static_cast<std::size_t>(node_count(shape, degree_));
        if (at + size > list.size()) file_.fail(name_, "the last cell is not complete");
        append(shape, list.data() + at);
        at += size;
      }
    }
    return std::move(blocks_);
  }

 private:
  template <class Predicate>
  [[nodiscard]] CellShape shape_of(const Predicate& fits, const std::string& what) const {
    for (const CellShape shape : shapes_of(dimension_)) {
      if (fits(shape)) return shape;
    }
    file_.fail(name_, fmt::format("there are no {} in dimension {} with degree {}", what, dimension_, degree_));
  }

  void append(CellShape shape, const std::int64_t* in_file) {
    if (blocks_.empty() || blocks_.back().shape != shape) {
      blocks_.push_back({shape, node_count(shape, degree_), {}, {}});
      order_ = vtk_cell(shape, degree_).from_ours;
    }
    CellBlock& block = blocks_.back();
    const std::size_t begin = block.nodes.size();
    block.nodes.resize(begin + order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (in_file[k] < 0 || in_file[k] >= nodes_)
        file_.fail(name_, fmt::format("node {} does not exist: there are {}", in_file[k], nodes_));
      block.nodes[begin + static_cast<std::size_t>(order_[k])] = static_cast<Index>(in_file[k]);
    }
    block.tags.push_back(static_cast<std::int64_t>(block.tags.size()) + 1);
  }

  const Hdf5Reader& file_;
  std::string name_;
  int dimension_, degree_;
  Index nodes_;
  std::vector<CellBlock> blocks_;
  std::vector<int> order_;
};

}  // namespace

ResultsReader::ResultsReader(const std::string& directory, int dimension, int degree)
    : dimension_(dimension), degree_(degree) {
  // A run that goes on waits with its next frame. What is known then does not change any more.
  FileLock lock(directory + "/results.xdmf");
  lock.acquire(FileLock::Kind::shared, longest_wait_of_a_reader);
  frames_ = read_xdmf_frames(directory + "/results.xdmf");
  file_ = std::make_unique<File>(directory + "/results.h5");
  const Hdf5Reader& file = file_->open();
  if (file_->frames.size() < frames_.times.size()) {
    file.fail("/frames",
              fmt::format("has {} frames where results.xdmf has {}", file_->frames.size(), frames_.times.size()));
  }
  const std::string name = "/mesh/nodes";
  const auto [rows, columns] = file.extents(name);
  if (columns != 3) file.fail(name, fmt::format("has {} columns where 3 are expected", columns));
  nodes_ = file.real_table(name, rows, columns).transpose();
  cells_ = Connectivity(file, "/mesh/cells", dimension_, degree_, rows).read();
  if (file.has_dataset("/mesh/contact_facets"))
    contact_facets_ = Connectivity(file, "/mesh/contact_facets", dimension_ - 1, degree_, rows).read();
}

ResultsReader::~ResultsReader() = default;

void ResultsReader::release() {
  file_->reader.reset();
}

Index ResultsReader::cell_count() const {
  Index count = 0;
  for (const CellBlock& block : cells_) count += block.size();
  return count;
}

const XdmfField* ResultsReader::find_field(const std::string& name) const {
  const auto found =
      std::find_if(frames_.fields.begin(), frames_.fields.end(), [&](const XdmfField& f) { return f.name == name; });
  return found == frames_.fields.end() ? nullptr : &*found;
}

template <class Number>
void ResultsReader::read_numbers(Index frame, const XdmfField& field, std::vector<Number>& values) const {
  file_->open().table(file_->frames[static_cast<std::size_t>(frame)], field.name,
                      field.on_nodes ? nodes_.cols() : cell_count(), field.components > 1 ? field.components : 0,
                      values);
}

void ResultsReader::read(Index frame, const XdmfField& field, std::vector<float>& values) const {
  read_numbers(frame, field, values);
}

void ResultsReader::read(Index frame, const XdmfField& field, std::vector<double>& values) const {
  read_numbers(frame, field, values);
}

}  // namespace ricochet
