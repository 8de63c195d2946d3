#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "ricochet/solver/contact/iterative_contact_solver.hpp"
#include "support/contact_problems.hpp"

/// @file Dependent contact conditions: W = H A⁻¹ Hᵀ with more rows than unknowns, with rows that are repeated, nearly
/// parallel or opposed. A step still has a unique motion, determined by the energy alone:
///   δ = argmin ½ δᵀA δ  over  H δ + q ≥ 0.

namespace ricochet::test_support {
namespace {

/// An elastic system and the conditions on it.
struct Constrained {
  Matrix stiffness;  ///< A
  Matrix rows;       ///< H, of unit length or nearly
  Vector offset;     ///< q

  /// Displacement δ = A⁻¹Hᵀr.
  [[nodiscard]] Vector motion(const Vector& reaction) const {
    return stiffness.llt().solve(rows.transpose() * reaction);
  }
  /// Rounding of H δ + q and of the reactions computed from it.
  [[nodiscard]] double rounding(const Vector& reaction) const {
    const Matrix w = rows * stiffness.llt().solve(rows.transpose());
    return 1e-12 * (1.0 + offset.lpNorm<Eigen::Infinity>() + (w.cwiseAbs() * reaction).maxCoeff());
  }
  /// Delassus operator as YᵀY with Y = L⁻¹Hᵀ, as computed in a step.
  [[nodiscard]] Matrix contact_operator() const {
    const Matrix half = stiffness.llt().matrixL().solve(rows.transpose());
    Matrix w = half.transpose() * half;
    w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
    return w;
  }
  [[nodiscard]] FrictionProblem problem(const std::vector<Index>& order) const {
    FrictionProblem result(std::vector<Index>(order.size(), 1), 0.0);
    result.w = contact_operator()(order, order);
    result.q = offset(order);
    return result;
  }
};

enum class Kind { twice, nearly_parallel, opposed, random };

/// Random conditions; `room`: clearance of all conditions at an admissible motion, negative if they are contradictory.
Constrained random_constraints(Index unknowns, Index count, unsigned seed) {
  std::mt19937 random(seed);
  Constrained result;
  result.stiffness = random_operator(unknowns, 2.0, random) + 1e-3 * Matrix::Identity(unknowns, unknowns);
  result.rows.resize(count, unknowns);
  const Vector inside = uniform(unknowns, random);
  result.offset.resize(count);
  for (Index i = 0; i < count; ++i) {
    const auto kind = i == 0 ? Kind::random : static_cast<Kind>(random() % 4);
    const Index like = i == 0 ? 0 : Index(random() % unsigned(i));
    Vector row = uniform(unknowns, random);
    if (kind == Kind::twice) row = result.rows.row(like);
    if (kind == Kind::opposed) row = -result.rows.row(like);
    if (kind == Kind::nearly_parallel) {
      const double angle = std::pow(10.0, -double(1 + random() % 16));
      row = result.rows.row(like).transpose() + angle * row;
    }
    result.rows.row(i) = row / row.norm();
    // `inside` meets the conditions, now and then with no clearance. Nearly opposed conditions need some clearance:
    // otherwise rounding would decide whether there is an admissible motion.
    const bool tight = random() % 3 == 0 && kind == Kind::random;
    const double room = tight ? 0.0 : 0.05 + std::abs(uniform(random));
    result.offset[i] = room - result.rows.row(i).dot(inside);
    if (kind == Kind::twice && random() % 2 == 0) result.offset[i] = result.offset[like];
  }
  return result;
}

std::vector<Index> identity_order(Index count) {
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  return order;
}

/// r ≥ 0, H δ + q ≥ 0 and r ⟂ H δ + q with δ = A⁻¹Hᵀr: sufficient for the minimum of a convex energy.
void expect_minimum(const Constrained& system, const Vector& reaction) {
  const Vector gap = system.offset + system.rows * system.motion(reaction);
  EXPECT_GE(reaction.minCoeff(), 0.0);
  EXPECT_GE(gap.minCoeff(), -system.rounding(reaction));
  EXPECT_LE(reaction.dot(gap.cwiseAbs()), system.rounding(reaction) * reaction.lpNorm<1>());
}

TEST(DependentConditions, HaveOneMotionHoweverTheyAreStated) {
  for (unsigned seed = 0; seed < samples(400); ++seed) {
    SCOPED_TRACE(seed);
    const Index unknowns = 1 + Index(seed % 7);
    const Index count = 2 + Index(seed % 17);
    const Constrained system = random_constraints(unknowns, count, seed);
    for (const char* name : {"automatic", "active-set"}) {
      std::mt19937 random(seed);
      std::vector<Index> order = identity_order(count);
      Vector first;
      for (int statement = 0; statement < 3; ++statement) {
        ContactRun run(name);
        // Another order, and another initial guess.
        if (statement > 0) std::shuffle(order.begin(), order.end(), random);
        if (statement > 1) run.set_warm_start(uniform(count, random).cwiseAbs());
        const ContactSolution& solution = run.solve(system.problem(order));
        ASSERT_TRUE(solution.solved()) << name << ": " << solution.reason << ", residual " << solution.residual;
        Vector reaction(count);
        for (Index i = 0; i < count; ++i) reaction[order[std::size_t(i)]] = solution.reaction[i];
        expect_minimum(system, reaction);
        if (statement == 0) first = reaction;
        // (δ − δ′)ᵀA(δ − δ′) = (r − r′)ᵀ(u − u′), which is negative up to the rounding of u.
        const Vector apart = system.motion(reaction) - system.motion(first);
        const double rounding = system.rounding(reaction) + system.rounding(first);
        EXPECT_LE(apart.dot(system.stiffness * apart), 2.0 * rounding * (reaction + first).lpNorm<1>()) << name;
      }
    }
  }
}

/// Time steps: different points and offsets in each, with the data that is kept from the previous step.
TEST(DependentConditions, StayInStepWithWhatIsKept) {
  for (unsigned seed = 0; seed < samples(40); ++seed) {
    SCOPED_TRACE(seed);
    const Index count = 12 + Index(seed % 20);
    const Constrained system = random_constraints(6, count, 1000 + seed);
    const std::vector<Index> order = identity_order(count);
    FrictionProblem problem = system.problem(order);
    const Vector offset = problem.q;
    for (const char* name : {"automatic", "active-set"}) {
      std::mt19937 random(seed);
      ContactRun run(name);
      for (int step = 0; step < 12; ++step) {
        problem.q = offset.array() + (random() % 2 == 0 ? 0.0 : 0.3 * std::abs(uniform(random)));
        for (char& eligible : problem.eligible) eligible = random() % 3 != 0 ? 1 : 0;
        const ContactSolution& solution = run.solve(problem);
        ASSERT_TRUE(solution.solved()) << name << ", step " << step << ": " << solution.reason;
        expect_law(problem, solution, 1e-11);
      }
    }
  }
}

/// A floor and a ceiling without clearance between them, and conditions that do not matter.
TEST(DependentConditions, NameThosePointsThatContradictOneAnother) {
  for (unsigned seed = 0; seed < samples(60); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Index unknowns = 3;
    Constrained system = random_constraints(unknowns, 8, 2000 + seed);
    // Three rows in a plane with a positive combination that is zero, and no clearance.
    const Vector one = uniform(unknowns, random).normalized(), other = uniform(unknowns, random).normalized();
    const Index a = 1, b = 4, c = 6;
    system.rows.row(a) = one;
    system.rows.row(b) = other;
    system.rows.row(c) = -(one + other);
    system.offset[a] = 0.3;
    system.offset[b] = 0.4;
    const double lack = std::pow(10.0, -double(seed % 6));
    system.offset[c] = -0.7 - lack;
    // The other conditions have clearance for every motion of interest.
    for (const Index i : {0, 2, 3, 5, 7}) system.offset[i] = 1e3;
    for (const Index tangents : {0, 1}) {
      FrictionProblem problem(std::vector<Index>(8, 1 + tangents), 0.3);
      const FrictionProblem normal = system.problem(identity_order(8));
      for (Index i = 0; i < 8; ++i) {
        problem.q[i * (1 + tangents)] = normal.q[i];
        for (Index j = 0; j < 8; ++j) problem.w(i * (1 + tangents), j * (1 + tangents)) = normal.w(i, j);
      }
      const auto solver = make_contact_solver();
      ContactSolution solution;
      const ContactProblem contact = problem.contact();
      solver->analyse(contact);
      solver->solve(contact, {}, solution);
      EXPECT_FALSE(solution.solved());
      EXPECT_EQ(solution.contradiction, (std::vector<Index>{a, b, c})) << solution.reason;
    }
  }
}

/// Two planes at one node that may slide on both: normals and tangents are four rows over two unknowns.
TEST(DependentConditions, WithFrictionMeetTheLaw) {
  for (unsigned seed = 0; seed < samples(150); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Index nodes = 1 + Index(seed % 4);
    Constrained system;
    system.stiffness = random_operator(2 * nodes, 1.0, random);
    const Index planes = 2 + Index(seed % 2);
    const Index points = planes * nodes;
    system.rows.setZero(2 * points, 2 * nodes);
    system.offset.resize(2 * points);
    const double angle = std::pow(10.0, -double(seed % 12));
    for (Index i = 0; i < points; ++i) {
      const Index node = i / planes;
      // A floor, a nearly identical one, and a ceiling.
      const double turn = i % planes == 1 ? angle : i % planes == 2 ? 3.141592653589793 : 0.0;
      system.rows.block(2 * i, 2 * node, 2, 2) << -std::sin(turn), std::cos(turn), std::cos(turn), std::sin(turn);
      system.offset[2 * i] = i % planes == 2 ? 2.0 : -std::abs(uniform(random));
      system.offset[2 * i + 1] = uniform(random);
    }
    FrictionProblem problem(std::vector<Index>(std::size_t(points), 2), 0.2);
    problem.w = system.contact_operator();
    problem.q = system.offset;
    expect_law(problem, solve(problem), 1e-10);
  }
}

}  // namespace
}  // namespace ricochet::test_support
