#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "ricochet/contact/row_writer.hpp"
#include "ricochet/contact/sliding/rigid_part.hpp"
#include "support/case_run.hpp"
#include "support/pair_rows.hpp"
#include "support/sanitized.hpp"
#include "support/two_bodies.hpp"

/// @file Rows of contact between bodies that slide far.
namespace ricochet::test_support {
namespace {

using Sled = PairOfBoxes;

/// A small box above a larger one; its whole base faces the larger one.
CaseRun sled_of(const Sled& of) {
  const bool plane = dimension(of.shape) == 2;
  const int d = plane ? 2 : 3;
  const std::vector<int> lower = plane ? std::vector{5, 2} : std::vector{4, 4, 2};
  const std::vector<int> upper = plane ? std::vector{3, 2} : std::vector{2, 2, 2};
  Vector place = Vector::Constant(d, 0.3);
  place[d - 1] = 1.01;
  const Mesh mesh = make_stack({.lower_shape = of.shape,
                                .upper_shape = of.shape,
                                .lower_counts = lower,
                                .upper_counts = upper,
                                .upper_map = affine_map(0.4 * Matrix::Identity(d, d), place)});
  const std::string name = fmt::format("sled-{}-{}.msh", int(of.shape), of.degree);
  const std::string last = plane ? "y" : "z";
  return CaseRun(
      fmt::format("[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"all\"\ndensity = 1.0\n"
                  "young = 100.0\npoisson = 0.3\n[[contact]]\ngroup = \"upper.{}0\"\nagainst = "
                  "\"lower.{}1\"\nmultipliers = \"{}\"\n"
                  "multipliers_on = \"group\"\nsliding = \"large\"\nunstable_multipliers = \"allow\"\nfriction = 0.1\n"
                  "[time]\nstep = 1e-3\nend = 1e-3\n",
                  write_mesh(name, mesh), of.degree, last, last, of.multipliers));
}

std::vector<Sled> sleds() {
  if (is_sanitized) return {{CellShape::triangle, "p1", 2}, {CellShape::hexahedron, "p0", 1}};
  std::vector<Sled> result;
  for (const CellShape shape : all_cell_shapes()) {
    for (const std::string multipliers : {"p1", "p0"}) result.push_back({shape, multipliers, 1});
    result.push_back({shape, "p1", 2});
  }
  return result;
}

/// Random displacements of the nodes, and a rotation of both bodies.
Vector some_slide(const SemidiscreteProblem& problem, unsigned seed, double size, double turn) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Vector result(problem.dof_count());
  const Index d = problem.dimension;
  Matrix rotation = Matrix::Identity(d, d);
  rotation.topLeftCorner(2, 2) << std::cos(turn), -std::sin(turn), std::sin(turn), std::cos(turn);
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Vector at = problem.nodes.col(node);
    for (Index k = 0; k < d; ++k) at[k] += number(random);
    result.segment(node * d, d) = rotation * at - problem.nodes.col(node);
  }
  return result;
}

ContactRows sled_rows(const SemidiscreteProblem& problem, const Vector& displacement, const StepStart* start) {
  ContactRows rows = *problem.contact.rows;
  problem.contact.geometry->update(displacement, 0.0, start, rows);
  return rows;
}

/// Largest difference between the rows and the derivatives of gaps along a motion, with the upper body raised.
double error_of_rows(const SemidiscreteProblem& problem, const std::string& what, double raised) {
  const Index d = problem.dimension;
  Vector at = some_slide(problem, 1, 0.002, 0.0);
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    if (problem.nodes(d - 1, node) > 1.001) at[node * d + d - 1] += raised - 0.01;
  }
  const Vector direction = some_slide(problem, 2, 0.05, 0.0);
  const ContactRows rows = sled_rows(problem, at, nullptr);
  Vector change;
  rows.normal_motion(direction, change);
  const double h = 1e-6;
  const Vector difference = (gaps(problem, at + h * direction) - gaps(problem, at - h * direction)) / (2.0 * h);
  EXPECT_GT(change.lpNorm<Eigen::Infinity>(), 1e-3) << what;
  return (difference - change).lpNorm<Eigen::Infinity>() / change.lpNorm<Eigen::Infinity>();
}

/// Up to terms that are proportional to the gap, and grow as the body is raised.
TEST(SlidingContact, RowsAreTheDerivativesOfGapsThatClose) {
  for (const Sled& sled : sleds()) {
    const CaseRun run = sled_of(sled);
    const double near = error_of_rows(run.problem(), name_of(sled), 0.002),
                 far = error_of_rows(run.problem(), name_of(sled), 2.0);
    EXPECT_LT(near, 4e-3) << name_of(sled);
    EXPECT_GT(far, 3.0 * near) << name_of(sled);
  }
}

