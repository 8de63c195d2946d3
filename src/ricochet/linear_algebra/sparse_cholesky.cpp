#include "ricochet/linear_algebra/sparse_cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <new>
#include <stdexcept>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/blocked_signals.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/linear_algebra/numeric_factorization.hpp"

namespace ricochet {

namespace {

/// Returns a view without copying, for functions that do not write.
cholmod_sparse view(int size, const int* begin, const int* rows, const double* values, int triangle) {
  cholmod_sparse result{};
  result.nrow = result.ncol = std::size_t(size);
  result.nzmax = std::size_t(begin[size]);
  result.p = const_cast<int*>(begin);
  result.i = const_cast<int*>(rows);
  result.x = const_cast<double*>(values);
  result.stype = triangle;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.packed = 1;
  return result;
}

}  // namespace

struct SparseCholesky::Implementation {
  /// Lower triangle of a symmetric matrix by columns, with the rows of a column in any order.
  struct LowerTriangle {
    std::vector<int> begin;  ///< per column, and the end
    std::vector<int> rows;
    std::vector<double> values;
  };
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  LowerTriangle ordered;            ///< of P A Pᵀ, from the analysis to the factorization
  std::vector<int> permutation;     ///< index in the factor → unknown
  std::vector<int> factor_indices;  ///< unknown → index in the factor
  double scale = 1.0;
  Arithmetic arithmetic = Arithmetic::own;
  SupernodalFactor supernodal;
  std::unique_ptr<NumericFactorization> numeric;
  std::size_t entries = 0;
  Prediction prediction;
  Index failed = -1;
  Vector permuted;
  // Workspace that cholmod_solve2 keeps between calls, so that a time loop allocates nothing.
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;

