#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Returns the contact nodes and, if the matrix is one of damping, the nodes of bodies without damping.
std::vector<Index> massless_nodes(const MassInput& input) {
  std::vector<Index> nodes = input.contact_nodes;
  const Vector diagonal = input.consistent->diagonal();
  for (Index node = 0; node < diagonal.size(); ++node)
    if (diagonal[node] == 0.0) nodes.push_back(node);
  return nodes;
}

/// Returns M without the rows and columns of contact nodes.
SparseMatrix restricted_to_massive_nodes(const MassInput& input) {
  const std::vector<char> is_contact = input.marked_contact_nodes();
  SparseMatrix result = *input.consistent;
  result.prune([&](Index row, Index column, double) {
    return is_contact[std::size_t(row)] == 0 && is_contact[std::size_t(column)] == 0;
  });
  return result;
}

/// Throws an error if the moments of a body are not preserved. Too few massive nodes cannot preserve mass, centre and
/// inertia: the Gram system is then singular and has no solution.
void check_conditions(const MassInput& input, const MassFrames& frames, const SparseMatrix& mass) {
  for (const MassBody& body : frames.bodies) {
    if (moment_defect(mass, *input.consistent, frames, body) <= 1e-10) continue;
    std::vector<Index> massive;
    for (const Index node : body.nodes) {
      if (!std::ranges::binary_search(input.contact_nodes, node)) massive.push_back(node);
    }
    std::ranges::sort(massive);
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("mass type \"equivalent-nearest\": the body with the node at {} has {}: they cannot carry its "
                    "mass, centre of gravity and moments of inertia; refine the mesh, or use mass type "
                    "\"consistent\" or \"lumped\" with scheme \"contact-stabilized\" or \"newmark\"",
                    text_of_point(*input.nodes, body.nodes.front()),
                    describe_massive_nodes(*input.nodes, body.nodes, massive)));
  }
}

/// Conditions of one body, as pairs (P^a, P^b).
std::vector<std::pair<Index, Index>> conditions(Index monomials) {
  std::vector<std::pair<Index, Index>> result;
  for (Index a = 0; a < monomials; ++a) {
    for (Index b = a; b < monomials; ++b) result.emplace_back(a, b);
  }
  return result;
}

void correct(SparseMatrix& mass, const MassFrames& frames, const MassBody& body, const SparseMatrix& consistent) {
  const Matrix& monomials = frames.monomials;
  const auto pairs = conditions(monomials.rows());
  const auto count = Index(pairs.size());
  const auto value = [&](Index condition, Index i, Index j) {
    const auto [a, b] = pairs[std::size_t(condition)];
    return 0.5 * (monomials(a, i) * monomials(b, j) + monomials(b, i) * monomials(a, j));
  };
  Matrix gram = Matrix::Zero(count, count);
  Vector row(count);
  for (const Index j : body.nodes) {
    for (SparseMatrix::InnerIterator entry(mass, j); entry; ++entry) {
      for (Index k = 0; k < count; ++k) row[k] = value(k, entry.row(), j);
      gram.noalias() += row * row.transpose();
    }
  }
  const PivotedCholesky factor(gram);
  // The second pass removes the rounding error of the first.
  for (int pass = 0; pass < 2; ++pass) {
    const Matrix missing = mass_moments(consistent, frames, body) - mass_moments(mass, frames, body);
    Vector defect(count);
    for (Index k = 0; k < count; ++k) {
      const auto [a, b] = pairs[std::size_t(k)];
      defect[k] = missing(a, b);
    }
    const Vector multipliers = factor.solve(defect);
    for (const Index j : body.nodes) {
      for (SparseMatrix::InnerIterator entry(mass, j); entry; ++entry) {
        double correction = 0.0;
        for (Index k = 0; k < count; ++k) correction += multipliers[k] * value(k, entry.row(), j);
        entry.valueRef() += correction;
      }
    }
  }
}

/// Construction of the source's authors: on the pattern of M without contact rows and columns, the matrix nearest to
/// M in the Frobenius norm subject to PᵃᵀM₀Pᵇ = PᵃᵀMPᵇ. Stationarity gives M₀ = M + Σ_ab μ_ab ½(PᵃPᵇᵀ + PᵇPᵃᵀ) on
/// the pattern, with the multipliers from a small Gram system. The conditions are symmetric from the start:
/// symmetrizing afterwards loses inertia.
SparseMatrix build_nearest_equivalent_mass(const MassInput& input, const Parameters&) {
  const MassFrames frames = mass_frames(input.inertia_matrix(), *input.nodes);
  SparseMatrix result = restricted_to_massive_nodes(input);
  // Each body is corrected separately: no mass passes between bodies.
  for (const MassBody& body : frames.bodies) correct(result, frames, body, *input.consistent);
  check_conditions(input, frames, result);
  if (!is_positive_definite(result, massless_nodes(input))) {
    throw Error(
        ErrorKind::invalid_input,
        "mass type \"equivalent-nearest\": on this mesh the nearest mass without inertia on contact nodes is "
        "indefinite (its Cholesky factorization fails), and a run with it would grow exponentially; use mass type "
        "\"equivalent\", which is positive semi-definite by construction, or refine the mesh");
  }
  return result;
}

}  // namespace

MassRegistration nearest_equivalent_mass() {
  return {"equivalent-nearest", {.build = build_nearest_equivalent_mass, .removes_contact_inertia = true}};
}

}  // namespace ricochet
