#include "ricochet/linear_algebra/dense_factor.hpp"

#include <algorithm>

#include "ricochet/base/blas.hpp"
#include "ricochet/base/flush_denormals.hpp"

// Fortran interfaces of BLAS and LAPACK, both in OpenBLAS; matrices in column-major order.
extern "C" {
void dgemm_(const char* a_transposed, const char* b_transposed, const int* rows, const int* columns, const int* depth,
            const double* factor, const double* a, const int* a_stride, const double* b, const int* b_stride,
            const double* c_factor, double* c, const int* c_stride);
void dgetrf_(const int* rows, const int* columns, double* a, const int* a_stride, int* pivots, int* info);
void dgetrs_(const char* transposed, const int* size, const int* columns, const double* a, const int* a_stride,
             const int* pivots, double* b, const int* b_stride, int* info);
void sgetrf_(const int* rows, const int* columns, float* a, const int* a_stride, int* pivots, int* info);
void sgetrs_(const char* transposed, const int* size, const int* columns, const float* a, const int* a_stride,
             const int* pivots, float* b, const int* b_stride, int* info);
void dpotrf_(const char* part, const int* size, double* a, const int* a_stride, int* info);
void dpotrs_(const char* part, const int* size, const int* columns, const double* a, const int* a_stride, double* b,
             const int* b_stride, int* info);
void dgemv_(const char* transposed, const int* rows, const int* columns, const double* factor, const double* a,
            const int* a_stride, const double* x, const int* x_stride, const double* y_factor, double* y,
            const int* y_stride);
}

namespace ricochet {

constexpr double one = 1.0;
constexpr double zero = 0.0;

void add_transposed_product(Index rows, Index left_columns, Index right_columns, const double* left, Index left_stride,
                            const double* right, Index right_stride, double* result, Index result_stride) {
  prepare_blas();
  const int m = int(left_columns), n = int(right_columns), k = int(rows);
  const int a = int(left_stride), b = int(right_stride), c = int(result_stride);
  dgemm_("T", "N", &m, &n, &k, &one, left, &a, right, &b, &one, result, &c);
}

void multiply_transposed(const Matrix& matrix, const Vector& x, double* y) {
  prepare_blas();
  const int rows = int(matrix.rows());
  const int columns = int(matrix.cols());
  const int step = 1;
  if (rows == 0) std::fill_n(y, columns, 0.0);
  if (rows == 0 || columns == 0) return;
  dgemv_("T", &rows, &columns, &one, matrix.data(), &rows, x.data(), &step, &zero, y, &step);
}

void DenseLu::compute(const Matrix& matrix) {
  prepare_blas();
  factors_ = matrix;
  const int size = int(matrix.rows());
  permutation_.resize(std::size_t(size));
  int info = 0;
  if (size > 0) dgetrf_(&size, &size, factors_.data(), &size, permutation_.data(), &info);
}

void DenseLu::solve(const Vector& right, Vector& x) const {
  x = right;
  const int size = int(right.size());
  const int single = 1;
  int info = 0;
  if (size > 0) dgetrs_("N", &size, &single, factors_.data(), &size, permutation_.data(), x.data(), &size, &info);
}

double DenseLu::smallest_pivot() const { return factors_.size() > 0 ? factors_.diagonal().cwiseAbs().minCoeff() : 1.0; }

bool SingleLu::compute(const Matrix& matrix) {
  prepare_blas();
  const FlushDenormals flush;
  factors_ = matrix.cast<float>();
  const int size = int(matrix.rows());
  permutation_.resize(std::size_t(size));
  int info = 0;
  if (size > 0) sgetrf_(&size, &size, factors_.data(), &size, permutation_.data(), &info);
  return info == 0 && factors_.diagonal().allFinite();
}

void SingleLu::solve(const Vector& right, Vector& x) const {
  const int size = int(right.size());
  const int single = 1;
  int info = 0;
  const FlushDenormals flush;
  solution_ = right.cast<float>();
  if (size > 0)
    sgetrs_("N", &size, &single, factors_.data(), &size, permutation_.data(), solution_.data(), &size, &info);
  x = solution_.cast<double>();
}

bool DenseCholesky::compute(const Matrix& matrix) {
  prepare_blas();
  factor_ = matrix;
  const int size = int(matrix.rows());
  int info = 0;
  if (size > 0) dpotrf_("L", &size, factor_.data(), &size, &info);
  return info == 0;
}

void DenseCholesky::solve(const Vector& right, Vector& x) const {
  x = right;
  const int size = int(right.size());
  const int single = 1;
  int info = 0;
  if (size > 0) dpotrs_("L", &size, &single, factor_.data(), &size, x.data(), &size, &info);
}

void multiply_dense(const Matrix& matrix, const Vector& x, Vector& y) {
  prepare_blas();
  y.resize(matrix.rows());
  const int rows = int(matrix.rows());
  const int columns = int(matrix.cols());
  const int stride = 1;
  if (rows > 0) dgemv_("N", &rows, &columns, &one, matrix.data(), &rows, x.data(), &stride, &zero, y.data(), &stride);
}

}  // namespace ricochet
