#include "ricochet/step/contact_tangent.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/case_run.hpp"
#include "support/pair_rows.hpp"
#include "support/two_bodies.hpp"

/// @file Derivatives of contact conditions against differences along a direction.
namespace ricochet::test_support {
namespace {

Vector some_motion(const SemidiscreteProblem& problem, unsigned seed, double size) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Vector result(problem.dof_count());
  for (double& value : result) value = number(random);
  return result;
}

/// A block above another one, which is larger, or above a ball, a step from u₀ to u₁, and reactions on all points.
struct StepOnSurface {
  CaseRun run;
  Vector start, end;
  Reactions reactions;

  explicit StepOnSurface(const std::string& toml)
      : run(toml), start(some_motion(run.problem(), 1, 2e-3)), end(start + some_motion(run.problem(), 2, 4e-3)) {
    const Index points = run.problem().contact.size(), d = run.problem().dimension;
    reactions.normal_reaction = Vector::LinSpaced(points, 1.0, 2.0);
    reactions.tangential_reaction = Vector::LinSpaced(points * (d - 1), -0.3, 0.3);
  }
  [[nodiscard]] ContactRows rows(const Vector& at) const {
    ContactRows result = *run.problem().contact.rows;
    const StepStart from{start, 0.0};
    run.problem().contact.geometry->update(at, 0.0, &from, result);
    return result;
  }
  [[nodiscard]] Vector force(const Vector& at) const {
    Vector result = Vector::Zero(run.problem().dof_count());
    rows(at).add_force(reactions.normal_reaction, reactions.tangential_reaction, result);
    return result;
  }
  /// Slips in space, as tangents may be rotated in their plane from one displacement to the next.
  [[nodiscard]] Vector slip(const Vector& at) const {
    const ContactRows there = rows(at);
    Vector along;
    there.tangential_motion(at - start, along);
    Vector result(there.size() * there.dimension());
    for (Index i = 0; i < there.size(); ++i)
      result.segment(i * there.dimension(), there.dimension()) = there.along_tangents(i, along);
    return result;
  }
};

std::string case_on(const std::string& mesh, const std::string& contact) {
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n" + contact +
         "[time]\nstep = 1e-3\nend = 1e-3\n";
}

std::vector<std::string> surfaces() {
  std::vector<std::string> result;
  for (const CellShape shape : {CellShape::triangle, CellShape::hexahedron}) {
    const bool plane = dimension(shape) == 2;
    const int d = plane ? 2 : 3;
    Vector place = Vector::Constant(d, 0.3);
    place[d - 1] = 1.001;
    const Mesh mesh = make_stack({.lower_shape = shape,
                                  .upper_shape = shape,
                                  .lower_counts = plane ? std::vector{5, 2} : std::vector{4, 4, 2},
                                  .upper_counts = plane ? std::vector{3, 2} : std::vector{2, 2, 2},
                                  .upper_map = affine_map(0.4 * Matrix::Identity(d, d), place)});
    const std::string file = write_mesh("tangent-" + std::to_string(d) + ".msh", mesh), last = plane ? "y" : "z";
    // Points with constant rows besides those of surfaces.
    const std::string floor = std::string("[obstacle.floor]\ntype = \"plane\"\npoint = ") +
                              (plane ? "[0, 0]\nnormal = [0, 1]" : "[0, 0, 0]\nnormal = [0, 0, 1]") +
                              "\n[[contact]]\ngroup = \"lower." + last + "0\"\nobstacle = \"floor\"\nfriction = 0.1\n";
    result.push_back(case_on(file, floor + "[[contact]]\ngroup = \"upper." + last + "0\"\nagainst = \"lower." + last +
                                       "1\"\nmultipliers_on = \"group\"\nsliding = \"large\"\nfriction = 0.1\n"));
    result.push_back(case_on(file, floor + std::string("[obstacle.ball]\ntype = \"sphere\"\ncentre = ") +
                                       (plane ? "[0.5, 0.6]" : "[0.5, 0.5, 0.6]") +
                                       "\nradius = 0.5\n[[contact]]\ngroup = \"upper." + last +
                                       "0\"\nobstacle = \"ball\"\nfriction = 0.1\n"));
  }
  return result;
}

TEST(ContactTangent, IsTheDerivativeOfGapsSlipsAndForces) {
  for (const std::string& toml : surfaces()) {
    const StepOnSurface step(toml);
    const SemidiscreteProblem& problem = step.run.problem();
    ContactTangent tangent;
    const StepStart from{step.start, 0.0};
    const ContactRows rows = step.rows(step.end);
    tangent.differentiate(problem, {step.start, step.end, 0.0, &from}, rows, step.reactions);
    const Vector direction = some_motion(problem, 3, 1.0);
    constexpr double width = 1e-5;
    const Vector after = step.end + width * direction, before = step.end - width * direction;
    const auto expect_near = [&](const Vector& product, const Vector& difference, const char* what) {
      EXPECT_GT(difference.norm(), width) << what;
      EXPECT_LT((product - difference / (2.0 * width)).norm(), 1e-6 * product.norm()) << what << "\n" << toml;
    };
    expect_near(tangent.gap() * direction, gaps(problem, after) - gaps(problem, before), "gaps");
    // Rotations of the tangents with the normal are beside the point.
    Vector slips = step.slip(after) - step.slip(before), along(rows.tangential_trace.rows());
    for (Index i = 0; i < rows.size(); ++i)
      along.segment(i * (problem.dimension - 1), problem.dimension - 1) =
          rows.tangents[std::size_t(i)].transpose() * slips.segment(i * problem.dimension, problem.dimension);
    expect_near(tangent.slip() * direction, along, "slips");
    if (problem.dimension == 2)
      expect_near(tangent.force() * direction, step.force(after) - step.force(before), "forces");
  }
}

TEST(ContactTangent, OfPlanesIsTheRows) {
  const Mesh mesh = make_stack({.lower_shape = CellShape::triangle,
                                .upper_shape = CellShape::triangle,
                                .lower_counts = {3, 2},
                                .upper_counts = {3, 2},
                                .upper_map = affine_map(Matrix::Identity(2, 2), Vector::Unit(2, 1) * 1.1)});
  const StepOnSurface step(case_on(write_mesh("tangent-plane.msh", mesh),
                                   "[obstacle.floor]\ntype = \"plane\"\npoint = [0, 0]\nnormal = [0, 1]\n[[contact]]\n"
                                   "group = \"lower.y0\"\nobstacle = \"floor\"\nfriction = 0.1\n"));
  ContactTangent tangent;
  const StepStart from{step.start, 0.0};
  const ContactRows& rows = *step.run.problem().contact.rows;
  tangent.differentiate(step.run.problem(), {step.start, step.end, 0.0, &from}, rows, step.reactions);
  EXPECT_EQ(Matrix(tangent.gap()), Matrix(rows.gap_operator));
  EXPECT_EQ(Matrix(tangent.slip()), Matrix(rows.tangential_trace));
  EXPECT_EQ(tangent.force().nonZeros(), 0);
}

}  // namespace
}  // namespace ricochet::test_support
