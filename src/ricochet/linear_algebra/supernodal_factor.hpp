#pragma once

#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/linear_algebra/huge_page_buffer.hpp"

/// @file A supernodal lower triangular factor laid out for triangular solves at the speed of memory.
namespace ricochet {

/// The shape of a factor as CHOLMOD's analysis gives it: supernode s has columns [first_column[s], first_column[s+1])
/// and the rows rows[row_start[s]] … rows[row_start[s+1]−1] ascending, its own columns first.
struct SupernodalShape {
  Index supernodes = 0;
  const int* first_column = nullptr;
  const int* row_start = nullptr;
  const int* rows = nullptr;
};

/// Supernodes that a sparse right-hand side reaches: with each one all that follow it on the way to the root.
struct FactorPath {
  std::vector<int> supernodes;  ///< ascending
  std::vector<Index> first;     ///< per supernode: the first of its rows in the factor
  std::vector<Index> offsets;   ///< per supernode: its place among the rows of the path, and their number at the end

  [[nodiscard]] Index rows() const { return offsets.empty() ? 0 : offsets.back(); }
};

class SupernodalFactor {
 public:
  SupernodalFactor() = default;
  /// Copies the shape. The numbers are to be written by a factorization (linear_algebra/numeric_factorization.hpp).
  explicit SupernodalFactor(const SupernodalShape& shape);

  [[nodiscard]] Index size() const { return size_; }
  /// Length of the vectors that are solved with: the first `size` entries are the vector, the others work space.
  [[nodiscard]] Index work_size() const { return work_size_; }
  /// Of all that is read in a solve.
  [[nodiscard]] std::size_t bytes() const;

  /// y ← L⁻¹ y and y ← L⁻ᵀ y. Nothing is allocated. Not for two threads at once.
  void forward(Vector& y) const;
  void backward(Vector& y) const;

  /// The path from some rows of the factor to the root.
  [[nodiscard]] FactorPath path(const std::vector<Index>& rows) const;
  /// L⁻¹ of columns that are zero outside a path: path.rows() × any. The bits of a column do not depend on the others,
  /// nor on how much more than its own path the given one contains.
  void forward_on_path(const FactorPath& path, Matrix& columns) const;

  // For who writes the numbers. Supernodes have the numbers of the order of columns.
  struct Supernode {
    int first = 0;                     ///< column
    int columns = 0;                   ///< k
    int below = 0;                     ///< rows below its own
    int number = 0;                    ///< in the order of columns
    Index stream = 0, stream_end = 0;  ///< where its numbers are
    Index rows = 0;                    ///< where its rows below begin in rows_
  };
  [[nodiscard]] Index supernode_count() const { return static_cast<Index>(supernodes_.size()); }
  [[nodiscard]] const Supernode& supernode(Index number) const {
    return supernodes_[static_cast<std::size_t>(place_[static_cast<std::size_t>(number)])];
  }
  /// In the layout of linear_algebra/supernode_layout.hpp.
  [[nodiscard]] double* numbers(const Supernode& node) { return stream_.data() + node.stream; }
  /// The row of the factor that a row of a supernode is.
  [[nodiscard]] int row(const Supernode& node, Index i) const {
    if (i < node.columns) return node.first + static_cast<int>(i);
    const int row = rows_[static_cast<std::size_t>(node.rows + i - node.columns)];
    return row < size_ ? row : row_of_work_[static_cast<std::size_t>(row - size_)];
  }
  /// Per supernode the root of the largest subtree that holds it and whose weights sum up to at most `most`; −1 where
  /// there is none. The supernodes of such a subtree lie side by side.
  [[nodiscard]] std::vector<int> subtrees(std::vector<double> weights, double most) const;

 private:
  /// Supernodes that are solved one after the other. Parts other than the last are subtrees of the elimination tree and
  /// independent of one another: what they add to rows beyond their own they add to a vector of their own, and these
  /// are added to y in the order of the parts. So the bits are the same for any number of threads.
  struct Part {
    std::size_t begin = 0, end = 0;  ///< supernodes, in the order in which they are solved
    std::vector<int> boundary;       ///< rows beyond its own that it reaches
    Index boundary_start = 0;        ///< their place in the work space of y
    mutable std::vector<double> work;
  };

  void read_shape(const SupernodalShape& shape);
  void divide();
  void place_numbers(const SupernodalShape& shape);
  void number_boundary(Part& part);
  void gather(const Supernode& node, const double* y, double* w) const;
  bool is_shared(const Part& part, const Supernode& node) const;
  void forward(const Part& part, double* y) const;
  void backward(const Part& part, double* y) const;

  Index size_ = 0, work_size_ = 0;
  std::vector<Supernode> supernodes_;  ///< in the order in which they are solved
  std::vector<int> place_;             ///< per supernode in the order of columns: its place above
  std::vector<int> parent_;            ///< per supernode in the order of columns; −1: a root
  std::vector<int> rows_;              ///< of all supernodes: rows of the factor, or places in the work space
  std::vector<int> row_of_work_;       ///< per place in the work space: the row it stands for
  std::vector<Part> parts_;            ///< the last one is what remains when the subtrees are done
  mutable std::vector<double> sums_;   ///< work space of supernodes that threads share
  HugePageBuffer stream_;
};

}  // namespace ricochet
