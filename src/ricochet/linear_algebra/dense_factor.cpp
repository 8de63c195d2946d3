#include "ricochet/linear_algebra/dense_factor.hpp"

#include "ricochet/linear_algebra/blas_threads.hpp"

// Fortran interfaces of BLAS and LAPACK, both in OpenBLAS; matrices by columns.
extern "C" {
void dtrsm_(const char* side, const char* part, const char* transposed, const char* unit, const int* rows,
            const int* columns, const double* factor, const double* a, const int* a_stride, double* b,
            const int* b_stride);
void dsyrk_(const char* part, const char* transposed, const int* size, const int* depth, const double* factor,
            const double* a, const int* a_stride, const double* c_factor, double* c, const int* c_stride);
void dgetrf_(const int* rows, const int* columns, double* a, const int* a_stride, int* pivots, int* info);
void dgetrs_(const char* transposed, const int* size, const int* columns, const double* a, const int* a_stride,
             const int* pivots, double* b, const int* b_stride, int* info);
}

namespace ricochet {

namespace {
constexpr double one = 1.0;
constexpr double zero = 0.0;
}  // namespace

void solve_lower_triangular(const Matrix& factor, Matrix& columns) {
  if (columns.size() == 0) return;
  use_one_blas_thread();
  const int rows = static_cast<int>(columns.rows());
  const int count = static_cast<int>(columns.cols());
  dtrsm_("L", "L", "N", "N", &rows, &count, &one, factor.data(), &rows, columns.data(), &rows);
}

Matrix gram_matrix(const Matrix& columns) {
  Matrix result = Matrix::Zero(columns.cols(), columns.cols());
  if (columns.size() == 0) return result;
  use_one_blas_thread();
  const int size = static_cast<int>(columns.cols());
  const int depth = static_cast<int>(columns.rows());
  dsyrk_("L", "T", &size, &depth, &one, columns.data(), &depth, &zero, result.data(), &size);
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

void DenseLu::compute(const Matrix& matrix) {
  use_one_blas_thread();
  factors_ = matrix;
  const int size = static_cast<int>(matrix.rows());
  permutation_.resize(static_cast<std::size_t>(size));
  int info = 0;
  if (size > 0) dgetrf_(&size, &size, factors_.data(), &size, permutation_.data(), &info);
}

void DenseLu::solve(const Vector& right, Vector& x) const {
  x = right;
  const int size = static_cast<int>(right.size());
  const int single = 1;
  int info = 0;
  if (size > 0) dgetrs_("N", &size, &single, factors_.data(), &size, permutation_.data(), x.data(), &size, &info);
}

double DenseLu::smallest_pivot() const {
  return factors_.size() > 0 ? factors_.diagonal().cwiseAbs().minCoeff() : 1.0;
}

}  // namespace ricochet
