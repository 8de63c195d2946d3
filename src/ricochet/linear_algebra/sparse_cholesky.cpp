#include "ricochet/linear_algebra/sparse_cholesky.hpp"

#include <cholmod.h>

#include <cmath>
#include <new>
#include <stdexcept>

#include "ricochet/linear_algebra/blas_threads.hpp"

namespace ricochet {

SparseMatrix extract(const SparseMatrix& matrix, const std::vector<int>& row_number, Index rows,
                     const std::vector<int>& column_number, Index columns) {
  SparseMatrix result(rows, columns);
  if (columns == 0) return result;  // Eigen's makeCompressed reads and writes a first column without asking
  std::vector<int> counts(static_cast<std::size_t>(columns), 0);
  for (Index j = 0; j < matrix.cols(); ++j) {
    const int column = column_number[static_cast<std::size_t>(j)];
    if (column < 0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      counts[static_cast<std::size_t>(column)] += row_number[static_cast<std::size_t>(entry.row())] >= 0 ? 1 : 0;
    }
  }
  result.reserve(counts);
  for (Index j = 0; j < matrix.cols(); ++j) {
    const int column = column_number[static_cast<std::size_t>(j)];
    if (column < 0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      const int row = row_number[static_cast<std::size_t>(entry.row())];
      if (row >= 0) result.insert(row, column) = entry.value();
    }
  }
  result.makeCompressed();
  return result;
}

struct SparseCholesky::Implementation {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<int> permutation;  ///< position in the factor → unknown
  Index trailing = 0;
  double scale = 1.0;
  Vector permuted;
  // Workspace that cholmod_solve2 keeps between calls, so that a time loop allocates nothing.
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;

  Implementation() {
    use_one_blas_thread();
    cholmod_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.print = 0;
    common.error_handler = nullptr;
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&work_e, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }

  void order(const SparseMatrix& matrix, const std::vector<Index>& last);
  void factorize(const SparseMatrix& matrix);
  void triangular_solve(int system, Vector& values);
};

namespace {

/// A view of the lower triangle of a symmetric Eigen matrix, no copy.
cholmod_sparse view(const SparseMatrix& matrix) {
  cholmod_sparse result{};
  result.nrow = static_cast<std::size_t>(matrix.rows());
  result.ncol = static_cast<std::size_t>(matrix.cols());
  result.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  result.p = const_cast<int*>(matrix.outerIndexPtr());
  result.i = const_cast<int*>(matrix.innerIndexPtr());
  result.x = const_cast<double*>(matrix.valuePtr());
  result.stype = -1;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = 1;
  result.packed = 1;
  return result;
}

}  // namespace

void SparseCholesky::Implementation::order(const SparseMatrix& matrix, const std::vector<Index>& last) {
  const Index size = matrix.cols();
  trailing = static_cast<Index>(last.size());
  std::vector<int> number(static_cast<std::size_t>(size), 0);
  for (const Index unknown : last) number[static_cast<std::size_t>(unknown)] = -1;
  std::vector<int> leading;
  for (Index i = 0; i < size; ++i) {
    if (number[static_cast<std::size_t>(i)] < 0) continue;
    number[static_cast<std::size_t>(i)] = static_cast<int>(leading.size());
    leading.push_back(static_cast<int>(i));
  }
  permutation.clear();
  if (!leading.empty()) {
    const auto count = static_cast<Index>(leading.size());
    const SparseMatrix interior = trailing == 0 ? matrix : extract(matrix, number, count, number, count);
    cholmod_sparse shape = view(interior);
    std::vector<int> order(leading.size());
    if (cholmod_metis(&shape, nullptr, 0, 1, order.data(), &common) == 0) {
      throw std::runtime_error("ordering the matrix failed (METIS)");
    }
    for (const int position : order) permutation.push_back(leading[static_cast<std::size_t>(position)]);
  }
  for (const Index unknown : last) permutation.push_back(static_cast<int>(unknown));
}

void SparseCholesky::Implementation::factorize(const SparseMatrix& matrix) {
  double largest = 0.0;
  for (Index i = 0; i < matrix.cols(); ++i) largest = std::max(largest, std::abs(matrix.coeff(i, i)));
  int exponent = 0;
  std::frexp(largest, &exponent);
  scale = largest > 0.0 ? std::ldexp(1.0, -exponent) : 1.0;
  SparseMatrix scaled = matrix * scale;
  cholmod_sparse shape = view(scaled);
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.postorder = 0;  // the given order is postordered already, and the trailing unknowns must stay last
  factor = cholmod_analyze_p(&shape, permutation.data(), nullptr, 0, &common);
  if (factor == nullptr) throw std::bad_alloc();
  cholmod_factorize(&shape, factor, &common);
  if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
}

void SparseCholesky::Implementation::triangular_solve(int system, Vector& values) {
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = static_cast<std::size_t>(values.size());
  right.ncol = 1;
  right.x = values.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (cholmod_solve2(system, factor, &right, nullptr, &solution, nullptr, &work_y, &work_e, &common) == 0) {
    throw std::bad_alloc();
  }
  values = Eigen::Map<const Vector>(static_cast<const double*>(solution->x), values.size());
}

SparseCholesky::SparseCholesky(const SparseMatrix& matrix, const std::vector<Index>& trailing)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->order(matrix, trailing);
  if (matrix.cols() > 0) implementation_->factorize(matrix);
  implementation_->permuted.resize(matrix.cols());
}

SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;
SparseCholesky::~SparseCholesky() = default;

Index SparseCholesky::size() const {
  return static_cast<Index>(implementation_->permutation.size());
}
bool SparseCholesky::positive_definite() const {
  return failed_unknown() < 0;
}

Index SparseCholesky::failed_unknown() const {
  const cholmod_factor* factor = implementation_->factor;
  if (factor == nullptr || factor->minor >= factor->n) return -1;
  return implementation_->permutation[factor->minor];
}

double SparseCholesky::scale() const {
  return implementation_->scale;
}
std::size_t SparseCholesky::factor_entries() const {
  return implementation_->factor == nullptr ? 0 : implementation_->factor->xsize;
}

void SparseCholesky::forward(const Vector& right_hand_side, Vector& y) {
  Implementation& own = *implementation_;
  y.resize(size());
  for (Index i = 0; i < y.size(); ++i) y[i] = own.scale * right_hand_side[own.permutation[static_cast<std::size_t>(i)]];
  if (y.size() > 0) own.triangular_solve(CHOLMOD_L, y);
}

void SparseCholesky::backward(const Vector& y, Vector& x) {
  Implementation& own = *implementation_;
  own.permuted = y;
  if (y.size() > 0) own.triangular_solve(CHOLMOD_Lt, own.permuted);
  x.resize(size());
  for (Index i = 0; i < y.size(); ++i) x[own.permutation[static_cast<std::size_t>(i)]] = own.permuted[i];
}

void SparseCholesky::solve(const Vector& right_hand_side, Vector& x) {
  Vector y;
  forward(right_hand_side, y);
  backward(y, x);
}

Matrix SparseCholesky::trailing_factor() const {
  const Implementation& own = *implementation_;
  Matrix result = Matrix::Zero(own.trailing, own.trailing);
  if (own.trailing == 0) return result;
  const cholmod_factor& factor = *own.factor;
  const auto* supernodes = static_cast<const int*>(factor.super);
  const auto* row_starts = static_cast<const int*>(factor.pi);
  const auto* value_starts = static_cast<const int*>(factor.px);
  const auto* rows = static_cast<const int*>(factor.s);
  const auto* values = static_cast<const double*>(factor.x);
  const Index first = size() - own.trailing;
  for (std::size_t s = 0; s < factor.nsuper; ++s) {
    const int row_count = row_starts[s + 1] - row_starts[s];
    for (int column = supernodes[s]; column < supernodes[s + 1]; ++column) {
      if (column < first) continue;
      const double* entries = values + value_starts[s] + static_cast<Index>(column - supernodes[s]) * row_count;
      for (int k = 0; k < row_count; ++k) {
        const int row = rows[row_starts[s] + k];
        if (row >= column) result(row - first, column - first) = entries[k];
      }
    }
  }
  return result;
}

}  // namespace ricochet
