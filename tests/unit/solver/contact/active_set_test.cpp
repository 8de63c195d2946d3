#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "support/contact_problems.hpp"

namespace ricochet::test_support {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A contact problem together with its data.
struct Problem {
  Matrix w;
  Vector q, rounding;
  std::vector<char> eligible;

  Problem(Matrix operator_matrix, Vector offset)
      : w(std::move(operator_matrix)),
        q(std::move(offset)),
        rounding(Vector::Zero(q.size())),
        eligible(std::size_t(q.size()), 1) {}
  [[nodiscard]] FrictionProblem points() const {
    FrictionProblem problem(std::vector<Index>(eligible.size(), 1), 0.0);
    problem.w = w;
    problem.q = q;
    problem.rounding = rounding;
    problem.eligible = eligible;
    return problem;
  }
};

/// W = Q diag(10^(−digits·k)) Qᵀ with k from 0 to 1.
Problem normal_problem(Index size, unsigned seed, double digits = 1.0) {
  std::mt19937 random(seed);
  Matrix square(size, size);
  for (Index j = 0; j < size; ++j) {
    for (Index i = 0; i < size; ++i) square(i, j) = uniform(random);
  }
  const Matrix basis = Eigen::HouseholderQR<Matrix>(square).householderQ();
  Vector values(size);
  for (Index i = 0; i < size; ++i) {
    values[i] = std::pow(10.0, -digits * double(i) / double(std::max<Index>(size - 1, 1)));
  }
  Matrix w = basis * values.asDiagonal() * basis.transpose();
  w.triangularView<Eigen::StrictlyUpper>() = w.transpose();
  Vector q(size);
  for (double& value : q) value = uniform(random);
  return {w, q};
}

/// The registered solver "active-set".
class ActiveSetRun : public ContactRun {
 public:
  ActiveSetRun() : ContactRun("active-set") {}
  /// Starts with reactions at these points.
  void set_active(const std::vector<char>& active) {
    Vector start(static_cast<Index>(active.size()));
    for (std::size_t i = 0; i < active.size(); ++i) start[Index(i)] = active[i] != 0 ? 1.0 : 0.0;
    set_warm_start(start);
  }
};

Vector solve(const Problem& problem, ActiveSetRun& solver, int* steps = nullptr) {
  const ContactSolution& solution = solver.solve(problem.points());
  EXPECT_TRUE(solution.solved()) << solution.reason;
  if (steps != nullptr) *steps = solution.newton_steps;
  // Comparisons with NaN fail without stopping the other tests.
  if (!solution.solved()) return Vector::Constant(problem.q.size(), std::nan(""));
  return solution.reaction;
}

Vector solve(const Problem& problem) {
  ActiveSetRun solver;
  return solve(problem, solver);
}

/// 0 ≤ r ⟂ y ≥ 0, each to the rounding of the sums behind it (a backward stable solve of the active block).
void expect_solution(const Problem& problem, const Vector& r) {
  const Index size = problem.q.size();
  ASSERT_EQ(r.size(), size);
  const double factor_rounding = 4.0 * double(size) * epsilon * problem.w.diagonal().maxCoeff();
  for (Index i = 0; i < size; ++i) {
    EXPECT_GE(r[i], 0.0);
    if (problem.eligible[std::size_t(i)] == 0) {
      EXPECT_EQ(r[i], 0.0);
      continue;
    }
    const double y = problem.q[i] + problem.w.row(i).dot(r);
    const double rounding = factor_rounding * r.lpNorm<1>() +
                            40.0 * epsilon * (std::abs(problem.q[i]) + problem.w.row(i).cwiseAbs().dot(r));
    EXPECT_GE(y, -rounding);
    if (r[i] > 0.0) {
      EXPECT_LE(y, rounding);
    }
  }
}

/// The unique solution, found by trying every set of points.
Vector brute_force(const Problem& problem) {
  const Index size = problem.q.size();
  for (unsigned set = 0; set < (1U << size); ++set) {
    std::vector<Index> active;
    for (Index i = 0; i < size; ++i) {
      if ((set >> i & 1U) != 0) active.push_back(i);
    }
    Vector r = Vector::Zero(size);
    if (!active.empty()) {
      const Vector part = Matrix(problem.w(active, active)).fullPivLu().solve(-problem.q(active));
      for (std::size_t k = 0; k < active.size(); ++k) r[active[k]] = part[Index(k)];
    }
    const Vector y = problem.q + problem.w * r;
    bool good = true;
    for (Index i = 0; i < size; ++i) {
      const bool in = (set >> i & 1U) != 0;
      if (problem.eligible[std::size_t(i)] == 0) {
        good = good && !in;
      } else {
        good = good && (in ? r[i] >= 0.0 : y[i] >= -1e-12);
      }
    }
    if (good) return r;
  }
  ADD_FAILURE() << "no set is a solution";
  return Vector::Zero(size);
}

TEST(ActiveSet, AgreesWithTheEnumerationOfAllSets) {
  for (Index size = 1; size <= 10; ++size) {
    for (unsigned seed = 0; seed < 12; ++seed) {
      Problem problem = normal_problem(size, 100 * unsigned(size) + seed, 2.0);
      if (seed % 3 == 2) problem.eligible[std::size_t(seed) % std::size_t(size)] = 0;
      const Vector expected = brute_force(problem);
      const Vector found = solve(problem);
      expect_solution(problem, found);
      EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 1e-11 * (1.0 + expected.lpNorm<Eigen::Infinity>()));
    }
  }
}

