#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "ricochet/fem/material.hpp"
#include "support/case_run.hpp"

/// @file A viscoelastic block, as pieces of a case.
namespace ricochet::test_support::viscous {

inline std::string block(int dimension) {
  return dimension == 2 ? mesh_geometry("viscous-block-2d",
                                        "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                        "Physical Curve(\"bottom\") = {1};\nPhysical Curve(\"right\") = {2};\n"
                                        "Physical Curve(\"top\") = {3};\nPhysical Curve(\"left\") = {4};\n",
                                        0.125, 1)
                        : mesh_geometry("viscous-block-3d",
                                        "Box(1) = {0, 0, 0, 1, 0.5, 0.6};\nPhysical Volume(\"body\") = {1};\n"
                                        "Physical Surface(\"bottom\") = {3};\n",
                                        0.2, 1);
}

inline constexpr double young = 100.0, poisson = 0.3, shear = young / (2.0 * (1.0 + poisson));
inline constexpr double lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));

inline std::string list(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

inline std::string material(const std::string& law, const std::vector<RelaxationBranch>& branches,
                            double density = 1.0) {
  std::vector<double> moduli, times;
  for (const RelaxationBranch& branch : branches) {
    moduli.push_back(branch.modulus);
    times.push_back(branch.time);
  }
  const std::string relaxation =
      branches.empty() ? "" : fmt::format("relaxation = {{ modulus = {}, time = {} }}\n", list(moduli), list(times));
  return fmt::format("[[material]]\ngroup = \"body\"\ndensity = {}\nyoung = {}\npoisson = {}\nlaw = \"{}\"\n{}",
                     density, young, poisson, law, relaxation);
}

}  // namespace ricochet::test_support::viscous
