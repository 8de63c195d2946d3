#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/case_run.hpp"

// C. Cattaneo (1938), R. D. Mindlin (1949): a cylinder pressed on a rigid plane by P and then pushed along it by Q < F
// P slips at the edges of the contact and sticks in the middle, |x| < c with c/a = √(1 − Q/FP). There q/Fp = 1 − √((c²
// − x²)/(a² − x²)), beyond it q = F p. Exact for a half-space with ν = ½, where pressure and friction are uncoupled (K.
// L. Johnson, Contact Mechanics, 1985, section 7.2).

namespace ricochet::test_support::friction_partial_slip_test {

/// The lower half of a disc of radius 1, with small cells where it touches.
std::string half_disc(double fine) {
  return mesh_geometry(
      fmt::format("half{}", fine),
      fmt::format("Point(1) = {{-1, 1, 0}}; Point(2) = {{0, 1, 0}}; Point(3) = {{1, 1, 0}}; Point(4) = {{0, 0, 0}};"
                  "Point(5) = {{-Sin(0.25), 1 - Cos(0.25), 0}}; Point(6) = {{Sin(0.25), 1 - Cos(0.25), 0}};"
                  "Circle(1) = {{1, 2, 5}}; Circle(2) = {{5, 2, 4}}; Circle(3) = {{4, 2, 6}}; Circle(4) = {{6, 2, 3}};"
                  "Line(5) = {{3, 2}}; Line(6) = {{2, 1}};"
                  "Curve Loop(1) = {{1, 2, 3, 4, 5, 6}}; Plane Surface(1) = {{1}};"
                  "Mesh.MeshSizeMin = 0; Mesh.MeshSizeMax = 1; Mesh.MeshSizeExtendFromBoundary = 0;"
                  "Mesh.MeshSizeFromPoints = 0; Field[1] = Distance; Field[1].PointsList = {{4}};"
                  "Field[2] = Threshold; Field[2].InField = 1; Field[2].SizeMin = {}; Field[2].SizeMax = 0.12;"
                  "Field[2].DistMin = 0.09; Field[2].DistMax = 1.0; Background Field = 2;"
                  "Physical Surface(\"body\") = {{1}}; Physical Curve(\"lower\") = {{2, 3}};"
                  "Physical Curve(\"top\") = {{5, 6}};",
                  fine),
      0.1, 2);
}

constexpr double coefficient = 0.3, young = 3.0, poisson = 0.49;

/// Pressed until t = 40 and pushed from 60 on, slowly relative to the waves (10 time units through the body and back),
/// which damping and γ > ½ remove.
std::string pressed_case(double fine) {
  return fmt::format(
      "[mesh]\nfile = \"{}\"\ndegree = 2\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = {}\npoisson = {}\n"
      "damping = {{ mass = 0.0, stiffness = 1.0 }}\n"
      "[obstacle.plane]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
      "[[contact]]\ngroup = \"lower\"\nobstacle = \"plane\"\nfriction = {}\n"
      "[[support]]\ngroup = \"top\"\ncomponents = [\"y\"]\nvalue = \"-0.008*(t < 40 ? sin(pi*t/80)^2 : 1)\"\n"
      "[[support]]\ngroup = \"top\"\ncomponents = [\"x\"]\nvalue = \"t < 60 ? 0 : 0.0026*sin(pi*(t-60)/160)^2\"\n"
      "[time]\nscheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\nstep = 0.5\nend = 140.0\n",
      half_disc(fine), young, poisson, coefficient);
}

struct ContactNode {
  double x = 0.0, pressure = 0.0, traction = 0.0;
  ContactStatus status = ContactStatus::open;
};

std::vector<ContactNode> contact_nodes(const CaseRun& run) {
  const ContactBoundary& contact = run.problem().contact;
  const StepForces& forces = run.state().forces;
  Vector along = forces.tangential_reaction;
  for (Index i = 0; i < along.size(); ++i) along[i] *= contact.rows->tangents[std::size_t(i)](0, 0);
  const Vector pressure = contact.pressure_recovery * forces.normal_reaction;
  const Vector traction = contact.pressure_recovery * along;
  std::vector<ContactNode> nodes;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const auto k = Index(i);
    nodes.push_back(
        {run.problem().nodes(0, contact.nodes[i]), pressure[k], traction[k], run.state().contact_status[i]});
  }
  std::ranges::sort(nodes, {}, &ContactNode::x);
  return nodes;
}