/// A large box above a small one, which carries no multipliers: its rims lie below the facets of the large one.
CaseRun box_over_rims(CellShape shape, const std::string& multipliers) {
  const bool plane = dimension(shape) == 2;
  const int d = plane ? 2 : 3;
  Vector place = Vector::Constant(d, -0.17);
  place[d - 1] = 1.002;
  const Mesh mesh = make_stack({.lower_shape = shape,
                                .upper_shape = shape,
                                .lower_counts = plane ? std::vector{3, 2} : std::vector{2, 2, 2},
                                .upper_counts = plane ? std::vector{6, 2} : std::vector{4, 4, 2},
                                .upper_map = affine_map(1.5 * Matrix::Identity(d, d), place)});
  const std::string last = plane ? "y" : "z";
  return CaseRun(
      fmt::format("[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 100.0\n"
                  "poisson = 0.3\n[[contact]]\ngroup = \"upper.{}0\"\nagainst = \"lower.{}1\"\n"
                  "multipliers = \"{}\"\nmultipliers_on = \"group\"\nsliding = \"large\"\n"
                  "unstable_multipliers = \"allow\"\n[time]\nstep = 1e-3\nend = 1e-3\n",
                  write_mesh(fmt::format("rims-{}.msh", int(shape)), mesh), last, last, multipliers));
}

/// Moves the upper body along the first axis.
Vector slid(const SemidiscreteProblem& problem, double way) {
  const Index d = problem.dimension;
  Vector result = Vector::Zero(problem.dof_count());
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    if (problem.nodes(d - 1, node) > 1.001) result[node * d] = way;
  }
  return result;
}

/// While a body slides over rims, gaps are continuous and rows their derivatives. (Quadrature is not exact where the
/// rounded zone ends within a segment.)
TEST(SlidingContact, RowsAtARimAreTheDerivativesOfGaps) {
  for (const CellShape shape : {CellShape::triangle, CellShape::quadrilateral, CellShape::hexahedron}) {
    const CaseRun run = box_over_rims(shape, "p1");
    const SemidiscreteProblem& problem = run.problem();
    constexpr double step = 1e-6;
    double steepest = 0.0;
    for (int k = 0; k < 60; ++k) {
      const double way = 0.005 * k;
      const Vector before = gaps(problem, slid(problem, way - step)), after = gaps(problem, slid(problem, way + step));
      const ContactRows rows = sled_rows(problem, slid(problem, way), nullptr);
      Vector change;
      rows.normal_motion(slid(problem, 1.0), change);
      for (Index i = 0; i < rows.size(); ++i) {
        if (rows.gap[i] > 0.2 || before[i] > 0.2 || after[i] > 0.2) continue;
        steepest = std::max(steepest, std::abs(change[i]));
        EXPECT_NEAR(change[i], (after[i] - before[i]) / (2.0 * step), 0.1) << int(shape) << " " << k << " " << i;
      }
    }
    EXPECT_GT(steepest, 0.4) << int(shape);
    EXPECT_LT(steepest, 1.5) << int(shape);
  }
}

TEST(SlidingContact, RowsOfAStepMeetBothEnds) {
  for (const Sled& sled : sleds()) {
    const CaseRun run = sled_of(sled);
    const SemidiscreteProblem& problem = run.problem();
    const Vector first = some_slide(problem, 3, 0.01, 0.1), second = some_slide(problem, 4, 0.01, 0.3);
    const StepStart start{first, 0.0};
    const ContactRows rows = sled_rows(problem, second, &start);
    expect_change_of_gaps(problem, rows, first, second, name_of(sled));
    expect_balance(problem, rows, 0.5 * (first + second), 1e-13, name_of(sled));
  }
}

TEST(SlidingContact, RigidMotionsChangeNoGapAndRowsHaveNoResultant) {
  for (const Sled& sled : sleds()) {
    const CaseRun run = sled_of(sled);
    const SemidiscreteProblem& problem = run.problem();
    const Vector at = some_slide(problem, 5, 0.01, 0.0);
    expect_balance(problem, sled_rows(problem, at, nullptr), at, 1e-13, name_of(sled));
    expect_invariant_gaps(problem, at, name_of(sled));
  }
}

/// For a reaction of 1, the force on the upper body is a unit vector.
TEST(SlidingContact, AReactionIsTheForceOnTheBody) {
  for (const Sled& sled : sleds()) {
    const CaseRun run = sled_of(sled);
    const SemidiscreteProblem& problem = run.problem();
    const Index d = problem.dimension;
    const ContactRows rows = sled_rows(problem, some_slide(problem, 6, 0.01, 0.4), nullptr);
    for (Index i = 0; i < rows.size(); ++i) {
      Vector force = Vector::Zero(d);
      rows.visit_normal(i, [&](Index dof, double value) {
        if (problem.nodes(d - 1, dof / d) > 1.001) force[dof % d] += value;
      });
      EXPECT_LT((force - rows.normal(i)).norm(), 1e-12) << name_of(sled);
      EXPECT_LT(std::abs(rows.normal(i).dot(rows.tangents[std::size_t(i)].col(0))), 1e-14);
    }
  }
}

