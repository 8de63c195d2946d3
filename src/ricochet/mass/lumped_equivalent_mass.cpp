#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/linear_algebra/diagonal_matrix.hpp"
#include "ricochet/mass/graph_rings.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"

namespace ricochet {

namespace {

/// Identifies a body in messages.
std::string name_of(const MassInput& input, const MassBody& body) {
  return "the body with the node at " + text_of_point(*input.nodes, body.nodes.front());
}

[[noreturn]] void refuse(const MassInput& input, const MassBody& body, const std::string& reason) {
  throw Error(ErrorKind::invalid_input,
              fmt::format("mass type \"equivalent-lumped\": {} has {}; refine the mesh, so that nodes off the contact "
                          "boundary surround its centre of gravity, or use mass type \"lumped\" "
                          "with scheme \"contact-stabilized\" or \"newmark\"",
                          name_of(input, body), reason));
}

/// Factor of ξη in the list of second moments: with it the norm of the list is that of the symmetric
/// matrix and independent of the axes.
double factor_of(Index a, Index b) { return a == b ? 1.0 : std::numbers::sqrt2; }

/// Moments that the masses of one body must reproduce, in the frame of the body.
struct Moments {
  Matrix functions;  ///< 1, ξ, η[, ζ], ξ², √2 ξη, η² and so on at the body's nodes, nodes × (6 or 10)
  Vector target;     ///< PᵃᵀMPᵇ in the same order
  Index affine = 0;  ///< number of the affine functions 1, ξ, η[, ζ], which come first
};

Moments moments_of(const MassInput& input, const MassFrames& frames, const MassBody& body) {
  const Index d = input.nodes->rows();
  const auto count = Index(body.nodes.size());
  Moments result;
  result.affine = d + 1;
  result.functions.resize(count, 1 + d + d * (d + 1) / 2);
  for (Index i = 0; i < count; ++i)
    result.functions.row(i).head(d + 1) = frames.monomials.col(body.nodes[std::size_t(i)]).transpose();
  const Matrix all = mass_moments(*input.consistent, frames, body);
  result.target.resize(result.functions.cols());
  result.target.head(d + 1) = all.col(0);
  Index column = d + 1;
  for (Index a = 1; a <= d; ++a) {
    for (Index b = a; b <= d; ++b) {
      result.functions.col(column) = factor_of(a, b) * result.functions.col(a).cwiseProduct(result.functions.col(b));
      result.target[column++] = factor_of(a, b) * all(a, b);
    }
  }
  return result;
}

/// Defect of the moments Σ_i m_i f(x_i), relative to the total mass.
Vector defect(const Moments& moments, const Vector& mass) {
  return (moments.target - moments.functions.transpose() * mass) / mass.sum();
}

/// Applies m ← m (1 + θ p). Returns θ, the largest value up to 1 with which every node keeps half of its mass.
double apply(const Vector& change, Vector& mass) {
  double lowest = 0.0;
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0) lowest = std::min(lowest, change[i]);
  }
  const double theta = lowest < -0.5 ? -0.5 / lowest : 1.0;
  mass.array() *= 1.0 + theta * change.array();
  return theta;
}

/// Corrects total mass and centre of gravity with the affine p of the least Σ (Δm)²/m.
double correct_centre(const Moments& moments, Vector& mass) {
  const auto affine = moments.functions.leftCols(moments.affine);
  const Matrix gram = affine.transpose() * (mass / mass.sum()).asDiagonal() * affine;
  return apply(affine * PivotedCholesky(gram).solve(Vector(defect(moments, mass).head(moments.affine))), mass);
}

/// Corrects the moments of inertia, total mass and centre being correct already, with a p in the span of the components
/// of the quadratic functions orthogonal to the affine ones in the weights m: for any θ, mass and centre do not change.
double correct_inertia(const Moments& moments, Vector& mass) {
  const auto affine = moments.functions.leftCols(moments.affine);
  const Vector weight = mass / mass.sum();
  const PivotedCholesky gram(affine.transpose() * weight.asDiagonal() * affine);
  Matrix part = moments.functions.rightCols(moments.target.size() - moments.affine);
  const Vector deficit = defect(moments, mass).tail(part.cols());
  // Twice because of rounding.
  for (int pass = 0; pass < 2; ++pass)
    part -= affine * gram.solve(Matrix(affine.transpose() * weight.asDiagonal() * part));
  // Rank-revealing: if all nodes lie at two values of x, x² is an affine function on them and cannot be corrected.
  const LeastNormSolver factor(part.transpose() * weight.asDiagonal() * part, 1e-10);
  return apply(part * factor.solve(deficit), mass);
}

