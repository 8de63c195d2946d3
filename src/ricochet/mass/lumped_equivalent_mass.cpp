#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/mass/mass.hpp"

namespace ricochet {

namespace {

/// Bodies: the connected components of the matrix's graph, nodes in the order in which they are reached.
std::vector<std::vector<Index>> connected_bodies(const SparseMatrix& matrix) {
  std::vector<char> seen(static_cast<std::size_t>(matrix.cols()), 0);
  std::vector<std::vector<Index>> bodies;
  for (Index first = 0; first < matrix.cols(); ++first) {
    if (seen[static_cast<std::size_t>(first)] != 0) continue;
    seen[static_cast<std::size_t>(first)] = 1;
    std::vector<Index> body{first};
    for (std::size_t k = 0; k < body.size(); ++k) {
      for (SparseMatrix::InnerIterator entry(matrix, body[k]); entry; ++entry) {
        if (seen[static_cast<std::size_t>(entry.row())] != 0) continue;
        seen[static_cast<std::size_t>(entry.row())] = 1;
        body.push_back(entry.row());
      }
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

[[noreturn]] void refuse(const MassInput& input, Index node) {
  const Vector at = input.nodes->col(node);
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("mass type \"equivalent-lumped\": the body of the node at ({:.6g}, {:.6g}{}) has too few nodes "
                  "that are not on the contact boundary to carry its mass about its centre of gravity; refine the "
                  "mesh, or use mass type \"lumped\" (with an implicit scheme)",
                  at[0], at[1], at.size() == 3 ? fmt::format(", {:.6g}", at[2]) : ""));
}

/// What the masses of one body must sum to.
struct Moments {
  Matrix functions;  ///< 1, x, y[, z] and their products at the body's nodes, nodes × (6 or 10)
  Vector wanted;     ///< PᵃᵀMPᵇ in the same order
  Index affine = 0;  ///< number of the first ones, 1, x, y[, z]
};

/// Lengths are about the centre of the body's box and relative to its size: the systems to solve have no unit.
Moments moments_of(const MassInput& input, const std::vector<Index>& body) {
  const Index d = input.nodes->rows();
  const auto count = static_cast<Index>(body.size());
  Matrix positions(d, count);
  for (Index i = 0; i < count; ++i) positions.col(i) = input.nodes->col(body[static_cast<std::size_t>(i)]);
  const Vector low = positions.rowwise().minCoeff();
  const Vector high = positions.rowwise().maxCoeff();
  Moments result;
  result.affine = d + 1;
  result.functions.resize(count, 1 + d + d * (d + 1) / 2);
  result.functions.col(0).setOnes();
  result.functions.middleCols(1, d) =
      ((positions.colwise() - 0.5 * (low + high)) / (high - low).maxCoeff()).transpose();
  Matrix monomials = Matrix::Zero(input.nodes->cols(), d + 1);
  for (Index i = 0; i < count; ++i) {
    monomials.row(body[static_cast<std::size_t>(i)]) = result.functions.row(i).head(d + 1);
  }
  const Matrix all = monomials.transpose() * (*input.consistent * monomials);
  result.wanted.resize(result.functions.cols());
  result.wanted.head(d + 1) = all.col(0);
  Index column = d + 1;
  for (Index a = 1; a <= d; ++a) {
    for (Index b = a; b <= d; ++b) {
      result.functions.col(column) = result.functions.col(a).cwiseProduct(result.functions.col(b));
      result.wanted[column++] = all(a, b);
    }
  }
  return result;
}

/// What Σ_i m_i f(x_i) lacks of what is wanted, relative to the total.
Vector defect(const Moments& moments, const Vector& mass) {
  return (moments.wanted - moments.functions.transpose() * mass) / mass.sum();
}

/// m ← m (1 + θ p). Returns θ: the most, up to 1, that leaves every node half of its mass.
double apply(const Vector& change, Vector& mass) {
  double lowest = 0.0;
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0) lowest = std::min(lowest, change[i]);
  }
  const double theta = lowest < -0.5 ? -0.5 / lowest : 1.0;
  mass.array() *= 1.0 + theta * change.array();
  return theta;
}

/// Total mass and centre of gravity by the affine p of the least Σ (Δm)²/m.
double correct_centre(const Moments& moments, Vector& mass) {
  const auto affine = moments.functions.leftCols(moments.affine);
  const Matrix gram = affine.transpose() * (mass / mass.sum()).asDiagonal() * affine;
  return apply(affine * gram.ldlt().solve(defect(moments, mass).head(moments.affine)), mass);
}

/// Moments of inertia likewise, total mass and centre being right already, by a p in the span of the quadratic
/// functions' parts that are orthogonal to the affine ones in the weights m: whatever θ, those two are not changed.
double correct_inertia(const Moments& moments, Vector& mass) {
  const auto affine = moments.functions.leftCols(moments.affine);
  const Vector weight = mass / mass.sum();
  const Eigen::LDLT<Matrix> gram(affine.transpose() * weight.asDiagonal() * affine);
  Matrix part = moments.functions.rightCols(moments.wanted.size() - moments.affine);
  Vector lacking = defect(moments, mass).tail(part.cols());
  for (Index k = 0; k < part.cols(); ++k) {
    const double size = std::sqrt(part.col(k).cwiseAbs2().dot(weight));
    if (!(size > 0.0)) continue;
    part.col(k) /= size;
    lacking[k] /= size;
  }
  // Twice, for rounding.
  for (int round = 0; round < 2; ++round) part -= affine * gram.solve(affine.transpose() * weight.asDiagonal() * part);
  // Rank-revealing: where all nodes are at two values of x, x² is an affine function on them and cannot be corrected.
  Eigen::CompleteOrthogonalDecomposition<Matrix> factor;
  factor.setThreshold(1e-10);
  factor.compute(part.transpose() * weight.asDiagonal() * part);
  return apply(part * factor.solve(lacking), mass);
}

/// l with the mass of each contact node shared among the free nodes nearest to it in the graph, in proportion to the
/// masses that these have.
Vector share_contact_mass(const MassInput& input, const Vector& lumped) {
  const SparseMatrix& graph = *input.consistent;
  std::vector<char> is_contact(static_cast<std::size_t>(graph.cols()), 0);
  for (const Index node : input.contact_nodes) is_contact[static_cast<std::size_t>(node)] = 1;
  Vector result = lumped;
  std::vector<Index> seen_from(static_cast<std::size_t>(graph.cols()), -1);
  std::vector<Index> front, next, free;
  for (const Index node : input.contact_nodes) {
    result[node] = 0.0;
    front.assign(1, node);
    seen_from[static_cast<std::size_t>(node)] = node;
    free.clear();
    double sum = 0.0;
    while (free.empty() && !front.empty()) {
      next.clear();
      for (const Index from : front) {
        for (SparseMatrix::InnerIterator entry(graph, from); entry; ++entry) {
          const auto neighbour = static_cast<Index>(entry.row());
          if (seen_from[static_cast<std::size_t>(neighbour)] == node) continue;
          seen_from[static_cast<std::size_t>(neighbour)] = node;
          next.push_back(neighbour);
          if (is_contact[static_cast<std::size_t>(neighbour)] != 0) continue;
          free.push_back(neighbour);
          sum += lumped[neighbour];
        }
      }
      std::swap(front, next);
    }
    if (free.empty()) refuse(input, node);
    for (const Index receiver : free) result[receiver] += lumped[node] * (lumped[receiver] / sum);
  }
  return result;
}

/// A diagonal mass without inertia on the contact nodes, for explicit schemes. Three steps, the last two body by body:
/// 1. d: the lumped mass, that of contact nodes shared among the nearest free nodes. Total mass is kept, and no node
/// has
///    less than it had.
/// 2. m = d (1 + a(x)) with the affine a that restores the centre of gravity.
/// 3. m ← m (1 + p(x)) with the quadratic p that restores the moments of inertia. All conditions of an equivalent mass
///    then hold: 6 in 2D, 10 in 3D.
/// a and p are those of the least Σ (Δm)²/m, from one small system each, and of the order of h² on a mesh of size h:
/// masses of the order of h are moved by h. Where step 3 would take more than half of some node's mass, p is scaled
/// down: total mass and centre still hold, the moments of inertia as far as that goes, which is said in the log.
class LumpedEquivalentMass final : public MassConstruction {
 public:
  [[nodiscard]] bool removes_contact_inertia() const override { return true; }

