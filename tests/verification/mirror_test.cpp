#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "ricochet/mesh/merge_parts.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"
#include "support/two_bodies.hpp"

/// @file A body that meets its mirror image moves as if it met the plane between them without friction: the relative
/// motion and W are doubled, the forces are the same.
namespace ricochet::test_support::mirror_test {

struct MirroredBody {
  CellShape shape;
  std::vector<int> counts;
  int degree;
};

/// Blocks with a curved side towards the plane, at a distance of 0.01.
PointMap block_above(int up) {
  return [up](const Vector& x) {
    Vector y = x;
    y[up] = 0.01 + 0.7 * x[up] + (1.0 - x[up]) * 0.15 * std::pow(x[0] - 0.4, 2);
    return y;
  };
}

/// The mesh alone, or with its mirror image. Boxes of one shape have equal distortions, so images match node by node.
std::string write_blocks(const MirroredBody& body, bool with_image) {
  const int up = dimension(body.shape) - 1;
  StackedBoxes stack{body.shape, body.shape, body.counts, body.counts};
  // On facets that are not parallelograms the quadrature is exact only to nine digits, and some schemes amplify the
  // error.
  if (body.shape == CellShape::hexahedron) stack.distortion = 0.0;
  stack.upper_map = block_above(up);
  stack.lower_map = [up, above = stack.upper_map](const Vector& x) {
    Vector y = above(x);
    y[up] = -y[up];
    return y;
  };
  const std::string name = fmt::format("mirror{}{}.msh", up, with_image ? "pair" : "");
  if (with_image) return write_mesh(name, make_stack(stack));
  return write_mesh(
      name, merge_parts({{"upper", make_box_mesh({body.shape, body.counts, 1, stack.distortion, stack.upper_map})}}));
}

std::string case_text(const MirroredBody& body, const std::string& mesh, bool with_image,
                      const Discretization& discretization) {
  const bool flat = dimension(body.shape) == 2;
  const std::string face = flat ? "y0" : "z0";
  // Bodies do not slip on each other, however rough they are. The default of reduced-kane depends on friction.
  const std::string rough = with_image && takes_friction(discretization.scheme) ? "friction = 0.4\n" : "";
  const std::string plane = "[obstacle.plane]\ntype = \"plane\"\n" +
                            std::string(flat ? "point = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
                                             : "point = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n");
  const auto motion = [&](const char* group, int sign) {
    return fmt::format("[[motion]]\ngroup = \"{}\"\n{}", group,
                       flat ? fmt::format("velocity = [0.1, {}]\nspin = {}\n", -0.5 * sign, 0.1 * sign)
                            : fmt::format("velocity = [0.1, 0.05, {}]\nspin = [{}, {}, 0.0]\n", -0.5 * sign, 0.1 * sign,
                                          -0.05 * sign));
  };
  const bool is_explicit = time_of(discretization.scheme).find("explicit") != std::string::npos ||
                           discretization.scheme == "cd-lagrange" || discretization.scheme == "taylor-flanagan";
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = {}\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n"
      "{}[[contact]]\ngroup = \"upper.{}\"\n{}\nmultipliers = \"{}\"\nunstable_multipliers = \"allow\"\n{}{}{}[mass]\n"
      "type = \"{}\"\n[time]\n{}step = {}\nend = {}\n",
      mesh, body.degree, with_image ? "" : plane, face,
      with_image ? fmt::format("against = \"lower.{}\"\nmultipliers_on = \"group\"", face) : "obstacle = \"plane\"",
      discretization.multipliers, rough, motion("upper.body", 1), with_image ? motion("lower.body", -1) : "",
      discretization.mass,
      time_of(discretization.scheme) + (discretization.scheme == "reduced-kane" ? "reaction_weight = \"end\"\n" : ""),
      is_explicit ? 0.002 : 0.01, is_explicit ? 0.4 : 0.8);
}

/// Index of each point in another set that contains it.
std::vector<Index> find_nodes(const Points& points, const Points& among) {
  const auto key = [](const auto& x) { return std::vector<double>(x.begin(), x.end()); };
  std::map<std::vector<double>, Index> place;
  for (Index i = 0; i < among.cols(); ++i) place[key(among.col(i))] = i;
  std::vector<Index> result;
  for (Index i = 0; i < points.cols(); ++i) result.push_back(place.at(key(points.col(i))));
  return result;
}

/// Largest difference and largest value of displacements and forces over all steps.
struct Difference {
  double displacement = 0.0, force = 0.0;
  double largest_displacement = 0.0, largest_force = 0.0;
};

Difference compare(CaseRun& alone, CaseRun& pair) {
  const int d = alone.problem().dimension;
  const std::vector<Index> place = find_nodes(alone.problem().nodes, pair.problem().nodes);
  Difference result;
  std::vector<Vector> displacements;
  std::vector<double> forces;
  alone.run([&] {
    displacements.push_back(alone.state().displacement);
    forces.push_back(alone.state().forces.normal_reaction.sum());
  });
  std::size_t step = 0;
  pair.run([&] {
    if (step >= displacements.size()) return;
    const Vector& expected = displacements[step];
    for (std::size_t i = 0; i < place.size(); ++i) {
      const Vector difference = pair.state().displacement.segment(place[i] * d, d) - expected.segment(Index(i) * d, d);
      result.displacement = std::max(result.displacement, difference.lpNorm<Eigen::Infinity>());
    }
    result.force = std::max(result.force, std::abs(pair.state().forces.normal_reaction.sum() - forces[step]));
    result.largest_displacement = std::max(result.largest_displacement, expected.lpNorm<Eigen::Infinity>());
    result.largest_force = std::max(result.largest_force, forces[step]);
    ++step;
  });
  EXPECT_EQ(step, displacements.size());
  return result;
}

TEST(MirroredBodies, MoveAsOneAgainstThePlaneBetweenThem) {
  int compared = 0;
  for (const MirroredBody& body :
       {MirroredBody{CellShape::triangle, {5, 4}, 1}, MirroredBody{CellShape::quadrilateral, {4, 3}, 2},
        MirroredBody{CellShape::tetrahedron, {3, 2, 2}, 1}, MirroredBody{CellShape::hexahedron, {2, 3, 2}, 1}}) {
    const std::string one = write_blocks(body, false), two = write_blocks(body, true);
    for (const Discretization& discretization : all_discretizations()) {
      // Under Nitsche's method points penetrate in proportion to the stress error of one side; here both sides share
      // it.
      if (!discretization.is_possible() || discretization.scheme == "nitsche") continue;
      // Blocks of so few cells do not admit these masses.
      if (discretization.mass == "equivalent-nearest") continue;
      if (discretization.mass == "equivalent-lumped" && dimension(body.shape) == 3) continue;
      const std::string label =
          fmt::format("{} on {} degree {}", discretization.label(), name(body.shape), body.degree);
      CaseRun alone(case_text(body, one, false, discretization));
      CaseRun pair(case_text(body, two, true, discretization));
      const Difference found = compare(alone, pair);
      EXPECT_GT(found.largest_force, 0.0) << label;
      // Bathe's scheme amplifies rounding where contact nodes have inertia (docs/scorecard.md: it creates energy).
      const bool amplifies = discretization.scheme == "bathe" && !discretization.mass.starts_with("equivalent");
      const double tolerance = amplifies ? 1e-7 : 1e-10;
      EXPECT_LE(found.displacement, tolerance * found.largest_displacement) << label;
      EXPECT_LE(found.force, tolerance * found.largest_force) << label;
      ++compared;
    }
  }
  EXPECT_GT(compared, 400);
}

}  // namespace ricochet::test_support::mirror_test
