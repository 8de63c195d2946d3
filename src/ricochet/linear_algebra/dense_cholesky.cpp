#include "ricochet/linear_algebra/dense_cholesky.hpp"

#include "ricochet/base/blas.hpp"

// Fortran interfaces of LAPACK, part of OpenBLAS; matrices in column-major order.
extern "C" {
void dpotrf_(const char* part, const int* size, double* a, const int* a_stride, int* info);
void dpotrs_(const char* part, const int* size, const int* columns, const double* a, const int* a_stride, double* b,
             const int* b_stride, int* info);
}

namespace ricochet {

bool DenseCholesky::compute(const Matrix& matrix) {
  prepare_blas();
  factor_ = matrix;
  const int size = static_cast<int>(matrix.rows());
  int info = 0;
  if (size > 0) dpotrf_("L", &size, factor_.data(), &size, &info);
  return info == 0;
}

void DenseCholesky::solve(const Vector& right, Vector& x) const {
  x = right;
  const int size = static_cast<int>(right.size());
  const int single = 1;
  int info = 0;
  if (size > 0) dpotrs_("L", &size, &single, factor_.data(), &size, x.data(), &size, &info);
}

}  // namespace ricochet