  Implementation() {
    prepare_blas();
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

  void order(const SparseMatrix& matrix);
  void store_ordered(const SparseMatrix& matrix);
  [[nodiscard]] cholmod_sparse ordered_view() const;
  void analyse();
  void require_possible() const;
  void find_scale();
  void copy_structure();
  void factorize();
  void factorize_by_library();
  void library_solve(int system, Vector& values);
};

namespace {

/// Restores the signal handlers: METIS puts back those it finds, but for one signal only.
class SavedHandlers {
 public:
  SavedHandlers() {
    for (std::size_t i = 0; i < before_.size(); ++i) sigaction(signals[i], nullptr, &before_[i]);
  }
  ~SavedHandlers() {
    for (std::size_t i = 0; i < before_.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
  }
  SavedHandlers(const SavedHandlers&) = delete;
  SavedHandlers& operator=(const SavedHandlers&) = delete;

 private:
  static constexpr std::array<int, 2> signals{SIGTERM, SIGABRT};
  std::array<struct sigaction, 2> before_{};
};

}  // namespace

void SparseCholesky::Implementation::order(const SparseMatrix& matrix) {
  permutation.resize(std::size_t(matrix.cols()));
  cholmod_sparse upper = view(int(matrix.cols()), matrix.outerIndexPtr(), matrix.innerIndexPtr(), matrix.valuePtr(), 1);
  upper.sorted = 1;
  // METIS catches SIGTERM while it works, and jumps out of its own work half done.
  const BlockedSignals until_ordered;
  const SavedHandlers saved;
  if (cholmod_metis(&upper, nullptr, 0, 1, permutation.data(), &common) == 0)
    throw std::runtime_error("ordering the matrix failed (METIS)");
  factor_indices.resize(permutation.size());
  for (std::size_t i = 0; i < permutation.size(); ++i) factor_indices[std::size_t(permutation[i])] = int(i);
  store_ordered(matrix);
}

/// Stores the lower triangle of P A Pᵀ. Its storage grows only once.
void SparseCholesky::Implementation::store_ordered(const SparseMatrix& matrix) {
  const int size = int(matrix.cols());
  const auto visit = [&](const auto& enter) {
    for (int column = 0; column < size; ++column) {
      for (SparseMatrix::InnerIterator entry(matrix, permutation[std::size_t(column)]); entry; ++entry) {
        const int row = factor_indices[std::size_t(entry.row())];
        if (row >= column) enter(column, row, entry.value());
      }
    }
  };
  ordered.begin.assign(std::size_t(size) + 1, 0);
  visit([&](int column, int, double) { ++ordered.begin[std::size_t(column) + 1]; });
  for (std::size_t column = 0; column < permutation.size(); ++column)
    ordered.begin[column + 1] += ordered.begin[column];
  ordered.rows.resize(std::size_t(ordered.begin.back()));
  ordered.values.resize(ordered.rows.size());
  std::size_t at = 0;
  visit([&](int, int row, double value) {
    ordered.rows[at] = row;
    ordered.values[at++] = value;
  });
}

cholmod_sparse SparseCholesky::Implementation::ordered_view() const {
  return view(int(permutation.size()), ordered.begin.data(), ordered.rows.data(), ordered.values.data(), -1);
}

void SparseCholesky::Implementation::analyse() {
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 0;  // the given order is postordered already
  cholmod_free_factor(&factor, &common);
  cholmod_sparse lower = ordered_view();
  factor = cholmod_analyze(&lower, &common);
  prediction = {true, common.lnz, common.fl};
  if (factor != nullptr && common.status != CHOLMOD_TOO_LARGE) {
    entries = factor->xsize;
    prediction.entries = double(entries);
    return;
  }
  if (common.status != CHOLMOD_TOO_LARGE) throw std::bad_alloc();
  prediction.possible = false;
}

void SparseCholesky::Implementation::require_possible() const {
  if (ordered.begin.empty()) throw std::logic_error("a matrix must be analysed before it is factorized");
  if (prediction.possible) return;
  throw Error(ErrorKind::invalid_input, fmt::format("the Cholesky factor of the operator would have {:.2g} entries, "
                                                    "more than CHOLMOD can count: set solver.method = \"iterative\"",
                                                    prediction.entries));
}

void SparseCholesky::Implementation::find_scale() {
  double largest = 0.0;
  for (std::size_t column = 0; column < permutation.size(); ++column) {
    for (auto k = std::size_t(ordered.begin[column]); k < std::size_t(ordered.begin[column + 1]); ++k)
      if (ordered.rows[k] == int(column)) largest = std::max(largest, std::abs(ordered.values[k]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  scale = largest > 0.0 ? std::ldexp(1.0, -exponent) : 1.0;
}

/// Copies the structure of the factor, which is all that is used of CHOLMOD's result.
void SparseCholesky::Implementation::copy_structure() {
  numeric.reset();
  supernodal = SupernodalFactor({Index(factor->nsuper), static_cast<const int*>(factor->super),
                                 static_cast<const int*>(factor->pi), static_cast<const int*>(factor->s)});
  cholmod_free_factor(&factor, &common);
}

void SparseCholesky::Implementation::factorize() {
  require_possible();
  find_scale();
  if (factor != nullptr) {
    release_freed_memory();  // memory peaks here
    copy_structure();
  }
  if (!numeric) numeric = std::make_unique<NumericFactorization>(supernodal);
  const Index column = numeric->run({ordered.begin.data(), ordered.rows.data(), ordered.values.data()}, scale);
  failed = column < 0 ? -1 : permutation[std::size_t(column)];
}

void SparseCholesky::Implementation::factorize_by_library() {
  require_possible();
  find_scale();
  for (double& value : ordered.values) value *= scale;
  cholmod_sparse lower = ordered_view();
  const BlockedSignals on_threads_of_cholmod;  // created by the first call, they still exist when METIS runs again
  cholmod_factorize(&lower, factor, &common);
  ordered = {};
  if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  entries = factor->xsize;
  failed = factor->minor < factor->n ? permutation[factor->minor] : -1;
}

void SparseCholesky::Implementation::library_solve(int system, Vector& values) {
  cholmod_dense right{};
  right.nrow = right.d = right.nzmax = std::size_t(values.size());
  right.ncol = 1;
  right.x = values.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  if (cholmod_solve2(system, factor, &right, nullptr, &solution, nullptr, &work_y, &work_e, &common) == 0) {
    throw std::bad_alloc();
  }
  values = Eigen::Map<const Vector>(static_cast<const double*>(solution->x), values.size());
}

SparseCholesky::SparseCholesky() : implementation_(std::make_unique<Implementation>()) {}

SparseCholesky::SparseCholesky(const SparseMatrix& matrix, Arithmetic arithmetic) : SparseCholesky() {
  analyse(matrix);
  factorize(arithmetic);
}

SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;
SparseCholesky::~SparseCholesky() = default;

std::string SparseCholesky::library() {
  int version[3] = {0, 0, 0};
  cholmod_l_version(version);
  return fmt::format("CHOLMOD {}.{}.{}", version[0], version[1], version[2]);
}

void SparseCholesky::analyse(const SparseMatrix& matrix) {
  if (matrix.cols() == 0) return;
  implementation_->order(matrix);
  implementation_->analyse();
}

void SparseCholesky::factorize(Arithmetic arithmetic) {
  Implementation& own = *implementation_;
  own.arithmetic = arithmetic;
  if (size() == 0) return;
  if (arithmetic == Arithmetic::library) {
    own.factorize_by_library();
    return;
  }
  own.factorize();
  // Most matrices are factorized once.
  own.numeric.reset();
  own.ordered = {};
}

void SparseCholesky::refactorize(const SparseMatrix& matrix) {
  Implementation& own = *implementation_;
  if (size() == 0) return;
  own.store_ordered(matrix);
  if (own.arithmetic == Arithmetic::library) {
    own.factorize_by_library();
  } else {
    own.factorize();
  }
}

SparseCholesky::Prediction SparseCholesky::predicted() const { return implementation_->prediction; }

Index SparseCholesky::size() const { return Index(implementation_->permutation.size()); }
bool SparseCholesky::positive_definite() const { return failed_unknown() < 0; }

Index SparseCholesky::failed_unknown() const { return implementation_->failed; }

double SparseCholesky::scale() const { return implementation_->scale; }
std::size_t SparseCholesky::factor_entries() const { return implementation_->entries; }
std::size_t SparseCholesky::factor_bytes() const {
  const bool own = implementation_->arithmetic == Arithmetic::own;
  return own ? implementation_->supernodal.bytes() : implementation_->entries * sizeof(double);
}
const std::vector<int>& SparseCholesky::permutation() const { return implementation_->permutation; }
Index SparseCholesky::factor_index(Index unknown) const {
  return implementation_->factor_indices[std::size_t(unknown)];
}
const SupernodalFactor& SparseCholesky::supernodal() const { return implementation_->supernodal; }
Index SparseCholesky::work_size() const {
  return implementation_->arithmetic == Arithmetic::own ? implementation_->supernodal.work_size() : size();
}

void SparseCholesky::solve_lower(Vector& y) {
  Implementation& own = *implementation_;
  if (own.arithmetic == Arithmetic::own) {
    own.supernodal.forward(y);
  } else if (y.size() > 0) {
    own.library_solve(CHOLMOD_L, y);
  }
}

void SparseCholesky::solve_upper(Vector& y) {
  Implementation& own = *implementation_;
  if (own.arithmetic == Arithmetic::own) {
    own.supernodal.backward(y);
  } else if (y.size() > 0) {
    own.library_solve(CHOLMOD_Lt, y);
  }
}

void SparseCholesky::forward(const Vector& right_hand_side, Vector& y) {
  const Implementation& own = *implementation_;
  y.resize(work_size());
  for (Index i = 0; i < size(); ++i) y[i] = own.scale * right_hand_side[own.permutation[std::size_t(i)]];
  solve_lower(y);
}

void SparseCholesky::backward(const Vector& y, Vector& x) {
  Implementation& own = *implementation_;
  own.permuted = y;
  solve_upper(own.permuted);
  x.resize(size());
  for (Index i = 0; i < size(); ++i) x[own.permutation[std::size_t(i)]] = own.permuted[i];
}

void SparseCholesky::solve(const Vector& right_hand_side, Vector& x) {
  Vector y;
  forward(right_hand_side, y);
  backward(y, x);
}

}  // namespace ricochet
