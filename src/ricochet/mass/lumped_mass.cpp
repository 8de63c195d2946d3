#include "ricochet/mass/mass.hpp"

namespace ricochet {

namespace {

/// A diagonal mass. Row sums where they are all positive (degree 1: total mass and centre of gravity are kept).
/// Otherwise (degree 2, whose vertices have zero or negative row sums) the diagonal of the consistent mass, scaled to
/// keep the total: E. Hinton, T. Rock, O. C. Zienkiewicz, Earthquake Engng. Struct. Dyn. 4 (1976) 245–249.
class LumpedMass final : public MassConstruction {
 public:
  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    const SparseMatrix& consistent = *input.consistent;
    Vector diagonal = consistent * Vector::Ones(consistent.cols());
    const double total = diagonal.sum();
    const Vector own = consistent.diagonal();
    // A row sum that is zero in exact arithmetic is rounding here; both quantities are masses, so the ratio has no
    // unit.
    if (((diagonal.array() / own.array()) < 1e-6).any()) diagonal = own * (total / own.sum());
    SparseMatrix result(consistent.rows(), consistent.cols());
    result.reserve(Eigen::VectorXi::Constant(consistent.cols(), 1));
    for (Index i = 0; i < consistent.cols(); ++i) result.insert(i, i) = diagonal[i];
    result.makeCompressed();
    return result;
  }
};

}  // namespace

std::unique_ptr<MassConstruction> make_lumped_mass() {
  return std::make_unique<LumpedMass>();
}

}  // namespace ricochet