/// Half the length on which nodes stick, up to the middle between the last sticking and the first slipping node.
double stick_half_width(const std::vector<ContactNode>& nodes) {
  double first = 0.0, last = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const bool before = nodes[i - 1].status == ContactStatus::stick, here = nodes[i].status == ContactStatus::stick;
    if (here && !before) first = 0.5 * (nodes[i - 1].x + nodes[i].x);
    if (before && !here) last = 0.5 * (nodes[i - 1].x + nodes[i].x);
  }
  return 0.5 * (last - first);
}

/// Relative L² error of the even part of the traction over the contact. Pressing leaves an odd part: a disc is no
/// half-space, and its ν not quite ½, so the surface tends to slip outwards or inwards, and friction holds it. The
/// nodes lie symmetrically.
double traction_error(const std::vector<ContactNode>& nodes, double a, double c, double peak) {
  double error = 0.0, size = 0.0;
  const auto ellipse = [](double r) { return std::sqrt(std::max(0.0, 1.0 - r * r)); };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double x = nodes[i].x;
    const double even = 0.5 * (nodes[i].traction + nodes[nodes.size() - 1 - i].traction);
    const double exact = coefficient * peak * (ellipse(x / a) - c / a * ellipse(x / c));
    error += (even - exact) * (even - exact);
    size += exact * exact;
  }
  return std::sqrt(error / size);
}

// The half-space of the theory is a half disc with a/R = 0.07 here, with ν = 0.49: c/a is accurate to 2 %, where the
// nodes that separate stick from slip are 2 % of a apart.
TEST(PartialSlip, CylinderPushedAlongThePlane) {
  std::vector<std::pair<double, double>> coarse_errors;
  for (const double fine : {0.006, 0.003}) {
    CaseRun run(pressed_case(fine));
    std::vector<std::pair<double, double>> errors;
    run.run([&] {
      const double t = run.state().time;
      if (t != 100.0 && t != 120.0 && t != 140.0) return;
      const std::vector<ContactNode> nodes = contact_nodes(run);
      const double load = run.state().forces.normal_reaction.sum();
      double shear = 0.0;
      for (Index i = 0; i < run.problem().contact.size(); ++i) {
        shear += run.problem().contact.rows->tangents[std::size_t(i)](0, 0) * run.state().forces.tangential_reaction[i];
      }
      const double a = std::sqrt(4.0 * load * (1.0 - poisson * poisson) / (M_PI * young));  // Hertz
      const double ratio = std::sqrt(1.0 - shear / (coefficient * load));
      const double width_error = stick_half_width(nodes) / a / ratio - 1.0;
      errors.emplace_back(width_error, traction_error(nodes, a, ratio * a, 2.0 * load / (M_PI * a)));
      std::printf("cells of %.3f: Q/FP %.4f, c/a %.4f to %+.1f %%, traction to %.1f %%\n", fine,
                  shear / (coefficient * load), ratio, 100.0 * width_error, 100.0 * errors.back().second);
    });
    ASSERT_EQ(errors.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(std::abs(errors[i].first), fine == 0.003 ? 0.02 : 0.04);
      EXPECT_LT(errors[i].second, fine == 0.003 ? 0.08 : 0.14);
      if (!coarse_errors.empty()) {
        EXPECT_LT(errors[i].second, coarse_errors[i].second / 1.3);
      }
    }
    coarse_errors = errors;
  }
}

}  // namespace ricochet::test_support::friction_partial_slip_test