TEST(SlidingContact, RowsOfAStepAreFrozenUntilItEnds) {
  const CaseRun run = sled_of({CellShape::triangle, "p1", 2});
  const SemidiscreteProblem& problem = run.problem();
  const ContactGeometry& geometry = *problem.contact.geometry;
  const Vector first = some_slide(problem, 3, 0.01, 0.1), second = some_slide(problem, 4, 0.01, 0.2);
  const StepStart start{first, 0.0};
  geometry.begin_step();
  ContactRows rows = sled_rows(problem, second, &start);
  EXPECT_FALSE(geometry.is_frozen());
  EXPECT_TRUE(geometry.freeze());
  EXPECT_TRUE(geometry.is_frozen());
  EXPECT_FALSE(geometry.freeze());
  const Matrix before = rows.gap_operator;
  geometry.update(some_slide(problem, 5, 0.01, 0.3), 0.0, &start, rows);
  EXPECT_EQ(Matrix(rows.gap_operator), before);
  geometry.end_step();
  EXPECT_FALSE(geometry.is_frozen());
}

/// Rows rebuilt from their stored positions have the same bits.
TEST(SlidingContact, RowsAreRestored) {
  const CaseRun run = sled_of({CellShape::triangle, "p1", 2});
  const SemidiscreteProblem& problem = run.problem();
  const Vector first = some_slide(problem, 3, 0.01, 0.1), second = some_slide(problem, 4, 0.01, 0.2);
  const StepStart start{first, 0.0};
  const ContactRows rows = sled_rows(problem, second, &start);
  const Vector values = problem.contact.geometry->row_values(rows);
  ASSERT_EQ(values.size(), problem.contact.geometry->row_value_count());
  sled_rows(problem, first, nullptr);
  ContactRows again = *problem.contact.rows;
  problem.contact.geometry->restore(rows.normals, rows.gap, values, again);
  EXPECT_EQ(Matrix(rows.gap_operator), Matrix(again.gap_operator));
  EXPECT_EQ(Matrix(rows.tangential_trace), Matrix(again.tangential_trace));
  EXPECT_EQ(rows.normals, again.normals);
}

TEST(RowWriter, RowsGetOtherColumns) {
  SparseRowMatrix matrix(3, 5);
  matrix.insert(0, 1) = 1.0;
  matrix.insert(1, 2) = 2.0;
  matrix.insert(2, 3) = 3.0;
  matrix.makeCompressed();
  Matrix expected = matrix;
  RowWriter writer;
  std::vector<char> changed(3, 0);
  writer.set(2, {{0, 5.0}, {4, 6.0}});
  writer.set(0, {{1, 1.0}});
  EXPECT_TRUE(writer.write(matrix, changed));
  expected.row(2) << 5.0, 0.0, 0.0, 0.0, 6.0;
  EXPECT_EQ(Matrix(matrix), expected);
  EXPECT_EQ(changed, (std::vector<char>{0, 0, 1}));
  writer.set(1, {});
  EXPECT_TRUE(writer.write(matrix, changed));
  expected.row(1).setZero();
  EXPECT_EQ(Matrix(matrix), expected);
  writer.set(2, {{0, 5.0}, {4, 6.0}});
  EXPECT_FALSE(writer.write(matrix, changed));
}

TEST(RigidPart, OnlyDeformationIsLeft) {
  for (const bool plane : {true, false}) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    std::vector<Eigen::Vector3d> places, rigid, motions;
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d place(number(random), number(random), plane ? 0.0 : number(random));
      places.push_back(place);
      rigid.push_back(Eigen::Vector3d(0.3, -0.2, plane ? 0.0 : 0.5) +
                      Eigen::Vector3d(plane ? 0.0 : 0.4, plane ? 0.0 : -0.1, 0.7).cross(place));
      motions.push_back(rigid.back() + Eigen::Vector3d(number(random), number(random), plane ? 0.0 : number(random)));
    }
    remove_rigid_part(places, plane, rigid);
    remove_rigid_part(places, plane, motions);
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    double largest = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      EXPECT_LT(rigid[k].norm(), 1e-15);
      force += motions[k];
      moment += places[k].cross(motions[k]);
      largest = std::max(largest, motions[k].norm());
    }
    EXPECT_LT(force.norm(), 1e-14);
    EXPECT_LT(moment.norm(), 1e-14);
    EXPECT_GT(largest, 0.1);
    const Eigen::Vector3d wanted(plane ? 0.0 : 0.3, plane ? 0.0 : -0.7, 0.5);
    std::vector<Eigen::Vector3d> couple;
    forces_of_couple(places, plane, wanted, couple);
    force.setZero();
    moment.setZero();
    for (std::size_t k = 0; k < places.size(); ++k) {
      force += couple[k];
      moment += places[k].cross(couple[k]);
    }
    EXPECT_LT(force.norm(), 1e-15);
    EXPECT_LT((moment - wanted).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace ricochet::test_support