TEST(ActiveSet, SolvesProblemsOfManySizes) {
  for (const Index size : {1, 2, 5, 20, 50, 100, 200}) {
    for (const double digits : {0.0, 1.0, 3.0, 6.0}) {
      SCOPED_TRACE(testing::Message() << size << " points, condition 1e" << digits);
      const Problem problem = normal_problem(size, unsigned(size) + 7U, digits);
      expect_solution(problem, solve(problem));
    }
  }
}

TEST(ActiveSet, SolvesIllConditionedProblems) {
  for (const Index size : {3, 10, 40, 120}) {
    for (const double digits : {9.0, 12.0}) {
      SCOPED_TRACE(testing::Message() << size << " points, condition 1e" << digits);
      const Problem problem = normal_problem(size, unsigned(size), digits);
      expect_solution(problem, solve(problem));
    }
  }
}

/// r and y are both exactly zero at some points: integers, with the solution chosen first.
TEST(ActiveSet, SolvesDegenerateProblems) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    const Index size = 8;
    Matrix root(size, size);
    for (Index j = 0; j < size; ++j) {
      for (Index i = 0; i < size; ++i) root(i, j) = double(random() % 5) - 2.0;
    }
    const Matrix w = root * root.transpose() + Matrix::Identity(size, size);
    Vector r(size), y(size);
    for (Index i = 0; i < size; ++i) {
      const auto kind = random() % 3;
      r[i] = kind == 0 ? 1.0 + double(random() % 4) : 0.0;
      y[i] = kind == 1 ? 1.0 + double(random() % 4) : 0.0;
    }
    const Problem problem(w, y - w * r);
    const Vector found = solve(problem);
    EXPECT_LE((found - r).lpNorm<Eigen::Infinity>(), 1e-11);
    expect_solution(problem, found);
  }
}

TEST(ActiveSet, NoOffsetNoReaction) {
  Problem problem = normal_problem(15, 4);
  problem.q.setZero();
  EXPECT_EQ(solve(problem), Vector::Zero(15));
  problem.q.setOnes();
  int iterations = 0;
  ActiveSetRun solver;
  EXPECT_EQ(solve(problem, solver, &iterations), Vector::Zero(15));
  EXPECT_EQ(iterations, 0);
}

