#include <Eigen/Cholesky>

#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"

namespace ricochet {

namespace {

/// The source's authors' construction: on the pattern of M without contact rows and columns, the matrix nearest to M in
/// the Frobenius norm under PᵃᵀM₀Pᵇ = PᵃᵀMPᵇ. Stationarity gives M₀ = M + Σ_ab μ_ab ½(PᵃPᵇᵀ + PᵇPᵃᵀ) on the pattern,
/// with the multipliers from a small Gram system. The condition rows are symmetric from the start: symmetrizing
/// afterwards loses inertia.
class NearestEquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }

  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    const Matrix monomials = scaled_monomials(*input.nodes);
    SparseMatrix result = free_pattern(input);
    correct(result, monomials, *input.consistent);
    check_conditions(result, monomials, *input.consistent);
    if (!is_positive_definite(result, input.contact_nodes)) {
      throw Error(
          ErrorKind::invalid_input,
          "mass type \"equivalent-nearest\": on this mesh the nearest mass without inertia on contact nodes is "
          "indefinite (its Cholesky factorization fails), and a run with it would grow exponentially; use mass type "
          "\"equivalent\", which is positive semi-definite by construction, or refine the mesh");
    }
    return result;
  }

 private:
  /// (1, x, y[, z]) about the centre and relative to the size of the body, so that the Gram matrix is well conditioned
  /// whatever the units. The conditions for these imply those for the plain monomials and conversely.
  static Matrix scaled_monomials(const Points& nodes) {
    Matrix monomials(nodes.cols(), nodes.rows() + 1);
    monomials.col(0).setOnes();
    const Vector low = nodes.rowwise().minCoeff();
    const Vector high = nodes.rowwise().maxCoeff();
    const double size = (high - low).maxCoeff();
    monomials.rightCols(nodes.rows()) = ((nodes.colwise() - 0.5 * (low + high)) / size).transpose();
    return monomials;
  }

  static SparseMatrix free_pattern(const MassInput& input) {
    std::vector<char> is_contact(static_cast<std::size_t>(input.consistent->cols()), 0);
    for (const Index node : input.contact_nodes) is_contact[static_cast<std::size_t>(node)] = 1;
    SparseMatrix result = *input.consistent;
    result.prune([&](Index row, Index column, double) {
      return is_contact[static_cast<std::size_t>(row)] == 0 && is_contact[static_cast<std::size_t>(column)] == 0;
    });
    return result;
  }

  /// Too few free nodes cannot keep mass, centre and inertia: the Gram system is then singular and has no solution.
  static void check_conditions(const SparseMatrix& mass, const Matrix& monomials, const SparseMatrix& consistent) {
    const Matrix wanted = monomials.transpose() * (consistent * monomials);
    const Matrix found = monomials.transpose() * (mass * monomials);
    // The monomials are of size one, so these are masses; rounding leaves 1e-13 of them.
    if ((found - wanted).cwiseAbs().maxCoeff() <= 1e-10 * wanted.cwiseAbs().maxCoeff()) return;
    throw Error(ErrorKind::invalid_input,
                "mass type \"equivalent-nearest\": the nodes that are not on the contact boundary are too few to carry "
                "the body's mass, centre of gravity and inertia; refine the mesh, or use mass type \"consistent\" or "
                "\"lumped\"");
  }

  static void correct(SparseMatrix& mass, const Matrix& monomials, const SparseMatrix& consistent) {
    const Index size = monomials.cols();
    std::vector<std::pair<Index, Index>> conditions;
    for (Index a = 0; a < size; ++a) {
      for (Index b = a; b < size; ++b) conditions.emplace_back(a, b);
    }
    const auto count = static_cast<Index>(conditions.size());
    const auto value = [&](Index condition, Index i, Index j) {
      const auto [a, b] = conditions[static_cast<std::size_t>(condition)];
      return 0.5 * (monomials(i, a) * monomials(j, b) + monomials(i, b) * monomials(j, a));
    };
    Matrix gram = Matrix::Zero(count, count);
    Vector row(count);
    for (Index j = 0; j < mass.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(mass, j); entry; ++entry) {
        for (Index k = 0; k < count; ++k) row[k] = value(k, entry.row(), j);
        gram.noalias() += row * row.transpose();
      }
    }
    const Eigen::LDLT<Matrix> factor(gram);
    // The second round takes away what rounding left of the first.
    for (int round = 0; round < 2; ++round) {
      const Matrix missing = monomials.transpose() * (consistent * monomials - mass * monomials);
      Vector defect(count);
      for (Index k = 0; k < count; ++k) {
        defect[k] =
            missing(conditions[static_cast<std::size_t>(k)].first, conditions[static_cast<std::size_t>(k)].second);
      }
      const Vector multipliers = factor.solve(defect);
      for (Index j = 0; j < mass.cols(); ++j) {
        for (SparseMatrix::InnerIterator entry(mass, j); entry; ++entry) {
          double correction = 0.0;
          for (Index k = 0; k < count; ++k) correction += multipliers[k] * value(k, entry.row(), j);
          entry.valueRef() += correction;
        }
      }
    }
  }
};

}  // namespace

std::unique_ptr<MassConstruction> make_nearest_equivalent_mass() {
  return std::make_unique<NearestEquivalentMass>();
}

}  // namespace ricochet