/// Tensor of inertia tr(S) I − S of the second moments S; in 2D the single moment tr(S).
Matrix inertia_tensor(const Matrix& second) {
  const Index d = second.rows();
  if (d == 2) return Matrix::Constant(1, 1, second.trace());
  return second.trace() * Matrix::Identity(d, d) - second;
}

/// Accuracy of the moments of inertia that the masses of a body yield.
struct InertiaCheck {
  double least = 1.0;    ///< the least moment of inertia about an axis through the centre, relative to the exact one
  double deficit = 0.0;  ///< the largest relative error of these and, relative to the largest, of the second moments
};

InertiaCheck check_inertia(const MassBody& body, const Moments& moments, const Vector& mass) {
  const Index d = moments.affine - 1;
  const Vector found = moments.functions.transpose() * mass;
  const auto second = [&](const Vector& sums) {
    Matrix result(d, d);
    Index column = d + 1;
    for (Index a = 0; a < d; ++a) {
      for (Index b = a; b < d; ++b) result(a, b) = result(b, a) = sums[column++] / factor_of(a, b);
    }
    return Matrix(body.axes * result * body.axes.transpose());
  };
  const Matrix own = second(found), target = second(moments.target);
  // (1 + ratio) J_wanted ω = J_own ω
  const SmallCholesky factor(inertia_tensor(target));
  const Matrix half = factor.solve_lower(inertia_tensor(own - target));
  const Vector ratios = symmetric_eigenvalues(factor.solve_lower(half.transpose()));
  return {1.0 + ratios.minCoeff(),
          std::max(ratios.cwiseAbs().maxCoeff(), (own - target).cwiseAbs().maxCoeff() / target.cwiseAbs().maxCoeff())};
}

/// Returns l with the mass of each contact node distributed among the massive nodes nearest to it in the graph, in
/// proportion to their own masses.
Vector share_contact_mass(const MassInput& input, const Vector& lumped) {
  const std::vector<char> is_contact = input.marked_contact_nodes();
  Vector result = lumped;
  GraphRings rings(*input.consistent);
  std::vector<Index> massive;
  for (const Index node : input.contact_nodes) {
    result[node] = 0.0;
    massive.clear();
    double sum = 0.0;
    rings.start(node);
    bool grows = true;
    while (massive.empty() && grows) {
      grows = rings.grow([&](Index neighbour) {
        if (is_contact[std::size_t(neighbour)] != 0) return;
        massive.push_back(neighbour);
        sum += lumped[neighbour];
      });
    }
    if (massive.empty()) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("mass type \"equivalent-lumped\": the body of the contact node at {} has no node off the "
                              "contact boundary that could carry its mass; refine the mesh, or use mass type "
                              "\"lumped\" with scheme \"contact-stabilized\" or \"newmark\"",
                              text_of_point(*input.nodes, node)));
    }
    for (const Index receiver : massive) result[receiver] += lumped[node] * (lumped[receiver] / sum);
  }
  return result;
}

void warn(const MassInput& input, const MassBody& body, double deficit) {
  log::warning(
      fmt::format("mass type \"equivalent-lumped\" preserves the mass and the centre of gravity of {}, but its "
                  "moments of inertia only within {:.2g} %: the nodes off the contact boundary are too few, or too "
                  "close together, to carry them with positive masses; refine the mesh where rotation matters",
                  name_of(input, body), 100.0 * deficit));
}

/// Fraction of a moment of inertia below which the mass is no longer an approximation.
constexpr double least_inertia = 0.1;
/// Least spread of the nodes with mass, in their worst direction, relative to that of the body.
constexpr double least_spread = 0.01;

