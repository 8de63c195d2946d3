#include "ricochet/io/results_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/file_lock.hpp"
#include "ricochet/io/results_storage.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

/// Reads connectivity as written by mesh_datasets.cpp: a table of cells of one shape, or XDMF's mixed list.
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
            shape_of([this, number](CellShape s) { return file_type(s, degree_).xdmf_number == number; },
                     fmt::format("cells of XDMF type {}", number));
        const auto size = std::size_t(node_count(shape, degree_));
        if (at + size > list.size()) file_.fail(name_, "the last cell is incomplete");
        append(shape, list.data() + at);
        at += size;
      }
    }
    return std::move(blocks_);
  }

 private:
  template <class Predicate>
  [[nodiscard]] CellShape shape_of(const Predicate& fits, const std::string& what) const {
    for (const CellShape shape : cell_shapes()) {
      if (dimension(shape) == dimension_ && fits(shape)) return shape;
    }
    file_.fail(name_, fmt::format("there are no {} in dimension {} with degree {}", what, dimension_, degree_));
  }

  void append(CellShape shape, const std::int64_t* in_file) {
    if (blocks_.empty() || blocks_.back().shape != shape) {
      blocks_.push_back({shape, node_count(shape, degree_), {}, {}});
      order_ = vtk_nodes(shape, degree_);
    }
    CellBlock& block = blocks_.back();
    const std::size_t begin = block.nodes.size();
    block.nodes.resize(begin + order_.size());
    for (std::size_t k = 0; k < order_.size(); ++k) {
      if (in_file[k] < 0 || in_file[k] >= nodes_)
        file_.fail(name_, fmt::format("node {} does not exist: the number of nodes is {}", in_file[k], nodes_));
      block.nodes[begin + std::size_t(order_[k])] = Index(in_file[k]);
    }
    block.tags.push_back(std::int64_t(block.tags.size()) + 1);
  }

  const Hdf5Reader& file_;
  std::string name_;
  int dimension_, degree_;
  Index nodes_;
  std::vector<CellBlock> blocks_;
  std::vector<int> order_;
};

const ResultsFormat& format_in(const std::string& directory) {
  const ResultsFormat* const found = find_results_format(directory);
  return found != nullptr ? *found : results_format_registry().all().front().type;
}

}  // namespace

ResultsReader::ResultsReader(const std::string& directory, int dimension, int degree)
    : format_(format_in(directory)), dimension_(dimension), degree_(degree) {
  // Data read under this lock remain valid when the run continues.
  FileLock lock(directory + "/" + format_.lock);
  lock.acquire(FileLock::Kind::shared, longest_wait_of_a_reader);
  storage_ = format_.open(directory, format_);
  const Hdf5Reader& file = storage_->file();
  const std::string name = "/mesh/nodes";
  const auto [rows, columns] = file.extents(name);
  if (columns != 3) file.fail(name, fmt::format("has {} columns where 3 are expected", columns));
  nodes_ = file.real_table(name, rows, columns).transpose();
  cells_ = Connectivity(file, "/mesh/cells", dimension_, degree_, rows).read();
  if (file.has_dataset("/mesh/contact_facets"))
    contact_facets_ = Connectivity(file, "/mesh/contact_facets", dimension_ - 1, degree_, rows).read();
}

ResultsReader::~ResultsReader() = default;

void ResultsReader::release() { storage_->close(); }

const std::vector<double>& ResultsReader::times() const { return storage_->frames().times; }

const std::vector<ResultField>& ResultsReader::fields() const { return storage_->frames().fields; }

Index ResultsReader::cell_count() const {
  Index count = 0;
  for (const CellBlock& block : cells_) count += block.size();
  return count;
}

const ResultField* ResultsReader::find_field(const std::string& name) const {
  const auto found =
      std::find_if(fields().begin(), fields().end(), [&](const ResultField& f) { return f.name == name; });
  return found == fields().end() ? nullptr : &*found;
}

Index ResultsReader::rows_of(const ResultField& field) const { return field.on_nodes ? nodes_.cols() : cell_count(); }

void ResultsReader::read(Index frame, const ResultField& field, std::vector<float>& values) const {
  storage_->read(frame, field, rows_of(field), &values);
}

void ResultsReader::read(Index frame, const ResultField& field, std::vector<double>& values) const {
  storage_->read(frame, field, rows_of(field), &values);
}

}  // namespace ricochet
