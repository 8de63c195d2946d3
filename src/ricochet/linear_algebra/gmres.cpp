#include "ricochet/linear_algebra/gmres.hpp"

namespace ricochet {

double Gmres::extend(Index k) {
  auto column = hessenberg_.col(k);
  const auto basis = basis_.leftCols(k + 1);
  // Classical Gram–Schmidt applied twice: as orthogonal as the modified one, but in products of matrices.
  projections_.noalias() = basis.transpose() * direction_;
  direction_.noalias() -= basis * projections_;
  column.head(k + 1) = projections_;
  projections_.noalias() = basis.transpose() * direction_;
  direction_.noalias() -= basis * projections_;
  column.head(k + 1) += projections_;
  const double length = direction_.norm();
  if (length > 0.0) {
    basis_.col(k + 1) = direction_ / length;
  } else {
    basis_.col(k + 1).setZero();
  }
  for (Index i = 0; i < k; ++i) {
    const double upper = cosine_[i] * column[i] + sine_[i] * column[i + 1];
    column[i + 1] = -sine_[i] * column[i] + cosine_[i] * column[i + 1];
    column[i] = upper;
  }
  const double diagonal = std::hypot(column[k], length);
  cosine_[k] = column[k] / diagonal;
  sine_[k] = length / diagonal;
  column[k] = diagonal;
  rotated_[k + 1] = -sine_[k] * rotated_[k];
  rotated_[k] *= cosine_[k];
  return std::abs(rotated_[k + 1]);
}

}  // namespace ricochet