/// The plain primal–dual active set method: all violations change sides at once. True if it returns to a set.
bool plain_method_cycles(const Problem& problem) {
  const Index size = problem.q.size();
  std::vector<char> active(static_cast<std::size_t>(size), 0);
  std::set<std::vector<char>> seen;
  while (seen.insert(active).second) {
    std::vector<Index> indices;
    for (Index i = 0; i < size; ++i) {
      if (active[std::size_t(i)] != 0) indices.push_back(i);
    }
    Vector r = Vector::Zero(size);
    if (!indices.empty()) {
      const Vector part = Matrix(problem.w(indices, indices)).llt().solve(-problem.q(indices));
      for (std::size_t k = 0; k < indices.size(); ++k) r[indices[k]] = part[Index(k)];
    }
    const Vector y = problem.q + problem.w * r;
    bool changed = false;
    for (Index i = 0; i < size; ++i) {
      char& state = active[std::size_t(i)];
      if (state != 0 ? r[i] < 0.0 : y[i] < -1e-12) {
        state ^= 1;
        changed = true;
      }
    }
    if (!changed) return false;
  }
  return true;
}

TEST(ActiveSet, EndsWhereThePlainMethodCycles) {
  int cycling = 0;
  for (const Index size : {3, 4, 5, 6, 8, 10}) {
    std::mt19937 random(static_cast<unsigned>(size));
    int of_this_size = 0;
    for (int trial = 0; trial < (is_sanitized ? 6000 : 60000) && of_this_size < 20; ++trial) {
      Matrix root(size, size);
      for (Index j = 0; j < size; ++j) {
        for (Index i = 0; i < size; ++i) root(i, j) = uniform(random);
      }
      Vector q(size);
      for (double& value : q) value = uniform(random);
      const Problem problem(root * root.transpose() + 1e-3 * Matrix::Identity(size, size), q);
      if (!plain_method_cycles(problem)) continue;
      ++of_this_size;
      const Vector found = solve(problem);
      expect_solution(problem, found);
      const Vector expected = brute_force(problem);
      EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 1e-9 * (1.0 + expected.lpNorm<Eigen::Infinity>()));
    }
    cycling += of_this_size;
  }
  std::printf("%d problems on which the plain method cycles\n", cycling);
  EXPECT_GE(cycling, 20);
}

/// The solution is unique, so it does not depend on where the search starts.
TEST(ActiveSet, AnyStartGivesTheSameSolution) {
  const Index size = 40;
  const Problem problem = normal_problem(size, 12, 2.0);
  const Vector expected = solve(problem);
  std::mt19937 random(9);
  for (int trial = 0; trial < 20; ++trial) {
    ActiveSetRun solver;
    std::vector<char> start(static_cast<std::size_t>(size));
    for (char& state : start) state = trial == 0 ? 1 : char(random() % 2);
    solver.set_active(start);
    const Vector found = solve(problem, solver);
    for (Index i = 0; i < size; ++i) EXPECT_EQ(expected[i] > 0.0, found[i] > 0.0);
    EXPECT_LE((found - expected).lpNorm<Eigen::Infinity>(), 1e-13 * expected.lpNorm<Eigen::Infinity>());
  }
}

TEST(ActiveSet, StartsFromTheLastSet) {
  const Problem problem = normal_problem(60, 14, 3.0);
  ActiveSetRun solver;
  int first = 0, again = 0, cold = 0;
  const Vector expected = solve(problem, solver, &first);
  EXPECT_GT(first, 1);
  EXPECT_TRUE(solve(problem, solver, &again) == expected);
  EXPECT_EQ(again, 1);
  Problem scaled = problem;
  scaled.q *= 2.0;  // the set stays, but not the offset
  EXPECT_TRUE(solve(scaled, solver, &again) == 2.0 * expected);
  EXPECT_EQ(again, 1);
  solver.reset();
  EXPECT_TRUE(solve(problem, solver, &cold) == expected);
  EXPECT_EQ(cold, first);
}

/// After reset() no data of an earlier operator remain, even if the set is the same.
TEST(ActiveSet, AnotherOperatorMayFollowAReset) {
  const Problem first(2.0 * Matrix::Identity(2, 2), Vector::Constant(2, -1.0));
  const Problem second(8.0 * Matrix::Identity(2, 2) + Matrix::Ones(2, 2), Vector::Constant(2, -1.0));
  ActiveSetRun solver;
  EXPECT_EQ(solve(first, solver), Vector::Constant(2, 0.5));
  solver.reset();
  solver.set_active({1, 1});
  expect_solution(second, solve(second, solver));
}

