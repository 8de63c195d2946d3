#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file A supernodal lower triangular factor, laid out for triangular solves at the speed of memory.
namespace ricochet {

/// Structure of a factor as computed by CHOLMOD's analysis: supernode s has columns [first_column[s],
/// first_column[s+1]) and the rows rows[row_start[s]] … rows[row_start[s+1]−1] ascending, its own columns first.
struct SupernodalStructure {
  Index supernodes = 0;
  const int* first_column = nullptr;
  const int* row_start = nullptr;
  const int* rows = nullptr;
};

/// Supernodes that a sparse right-hand side reaches: with each one all its ancestors up to the root.
struct FactorPath {
  std::vector<int> supernodes;  ///< ascending
  std::vector<Index> first;     ///< per supernode: the first of its rows in the factor
  std::vector<Index> offsets;   ///< per supernode: its offset among the rows of the path; their number at the end

  [[nodiscard]] Index rows() const { return offsets.empty() ? 0 : offsets.back(); }
};

/// An array of doubles aligned to 64 bytes, on huge pages if the system has them (a factor of 200 MB has 50,000
/// ordinary pages, more than a processor holds address translations for). Not initialized. Throws std::bad_alloc.
class HugePageBuffer {
 public:
  HugePageBuffer() = default;
  explicit HugePageBuffer(std::size_t size);

  [[nodiscard]] double* data() { return values_.get(); }
  [[nodiscard]] const double* data() const { return values_.get(); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  struct Release {
    void operator()(double* values) const;
  };
  std::unique_ptr<double[], Release> values_;
  std::size_t size_ = 0;
};

class SupernodalFactor {
 public:
  SupernodalFactor() = default;
  /// Copies the structure. A factorization (linear_algebra/numeric_factorization.hpp) writes the numbers.
  explicit SupernodalFactor(const SupernodalStructure& shape);

  [[nodiscard]] Index size() const { return size_; }
  /// Length of the vectors in solves: the first `size` entries are the vector, the others work space.
  [[nodiscard]] Index work_size() const { return work_size_; }
  /// Memory that a solve reads.
  [[nodiscard]] std::size_t bytes() const;

  /// Compute y ← L⁻¹ y and y ← L⁻ᵀ y without allocating. Not to be called by two threads at once.
  void forward(Vector& y) const;
  void backward(Vector& y) const;

  /// Path from some rows of the factor to the root.
  [[nodiscard]] FactorPath path(const std::vector<Index>& rows) const;
  /// Computes L⁻¹ times columns that are zero outside a path: path.rows() × any number. The bits of a column depend
  /// neither on the others nor on supernodes of the given path beyond its own.
  void forward_on_path(const FactorPath& path, Matrix& columns) const;

  // Access for the factorization that writes the numbers. Supernodes are numbered in the order of columns.
  struct Supernode {
    int first = 0;                     ///< column
    int columns = 0;                   ///< k
    int below = 0;                     ///< rows below its own
    int number = 0;                    ///< in the order of columns
    Index stream = 0, stream_end = 0;  ///< range of its numbers in the stream
    Index rows = 0;                    ///< index in rows_ of its first row below
  };
  [[nodiscard]] Index supernode_count() const { return Index(supernodes_.size()); }
  [[nodiscard]] const Supernode& supernode(Index number) const {
    return supernodes_[std::size_t(position_[std::size_t(number)])];
  }
  /// Numbers of a supernode in the layout of linear_algebra/supernode_layout.hpp.
  [[nodiscard]] double* numbers(const Supernode& node) { return stream_.data() + node.stream; }
  /// Row of the factor for a row of a supernode.
  [[nodiscard]] int row(const Supernode& node, Index i) const {
    if (i < node.columns) return node.first + int(i);
    const int row = rows_[std::size_t(node.rows + i - node.columns)];
    return row < size_ ? row : row_of_work_[std::size_t(row - size_)];
  }
  /// Returns per supernode the root of the largest subtree that contains it and whose weights sum to at most `most`; −1
  /// if none. The supernodes of such a subtree are contiguous.
  [[nodiscard]] std::vector<int> subtrees(std::vector<double> weights, double most) const;

 private:
  /// Supernodes that are solved one after the other. Parts other than the last are subtrees of the elimination tree and
  /// independent of one another: their contributions to rows beyond their own are collected in a separate vector, and
  /// these vectors are added to y in the order of the parts. Hence the bits are the same for any number of threads.
  struct Part {
    std::size_t begin = 0, end = 0;  ///< supernodes, in the order in which they are solved
    std::vector<int> boundary;       ///< rows beyond its own to which it contributes
    Index boundary_start = 0;        ///< their offset in the work space of y
    mutable std::vector<double> work;
  };

  void read_shape(const SupernodalStructure& shape);
  void partition();
  void allocate_numbers(const SupernodalStructure& shape);
  void number_boundary(Part& part);
  void gather(const Supernode& node, const double* y, double* w) const;
  bool is_shared(const Part& part, const Supernode& node) const;
  void forward(const Part& part, double* y) const;
  void backward(const Part& part, double* y) const;

  Index size_ = 0, work_size_ = 0;
  std::vector<Supernode> supernodes_;  ///< in the order in which they are solved
  std::vector<int> position_;          ///< per supernode in the order of columns: its index in supernodes_
  std::vector<int> parent_;            ///< per supernode in the order of columns; −1: a root
  std::vector<int> rows_;              ///< of all supernodes: rows of the factor, or indices in the work space
  std::vector<int> row_of_work_;       ///< per index in the work space: the row it stands for
  std::vector<Part> parts_;            ///< the last one is processed when the subtrees are done
  mutable std::vector<double> sums_;   ///< work space of supernodes that threads share
  HugePageBuffer stream_;
};

}  // namespace ricochet
