#include "ricochet/mass/mass.hpp"

namespace ricochet {

/// If not all row sums are positive (degree 2, where those of vertices are zero or negative), the diagonal is scaled:
/// E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Engng. Struct. Dyn. 4 (1976) 245–249.
Vector lumped_diagonal(const SparseMatrix& consistent) {
  Vector diagonal = consistent * Vector::Ones(consistent.cols());
  const Vector own = consistent.diagonal();
  // A row sum that is zero in exact arithmetic is rounding error here; both quantities are
  // masses, so their ratio has no unit.
  if (((diagonal.array() / own.array()) < 1e-6).any()) diagonal = own * (diagonal.sum() / own.sum());
  return diagonal;
}

namespace {

/// Stores the zeros of damping as well.
SparseMatrix build_lumped_mass(const MassInput& input, const Parameters&) {
  const Vector diagonal = lumped_diagonal(*input.consistent);
  SparseMatrix result(diagonal.size(), diagonal.size());
  result.reserve(Eigen::VectorXi::Constant(diagonal.size(), 1));
  for (Index i = 0; i < diagonal.size(); ++i) result.insert(i, i) = diagonal[i];
  result.makeCompressed();
  return result;
}

}  // namespace

MassRegistration lumped_mass() { return {"lumped", {.build = build_lumped_mass}}; }

}  // namespace ricochet