  /// Damping keeps the rate of each node: c_i = m_i (∫aρ N_i²)/(∫ρ N_i²).
  [[nodiscard]] SparseMatrix build(const MassInput& input) const override {
    double lacking = 0.0;
    const Vector mass = build_diagonal({&input.inertia_matrix(), input.nodes, input.contact_nodes}, lacking);
    if (input.consistent == &input.inertia_matrix()) {
      if (lacking > 1e-10) warn(lacking);
      return to_matrix(mass);
    }
    const Vector rate = input.consistent->diagonal().cwiseQuotient(input.inertia->diagonal());
    return to_matrix(mass.cwiseProduct(rate));
  }

 private:
  static Vector build_diagonal(const MassInput& input, double& lacking) {
    Vector diagonal = share_contact_mass(input, lumped_diagonal(*input.consistent));
    for (const std::vector<Index>& body : connected_bodies(*input.consistent)) {
      lacking = std::max(lacking, balance(input, body, diagonal));
    }
    return diagonal;
  }

  static void warn(double lacking) {
    log::warning(fmt::format(
        "mass type \"equivalent-lumped\" keeps total mass and centre of gravity, but moments of inertia only "
        "to {:.2g} of the largest: the nodes that are not on the contact boundary are too few, or too near to "
        "one another, to carry them with positive masses; refine the mesh where this matters",
        lacking));
  }