/// Point masses in one plane (on one line in 2D) cannot rotate like a body, whatever their sizes.
void require_span(const MassInput& input, const MassBody& body, const Moments& moments, const Vector& mass) {
  const Index d = moments.affine - 1;
  const auto positions = moments.functions.middleCols(1, d);
  const Vector weight = mass / mass.sum();
  const Vector centre = positions.transpose() * weight;
  const Matrix spread = positions.transpose() * weight.asDiagonal() * positions - centre * centre.transpose();
  const Vector sizes = symmetric_eigenvalues(spread);
  if (sizes[0] > least_spread * least_spread) return;
  std::vector<Index> massive;
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0) massive.push_back(body.nodes[std::size_t(i)]);
  }
  std::ranges::sort(massive);
  refuse(input, body, describe_massive_nodes(*input.nodes, body.nodes, massive));
}

/// Performs steps 2 and 3 on one body. Returns the error of its moments of inertia, see InertiaCheck.
double balance(const MassInput& input, const MassFrames& frames, const MassBody& body, Vector& diagonal) {
  const char* const too_few = "too few nodes off the contact boundary to carry its mass about its centre of gravity";
  const Moments moments = moments_of(input, frames, body);
  Vector mass(static_cast<Index>(body.nodes.size()));
  for (Index i = 0; i < mass.size(); ++i) mass[i] = diagonal[body.nodes[std::size_t(i)]];
  require_span(input, body, moments, mass);
  // The second corrections remove the rounding error of the first.
  if (correct_centre(moments, mass) < 1.0) refuse(input, body, too_few);
  correct_centre(moments, mass);
  if (correct_inertia(moments, mass) == 1.0) correct_inertia(moments, mass);
  if (!(defect(moments, mass).head(moments.affine).cwiseAbs().maxCoeff() < 1e-12)) refuse(input, body, too_few);
  const InertiaCheck inertia = check_inertia(body, moments, mass);
  if (!(inertia.least >= least_inertia)) {
    refuse(input, body,
           fmt::format("too few nodes off the contact boundary to carry its moments of inertia: about one axis only "
                       "{:.2g} % would remain",
                       std::max(100.0 * inertia.least, 0.0)));
  }
  for (Index i = 0; i < mass.size(); ++i) diagonal[body.nodes[std::size_t(i)]] = mass[i];
  return inertia.deficit;
}

Vector build_diagonal(const MassInput& input, bool warns) {
  Vector diagonal = share_contact_mass(input, lumped_diagonal(*input.consistent));
  const MassFrames frames = mass_frames(*input.consistent, *input.nodes);
  double deficit = 0.0;
  const MassBody* worst = nullptr;
  for (const MassBody& body : frames.bodies) {
    const double own = balance(input, frames, body, diagonal);
    if (own <= deficit) continue;
    deficit = own;
    worst = &body;
  }
  if (warns && deficit > 1e-10) warn(input, *worst, deficit);
  return diagonal;
}

/// Diagonal mass without inertia on the contact nodes, for explicit schemes. Three steps, the last two body by body:
/// 1. d: the lumped mass, with that of contact nodes distributed among the nearest massive nodes. Total mass is
///    preserved, and no massive node loses mass.
/// 2. m = d (1 + a(x)) with the affine a that restores the centre of gravity.
/// 3. m ← m (1 + p(x)) with the quadratic p that restores the moments of inertia. All conditions of an equivalent mass
///    then hold: 6 in 2D, 10 in 3D.
/// a and p minimize Σ (Δm)²/m, are found from one small system each, and are of the order of h² on a mesh of size h:
/// masses of the order of h are moved by h. If step 3 would remove more than half of some node's mass, p is scaled
/// down: total mass and centre remain exact, the moments of inertia are as close as possible, and a warning is logged.
/// Preserves the damping rate of each node: c_i = m_i (∫aρ φ_i²)/(∫ρ φ_i²).
SparseMatrix build_lumped_equivalent_mass(const MassInput& input, const Parameters&) {
  const bool warns = input.consistent == &input.inertia_matrix();  // only once, not again for damping
  const Vector mass = build_diagonal({&input.inertia_matrix(), input.nodes, input.contact_nodes}, warns);
  if (warns) return diagonal_matrix(mass);
  const Vector rate = input.consistent->diagonal().cwiseQuotient(input.inertia->diagonal());
  return diagonal_matrix(mass.cwiseProduct(rate));
}

}  // namespace

MassRegistration lumped_equivalent_mass() {
  return {"equivalent-lumped", {.build = build_lumped_equivalent_mass, .removes_contact_inertia = true}};
}

}  // namespace ricochet
