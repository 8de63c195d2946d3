#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "support/case_run.hpp"

/// @file Blocks that fly, spin and fall at finite strain, and what is true of every such motion.
namespace ricochet::test_support {

/// Meshes a block of 1 × 0.5 (× 0.6), at rest on its side "bottom".
inline std::string finite_block(int dimension, double size_in_space) {
  return dimension == 2 ? mesh_geometry("finite-block-2d",
                                        "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                        "Physical Curve(\"bottom\") = {1};\n",
                                        0.125, 1)
                        : mesh_geometry("finite-block-3d",
                                        "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                                        "Physical Surface(\"bottom\") = {3};\n",
                                        size_in_space, 1);
}

// Displacements and velocities, as lists of expressions.
inline std::string stretched(int dimension) {
  return dimension == 2 ? "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]"
                        : "[\"0.02*sin(5*x)\", \"0.02*sin(5*y)\", \"0.02*sin(4*z+x)\"]";
}
inline std::string spinning(int dimension) {
  return dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"2*(x-0.5)\"]"
                        : "[\"0.3-2*(y-0.25)+(z-0.3)\", \"2*(x-0.5)-0.5*(z-0.3)\", \"0.5*(y-0.25)-(x-0.5)\"]";
}
inline std::string falling(int dimension) {
  return dimension == 2 ? "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\"]"
                        : "[\"0.3-2*(y-0.25)\", \"-0.5+2*(x-0.5)\", \"0.2\"]";
}

/// Makes a case of a displacement and a velocity.
using CaseOfMotion = std::function<std::string(const std::string& displacement, const std::string& velocity)>;

/// Expects halving the step to divide the error of a flight by four. `case_of` also has the step.
inline void expect_second_order(const std::function<std::string(double step, const std::string& displacement,
                                                                const std::string& velocity)>& case_of,
                                const std::string& what) {
  const auto end_of = [&](double step) {
    CaseRun run(case_of(step, "[\"0.02*(x-0.5)\", \"-0.01*(y-0.25)\"]", "[\"-2*(y-0.25)\", \"2*(x-0.5)\"]"));
    while (run.state().time < 0.016 * (1.0 - 1e-9)) run.session().step();
    return run.state().displacement;
  };
  const Vector coarse = end_of(4e-4), middle = end_of(2e-4), fine = end_of(1e-4);
  const double rate = (coarse - middle).norm() / (middle - fine).norm();
  EXPECT_GT(rate, 3.5) << what;
  EXPECT_LT(rate, 4.5) << what;
}

/// Expects two laws to give the same motion and forces under small loads.
inline void expect_same_motion(CaseRun linear, CaseRun finite, const std::string& what) {
  double force = 0.0, difference = 0.0;
  while (linear.session().step() && finite.session().step()) {
    const double of_linear = linear.state().forces.normal_reaction.sum();
    force = std::max(force, of_linear);
    difference = std::max(difference, std::abs(of_linear - finite.state().forces.normal_reaction.sum()));
  }
  EXPECT_GT(force, 0.0);
  EXPECT_LT(difference, 1e-6 * force) << what;
  const double size = linear.state().displacement.lpNorm<Eigen::Infinity>();
  EXPECT_LT((linear.state().displacement - finite.state().displacement).lpNorm<Eigen::Infinity>(), 1e-6 * size) << what;
}

/// Runs a motion of the velocity (p, q) in the plane and the same motion rotated as a whole, and expects rotated
/// positions. Returns the largest difference of internal strains.
inline double expect_turned_motion(const CaseOfMotion& case_of, const std::string& p, const std::string& q,
                                   const std::string& what = "") {
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  const std::string u = "0.02*sin(5*x)", v = "0.02*sin(5*y)", x = "(x+" + u + ")", y = "(y+" + v + ")";
  const auto turned = [&](const std::string& a, const std::string& b, const std::string& less_x,
                          const std::string& less_y) {
    return fmt::format("[\"({0:.17g})*{2}-({1:.17g})*{3}{4}\", \"({1:.17g})*{2}+({0:.17g})*{3}{5}\"]", c, s, a, b,
                       less_x, less_y);
  };
  CaseRun one(case_of("[\"" + u + "\", \"" + v + "\"]", "[\"" + p + "\", \"" + q + "\"]"));
  CaseRun other(case_of(turned(x, y, "-x", "-y"), turned(p, q, "", "")));
  one.run([] {});
  other.run([] {});
  const Matrix rotation = (Matrix(2, 2) << c, -s, s, c).finished();
  const Index nodes = one.problem().nodes.cols();
  const Points first = one.problem().nodes + one.state().displacement.reshaped(2, nodes);
  const Points second = other.problem().nodes + other.state().displacement.reshaped(2, nodes);
  EXPECT_LT((rotation * first - second).cwiseAbs().maxCoeff(), 1e-12) << what;
  const Vector strains = one.state().internal_strain - other.state().internal_strain;
  return strains.size() > 0 ? strains.lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace ricochet::test_support
