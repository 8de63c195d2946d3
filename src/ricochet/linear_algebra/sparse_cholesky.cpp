#include "ricochet/linear_algebra/sparse_cholesky.hpp"

#include <cholmod.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <new>
#include <stdexcept>

#include "ricochet/base/blas_threads.hpp"
#include "ricochet/base/blocked_signals.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/memory.hpp"

namespace ricochet {

struct SparseCholesky::Implementation {
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_sparse* ordered = nullptr;  ///< lower triangle of P A Pᵀ, from the analysis to the factorization
  std::vector<int> permutation;       ///< place in the factor → unknown
  std::vector<int> places;            ///< unknown → place in the factor
  double scale = 1.0;
  TriangularSolve solve = TriangularSolve::own;
  SupernodalFactor supernodal;
  std::size_t entries = 0;
  Prediction prediction;
  Index failed = -1;
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
    cholmod_free_sparse(&ordered, &common);
    cholmod_finish(&common);
  }

  void order(const SparseMatrix& matrix);
  void take_ordered(const SparseMatrix& matrix);
  void analyse();
  void factorize();
  void take_factor();
  void library_solve(int system, Vector& values);
};

namespace {

/// A view of the upper triangle of a symmetric matrix stored whole, no copy.
cholmod_sparse view(const SparseMatrix& matrix) {
  cholmod_sparse result{};
  result.nrow = static_cast<std::size_t>(matrix.rows());
  result.ncol = static_cast<std::size_t>(matrix.cols());
  result.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  result.p = const_cast<int*>(matrix.outerIndexPtr());
  result.i = const_cast<int*>(matrix.innerIndexPtr());
  result.x = const_cast<double*>(matrix.valuePtr());
  result.stype = 1;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = 1;
  result.packed = 1;
  return result;
}

/// METIS puts back the handlers that it finds, but so that they serve for one signal only.
class KeptHandlers {
 public:
  KeptHandlers() {
    for (std::size_t i = 0; i < before_.size(); ++i) sigaction(signals[i], nullptr, &before_[i]);
  }
  ~KeptHandlers() {
    for (std::size_t i = 0; i < before_.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
  }
  KeptHandlers(const KeptHandlers&) = delete;
  KeptHandlers& operator=(const KeptHandlers&) = delete;

 private:
  static constexpr std::array<int, 2> signals{SIGTERM, SIGABRT};
  std::array<struct sigaction, 2> before_{};
};

}  // namespace

/// The permutation, and the lower triangle of P A Pᵀ. Given in the order of the factor, it is not copied again.
void SparseCholesky::Implementation::order(const SparseMatrix& matrix) {
  permutation.resize(static_cast<std::size_t>(matrix.cols()));
  cholmod_sparse upper = view(matrix);
  // METIS catches SIGTERM while it works, and jumps out of that with its own work half done.
  const BlockedSignals until_ordered;
  const KeptHandlers kept;
  if (cholmod_metis(&upper, nullptr, 0, 1, permutation.data(), &common) == 0)
    throw std::runtime_error("ordering the matrix failed (METIS)");
  places.resize(permutation.size());
  for (std::size_t i = 0; i < permutation.size(); ++i)
    places[static_cast<std::size_t>(permutation[i])] = static_cast<int>(i);
  take_ordered(matrix);
}

void SparseCholesky::Implementation::take_ordered(const SparseMatrix& matrix) {
  cholmod_sparse upper = view(matrix);
  cholmod_free_sparse(&ordered, &common);
  ordered = cholmod_ptranspose(&upper, 1, permutation.data(), nullptr, 0, &common);
  if (ordered == nullptr) throw std::bad_alloc();
}

void SparseCholesky::Implementation::analyse() {
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_NATURAL;
  common.postorder = 0;  // the given order is postordered already
  cholmod_free_factor(&factor, &common);
  factor = cholmod_analyze(ordered, &common);
  prediction = {true, common.lnz, common.fl};
  if (factor != nullptr && common.status != CHOLMOD_TOO_LARGE) {
    entries = factor->xsize;
    prediction.entries = static_cast<double>(entries);
    return;
  }
  if (common.status != CHOLMOD_TOO_LARGE) throw std::bad_alloc();
  prediction.possible = false;
}

void SparseCholesky::Implementation::factorize() {
  if (!prediction.possible)
    throw Error(ErrorKind::invalid_input, fmt::format("the Cholesky factor of the operator would have {:.2g} entries, "
                                                      "more than CHOLMOD can count: set solver.method = \"iterative\"",
                                                      prediction.entries));
  const auto* begins = static_cast<const int*>(ordered->p);
  const auto* rows = static_cast<const int*>(ordered->i);
  auto* values = static_cast<double*>(ordered->x);
  double largest = 0.0;
  for (int column = 0; column < static_cast<int>(ordered->ncol); ++column) {
    for (int k = begins[column]; k < begins[column + 1]; ++k)
      if (rows[k] == column) largest = std::max(largest, std::abs(values[k]));
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  scale = largest > 0.0 ? std::ldexp(1.0, -exponent) : 1.0;
  for (int k = 0; k < begins[ordered->ncol]; ++k) values[k] *= scale;
  release_freed_memory();                      // the most that a run takes is taken here
  const BlockedSignals on_threads_of_cholmod;  // made by the first call, they are there when METIS works again
  cholmod_factorize(ordered, factor, &common);
  cholmod_free_sparse(&ordered, &common);
  if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  entries = factor->xsize;
  failed = factor->minor < factor->n ? permutation[factor->minor] : -1;
}

/// Our own solves have a copy of the factor; CHOLMOD's goes as it is made.
void SparseCholesky::Implementation::take_factor() {
  if (failed < 0) {
    supernodal = SupernodalFactor({static_cast<Index>(factor->nsuper), static_cast<const int*>(factor->super),
                                   static_cast<const int*>(factor->pi), static_cast<const int*>(factor->s),
                                   static_cast<const int*>(factor->px), static_cast<double*>(factor->x)});
  }
  cholmod_free_factor(&factor, &common);
}

void SparseCholesky::Implementation::library_solve(int system, Vector& values) {
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

SparseCholesky::SparseCholesky() : implementation_(std::make_unique<Implementation>()) {}

SparseCholesky::SparseCholesky(const SparseMatrix& matrix, TriangularSolve solve) : SparseCholesky() {
  analyse(matrix);
  factorize(solve);
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

void SparseCholesky::factorize(TriangularSolve solve) {
  implementation_->solve = solve;
  if (size() == 0) return;
  implementation_->factorize();
  if (solve == TriangularSolve::own) implementation_->take_factor();
}

void SparseCholesky::refactorize(const SparseMatrix& matrix) {
  if (size() == 0) return;
  implementation_->take_ordered(matrix);
  implementation_->analyse();  // the pattern of the factor, in the given order: quick beside finding that order
  factorize(implementation_->solve);
}

SparseCholesky::Prediction SparseCholesky::predicted() const {
  return implementation_->prediction;
}

Index SparseCholesky::size() const {
  return static_cast<Index>(implementation_->permutation.size());
}
bool SparseCholesky::positive_definite() const {
  return failed_unknown() < 0;
}

Index SparseCholesky::failed_unknown() const {
  return implementation_->failed;
}

double SparseCholesky::scale() const {
  return implementation_->scale;
}
std::size_t SparseCholesky::factor_entries() const {
  return implementation_->entries;
}
std::size_t SparseCholesky::factor_bytes() const {
  const bool own = implementation_->solve == TriangularSolve::own;
  return own ? implementation_->supernodal.bytes() : implementation_->entries * sizeof(double);
}
const std::vector<int>& SparseCholesky::permutation() const {
  return implementation_->permutation;
}
Index SparseCholesky::place(Index unknown) const {
  return implementation_->places[static_cast<std::size_t>(unknown)];
}
const SupernodalFactor& SparseCholesky::supernodal() const {
  return implementation_->supernodal;
}
Index SparseCholesky::work_size() const {
  return implementation_->solve == TriangularSolve::own ? implementation_->supernodal.work_size() : size();
}

void SparseCholesky::solve_lower(Vector& y) {
  Implementation& own = *implementation_;
  if (own.solve == TriangularSolve::own) {
    own.supernodal.forward(y);
  } else if (y.size() > 0) {
    own.library_solve(CHOLMOD_L, y);
  }
}

void SparseCholesky::solve_upper(Vector& y) {
  Implementation& own = *implementation_;
  if (own.solve == TriangularSolve::own) {
    own.supernodal.backward(y);
  } else if (y.size() > 0) {
    own.library_solve(CHOLMOD_Lt, y);
  }
}

void SparseCholesky::forward(const Vector& right_hand_side, Vector& y) {
  const Implementation& own = *implementation_;
  y.resize(work_size());
  for (Index i = 0; i < size(); ++i) y[i] = own.scale * right_hand_side[own.permutation[static_cast<std::size_t>(i)]];
  solve_lower(y);
}

void SparseCholesky::backward(const Vector& y, Vector& x) {
  Implementation& own = *implementation_;
  own.permuted = y;
  solve_upper(own.permuted);
  x.resize(size());
  for (Index i = 0; i < size(); ++i) x[own.permutation[static_cast<std::size_t>(i)]] = own.permuted[i];
}

void SparseCholesky::solve(const Vector& right_hand_side, Vector& x) {
  Vector y;
  forward(right_hand_side, y);
  backward(y, x);
}

}  // namespace ricochet