  /// Steps 2 and 3 on one body. Returns what the moments of inertia lack, relative to the largest.
  static double balance(const MassInput& input, const std::vector<Index>& body, Vector& diagonal) {
    const Moments moments = moments_of(input, body);
    Vector mass(static_cast<Index>(body.size()));
    for (Index i = 0; i < mass.size(); ++i) mass[i] = diagonal[body[static_cast<std::size_t>(i)]];
    // Second rounds take away what rounding left of the first.
    if (correct_centre(moments, mass) < 1.0) refuse(input, body.front());
    correct_centre(moments, mass);
    // Not so where the free nodes lie in a line that misses the centre.
    if (!(defect(moments, mass).head(moments.affine).cwiseAbs().maxCoeff() < 1e-12)) refuse(input, body.front());
    if (correct_inertia(moments, mass) == 1.0) correct_inertia(moments, mass);
    for (Index i = 0; i < mass.size(); ++i) diagonal[body[static_cast<std::size_t>(i)]] = mass[i];
    const Index quadratic = moments.wanted.size() - moments.affine;
    return defect(moments, mass).tail(quadratic).cwiseAbs().maxCoeff() * mass.sum() /
           moments.wanted.tail(quadratic).cwiseAbs().maxCoeff();
  }

  /// Contact nodes have no entry.
  static SparseMatrix to_matrix(const Vector& diagonal) {
    SparseMatrix result(diagonal.size(), diagonal.size());
    result.reserve(Eigen::VectorXi::Constant(diagonal.size(), 1));
    for (Index i = 0; i < diagonal.size(); ++i) {
      if (diagonal[i] != 0.0) result.insert(i, i) = diagonal[i];
    }
    result.makeCompressed();
    return result;
  }
};

}  // namespace

std::unique_ptr<MassConstruction> make_lumped_equivalent_mass() {
  return std::make_unique<LumpedEquivalentMass>();
}

}  // namespace ricochet
