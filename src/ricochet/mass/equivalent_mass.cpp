#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"

namespace ricochet {

namespace {

/// Weights of one contact node on free nodes.
struct Extrapolation {
  std::vector<Index> nodes;
  Vector weights;
};

/// M₀ = EᵀME. E is the identity on free nodes; the row of a contact node holds the weights on nearby free nodes which
/// reproduce affine functions and are least in the norm Σ w_j²/m_jj. So PᵃᵀM₀Pᵇ = PᵃᵀMPᵇ exactly, M₀ is positive
/// semi-definite with the contact dofs as its null space by construction, and wᵀ(m_cc)w measures what is added to the
/// free nodes relative to the mass they have: the choice of norm and of many neighbours keeps the top eigenvalue low.
/// See docs/equivalent-mass.md for the measurements behind `wanted_neighbours`.
class EquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }

  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    const SparseMatrix& consistent = *input.consistent;
    const Index count = consistent.cols();
    std::vector<char> is_contact(static_cast<std::size_t>(count), 0);
    for (const Index node : input.contact_nodes) is_contact[static_cast<std::size_t>(node)] = 1;
    const Vector diagonal = input.inertia_matrix().diagonal();
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<Index> seen_from(static_cast<std::size_t>(count), -1);
    for (Index node = 0; node < count; ++node) {
      if (is_contact[static_cast<std::size_t>(node)] == 0) {
        entries.emplace_back(static_cast<int>(node), static_cast<int>(node), 1.0);
        continue;
      }
      const Extrapolation row = extrapolate(input, is_contact, diagonal, node, seen_from);
      for (std::size_t k = 0; k < row.nodes.size(); ++k) {
        entries.emplace_back(static_cast<int>(node), static_cast<int>(row.nodes[k]),
                             row.weights[static_cast<Index>(k)]);
      }
    }
    SparseMatrix extension(count, count);
    extension.setFromTriplets(entries.begin(), entries.end());
    SparseMatrix result = extension.transpose() * (consistent * extension);
    // The product is symmetric only to rounding; what follows relies on exact symmetry.
    const SparseMatrix transposed = result.transpose();
    result = 0.5 * (result + transposed);
    result.makeCompressed();
    return result;
  }

 private:
  /// Weights on the rings of free nodes around a contact node: enough rings to have the wanted number of neighbours and
  /// to span space affinely. `seen_from` is work space: the contact node from which a node was last reached.
  static Extrapolation extrapolate(const MassInput& input, const std::vector<char>& is_contact, const Vector& diagonal,
                                   Index node, std::vector<Index>& seen_from) {
    const Index dimension = input.nodes->rows();
    const std::size_t wanted_neighbours = dimension == 2 ? 20 : 40;
    std::vector<Index> front{node}, next, free;
    seen_from[static_cast<std::size_t>(node)] = node;
    Extrapolation result;
    while (!front.empty()) {
      next.clear();
      for (const Index from : front) {
        for (SparseMatrix::InnerIterator entry(*input.consistent, from); entry; ++entry) {
          const auto neighbour = static_cast<Index>(entry.row());
          if (seen_from[static_cast<std::size_t>(neighbour)] == node) continue;
          seen_from[static_cast<std::size_t>(neighbour)] = node;
          next.push_back(neighbour);
          if (is_contact[static_cast<std::size_t>(neighbour)] == 0) free.push_back(neighbour);
        }
      }
      std::swap(front, next);
      const bool enough = free.size() >= wanted_neighbours || front.empty();
      if (enough && least_weights(input, diagonal, node, free, result)) return result;
    }
    throw Error(ErrorKind::invalid_input, refusal(input, node, free.size()));
  }

  /// Least-norm affine weights; false when the nodes do not span space affinely well enough.
  static bool least_weights(const MassInput& input, const Vector& diagonal, Index node, const std::vector<Index>& free,
                            Extrapolation& result) {
    const Index dimension = input.nodes->rows();
    const auto count = static_cast<Index>(free.size());
    if (count <= dimension) return false;
    Matrix conditions(dimension + 1, count);
    Vector trust(count);
    for (Index k = 0; k < count; ++k) {
      conditions(0, k) = 1.0;
      conditions.col(k).tail(dimension) = input.nodes->col(free[static_cast<std::size_t>(k)]) - input.nodes->col(node);
      trust[k] = diagonal[free[static_cast<std::size_t>(k)]];
    }
    // Lengths relative to the neighbourhood's size, masses to the largest: the test below has no unit.
    conditions.bottomRows(dimension) /= conditions.bottomRows(dimension).cwiseAbs().maxCoeff();
    trust /= trust.maxCoeff();
    const Matrix gram = conditions * trust.asDiagonal() * conditions.transpose();
    // Spread of the nodes about their own centre, in the worst direction.
    const Vector centre = conditions * trust / trust.sum();
    const Matrix spread = gram / trust.sum() - centre * centre.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix> axes(spread.bottomRightCorner(dimension, dimension));
    if (axes.eigenvalues()[0] < 1e-3 * axes.eigenvalues()[dimension - 1]) return false;
    result.nodes = free;
    result.weights = trust.asDiagonal() * (conditions.transpose() * gram.ldlt().solve(Vector::Unit(dimension + 1, 0)));
    return true;
  }

  static std::string refusal(const MassInput& input, Index node, std::size_t found) {
    const Vector at = input.nodes->col(node);
    return fmt::format(
        "mass type \"equivalent\": the free nodes around the contact node at ({}{}) do not span space affinely ({} "
        "free nodes "
        "in its body), so its inertia has nowhere to go; refine the mesh there so that at least {} nodes which are not "
        "on the "
        "contact boundary surround it and are not all in one {}, or use mass type \"consistent\" or \"lumped\"",
        at.size() == 3 ? fmt::format("{:.6g}, {:.6g}, ", at[0], at[1]) : fmt::format("{:.6g}, ", at[0]),
        fmt::format("{:.6g}", at[at.size() - 1]), found, at.size() + 1, at.size() == 3 ? "plane" : "line");
  }
};

}  // namespace

std::unique_ptr<MassConstruction> make_equivalent_mass() {
  return std::make_unique<EquivalentMass>();
}

}  // namespace ricochet
