#include "ricochet/linear_algebra/sparse_lu.hpp"

#include <Eigen/SparseLU>

namespace ricochet {

struct SparseLu::Implementation {
  Eigen::SparseLU<SparseMatrix, Eigen::COLAMDOrdering<int>> factor;
  bool analysed = false;
};

SparseLu::SparseLu() : implementation_(std::make_unique<Implementation>()) {}
SparseLu::SparseLu(SparseLu&&) noexcept = default;
SparseLu& SparseLu::operator=(SparseLu&&) noexcept = default;
SparseLu::~SparseLu() = default;

bool SparseLu::compute(const SparseMatrix& matrix) {
  Implementation& own = *implementation_;
  if (!own.analysed) own.factor.analyzePattern(matrix);
  own.analysed = true;
  own.factor.factorize(matrix);
  return own.factor.info() == Eigen::Success;
}

void SparseLu::reset() { implementation_->analysed = false; }

void SparseLu::solve(const Vector& right, Vector& x) const { x = implementation_->factor.solve(right); }

}  // namespace ricochet