TEST(ActiveSet, IneligiblePointsAreNotThere) {
  const Index size = 24;
  Problem problem = normal_problem(size, 16, 2.0);
  std::vector<Index> kept;
  for (Index i = 0; i < size; ++i) {
    if (i % 3 == 0) {
      problem.eligible[std::size_t(i)] = 0;
    } else {
      kept.push_back(i);
    }
  }
  ActiveSetRun solver;
  solver.set_active(std::vector<char>(std::size_t(size), 1));
  const Vector found = solve(problem, solver);
  expect_solution(problem, found);
  const Vector reduced = solve(Problem(problem.w(kept, kept), problem.q(kept)));
  EXPECT_LE((found(kept) - reduced).lpNorm<Eigen::Infinity>(), 1e-13 * reduced.lpNorm<Eigen::Infinity>());
  std::ranges::fill(problem.eligible, char{0});
  EXPECT_EQ(solve(problem, solver), Vector::Zero(size));
}

/// An ineligible point may have no operator at all: W must be positive definite on the others only.
TEST(ActiveSet, AnIneligiblePointNeedsNoOperator) {
  Problem problem(Matrix::Zero(2, 2), Vector::Constant(2, -1.0));
  problem.w(1, 1) = 4.0;
  problem.eligible[0] = 0;
  EXPECT_EQ(solve(problem), Vector(Eigen::Vector2d(0.0, 0.25)));
}

/// A negative offset within its rounding is no penetration.
TEST(ActiveSet, OffsetsWithinTheirRoundingAreZero) {
  Problem problem(Matrix::Identity(2, 2), Eigen::Vector2d(-1e-10, -1.0));
  EXPECT_GT(solve(problem)[0], 0.0);
  problem.rounding.setConstant(1e-9);
  EXPECT_EQ(solve(problem), Vector(Eigen::Vector2d(0.0, 1.0)));
}

TEST(ActiveSet, PowersOfTwoChangeNoBit) {
  for (const unsigned seed : {1U, 2U}) {
    const Problem problem = normal_problem(50, seed, 4.0);
    ActiveSetRun one;
    int iterations = 0;
    const Vector expected = solve(problem, one, &iterations);
    for (const int matrix_power : {-200, -33, -1, 0, 1, 7, 201}) {
      for (const int offset_power : {-101, 0, 3, 150}) {
        Problem scaled = problem;
        scaled.w *= std::ldexp(1.0, matrix_power);
        scaled.q *= std::ldexp(1.0, offset_power);
        ActiveSetRun solver;
        int scaled_iterations = 0;
        const Vector found = solve(scaled, solver, &scaled_iterations);
        EXPECT_TRUE(found == expected * std::ldexp(1.0, offset_power - matrix_power))
            << matrix_power << " " << offset_power;
        EXPECT_EQ(scaled_iterations, iterations);
      }
    }
  }
}

TEST(ActiveSet, SolvesConditionsThatDependOnOneAnother) {
  ActiveSetRun solver;
  const Problem singular(Matrix::Ones(2, 2), Vector::Constant(2, -1.0));
  EXPECT_EQ(solve(singular, solver).sum(), 1.0);
  // A point that obstructs the other one.
  solver.reset();
  Problem opposed(Matrix::Ones(2, 2), Eigen::Vector2d(-1.0, 0.5));
  opposed.w(0, 1) = opposed.w(1, 0) = -1.0;
  const ContactSolution solution = solver.solve(opposed.points());
  EXPECT_FALSE(solution.solved());
  EXPECT_NE(solution.reason.find("contradict one another"), std::string::npos);
  // The same solver then solves a solvable problem.
  solver.reset();
  EXPECT_EQ(solve(Problem(2.0 * Matrix::Identity(2, 2), Vector::Constant(2, -1.0)), solver), Vector::Constant(2, 0.5));
}

TEST(ActiveSet, OfNoPointsIsSolved) {
  const Problem none(Matrix(0, 0), Vector(0));
  EXPECT_EQ(solve(none).size(), 0);
}

}  // namespace
}  // namespace ricochet::test_support
